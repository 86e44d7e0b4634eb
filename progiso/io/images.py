"""Images in memory as sources: what VTK's readers, and VTK's users, have already."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData

from .._typing import Array, Progress
from ..compression import decompress, describe, find_array, is_compressed
from ..geometry import axes_of
from ..vtkProgIsoFilters import vtkCompressedVolume
from .source import Description, Geometry, Region, Source


class ImageSource(Source):
    """A plain image, of which one array's samples are read, or a compressed volume.

    Parameters
    ----------
    what : object
        The file, or what else the image is, for messages.
    image : vtkmodules.vtkCommonDataModel.vtkDataObject or None
        The image.
    array : str, optional
        Name of the array, see `find_array`.

    Raises
    ------
    ValueError
        When it is no image, or has no samples.
    """

    concurrent = True
    more_than_samples = True
    gives_all_arrays = True

    def __init__(self, what: object, image: vtkDataObject | None, array: str | None = None) -> None:
        self._image = checked_image(what, image)
        self._array = array
        super().__init__(_describe(what, self._image, array))
        if array is not None and not is_compressed(self._image):
            make_active(self._image, array)

    def _open(self) -> Array:
        image = decompress(self._image) if is_compressed(self._image) else self._image
        found, _ = find_array(image, self._array)
        values = vtk_to_numpy(found)
        return values.reshape(self.shape + values.shape[1:])

    def _read(self, region: Region) -> Array:
        found: Array = self.handle[region]
        return found.astype(self.dtype, copy=False)

    def image(self, progress: Progress | None = None) -> vtkImageData:
        return self._image

    def place(self, image: vtkImageData) -> None:
        place_as(image, self._image)


def checked_image(what: object, image: vtkDataObject | None) -> vtkImageData:
    """Return an image that is not empty, or raise."""
    if not isinstance(image, vtkImageData):
        kind = "nothing" if image is None else f"a {image.GetClassName()}"
        raise ValueError(
            f"'{what}' holds {kind}, not an image (vtkImageData); resample it to one first"
        )
    if image.GetNumberOfPoints() == 0:
        raise ValueError(f"'{what}' holds an empty image")
    return image


def make_active(image: vtkImageData, array: str) -> None:
    """Make an array of points or cells the one that an image is taken for."""
    _, of_cells = find_array(image, array)
    points, cells = image.GetPointData(), image.GetCellData()
    points.SetActiveScalars(None if of_cells else array)
    if of_cells:
        cells.SetActiveScalars(array)


def place_as(image: vtkImageData, other: vtkImageData) -> None:
    """Give an image the place of another, to the last bit."""
    image.SetExtent(other.GetExtent())
    image.SetSpacing(other.GetSpacing())
    image.SetOrigin(other.GetOrigin())
    image.SetDirectionMatrix(other.GetDirectionMatrix())
    vtkCompressedVolume.Place(image)


def geometry_of(image: vtkImageData) -> Geometry:
    """Return where an image's samples lie."""
    x, y, z = image.GetExtent()[::2]
    return Geometry(axes=axes_of(image), origin=np.array(image.GetOrigin()), extent_start=(x, y, z))


def _describe(what: object, image: vtkImageData, array: str | None) -> Description:
    """Describe the samples of an image, or of a compressed volume once it is decoded."""
    width, height, depth = image.GetDimensions()
    about: dict[str, Any] = {"dtype": np.dtype(np.float32), "components": 1, "name": ""}
    if is_compressed(image):
        held = describe(image)
        width, height, depth = held["samples"]
        units = (held["offset"], held["scale"]) != (0, 1)
        about |= {"dtype": np.dtype(np.float64 if units else np.float32), "name": held["array"]}
    elif image.GetPointData().GetNumberOfArrays() or image.GetCellData().GetNumberOfArrays():
        found, of_cells = find_array(image, array)
        width, height, depth = (n - of_cells for n in (width, height, depth))
        values = vtk_to_numpy(found)
        about |= {
            "dtype": values.dtype.newbyteorder("="),
            "components": found.GetNumberOfComponents(),
            "name": found.GetName() or "scalars",
        }
    return Description(
        what=str(what), shape=(depth, height, width), geometry=geometry_of(image), **about
    )
