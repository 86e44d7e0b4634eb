"""Raw volumes named as the Open SciVis data sets are: ``name_WxHxD_type.raw``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_BIT
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, FilePath
from .files import check_bytes
from .source import Description, Region, Selection, Source

TYPES = (
    *("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64"),
    *("float32", "float64"),
)

_NAME = re.compile(
    r"(?P<name>.+)_(?P<x>\d+)x(?P<y>\d+)x(?P<z>\d+)_(?P<type>" + "|".join(TYPES) + r")\.raw",
)


def raw_name(name: str, dimensions: Sequence[int], dtype: npt.DTypeLike) -> str:
    """Compose a file name that says what the file holds.

    Examples
    --------
    >>> raw_name("gyroid", (64, 32, 16), "float32")
    'gyroid_64x32x16_float32.raw'
    """
    return f"{name}_{'x'.join(str(n) for n in dimensions)}_{np.dtype(dtype).name}.raw"


def parse_raw_name(path: FilePath) -> tuple[str, Dimensions, np.dtype[Any]]:
    """Read name, dimensions and sample type out of a raw file's name.

    Parameters
    ----------
    path : str or os.PathLike
        Only its last part is looked at.

    Returns
    -------
    name : str
        The part before the dimensions.
    dimensions : tuple of int
        Samples along x (fastest in the file), y and z.
    dtype : numpy.dtype
        Little-endian sample type.

    Raises
    ------
    ValueError
        When the name does not follow the convention.

    Examples
    --------
    >>> parse_raw_name("skull_256x256x256_uint8.raw")
    ('skull', (256, 256, 256), dtype('uint8'))
    """
    match = _NAME.fullmatch(Path(path).name)
    if match is None:
        raise ValueError(
            f"cannot tell dimensions and type of '{Path(path).name}': a raw file must be named "
            f"name_WxHxD_type.raw, type one of {', '.join(TYPES)}"
        )
    dimensions = (int(match["x"]), int(match["y"]), int(match["z"]))
    return match["name"], dimensions, np.dtype(match["type"]).newbyteorder("<")


class RawSource(Source):
    """Samples without a header: a memory map, so that pages are read when they are touched."""

    concurrent = True

    def __init__(self, path: Path, about: Description, stored: np.dtype[Any]) -> None:
        super().__init__(about)
        self._path, self._stored = path, stored

    def _read(self, region: Region) -> Array:
        z, *rows_and_columns = region
        inner = self.shape[1:] + ((self.about.components,) if self.about.components > 1 else ())
        # a map of these slices alone: the pages of a larger one would count as the process's memory
        slices: Array = np.memmap(
            self._path,
            dtype=self._stored,
            mode="r",
            offset=z.start * int(np.prod(inner, dtype=object)) * self._stored.itemsize,
            shape=(z.stop - z.start, *inner),
        )
        found = slices[(slice(None), *rows_and_columns)]
        return found.astype(self.dtype, copy=False)  # a big-endian machine has to swap


def open_raw(path: Path, _selection: Selection) -> Source:
    """Open a raw volume, little-endian, x fastest; its array is called by the file's name.

    Raises
    ------
    ValueError
        When the name does not follow the convention or the size does not fit it.
    """
    name, dimensions, dtype = _checked_name(path)
    about = Description(
        what=str(path), shape=dimensions[::-1], dtype=dtype.newbyteorder("="), name=name
    )
    return RawSource(path, about, dtype)


def _checked_name(path: FilePath) -> tuple[str, Dimensions, np.dtype[Any]]:
    """Parse a raw file's name, or raise where its size does not fit it."""
    name, dimensions, dtype = parse_raw_name(path)
    expected = int(np.prod(dimensions, dtype=object)) * dtype.itemsize
    actual = Path(path).stat().st_size
    if expected != actual or expected == 0:
        raise ValueError(
            f"'{path}' has {actual} bytes where its name announces {expected} "
            f"({'x'.join(map(str, dimensions))} samples of {dtype.itemsize} bytes)"
        )
    return name, dimensions, dtype


def write_raw(image: vtkImageData, path: FilePath) -> None:
    """Write an image's active scalars as a raw file; the name must announce what is in it.

    Raises
    ------
    ValueError
        When the name's dimensions or type differ from the image's, or the image's samples have
        several components, or a type that no raw file holds.
    """
    scalars = image.GetPointData().GetScalars()
    name, components = Path(path).name, scalars.GetNumberOfComponents()
    kind = vtk_to_numpy(scalars).dtype if scalars.GetDataType() != VTK_BIT else np.dtype(bool)
    if components != 1 or kind.name not in TYPES:
        held = f"{components} components" if components != 1 else f"type {kind.name}"
        raise ValueError(
            f"'{name}': a raw file holds samples of one component, of type {', '.join(TYPES)}; the "
            f"image's have {held}: write it as .vti"
        )
    _, dimensions, dtype = parse_raw_name(path)
    if dimensions != image.GetDimensions() or dtype != kind.newbyteorder("<"):
        correct = raw_name("name", image.GetDimensions(), kind)
        raise ValueError(f"'{name}' does not describe the image: call it {correct}")
    values = vtk_to_numpy(scalars).astype(dtype, copy=False)
    values.tofile(path)
    check_bytes(Path(path), values.nbytes)
