"""Arrays in memory or read lazily, and other libraries' images, as sources."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, ImageLike
from .._vtk import image_data
from ..geometry import image_of_samples, plain_samples
from .axes import even_step, roles_of
from .source import Description, Geometry, Region, Selection, Source

#: Attributes of an xarray that tell what stands for no value, where it was not decoded.
_FILLS = ("_FillValue", "missing_value", "nodata")


class ArraySource(Source):
    """Anything with a shape, a type and slicing, of three dimensions.

    Parameters
    ----------
    array : object
        Is sliced region by region, and what comes is made a NumPy array.
    axes : str
        "xyz" or "zyx", or any other order of the three letters: the meaning of its dimensions.
    fill : float, optional
        Samples of this value are masked: they have none.
    **about
        Other fields of `Description`.

    Raises
    ------
    TypeError
        When it has other dimensions, or holds no real numbers.
    """

    def __init__(
        self, array: Any, axes: str = "xyz", *, fill: float | None = None, **about: Any
    ) -> None:
        self._array, self._order = array, [axes.index(axis) for axis in "zyx"]
        self._fill = fill
        if len(array.shape) != 3:
            raise TypeError(f"an array must have 3 dimensions, this one has {len(array.shape)}")
        kind = plain_samples(np.empty(0, array.dtype))[0].dtype
        about = {"what": type(array).__name__, "name": "values", **about}
        depth, height, width = (int(array.shape[axis]) for axis in self._order)
        super().__init__(
            Description(shape=(depth, height, width), dtype=kind, chunks=self._chunks(), **about)
        )

    def _chunks(self) -> Dimensions | None:
        """Return the chunks' shape along z, y and x, where the array tells of chunks."""
        chunks = getattr(self._array, "chunks", None)
        if not chunks or len(chunks) != 3:
            return None
        sizes = [int(c[0] if isinstance(c, Sequence) else c) for c in chunks]
        depth, height, width = (sizes[axis] for axis in self._order)
        return depth, height, width

    def _read(self, region: Region) -> Array:
        own = [slice(None)] * 3
        for axis, part in zip(self._order, region):
            own[axis] = part
        found = self._array[tuple(own)]
        found = found.data if _is_of(found, "xarray") else found
        found = found.compute() if _is_of(found, "dask") else found  # np.asarray drops a mask
        samples, hidden = plain_samples(found if np.ma.isMA(found) else np.asarray(found))
        if self._fill is not None:
            filled = samples == self._fill
            hidden = filled if hidden is None else hidden | filled
        samples = samples.transpose(self._order)
        if hidden is None:
            return samples
        return np.ma.MaskedArray(samples, hidden.transpose(self._order))


class _NumpyFile:
    """A ``.npy`` file as an array that is mapped anew for each region.

    The pages of one map of everything would count as the process's memory.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        mapped = self._map()
        self.shape, self.dtype = mapped.shape, mapped.dtype

    def __getitem__(self, region: tuple[slice, ...]) -> Array:
        found: Array = self._map()[region]
        return found

    def _map(self) -> Array:
        return np.load(self._path, mmap_mode="r", allow_pickle=False)


def open_npy(path: Path, selection: Selection) -> Source:
    """Open a ``.npy`` file of a three-dimensional array, indexed [x, y, z] by default."""
    array = _NumpyFile(path)
    if len(array.shape) != 3 or array.dtype.kind not in "biuf":
        raise ValueError(
            f"'{path}' holds an array of shape {array.shape} and type {array.dtype}, not of 3 "
            "dimensions and real numbers"
        )
    return ArraySource(array, _checked_axes(selection.axes) or "xyz", what=str(path))


def as_image(volume: ImageLike, axes: str | None = None) -> vtkImageData:
    """Make an image of an array; an image is returned as it is.

    Parameters
    ----------
    volume : vtkmodules.vtkCommonDataModel.vtkImageData, numpy.ndarray, or like one
        An image, or the samples of one: a three-dimensional array that is indexed [x, y, z], as
        pyvista's ``wrap`` takes it. The masked samples of a `numpy.ma.MaskedArray` become hidden
        points. Or what `progiso.io.source_of` takes: arrays of dask, zarr, h5py and xarray, images
        of SimpleITK and nibabel.
    axes : str, optional
        Order of an array's dimensions, "zyx" where slices come first.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        The image itself; or one with unit spacing and its origin at zero, whose array is called
        "values". Samples in Fortran's order, as those of ``array.T``, are not copied.

    Raises
    ------
    TypeError
        When it is neither, or the array has other dimensions or holds no real numbers.
    ValueError
        When `axes` is no order of x, y and z.

    Examples
    --------
    >>> import numpy as np
    >>> as_image(np.zeros((4, 3, 2))).GetDimensions()
    (4, 3, 2)
    """
    if isinstance(volume, vtkImageData):
        return volume
    if isinstance(volume, np.ndarray) and axes in (None, "xyz"):
        return image_of_samples(volume)
    source = source_of(volume, axes)
    if source is None:
        return image_data(volume)
    source.tell_notes()
    return source.image()


def source_of(volume: Any, axes: str | None = None) -> Source | None:
    """Make a source of an array or of another library's image.

    Parameters
    ----------
    volume : object
        An array of NumPy, dask, zarr or h5py, an ``xarray.DataArray``, whose coordinates place it
        where they are evenly spaced, or an image of SimpleITK or nibabel, which knows its place.
    axes : str, optional
        Order of the dimensions of an array: by default "xyz", as pyvista's ``wrap`` takes it, or
        what the names of an xarray's dimensions say; "zyx" where slices come first.

    Returns
    -------
    Source or None
        None where it is none of these.

    Raises
    ------
    TypeError
        When it has other than three dimensions, or holds no real numbers.
    ValueError
        When `axes` is no order of x, y and z, or is given for an image.
    """
    _checked_axes(axes)
    for library, make in (("SimpleITK", _of_simpleitk), ("nibabel", _of_nibabel)):
        if _is_of(volume, library) and not hasattr(volume, "__array_interface__"):
            if axes is not None:
                raise ValueError(f"{type(volume).__name__} knows its axes: give no axes")
            return make(volume)
    if _is_of(volume, "xarray") and hasattr(volume, "dims"):
        return _of_xarray(volume, axes)
    return ArraySource(volume, axes or "xyz") if is_sliced(volume) else None


def is_sliced(volume: Any) -> bool:
    """Tell whether an object has what arrays have: a shape, a type and slicing."""
    return all(hasattr(volume, name) for name in ("shape", "dtype", "__getitem__"))


def _checked_axes(axes: str | None) -> str | None:
    """Return the order of axes, or raise where it is none."""
    if axes is not None and sorted(axes) != ["x", "y", "z"]:
        raise ValueError(f"axes must be 'xyz', 'zyx' or another order of these, got {axes!r}")
    return axes


def _is_of(volume: Any, library: str) -> bool:
    """Tell whether an object is of a library, without importing it."""
    return any(base.__module__.split(".")[0] == library for base in type(volume).__mro__)


def _of_simpleitk(image: Any) -> Source:
    """View an image of SimpleITK, in its own coordinates (LPS)."""
    import SimpleITK

    if image.GetDimension() != 3 or image.GetNumberOfComponentsPerPixel() != 1:
        raise TypeError("an image of SimpleITK must have 3 dimensions and one component")
    axes = np.array(image.GetDirection()).reshape(3, 3) * np.array(image.GetSpacing())
    geometry = Geometry(axes=axes, origin=np.array(image.GetOrigin()), space="LPS")
    view = SimpleITK.GetArrayViewFromImage(image)
    return ArraySource(view, "zyx", what="SimpleITK.Image", geometry=geometry)


def _of_nibabel(image: Any) -> Source:
    """View an image of nibabel, in its own coordinates (RAS)."""
    if not hasattr(image, "dataobj") or image.affine is None:
        raise TypeError(f"{type(image).__name__} is no volume")
    geometry = Geometry(axes=image.affine[:3, :3], origin=image.affine[:3, 3], space="RAS")
    return ArraySource(image.dataobj, "xyz", what=type(image).__name__, geometry=geometry)


def _of_xarray(array: Any, axes: str | None) -> Source:
    """View an xarray's samples, placed by the coordinates that are evenly spaced."""
    if len(array.dims) != 3:
        raise TypeError(f"an array must have 3 dimensions, this one has {len(array.dims)}")
    axes = axes or _axes_named(array.dims)
    vectors, origin, notes = np.zeros((3, 3)), np.zeros(3), []
    for name, axis in zip(array.dims, axes):
        index = "xyz".index(axis)
        first, step = 0.0, 1.0
        if name in array.coords:
            coordinates = array.coords[name].values
            placed = even_step(coordinates)
            if placed.size is None and coordinates.size > 1:
                notes.append(f"coordinate '{name}' is not evenly spaced: its indices are taken")
            else:
                first, step = placed.start, placed.size or 1.0
        vectors[index, index], origin[index] = step, first
    return ArraySource(
        array,
        axes,
        what="xarray.DataArray",
        name=str(array.name or "values"),
        fill=next((array.attrs[key] for key in _FILLS if key in array.attrs), None),
        geometry=Geometry(axes=vectors, origin=origin),
        notes=tuple(notes),
    )


def _axes_named(names: Sequence[Any]) -> str:
    """Return the axes that the names of dimensions mean; "xyz" where they mean nothing."""
    roles = roles_of([str(name) for name in names])
    found = [role if role in ("x", "y") else "z" for role in roles]
    return "".join(found) if sorted(found) == ["x", "y", "z"] else "xyz"
