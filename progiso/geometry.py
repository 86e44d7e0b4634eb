"""Images from arrays: origin, spacing and direction in one place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkImageData

from ._typing import Array
from .vtkProgIsoFilters import vtkCompressedVolume

#: Name of the array that hides points or cells.
GHOSTS = "vtkGhostType"  # vtkDataSetAttributes::GhostArrayName()


def image_from_array(
    values: Array, dimensions: Sequence[int], *, name: str = "scalars", components: int = 1
) -> vtkImageData:
    """Wrap samples as the active point scalars of a `vtkImageData`, without copying them.

    Parameters
    ----------
    values : numpy.ndarray
        ``prod(dimensions) * components`` values, x fastest; any native numeric type. A
        read-only memory map is fine as long as nothing writes to the image's scalars.
    dimensions : sequence of int
        Samples along x, y and z.
    name : str, default: "scalars"
        Name of the array.
    components : int, default: 1
        Values per sample.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        With unit spacing and its origin at zero.

    Raises
    ------
    ValueError
        When the number of values does not fit the dimensions.

    Examples
    --------
    >>> import numpy as np
    >>> image = image_from_array(np.arange(24.0), (4, 3, 2))
    >>> image.GetDimensions()
    (4, 3, 2)
    """
    count = int(np.prod(dimensions, dtype=np.int64)) * components
    if values.size != count:
        shape = "x".join(map(str, dimensions))
        raise ValueError(f"{shape} samples of {components} need {count} values, got {values.size}")
    flat = values.reshape(-1, components) if components > 1 else values.reshape(-1)
    array = numpy_to_vtk(flat)
    array.SetName(name)
    image = vtkImageData()
    image.SetDimensions([int(n) for n in dimensions])
    image.GetPointData().SetScalars(array)
    return image


def samples_of(image: vtkImageData) -> Array:
    """View an image's active scalars as an array; the inverse of `image_from_array`.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        With scalars of one component at its points, or else at its cells.

    Returns
    -------
    numpy.ndarray, shape (depth, height, width)
        A view, z slowest.
    """
    points = image.GetPointData().GetScalars()
    size = np.array(image.GetDimensions()) - (0 if points else 1)
    return vtk_to_numpy(points or image.GetCellData().GetScalars()).reshape(size[::-1])


def image_of_samples(samples: Array) -> vtkImageData:
    """Make an image of a NumPy array.

    Parameters
    ----------
    samples : numpy.ndarray
        Three-dimensional, indexed [x, y, z], as pyvista's ``wrap`` takes it. The masked samples of
        a `numpy.ma.MaskedArray` become hidden points.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        With unit spacing and its origin at zero; its array is called "values". Samples in Fortran's
        order, as those of ``array.T``, are not copied.

    Raises
    ------
    TypeError
        When the array has other dimensions or holds no real numbers.

    Examples
    --------
    >>> import numpy as np
    >>> image_of_samples(np.zeros((4, 3, 2))).GetDimensions()
    (4, 3, 2)
    """
    if samples.ndim != 3:
        raise TypeError(f"an array must have 3 dimensions, this one has {samples.ndim}")
    values, hidden = plain_samples(samples)
    image = image_from_array(values.ravel(order="F"), samples.shape, name="values")
    if hidden is not None:
        hide_points(image, hidden.ravel(order="F"))
    return image


def plain_samples(samples: npt.ArrayLike) -> tuple[Array, npt.NDArray[np.bool_] | None]:
    """Split samples into plain ones of a type that VTK has, and what a mask hides of them.

    Parameters
    ----------
    samples : array_like
        Truth values or real numbers of any type, byte order and class.

    Returns
    -------
    values : numpy.ndarray
        In native byte order: truth values as uint8, half precision as float32, long double
        precision as float64. Not copied where nothing is converted.
    hidden : numpy.ndarray of bool, or None
        Of the same shape, true where a `numpy.ma.MaskedArray` is masked; None where nothing is.

    Raises
    ------
    TypeError
        When they are no real numbers.

    Examples
    --------
    >>> values, hidden = plain_samples(np.ma.masked_equal([True, False], False))
    >>> values.dtype, hidden
    (dtype('uint8'), array([False,  True]))
    """
    values = np.asarray(np.ma.getdata(samples))
    if values.dtype.kind not in "biuf":
        raise TypeError(f"an array must hold real numbers, this one has {values.dtype}")
    mask = np.ma.getmask(samples)
    hidden = None if mask is np.ma.nomask or not mask.any() else np.asarray(mask)
    if values.dtype == bool:
        return values.view(np.uint8), hidden
    if values.dtype.kind == "f" and values.dtype.itemsize not in (4, 8):  # VTK has no such type
        return values.astype(np.float32 if values.dtype.itemsize < 4 else np.float64), hidden
    return values.astype(values.dtype.newbyteorder("="), copy=False), hidden


def hide_points(image: vtkImageData, hidden: npt.NDArray[np.bool_]) -> None:
    """Hide points of an image, beside those that its ghost array hides already.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Changed in place: it gets an array ``vtkGhostType`` of its points, or a new one.
    hidden : numpy.ndarray of bool
        One value for each point, x fastest: flat, or of shape (depth, height, width).

    Raises
    ------
    ValueError
        When the number of values is not that of the points.

    Examples
    --------
    >>> image = image_from_array(np.arange(24.0), (4, 3, 2))
    >>> hide_points(image, np.arange(24) == 5)
    >>> image.IsPointVisible(5), image.IsPointVisible(6)
    (0, 1)
    """
    if hidden.size != image.GetNumberOfPoints():
        raise ValueError(f"{hidden.size} truth values for {image.GetNumberOfPoints()} points")
    flags = np.where(hidden.reshape(-1), np.uint8(vtkDataSetAttributes.HIDDENPOINT), np.uint8(0))
    before = image.GetPointData().GetArray(GHOSTS)
    if before is not None:
        flags |= vtk_to_numpy(before)
    ghosts = numpy_to_vtk(flags, deep=True)
    ghosts.SetName(GHOSTS)
    image.GetPointData().AddArray(ghosts)


def set_axes(image: vtkImageData, axes: npt.ArrayLike, origin: npt.ArrayLike) -> None:
    """Place an image in the world by the vectors from one sample to the next.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Changed in place: spacing, direction matrix and origin.
    axes : array_like, shape (3, 3)
        Column *j* is the world vector from a sample to its neighbour along axis *j*. Any
        invertible matrix: rotations, reflections and shears are all kept.
    origin : array_like, shape (3,)
        World position of sample (0, 0, 0).

    Raises
    ------
    ValueError
        When the vectors do not span space or are not finite.
    """
    axes, origin = np.asarray(axes, float), np.asarray(origin, float)
    spacing = np.linalg.norm(axes, axis=0)
    finite = np.isfinite(axes).all() and np.isfinite(origin).all() and (spacing > 0).all()
    if not finite or origin.shape != (3,):
        raise ValueError(
            f"the image's axes {axes.tolist()} or origin {origin.tolist()} are unusable"
        )
    direction = axes / spacing
    if abs(np.linalg.det(direction)) < 1e-6:
        raise ValueError(f"the image's axes {axes.tolist()} do not span space")
    image.SetSpacing(*spacing)
    image.SetOrigin(*origin)
    image.SetDirectionMatrix(*direction.ravel())
    vtkCompressedVolume.Place(image)  # where it is one, its samples move along


def axes_of(image: vtkImageData) -> npt.NDArray[np.float64]:
    """Return the world vectors between neighbouring samples as columns; see `set_axes`."""
    matrix = image.GetDirectionMatrix()
    direction = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
    return direction * np.asarray(image.GetSpacing())


def cell_centres(image: vtkImageData) -> vtkImageData:
    """Make an image whose points are the centres of another's cells.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        At least 2 points along every axis.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        Without data.

    Examples
    --------
    >>> image = vtkImageData()
    >>> image.SetDimensions(4, 3, 2)
    >>> centres = cell_centres(image)
    >>> centres.GetDimensions(), centres.GetOrigin()
    ((3, 2, 1), (0.5, 0.5, 0.5))
    """
    centres = vtkImageData()
    centres.CopyStructure(image)
    centres.SetExtent([end - upper for upper, end in zip((0, 1) * 3, image.GetExtent())])
    origin = [0.0, 0.0, 0.0]
    image.TransformContinuousIndexToPhysicalPoint(0.5, 0.5, 0.5, origin)
    centres.SetOrigin(origin)
    return centres
