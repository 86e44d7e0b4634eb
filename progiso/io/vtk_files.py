"""VTK's own image files: ``.vti``, ``.pvti`` and ``.vtk``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkIOLegacy import vtkDataSetReader
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader,
    vtkXMLImageDataWriter,
    vtkXMLPImageDataReader,
)

from .._typing import Progress
from .._vtk import observe_progress, vtk_errors
from ..compression import is_compressed

#: VTK's reader by suffix.
VTK_READERS = {
    ".vti": vtkXMLImageDataReader,
    ".pvti": vtkXMLPImageDataReader,
    ".vtk": vtkDataSetReader,
}


def read_with(reader: Any, path: Path, progress: Progress | None = None) -> vtkDataObject:
    """Run a VTK reader on a file."""
    observe_progress(reader, progress)
    try:
        with vtk_errors(f"cannot read '{path}'"):
            reader.SetFileName(str(path))
            reader.Update()
    except RuntimeError as error:
        if "not well-formed" in str(error) and _has_raw_appended_data(path):
            raise RuntimeError(
                f"cannot read '{path}': its data are appended raw, which VTK before 9.3.1 cannot "
                "read with a libexpat of 2024 or later; preload libEagerExpat.so (README, "
                "ParaView), or save the file without appended data"
            ) from None
        raise
    return reader.GetOutputDataObject(0)


def _has_raw_appended_data(path: Path) -> bool:
    """Tell whether a file's XML ends where raw bytes begin."""
    with open(path, "rb") as file:
        return b'<AppendedData encoding="raw"' in file.read(2**20)


def write_with(writer: Any, path: Path) -> None:
    """Run a VTK writer that reports failure by an error or by returning 0."""
    with vtk_errors(f"cannot write '{path.name}'"):
        writer.SetFileName(str(path))
        written = writer.Write()
    if not written:
        raise RuntimeError(f"cannot write '{path.name}'")


def write_vti(
    image: vtkImageData, path: Path, *, progress: Progress | None = None, appended: bool = False
) -> None:
    """Write a ``.vti``; a compressed stream is not squeezed a second time.

    Data are in line unless asked otherwise: Debian 12's ParaView cannot read appended data since a
    security update of its XML parser (libexpat1 2.5.0-1+deb12u2).
    """
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    if appended:
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
    else:
        writer.SetDataModeToBinary()
    writer.SetHeaderTypeToUInt64()
    if is_compressed(image):
        writer.SetCompressorTypeToNone()
    observe_progress(writer, progress)
    write_with(writer, path)
