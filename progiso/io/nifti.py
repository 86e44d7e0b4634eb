"""NIfTI (``.nii``, ``.nii.gz``): VTK's reader, placed by the affine."""

from __future__ import annotations

import gzip
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import get_vtk_to_numpy_typemap, numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_ID_TYPE, VTK_LONG_LONG
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkIOImage import vtkNIFTIImageReader, vtkNIFTIImageWriter

from .._typing import Array, FilePath
from .._vtk import dimensions_of, place_as_read, vtk_errors
from ..geometry import axes_of, set_axes
from .files import DISK_FULL
from .slab_files import SlabFile, gunzipped, opened_at
from .vtk_files import write_with


def read_nifti(path: FilePath) -> vtkImageData:
    """Read a NIfTI image with its affine as spacing, origin and direction.

    Parameters
    ----------
    path : str or os.PathLike
        A ``.nii`` or ``.nii.gz`` file; of a time series the first volume is read.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        In the file's world coordinates (right-anterior-superior), by its sform where it has
        one, else by its qform. A slope and intercept other than 1 and 0 are applied, as float32.
    """
    reader = _reader(path)
    with vtk_errors(f"cannot read '{path}'"):
        reader.Update()
    image = reader.GetOutput()
    _place(image, reader)
    rescale = _rescaling(reader)
    if rescale is not None:
        scalars = image.GetPointData().GetScalars()
        scaled = numpy_to_vtk(rescale(vtk_to_numpy(scalars)))
        scaled.SetName(scalars.GetName())
        image.GetPointData().SetScalars(scaled)
    return image


def nifti_slabs(path: FilePath) -> SlabFile | None:
    """Open a NIfTI image to be read some slices at a time; errors as in `read_nifti`.

    Returns
    -------
    SlabFile or None
        None when the components of vectors are stored one after the other, or the file is
        compressed and begins with the last slice.
    """
    reader = _reader(path)
    with vtk_errors(f"cannot read '{path}'"):
        reader.UpdateInformation()
    with open(path, "rb") as file:
        packed = file.read(2) == b"\x1f\x8b"
    from_top = reader.GetQFac() < 0  # VTK puts the slices in the other order
    if reader.GetNIFTIHeader().GetDim(5) > 1 or (packed and from_top):
        return None

    def place(image: vtkImageData) -> None:
        place_as_read(image, reader)
        _place(image, reader)

    header = reader.GetHeaderSize()
    opener = opened_at(path, wrap=gunzipped, skip=header) if packed else opened_at(path, header)
    kind = reader.GetDataScalarType()
    dtype = np.dtype(get_vtk_to_numpy_typemap()[kind])
    dtype = dtype.newbyteorder() if reader.GetSwapBytes() else dtype
    return SlabFile(
        Path(path),
        "NIFTI",
        dimensions_of(reader),
        dtype,
        open=opener,
        place=place,
        components=reader.GetNumberOfScalarComponents(),
        vtk_type=kind,
        convert=_rescaling(reader),
        from_top=from_top,
    )


def _reader(path: FilePath) -> vtkNIFTIImageReader:
    reader = vtkNIFTIImageReader()
    if not reader.CanReadFile(str(path)):
        raise ValueError(f"'{path}' is not a NIfTI image")
    reader.SetFileName(str(path))
    return reader


def _place(image: vtkImageData, reader: vtkNIFTIImageReader) -> None:
    """Set the axes and origin by the affine, which maps VTK's own coordinates, spacing included."""
    affine = reader.GetSFormMatrix() or reader.GetQFormMatrix()
    if affine is not None:
        matrix = np.array([[affine.GetElement(i, j) for j in range(4)] for i in range(4)])
        origin = matrix[:3, :3] @ np.asarray(image.GetOrigin()) + matrix[:3, 3]
        set_axes(image, matrix[:3, :3] * np.asarray(image.GetSpacing()), origin)


def _rescaling(reader: vtkNIFTIImageReader) -> Callable[[Array], Array] | None:
    """Return what applies the slope and intercept, or None; a slope of 0 or NaN means none."""
    slope, intercept = reader.GetRescaleSlope(), reader.GetRescaleIntercept()
    if not np.isfinite(slope) or slope == 0 or (slope == 1 and intercept == 0):
        return None
    return lambda values: (values * slope + intercept).astype(np.float32)


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
