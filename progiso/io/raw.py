"""Raw volumes named as the Open SciVis data sets are: ``name_WxHxD_type.raw``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, FilePath
from ..geometry import image_from_array
from .slab_files import SlabFile, opened_at

TYPES = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")

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


def read_raw(path: FilePath) -> vtkImageData:
    """Open a raw volume as an image whose scalars are a memory map of the file.

    Pages are read when they are touched, so volumes larger than main memory open at once.
    The scalars must not be written to.

    Parameters
    ----------
    path : str or os.PathLike
        A file named ``name_WxHxD_type.raw``, little-endian, x fastest, no header.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        Unit spacing, origin zero, one point array named after the file.

    Raises
    ------
    ValueError
        When the name does not follow the convention or the size does not fit it.
    """
    name, dimensions, dtype = _checked_name(path)
    values: Array = np.memmap(path, dtype=dtype, mode="r")
    if not values.dtype.isnative:  # a big-endian machine has to swap, hence to copy
        values = values.astype(dtype.newbyteorder("="))
    return image_from_array(values, dimensions, name=name)


def raw_slabs(path: FilePath) -> SlabFile:
    """Open a raw volume to be read some slices at a time; errors as in `read_raw`.

    Returns
    -------
    SlabFile
    """
    name, dimensions, dtype = _checked_name(path)
    return SlabFile(
        Path(path), name, dimensions, dtype, open=opened_at(path), place=lambda image: None
    )


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
        When the name's dimensions or type differ from the image's.
    """
    _, dimensions, dtype = parse_raw_name(path)
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    same = values.dtype == dtype.newbyteorder("=") and dimensions == image.GetDimensions()
    if values.ndim != 1 or not same:
        correct = raw_name("name", image.GetDimensions(), values.dtype)
        name = Path(path).name
        raise ValueError(f"'{name}' does not describe the image: call it {correct} (one component)")
    values.astype(dtype, copy=False).tofile(path)
