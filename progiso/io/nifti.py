"""Writing NIfTI (``.nii``, ``.nii.gz``)."""

from __future__ import annotations

import gzip
import struct
import zlib
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_ID_TYPE, VTK_LONG_LONG
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkIOImage import vtkNIFTIImageWriter

from .._typing import FilePath
from ..geometry import axes_of
from .files import DISK_FULL
from .vtk_files import write_with


def write_nifti(image: vtkImageData, path: FilePath) -> None:
    """Write the active scalars as NIfTI with the image's geometry as its sform.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Its geometry is stored in single precision, as NIfTI does.
    path : str or os.PathLike
        A ``.nii`` or ``.nii.gz`` file.
    """
    matrix, extent = np.eye(4), image.GetExtent()
    axes = axes_of(image)
    matrix[:3, :3] = axes / np.asarray(image.GetSpacing())
    matrix[:3, 3] = np.asarray(image.GetOrigin()) + axes @ np.asarray(extent[::2], float)
    sform = vtkMatrix4x4()
    sform.DeepCopy(matrix.ravel().tolist())
    plain = type(image)()  # the writer adds the origin to the matrix by itself
    plain.ShallowCopy(image)
    plain.SetExtent(0, extent[1] - extent[0], 0, extent[3] - extent[2], 0, extent[5] - extent[4])
    plain.SetOrigin(0, 0, 0)
    scalars = plain.GetPointData().GetScalars()
    if scalars.GetDataType() == VTK_ID_TYPE:  # which the writer does not know
        copied = numpy_to_vtk(vtk_to_numpy(scalars), array_type=VTK_LONG_LONG)
        copied.SetName(scalars.GetName())
        plain.GetPointData().SetScalars(copied)
    writer = vtkNIFTIImageWriter()
    writer.SetInputData(plain)
    writer.SetSFormMatrix(sform)
    write_with(writer, Path(path))
    scalars = plain.GetPointData().GetScalars()
    _check_written(Path(path), scalars.GetDataTypeSize() * scalars.GetNumberOfValues())


def _check_written(path: Path, sample_bytes: int) -> None:
    """Raise where not all samples have come into a file; VTK does not tell when closing fails."""
    opened = gzip.open if path.suffix.lower() == ".gz" else open
    held = 0
    try:
        with opened(path, "rb") as file:
            (header,) = struct.unpack("<i", file.read(4))
            held = 4
            while chunk := file.read(2**20):
                held += len(chunk)
    except (OSError, EOFError, zlib.error, struct.error) as error:
        raise RuntimeError(f"cannot write '{path}': {DISK_FULL}") from error
    if held != header + 4 + sample_bytes:  # 4 bytes tell that there are no extensions
        raise RuntimeError(f"cannot write '{path}': {DISK_FULL}")
