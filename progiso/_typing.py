"""Types that the annotations of several modules name."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from vtkmodules.vtkCommonDataModel import vtkImageData

#: A file's path.
FilePath: TypeAlias = str | os.PathLike[str]

#: An image, or samples indexed [x, y, z].
ImageLike: TypeAlias = vtkImageData | np.ndarray

#: Samples or pixels of any numeric type.
Array: TypeAlias = npt.NDArray[Any]

#: One isovalue or several.
Isovalues: TypeAlias = float | Sequence[float]

#: Bits per sample, "auto" where a tolerance tells, or None for what suits the samples.
Rate: TypeAlias = float | str | None

#: Red, green and blue, each from 0 to 1.
RGB: TypeAlias = tuple[float, float, float]

#: A point, a direction, or bounds.
Vector: TypeAlias = Sequence[float] | npt.NDArray[np.floating[Any]]

#: Samples along x, y and z.
Dimensions: TypeAlias = tuple[int, int, int]

#: Called with the fraction done, from 0 to 1.
Progress: TypeAlias = Callable[[float], object]
