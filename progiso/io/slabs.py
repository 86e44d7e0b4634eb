"""Volumes that are computed and compressed a few slices at a time, never in memory as a whole."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, Progress
from ..options import CompressionOptions
from ..vtkProgIsoFilters import vtkCompressedVolumeBuilder

#: A function of a slice's number that returns the slice, of shape (height, width).
_SliceAt = Callable[[int], npt.ArrayLike]

#: Samples in a slab that are worth starting threads for.
_WORTHWHILE = 2**23


def compress_slabs(
    slabs: Iterable[Array] | _SliceAt,
    dimensions: Sequence[int],
    *,
    rate: float = 8.0,
    name: str = "scalars",
    mask_nan: bool = False,
    units: tuple[float, float] = (0.0, 1.0),
    threads: int = 0,
    progress: Progress | None = None,
) -> vtkImageData:
    """Compress a volume that is computed or read a few slices at a time.

    Memory holds one slab and the compressed stream. The result is bit for bit that of `compress`
    on the whole volume, except for values that float32 cannot hold: there `compress`, which sees
    all values, chooses `units` itself.

    Parameters
    ----------
    slabs : iterable of numpy.ndarray, or callable
        Consecutive slabs of shape (depth, height, width), or slices of shape (height, width), of
        one numeric type, x fastest; of any depth, though 4 slices or more at a time are fastest.
        Each is used up before the next is asked for, so that its memory may be used again.
        Or ``slice_at(z)``, a function of a slice's number that returns the slice; it is called
        from several threads at once, and its values are taken as float32 (float64 with `units`).
    dimensions : sequence of int
        Samples along x (width), y (height) and z, each at least 2.
    rate : float, default: 8
        Bits per sample, in (0, 32].
    name : str, default: "scalars"
        Name of the array.
    mask_nan : bool, default: False
        Whether NaN and infinite samples are hidden, as in `compress`.
    units : tuple of 2 float, default: (0, 1)
        Offset and scale: the stream has (value - offset) / scale, as float32. So it can hold small
        differences on a large offset, and values beyond float32.
    threads : int, default: 0
        Threads that encode, and that call ``slice_at``; 0 for one per core.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume with unit spacing and its origin at zero.

    Raises
    ------
    ValueError
        When a slab's shape does not fit the dimensions.
    RuntimeError
        When the rate, the dimensions or the units are out of range, there are too few or too many
        slices, or values are too small for ZFP, or NaN or infinite and not to be hidden; the
        message says what, and where.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> x, y = np.meshgrid(np.linspace(-1, 1, 32), np.linspace(-1, 1, 32))
    >>> slices = (np.sqrt(x * x + y * y + z * z) for z in np.linspace(-1, 1, 32))
    >>> volume = progiso.compress_slabs(slices, (32, 32, 32), rate=4)
    >>> progiso.describe(volume)["samples"]
    [32, 32, 32]
    """
    width, height, depth = (int(n) for n in dimensions)
    size = (width, height, depth)
    if callable(slabs):
        kind = np.float32 if tuple(units) == (0.0, 1.0) else np.float64
        slabs = compute_slabs(slabs, size, threads=threads, kind=kind)
    arrays = (_vtk_array(slab) for slab in _whole_layers(slabs, size))
    options = CompressionOptions(rate=rate, mask_nan=mask_nan, threads=threads, progress=progress)
    return build(arrays, size, name, options, units=units)


def build(
    arrays: Iterable[vtkDataArray],
    dimensions: Dimensions,
    name: str,
    options: CompressionOptions,
    *,
    units: tuple[float, float] = (0.0, 1.0),
) -> vtkImageData:
    """Compress slabs of whole layers of blocks that are VTK arrays; see `compress_slabs`."""
    offset, scale = map(float, units)
    builder = vtkCompressedVolumeBuilder()
    builder.SetArrayName(name)
    builder.SetNumberOfThreads(options.threads)
    builder.SetMaskNonFinite(bool(options.mask_nan))
    builder.SetOffset(offset)
    builder.SetScale(scale)
    _require(builder.Start(dimensions, options.rate), builder)
    for array in arrays:
        _require(builder.AddSlab(array, options.component), builder)
        if options.progress is not None:
            options.progress(builder.GetNumberOfSlices() / dimensions[2])
    image = vtkImageData()
    _require(builder.Finish(image), builder)
    return image


def compute_slabs(
    slice_at: _SliceAt,
    dimensions: Sequence[int],
    *,
    threads: int = 0,
    kind: npt.DTypeLike = np.float32,
) -> Iterator[Array]:
    """Compute a volume slab by slab, in threads.

    Parameters
    ----------
    slice_at : callable
        Function of a slice's number that returns the slice, shape (height, width); called from
        several threads at once.
    dimensions : sequence of int
        Samples along x, y and z.
    threads : int, default: 0
        0 for one per core.
    kind : numpy.dtype, default: float32

    Yields
    ------
    numpy.ndarray of that kind, shape (depth, height, width)
        The next slices. The same memory every time: use it before the next is asked for.

    Examples
    --------
    >>> [slab.shape for slab in compute_slabs(lambda z: np.full((2, 3), z), (3, 2, 5))]
    [(5, 2, 3)]
    """
    width, height, slices = dimensions
    threads = threads or _cores()
    worthwhile = max(threads, _WORTHWHILE // (width * height))
    slab = np.empty((min(slices, -(-worthwhile // 4) * 4), height, width), kind)

    def compute(place: int, z: int) -> None:
        slab[place] = slice_at(z)

    with _one_blas_thread(), ThreadPoolExecutor(threads) as pool:
        for first in range(0, slices, len(slab)):
            count = min(len(slab), slices - first)
            list(pool.map(compute, range(count), range(first, first + count)))
            yield slab[:count]


def _cores() -> int:
    """Count the cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _one_blas_thread() -> AbstractContextManager[Any]:
    """Keep NumPy's matrix products in the thread that asks for them: all cores are busy already."""
    from threadpoolctl import threadpool_limits

    return threadpool_limits(limits=1, user_api="blas")


def _whole_layers(slabs: Iterable[npt.ArrayLike], dimensions: Dimensions) -> Iterator[Array]:
    """Regroup slabs so that all but the last have a multiple of 4 slices: whole blocks."""
    width, height, _ = dimensions
    rest: Array | None = None
    for number, given in enumerate(slabs):
        slab = np.asarray(given)
        slab = slab[np.newaxis] if slab.ndim == 2 else slab
        if slab.ndim != 3 or slab.shape[1:] != (height, width):
            raise ValueError(
                f"slab {number} has shape {slab.shape}, not (any depth, {height}, {width})"
            )
        slab = slab if rest is None else np.concatenate([rest, slab])
        whole = len(slab) // 4 * 4
        if whole:
            yield slab[:whole]
        rest = slab[whole:].copy() if whole < len(slab) else None
    if rest is not None:
        yield rest


def _vtk_array(slab: Array) -> vtkDataArray:
    """View a slab as a VTK array; it is copied only where its memory is in another order."""
    native = slab.astype(slab.dtype.newbyteorder("="), copy=False)
    return numpy_to_vtk(np.ascontiguousarray(native).reshape(-1))


def _require(succeeded: bool, builder: vtkCompressedVolumeBuilder) -> None:
    if not succeeded:
        raise RuntimeError(f"cannot compress: {builder.GetErrorMessage()}")
