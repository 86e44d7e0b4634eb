"""zfp's own format (``.zfp``): a fixed-rate stream, with or without zfp's header."""

from __future__ import annotations

from pathlib import Path

from vtkmodules.vtkCommonDataModel import vtkImageData

from ..vtkProgIsoFilters import vtkZFPReader, vtkZFPWriter
from .images import ImageSource
from .source import Selection, Source
from .vtk_files import read_with, write_with


def open_zfp(path: Path, selection: Selection) -> Source:
    """Open a stream; without header, dimensions and rate are needed to make sense of it."""
    reader = vtkZFPReader()
    if selection.dimensions is not None:
        reader.SetDataDimensions([int(n) for n in selection.dimensions])
        reader.SetRate(8.0 if selection.rate is None else selection.rate)
    elif not reader.HasReadableHeader(str(path)):
        raise ValueError(
            f"'{path}' has no zfp header of a fixed-rate 3-D float32 array; give dimensions and "
            "rate of a file without header"
        )
    reader.SetArrayName(path.stem)
    return ImageSource(path, read_with(reader, path))


def write_zfp(image: vtkImageData, path: Path) -> None:
    """Write a compressed volume's stream with zfp's header."""
    writer = vtkZFPWriter()
    writer.SetInputData(image)
    write_with(writer, path)
