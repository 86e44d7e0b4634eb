"""The least rate that keeps every sample within a tolerance."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from numbers import Real
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

from ._typing import Array, Progress
from .compression import compress, compress_with, decompress, describe, find_array
from .geometry import GHOSTS, image_from_array, samples_of
from .options import CompressionOptions

#: Bits of a block of 64 samples at the lowest and at the highest rate.
LEAST_BITS, MOST_BITS = 9, 2048

#: Samples that are compressed at a time, at least 4 slices.
_SLAB = 1 << 20

#: Largest error of a part of an image, as a function of the bits of a block.
_Error = Callable[[int], float]


def least_rate(
    image: vtkImageData,
    tolerance: float,
    *,
    relative: bool = False,
    array: str | None = None,
    component: int = 0,
    mask_nan: bool = False,
    progress: Progress | None = None,
) -> float:
    """Find the least rate at which no sample is off by more than a tolerance.

    At the returned rate every sample has been compressed, decompressed and compared with the
    original. A lower rate may keep them all by chance: rates are a 64th of a bit apart, errors do
    not fall at every step, and not all rates are tried. The search takes two to three times as
    long as compressing and decompressing the image, and memory for some slices (for a decompressed
    volume where samples are hidden).

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Plain, at least 2 samples along every axis.
    tolerance : float
        Largest error of a sample, above 0, in the units of the image's values. Hidden samples
        do not count.
    relative : bool, default: False
        Whether the tolerance is in units of the values' range, their maximum less their minimum.
    array, component, mask_nan : str, int, bool
        What is compressed of the image, as in `compress`.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Returns
    -------
    float
        Bits per sample, a multiple of 1/64 from 9/64 to 32, as `compress` takes it.

    Raises
    ------
    TypeError
        When `image` is no image.
    ValueError
        When the tolerance is not positive, or finer than 32 bits per sample can keep; the message
        tells what they can. When there is no such array.
    RuntimeError
        When `compress` cannot compress the image.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> image = progiso.image_from_array(np.arange(512.0), (8, 8, 8))
    >>> rate = progiso.least_rate(image, 0.5)
    >>> decoded = progiso.decompress(progiso.compress(image, rate=rate)).GetPointData().GetScalars()
    >>> max(abs(decoded.GetValue(i) - i) for i in range(512)) <= 0.5
    True
    """
    if not isinstance(tolerance, Real) or not 0 < tolerance < math.inf:
        raise ValueError(f"tolerance must be a number above 0, got {tolerance!r}")
    options = CompressionOptions(
        rate=LEAST_BITS / 64, array=array, component=component, mask_nan=mask_nan
    )
    about = describe(compress_with(image, options))
    low, high = about["range"]
    if relative and low == high:
        raise ValueError(f"all samples are {low:g}: give a tolerance in their own units")
    if relative:
        tolerance = tolerance * (high - low)
    if mask_nan or _has_ghosts(image):
        errors: list[_Error] = [lambda bits: _error_of_visible(image, options, bits)]
    else:
        errors = [_error_of(slab, about) for slab in _slabs(image, array, component)]
    return _search(errors, tolerance, progress or (lambda _: None)) / 64


# ---- errors of parts of the image, as functions of the bits of a block


def _has_ghosts(image: vtkImageData) -> bool:
    attributes = image.GetPointData(), image.GetCellData()
    return any(data.HasArray(GHOSTS) for data in attributes)


def _error_of_visible(image: vtkImageData, options: CompressionOptions, bits: int) -> float:
    """Return the largest error of a whole image; hidden samples are decompressed to NaN."""
    found, _ = find_array(image, options.array)
    decoded = decompress(compress_with(image, replace(options, rate=bits / 64)))
    ours = samples_of(decoded).ravel()
    theirs = vtk_to_numpy(found).reshape(len(ours), -1)[:, options.component]
    seen = ~np.isnan(ours)
    return float(np.abs(ours[seen] - theirs[seen].astype(float)).max(initial=0.0))


def _slabs(image: vtkImageData, array: str | None, component: int) -> list[Array]:
    """Cut the samples into slabs of whole blocks, each an array [z, y, x]."""
    found, of_cells = find_array(image, array)
    width, height, depth = (n - int(of_cells) for n in image.GetDimensions())
    values = vtk_to_numpy(found).reshape(depth, height, width, -1)[..., component]
    slices = 4 * max(1, _SLAB // (4 * width * height))
    begins = list(range(0, depth, slices))
    if len(begins) > 1 and depth - begins[-1] < 2:
        begins.pop()  # a single slice cannot be compressed
    return [values[a:b] for a, b in zip(begins, [*begins[1:], depth])]


def _error_of(slab: Array, about: dict[str, Any]) -> _Error:
    """Make a function of the bits of a block that returns the largest error of a slab.

    The slab is of a volume that `about` describes: it is compressed in the volume's units, so that
    its blocks are those of the volume.
    """
    offset, scale = about["offset"], about["scale"]
    identity = (offset, scale) == (0, 1)

    def error(bits: int) -> float:
        stored = np.ascontiguousarray(slab if identity else (slab.astype(float) - offset) / scale)
        plain = image_from_array(stored.astype(np.float32).ravel(), slab.shape[::-1])
        decoded = samples_of(decompress(compress(plain, rate=bits / 64)))
        ours = offset + scale * decoded.astype(float)
        return float(np.abs(ours - slab.astype(float)).max())

    return error


# ---- the search


def _search(errors: list[_Error], tolerance: float, progress: Progress) -> int:
    """Find the least number of bits with which all errors are within the tolerance."""
    # A part that needs more bits than those before it starts a bisection. In random order that
    # happens seldom: to ln n of n parts.
    order = list(np.random.default_rng(0).permutation(len(errors)))
    bits, unseen, most_seen = LEAST_BITS, order, 0
    while unseen:
        error = errors[unseen[0]]
        if error(bits) > tolerance:
            bits = _bisect(error, bits, tolerance)
            # errors do not fall at every step: those that fitted with fewer bits may not now
            unseen = [i for i in order if i != unseen[0]]
        else:
            unseen = unseen[1:]
        most_seen = max(most_seen, len(errors) - len(unseen))
        progress(most_seen / len(errors))
    return bits


def _bisect(error: _Error, too_few: int, tolerance: float) -> int:
    """Find a number of bits with which an error is within the tolerance, above one that is not."""
    enough, least = MOST_BITS, error(MOST_BITS)
    if least > tolerance:
        raise ValueError(
            f"no rate keeps the samples within {tolerance:g}: at 32 bits some are off by {least:g}"
        )
    while enough - too_few > 1:
        middle = (enough + too_few) // 2
        if error(middle) > tolerance:
            too_few = middle
        else:
            enough = middle
    return enough
