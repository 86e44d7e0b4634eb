"""Volumes that are computed and compressed a few slices at a time, never in memory as a whole."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, Progress, Rate, Vector
from .._vtk import vtk_errors
from .._warnings import warn_user
from ..compression import describe
from ..geometry import plain_samples, set_axes
from ..options import CompressionOptions, RateChoice, checked_levels, rate_choice
from ..vtkProgIsoFilters import (
    vtkCompressedVolumeBuilder,
    vtkSampleRateFinder,
    vtkSampleUnitsFinder,
)
from .arrays import ArraySource, is_sliced

#: A function of a slice's number that returns the slice, of shape (height, width).
_SliceAt = Callable[[int], npt.ArrayLike]

#: Samples in a slab that are worth starting threads for.
_WORTHWHILE = 2**23


def compress_slabs(
    slabs: Iterable[Array] | _SliceAt,
    dimensions: Sequence[int] | None = None,
    *,
    rate: Rate = None,
    tolerance: float | None = None,
    name: str = "scalars",
    spacing: Sequence[float] = (1.0, 1.0, 1.0),
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    mask_nan: bool = True,
    levels: int = 0,
    units: tuple[float, float] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> vtkImageData:
    """Compress a volume that is computed or read a few slices at a time.

    Memory holds one slab and the compressed stream. The result is bit for bit that of `compress`
    on the whole volume. Only where slabs come once, from a generator, nobody can tell from the
    first ones whether float32 will hold all values: then a warning names the `units` that would
    have.

    Parameters
    ----------
    slabs : iterable of numpy.ndarray, or callable
        Consecutive slabs of shape (depth, height, width), or slices of shape (height, width), of
        one numeric type, x fastest; of any depth, though 4 slices or more at a time are fastest.
        Each is used up before the next is asked for, so that its memory may be used again.
        Or ``slice_at(z)``, a function of a slice's number that returns the slice, of one type; it
        is called from several threads at once. Masked samples (`numpy.ma`) are hidden.
        Or an array of dask, zarr or h5py, indexed [z, y, x], that is read some slices at a time.
    dimensions : sequence of int, optional
        Samples along x (width), y (height) and z, each at least 2. An array tells its own.
    rate : float or "auto", optional
        Bits per sample, in (0, 32], or what `compress` chooses: for that, `slabs` are gone through
        several times where they are labels, or where there is a tolerance. Slabs that come once
        take a number, by default 8.
    tolerance : float, optional
        As in `compress`, for slabs that can be gone through several times.
    name : str, default: "scalars"
        Name of the array.
    spacing, origin : sequence of 3 float
        Distance of samples along x, y and z, and the place of the first.
    mask_nan : bool, default: True
        Whether NaN and infinite samples are hidden, as in `compress`.
    levels : int, default: 0
        Most levels of detail, as in `compress`: they are made as slabs come, and memory holds some
        slices of each.
    units : tuple of 2 float, optional
        Offset and scale: the stream has (value - offset) / scale, as float32. So it can hold small
        differences on a large offset, and values beyond float32. By default those that `compress`
        chooses: for that, `slabs` are gone through twice where their type asks for it (float64, and
        integers of 32 bits and more, unless small values come soon).
    threads : int, default: 0
        Threads that encode, and that call ``slice_at``; 0 for one per core.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.

    Raises
    ------
    ValueError
        When a slab's shape does not fit the dimensions, or these are missing.
    TypeError
        When slabs hold no real numbers, or slices are of another type than the first.
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
    options = CompressionOptions(
        rate=rate,
        tolerance=tolerance,
        mask_nan=mask_nan,
        levels=levels,
        threads=threads,
        progress=progress,
    )
    size, passes = _sized_passes(slabs, dimensions, threads)
    if callable(passes):
        volume = compress_passes(passes, size, name, options, units=units, spacing=spacing)
    else:
        volume = build(passes, size, name, options, units=units, spacing=spacing)
    set_axes(volume, np.diag(np.asarray(spacing, float)), origin)
    return volume


def _sized_passes(
    slabs: Iterable[Array] | _SliceAt, dimensions: Sequence[int] | None, threads: int
) -> tuple[Dimensions, Iterator[Array] | Callable[[], Iterator[Array]]]:
    """Return the dimensions, and whole layers of blocks or what makes these each time."""
    if is_sliced(slabs):
        source = ArraySource(slabs, "zyx")
        own = source.about.dimensions
        if dimensions is not None and tuple(dimensions) != own:
            raise ValueError(f"the array has {own} samples, not {tuple(dimensions)}")
        return own, source.slabs
    if dimensions is None:
        raise ValueError("give dimensions: samples along x, y and z")
    width, height, depth = (int(n) for n in dimensions)
    size = (width, height, depth)
    return size, _passes(slabs, size, threads)


def compress_passes(
    slabs: Callable[[], Iterable[npt.ArrayLike | vtkDataArray]],
    dimensions: Dimensions,
    name: str,
    options: CompressionOptions,
    *,
    units: tuple[float, float] | None = None,
    components: int = 1,
    spacing: Vector = (1.0, 1.0, 1.0),
) -> vtkImageData:
    """Compress slabs of whole layers of blocks that can be gone through several times.

    Units and rate are those that `compress` chooses for the whole, whose errors are raised, too.
    ``slabs()`` begins a pass; what it yields is described in `build`.
    """
    choice = rate_choice(options.rate, options.tolerance)
    if units is None:
        units = units_of(slabs(), component=options.component, components=components)
    if choice.tolerance or choice.keep_labels:
        rate = _find_rate(slabs, dimensions, options, choice, units, components)
        options = replace(options, rate=rate, tolerance=None)
    return build(
        slabs(), dimensions, name, options, units=units, components=components, spacing=spacing
    )


def _find_rate(
    slabs: Callable[[], Iterable[npt.ArrayLike | vtkDataArray]],
    dimensions: Dimensions,
    options: CompressionOptions,
    choice: RateChoice,
    units: tuple[float, float],
    components: int,
) -> float:
    """Find the rate that a tolerance asks for, or that labels need, in some passes."""
    finder = vtkSampleRateFinder()
    finder.SetOffset(units[0])
    finder.SetScale(units[1])
    finder.SetMaskNonFinite(bool(options.mask_nan))
    finder.SetNumberOfThreads(options.threads)

    def go_through(add: Callable[..., bool]) -> None:
        finder.Start(dimensions)
        with vtk_errors("cannot compress"):
            for slab in slabs():
                samples, hidden = _vtk_arrays(slab, options.component, components)
                if not add(samples, options.component, hidden):
                    break

    if choice.tolerance:
        finder.SetTolerance(choice.tolerance)
    else:
        go_through(finder.AddForLabels)
        if not finder.FindsLabels():
            return choice.rate
        finder.SetRate(choice.rate)
    before = 0.0
    while finder.GetRate() != before and not finder.GetLeastError():
        before = finder.GetRate()
        go_through(finder.AddSlab)
    if not finder.GetLeastError():
        return finder.GetRate()
    if choice.tolerance:
        raise ValueError(
            f"no rate keeps the samples within {choice.tolerance:g}: at 32 bits some are off by "
            f"{finder.GetLeastError():g}"
        )
    return 32.0


def units_of(
    slabs: Iterable[npt.ArrayLike | vtkDataArray], *, component: int = 0, components: int = 1
) -> tuple[float, float]:
    """Choose the units of a volume that comes some slices at a time, as `compress` does.

    Parameters
    ----------
    slabs : iterable of array_like or vtkmodules.vtkCommonCore.vtkDataArray
        The volume's samples, all of one type, cut in any way. Not all are asked for where the first
        ones settle the matter: none but the first where the type has at most 16 bits, few where it
        is float32, or where integers lie close to zero. Masked (`numpy.ma`), NaN and infinite
        samples do not count.
    component : int, default: 0
        Component that is compressed.
    components : int, default: 1
        Values per sample of arrays, along the last axis; VTK's arrays know theirs.

    Returns
    -------
    offset, scale : float
        What `compress_slabs` takes as ``units``: 0 and 1 where float32 holds the values as they
        are.

    Examples
    --------
    >>> units_of([np.arange(12.0).reshape(3, 4), np.arange(1e8, 1e8 + 12).reshape(3, 4)])
    (0.0, 1.0)
    >>> units_of([np.full((3, 4), 101325.25), np.full((3, 4), 101325.75)])
    (101325.5, 1.0)
    """
    finder = vtkSampleUnitsFinder()
    for slab in slabs:
        samples, hidden = _vtk_arrays(slab, component, components)
        with vtk_errors("cannot choose units"):
            if finder.AddSamples(samples, component, hidden):
                break
    return finder.GetOffset(), finder.GetScale()


def build(
    slabs: Iterable[npt.ArrayLike | vtkDataArray],
    dimensions: Dimensions,
    name: str,
    options: CompressionOptions,
    *,
    units: tuple[float, float] | None = None,
    components: int = 1,
    spacing: Vector = (1.0, 1.0, 1.0),
) -> vtkImageData:
    """Compress slabs of whole layers of blocks; see `compress_slabs`.

    They are arrays of shape (depth, height, width), with `components` more values where there are
    several, whose masked samples are hidden, or VTK's. Where `units` are None nobody looked for
    them: values that float32 cannot hold are compressed as they are, and a warning says so. Where
    the rate is None nobody looked for labels, and a warning tells that they have not been kept.
    Levels of detail halve axes by the spacing, which the image does not get.
    """
    offset, scale = (0.0, 1.0) if units is None else map(float, units)
    builder = vtkCompressedVolumeBuilder()
    builder.SetArrayName(name)
    builder.SetNumberOfThreads(options.threads)
    builder.SetMaskNonFinite(bool(options.mask_nan))
    builder.SetOffset(offset)
    builder.SetScale(scale)
    builder.SetLevels(checked_levels(options.levels))
    builder.SetSpacing(*map(float, spacing))
    choice = rate_choice(options.rate, options.tolerance)
    if choice.tolerance:
        raise ValueError("slabs that come once take a rate, not a tolerance")
    _require(builder.Start(dimensions, choice.rate), builder)
    finder = vtkSampleUnitsFinder() if units is None else None
    labels = vtkSampleRateFinder() if choice.keep_labels else None
    if labels is not None:
        labels.Start(dimensions)
    for slab in slabs:
        samples, hidden = _vtk_arrays(slab, options.component, components)
        if finder is not None and samples.GetNumberOfComponents() > options.component >= 0:
            finder.AddSamples(samples, options.component, hidden)
        if not builder.AddSlab(samples, options.component, hidden):
            raise RuntimeError(f"cannot compress: {builder.GetErrorMessage()}{_advice(finder)}")
        if labels is not None and not labels.AddForLabels(samples, options.component, hidden):
            labels = None
        if options.progress is not None:
            options.progress(builder.GetNumberOfSlices() / dimensions[2])
        del slab, samples, hidden  # before the next are read
    image = vtkImageData()
    if not builder.Finish(image):
        raise RuntimeError(f"cannot compress: {builder.GetErrorMessage()}{_advice(finder)}")
    if _advice(finder):
        warn_user(f"float32 cannot hold the samples{_advice(finder)}")
    error = describe(image)["largest_error"]
    if labels is not None and labels.FindsLabels() and error >= 0.5:
        warn_user(
            f"the slabs are labels, and off by up to {error:g} at {choice.rate:g} bits per sample: "
            "give a rate, or slabs that can be gone through twice"
        )
    return image


def _advice(finder: vtkSampleUnitsFinder | None) -> str:
    """Say what to do about values that a single pass could not compress well."""
    units = (0.0, 1.0) if finder is None else (finder.GetOffset(), finder.GetScale())
    if units == (0.0, 1.0):
        return ""
    return (
        f" (slabs that come once are compressed as they are: give units={units!r}, or slabs that "
        "can be gone through twice)"
    )


def _passes(
    slabs: Iterable[npt.ArrayLike] | _SliceAt, dimensions: Dimensions, threads: int
) -> Iterator[Array] | Callable[[], Iterator[Array]]:
    """Return whole layers of blocks, or where slabs can be gone through again, what makes these."""
    if callable(slabs):
        slice_at = slabs
        kind = plain_samples(slice_at(0))[0].dtype
        return lambda: compute_slabs(slice_at, dimensions, threads=threads, kind=kind)
    if iter(slabs) is slabs:
        return _whole_layers(slabs, dimensions)
    given = slabs
    return lambda: _whole_layers(given, dimensions)


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
        Type of the slabs; other floating point values are rounded to it.

    Yields
    ------
    numpy.ndarray of that kind, shape (depth, height, width)
        The next slices, a masked array where one of them is. The same memory every time: use it
        before the next is asked for.

    Raises
    ------
    TypeError
        When a slice is of a type that the kind cannot hold.

    Examples
    --------
    >>> [slab.shape for slab in compute_slabs(lambda z: np.full((2, 3), z), (3, 2, 5))]
    [(5, 2, 3)]
    """
    width, height, slices = dimensions
    threads = threads or _cores()
    worthwhile = max(threads, _WORTHWHILE // (width * height))
    slab: Array = np.empty((min(slices, -(-worthwhile // 4) * 4), height, width), kind)
    masks: dict[int, Array] = {}

    def compute(place: int, z: int) -> None:
        values, hidden = plain_samples(slice_at(z))
        if not np.can_cast(values.dtype, slab.dtype, "same_kind"):
            raise TypeError(f"slice {z} is of type {values.dtype}, not {slab.dtype} as the first")
        slab[place] = values
        if hidden is not None:
            masks[place] = hidden

    with _one_blas_thread(), ThreadPoolExecutor(threads) as pool:
        for first in range(0, slices, len(slab)):
            count = min(len(slab), slices - first)
            masks.clear()
            list(pool.map(compute, range(count), range(first, first + count)))
            yield _masked(slab[:count], masks)


def _cores() -> int:
    """Count the cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _one_blas_thread() -> AbstractContextManager[Any]:
    """Keep NumPy's matrix products in the thread that asks for them: all cores are busy already."""
    from threadpoolctl import threadpool_limits

    return threadpool_limits(limits=1, user_api="blas")


def _masked(slab: Array, masks: dict[int, Array]) -> Array:
    """Mask some slices of a slab."""
    if not masks:
        return slab
    hidden = np.zeros(slab.shape, bool)
    for place, mask in masks.items():
        hidden[place] = mask
    return np.ma.MaskedArray(slab, hidden, copy=False)


def _whole_layers(slabs: Iterable[npt.ArrayLike], dimensions: Dimensions) -> Iterator[Array]:
    """Regroup slabs so that all but the last have a multiple of 4 slices: whole blocks."""
    width, height, _ = dimensions
    rest: Array | None = None
    for number, given in enumerate(slabs):
        slab = np.ma.asanyarray(given) if np.ma.isMA(given) else np.asarray(given)
        slab = slab[np.newaxis] if slab.ndim == 2 else slab
        if slab.ndim != 3 or slab.shape[1:] != (height, width):
            raise ValueError(
                f"slab {number} has shape {slab.shape}, not (any depth, {height}, {width})"
            )
        slab = slab if rest is None else _joined(rest, slab)
        whole = len(slab) // 4 * 4
        if whole:
            yield slab[:whole]
        rest = slab[whole:].copy() if whole < len(slab) else None
    if rest is not None:
        yield rest


def _joined(first: Array, second: Array) -> Array:
    """Concatenate slabs, with their masks where there are any."""
    masked = np.ma.isMA(first) or np.ma.isMA(second)
    return (np.ma.concatenate if masked else np.concatenate)([first, second])


def _vtk_arrays(
    slab: npt.ArrayLike | vtkDataArray, component: int, components: int
) -> tuple[vtkDataArray, vtkDataArray | None]:
    """View a slab, and what is hidden of one component, as VTK arrays.

    It is copied only where its memory is in another order.
    """
    if isinstance(slab, vtkDataArray):
        return slab, None
    values, mask = plain_samples(slab)
    flat = np.ascontiguousarray(values).reshape(-1, components)
    samples = numpy_to_vtk(flat if components > 1 else flat[:, 0])
    if mask is None or not -1 <= component < components:
        return samples, None
    flags = mask.reshape(-1, components)
    hidden = np.ascontiguousarray(flags.any(axis=1) if component < 0 else flags[:, component])
    return samples, numpy_to_vtk(hidden.view(np.uint8), deep=True)


def _require(succeeded: bool, builder: vtkCompressedVolumeBuilder) -> None:
    if not succeeded:
        raise RuntimeError(f"cannot compress: {builder.GetErrorMessage()}")
