"""NIfTI (``.nii``, ``.nii.gz``) through VTK, and whatever else nibabel reads."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkIOImage import vtkNIFTIImageReader, vtkNIFTIImageWriter

from ._vtk import vtk_errors
from .geometry import axes_of, image_from_array, set_axes


def read_nifti(path):
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
    reader = vtkNIFTIImageReader()
    if not reader.CanReadFile(str(path)):
        raise ValueError(f"'{path}' is not a NIfTI image")
    with vtk_errors(f"cannot read '{path}'"):
        reader.SetFileName(str(path))
        reader.Update()
    image = reader.GetOutput()
    affine = reader.GetSFormMatrix() or reader.GetQFormMatrix()
    if affine is not None:  # it maps VTK's own coordinates, spacing included
        matrix = np.array([[affine.GetElement(i, j) for j in range(4)] for i in range(4)])
        origin = matrix[:3, :3] @ np.asarray(image.GetOrigin()) + matrix[:3, 3]
        set_axes(image, matrix[:3, :3] * np.asarray(image.GetSpacing()), origin)
    return _rescaled(image, reader.GetRescaleSlope(), reader.GetRescaleIntercept())


def _rescaled(image, slope, intercept):
    """Apply a NIfTI slope and intercept to the scalars; a slope of 0 or NaN means none."""
    if not np.isfinite(slope) or slope == 0 or (slope == 1 and intercept == 0):
        return image
    scalars = image.GetPointData().GetScalars()
    scaled = numpy_to_vtk((vtk_to_numpy(scalars) * slope + intercept).astype(np.float32))
    scaled.SetName(scalars.GetName())
    image.GetPointData().SetScalars(scaled)
    return image


def write_nifti(image, path):
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
    sform.DeepCopy(matrix.ravel())
    plain = type(image)()  # the writer adds the origin to the matrix by itself
    plain.ShallowCopy(image)
    plain.SetExtent(0, extent[1] - extent[0], 0, extent[3] - extent[2], 0, extent[5] - extent[4])
    plain.SetOrigin(0, 0, 0)
    writer = vtkNIFTIImageWriter()
    writer.SetInputData(plain)
    writer.SetSFormMatrix(sform)
    writer.SetFileName(str(path))
    with vtk_errors(f"cannot write '{path}'"):
        writer.Write()


def read_nibabel(path):
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
        source = nibabel.load(path)
        values = np.asarray(source.dataobj)
    except (nibabel.filebasedimages.ImageFileError, nibabel.spatialimages.HeaderDataError) as error:
        raise ValueError(f"cannot read '{path}': {error}") from None
    while values.ndim > 3:  # of a series the first volume
        values = values[..., 0]
    if values.ndim != 3:
        raise ValueError(f"'{path}' is not a volume: its shape is {values.shape}")
    native = np.ascontiguousarray(values.T, values.dtype.newbyteorder("="))
    image = image_from_array(native, values.shape, "scalars")
    set_axes(image, source.affine[:3, :3], source.affine[:3, 3])
    return image
