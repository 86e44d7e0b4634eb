"""Formats without a module of their own: what nibabel reads, and VTK's readers of pictures."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkIOImage import vtkImageReader2Factory

from .._vtk import captured_output
from ..geometry import image_from_array, set_axes
from .vtk_files import read_with


def read_other(path: Path, known: Iterable[str]) -> vtkDataObject:
    """Read a file by nibabel, else by VTK's readers of pictures.

    Parameters
    ----------
    path : pathlib.Path
    known : iterable of str
        Suffixes of all other formats, for the message.

    Raises
    ------
    ValueError
        When neither can read the file.
    """
    try:
        return read_nibabel(path)
    except (ImportError, ValueError) as error:
        reader = _picture_reader(path)
        if reader is not None:
            return read_with(reader, path)
        more = "; with nibabel also what that reads" if isinstance(error, ImportError) else ""
        raise ValueError(
            f"do not know how to read '{path}' (known: {', '.join(known)}{more})"
        ) from None


def _picture_reader(path: Path) -> Any:
    with captured_output():  # each reader that cannot read the file prints an error
        reader = vtkImageReader2Factory.CreateImageReader2(str(path))
    # One of VTK's readers claims any file, and crashes on it: trust the suffix.
    known = "" if reader is None else reader.GetFileExtensions().lower()
    return reader if path.suffix.lower() in known.split() else None


def read_nibabel(path: Path) -> vtkImageData:
    """Read any other image format that nibabel knows (``.mgz``, ``.mnc``, ``.hdr``/``.img`` …).

    Raises
    ------
    ImportError
        When nibabel is not installed.
    ValueError
        When nibabel cannot read the file or it is not a volume.
    """
    try:
        import nibabel
    except ImportError:
        raise ImportError(f"reading '{path}' needs nibabel: pip install nibabel") from None
    try:
        source: Any = nibabel.load(path)
        values = np.asarray(source.dataobj)
    except (nibabel.filebasedimages.ImageFileError, nibabel.spatialimages.HeaderDataError) as error:
        raise ValueError(f"cannot read '{path}': {error}") from None
    while values.ndim > 3:  # of a series the first volume
        values = values[..., 0]
    if values.ndim != 3:
        raise ValueError(f"'{path}' is not a volume: its shape is {values.shape}")
    native = np.ascontiguousarray(values.T, values.dtype.newbyteorder("="))
    image = image_from_array(native, values.shape, name="scalars")
    set_axes(image, source.affine[:3, :3], source.affine[:3, 3])
    return image
