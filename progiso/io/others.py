"""Formats without a module of their own: VTK's readers of pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from vtkmodules.vtkIOImage import vtkImageReader2Factory

from .._vtk import captured_output
from .formats import FORMATS
from .images import ImageSource
from .source import Selection, Source
from .vtk_files import read_with


def open_other(path: Path, selection: Selection) -> Source:
    """Open a file of another format by VTK's readers of pictures.

    Raises
    ------
    ValueError
        When none of them takes it.
    """
    reader = _picture_reader(path)
    if reader is None:
        raise ValueError(f"do not know how to read '{path}' (known: {', '.join(FORMATS)})")
    return ImageSource(path, read_with(reader, path), selection.array)


def _picture_reader(path: Path) -> Any:
    with captured_output():  # each reader that cannot read the file prints an error
        reader = vtkImageReader2Factory.CreateImageReader2(str(path))
    # One of VTK's readers claims any file, and crashes on it: trust the suffix.
    known = "" if reader is None else reader.GetFileExtensions().lower()
    return reader if path.suffix.lower() in known.split() else None
