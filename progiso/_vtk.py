"""Helpers around VTK that the rest of the package shares."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from ._typing import Progress

# "ERROR: In file.cxx, line 12\nvtkClass (0x55...): the message\n\n"
_MESSAGE = re.compile(
    r"(ERROR|Warning): In [^\n]*\n(.*?)(?=\n\s*\n|\Z)",
    re.DOTALL,
)
_OBJECT = re.compile(r"^\w+ \((?:0x)?[0-9a-fA-F]+\)[^:]*: ")


@contextmanager
def captured_output() -> Iterator[vtkStringOutputWindow]:
    """Keep what VTK prints inside the block from standard error.

    Yields
    ------
    vtkmodules.vtkCommonCore.vtkStringOutputWindow
        Its ``GetOutput()`` is the text.
    """
    window, verbosity = vtkOutputWindow.GetInstance(), vtkLogger.GetCurrentVerbosityCutoff()
    capture = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(capture)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield capture
    finally:
        vtkLogger.SetStderrVerbosity(verbosity)
        vtkOutputWindow.SetInstance(window)


@contextmanager
def vtk_errors(what: str) -> Iterator[None]:
    """Turn what VTK prints as an error inside the block into one exception.

    Parameters
    ----------
    what : str
        What was being attempted; the exception's message starts with it.

    Raises
    ------
    RuntimeError
        With VTK's own message on one line, when VTK reported an error.

    Warns
    -----
    UserWarning
        For every warning of VTK.

    Examples
    --------
    >>> from vtkmodules.vtkIOXML import vtkXMLImageDataReader
    >>> reader = vtkXMLImageDataReader()
    >>> reader.SetFileName("none.vti")
    >>> with vtk_errors("cannot read"):
    ...     reader.Update()
    Traceback (most recent call last):
        ...
    RuntimeError: cannot read: Error opening file none.vti
    """
    with captured_output() as capture:
        yield
    errors, warned = _messages(capture.GetOutput())
    for message in warned:
        warnings.warn(f"{what}: {message}", stacklevel=3)
    if errors:
        raise RuntimeError(f"{what}: {errors[0]}")


def messages_of(text: str) -> list[str]:
    """Return the errors and warnings that VTK prints, each in one line without its place."""
    errors, warned = _messages(text)
    return errors + warned


def _messages(text: str) -> tuple[list[str], list[str]]:
    """Split VTK's output into one-line errors and warnings, without object addresses."""
    errors: list[str] = []
    failures: list[str] = []
    warned: list[str] = []
    for kind, body in _MESSAGE.findall(text):
        message = " ".join(_OBJECT.sub("", body).split())
        # The executive repeats that its algorithm failed, without a reason.
        if "returned failure for request" in message:
            failures.append(message.split(" returned failure")[0] + " failed")
        else:
            (errors if kind == "ERROR" else warned).append(message)
    return errors or failures, warned


def image_data(image: Any) -> vtkImageData:
    """Check that an argument is a `vtkImageData` and return it.

    Raises
    ------
    TypeError
        Naming what was passed instead.
    """
    if not getattr(image, "IsA", lambda _: False)("vtkImageData"):
        raise TypeError(f"expected a vtkImageData, got {type(image).__name__}{_hint(image)}")
    return image


def _hint(found: Any) -> str:
    """Tell what to do about something that is no image."""
    if isinstance(found, (str, Path)):
        return ": progiso.read makes an image of a file"
    is_a = getattr(found, "IsA", lambda _: False)
    if is_a("vtkCompositeDataSet"):
        return ": take one of its blocks"
    if is_a("vtkDataSet"):
        return (
            ": resample it to an image (ParaView's 'Resample To Image', vtkResampleToImage, or "
            "pyvista.ImageData(...).sample(mesh))"
        )
    return ""


def observe_progress(algorithm: vtkAlgorithm, progress: Progress | None) -> None:
    """Call ``progress(fraction)`` whenever a VTK algorithm reports progress."""
    if progress is not None:
        observe: Any = algorithm.AddObserver  # VTK's stubs do not know names of events
        observe("ProgressEvent", lambda source, _: progress(source.GetProgress()))
