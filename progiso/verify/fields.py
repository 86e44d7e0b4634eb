"""Make fields, and images of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData


def noise(shape: tuple[int, ...], seed: int = 0) -> np.ndarray:
    """Make white noise [z, y, x]: most cells cross zero, many with several roots along a ray."""
    return np.random.default_rng(seed).normal(size=shape).astype(np.float32)


def marschner_lobb(n: int, frequency: float = 6.0, alpha: float = 0.25) -> np.ndarray:
    """Make the signal of Marschner and Lobb (1994), the usual test of resampling."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, n)] * 3, indexing="ij")
    ring = np.cos(2 * np.pi * frequency * np.cos(np.pi * np.hypot(x, y) / 2))
    signal = (1 - np.sin(np.pi * z / 2) + alpha * (1 + ring)) / (2 * (1 + alpha))
    return signal.astype(np.float32)


def blobs(shape: tuple[int, ...], seed: int = 0, waves: int = 3) -> np.ndarray:
    """Make a smooth random field of waves, from about -1 to 1."""
    rng = np.random.default_rng(seed)
    axes = np.meshgrid(*[np.linspace(0, 2 * np.pi, n) for n in shape], indexing="ij")
    field = np.zeros(shape)
    for _ in range(6):
        frequency, phase = rng.uniform(-waves, waves, 3), rng.uniform(0, 2 * np.pi)
        field += np.cos(sum(f * a for f, a in zip(frequency, axes)) + phase)
    return (field / 3).astype(np.float32)


def coordinates(shape: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return coordinates x, y and z of the samples, each an array [z, y, x]."""
    z, y, x = np.indices(shape, dtype=float)
    return x, y, z


def make_image(
    values: np.ndarray,
    name: str = "field",
    *,
    cells: bool = False,
    origin: Sequence[float] = (0, 0, 0),
    spacing: Sequence[float] = (1, 1, 1),
    direction: np.ndarray | None = None,
    extent_start: Sequence[int] = (0, 0, 0),
) -> vtkImageData:
    """Place values [z, y, x] or [z, y, x, component] in a ``vtkImageData``."""
    values = np.asarray(values)
    size = np.array(values.shape[:3][::-1]) + bool(cells)
    image = vtkImageData()
    image.SetExtent(*(int(v) for s, n in zip(extent_start, size) for v in (s, s + n - 1)))
    image.SetOrigin(origin)
    image.SetSpacing(spacing)
    if direction is not None:
        image.SetDirectionMatrix(np.asarray(direction, float).ravel())
    flat = values.reshape(-1) if values.ndim == 3 else values.reshape(-1, values.shape[3])
    array = numpy_to_vtk(np.ascontiguousarray(flat), deep=True)
    array.SetName(name)
    (image.GetCellData() if cells else image.GetPointData()).SetScalars(array)
    return image
