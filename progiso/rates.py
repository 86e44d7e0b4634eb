"""Choosing a rate: the least that keeps every sample within a tolerance."""

from __future__ import annotations

import math
from numbers import Real

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from .compression import GHOSTS, compress, decompress, describe, find_array
from .geometry import image_from_array

#: Bits of a block of 64 samples at the lowest and at the highest rate.
LEAST_BITS, MOST_BITS = 9, 2048

#: Samples that are compressed at a time, at least 4 slices.
_SLAB = 1 << 20


def least_rate(
    image, tolerance, relative=False, array=None, component=0, progress=None, mask_nan=False
):
    """Find the least rate at which no sample is off by more than a tolerance.

    At the rate that is returned every sample has been compressed, decompressed and compared with
    the original. At some lower rate they may all fit by chance: errors do not fall at every one of
    the rates, which are a 64th of a bit apart, and not all of them are tried. It takes some two or
    three times as long as to compress and decompress the image, and memory for some slices (for a
    decompressed volume where samples are hidden).

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
        What of the image, as in `compress`.
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
        When `compress` refuses the image.

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
    choice = {"array": array, "component": component, "mask_nan": mask_nan}
    about = describe(compress(image, LEAST_BITS / 64, **choice))
    low, high = about["range"]
    if relative and low == high:
        raise ValueError(f"all samples are {low:g}: give a tolerance in their own units")
    if relative:
        tolerance = tolerance * (high - low)
    if mask_nan or _has_ghosts(image):
        errors = [lambda bits: _error_of_visible(image, choice, bits)]
    else:
        errors = [_error_of(slab, about) for slab in _slabs(image, array, component)]
    return _search(errors, tolerance, progress or (lambda _: None)) / 64


# ---- errors of parts of the image, as functions of the bits of a block


def _has_ghosts(image):
    attributes = image.GetPointData(), image.GetCellData()
    return any(data.HasArray(GHOSTS) for data in attributes)


def _error_of_visible(image, choice, bits):
    """Largest error of an image as a whole; hidden samples are decompressed to NaN."""
    found, of_cells = find_array(image, choice["array"])
    decoded = decompress(compress(image, bits / 64, **choice))
    attributes = decoded.GetCellData() if of_cells else decoded.GetPointData()
    ours = vtk_to_numpy(attributes.GetScalars())
    theirs = vtk_to_numpy(found).reshape(len(ours), -1)[:, choice["component"]]
    seen = ~np.isnan(ours)
    return float(np.abs(ours[seen] - theirs[seen].astype(float)).max(initial=0.0))


def _slabs(image, array, component):
    """The samples, some slices of whole blocks at a time, each an array [z, y, x]."""
    found, of_cells = find_array(image, array)
    width, height, depth = (n - int(of_cells) for n in image.GetDimensions())
    values = vtk_to_numpy(found).reshape(depth, height, width, -1)[..., component]
    slices = 4 * max(1, _SLAB // (4 * width * height))
    begins = list(range(0, depth, slices))
    if len(begins) > 1 and depth - begins[-1] < 2:
        begins.pop()  # a single slice is no volume
    return [values[a:b] for a, b in zip(begins, [*begins[1:], depth])]


def _error_of(slab, about):
    """Largest error of a slab of a volume, which `about` describes."""
    offset, scale = about["offset"], about["scale"]
    own = (offset, scale) == (0, 1)

    def error(bits):
        # as it is stored; this is what the slab's blocks hold in the volume, too
        stored = np.ascontiguousarray(slab if own else (slab.astype(float) - offset) / scale)
        plain = image_from_array(stored.astype(np.float32).ravel(), slab.shape[::-1])
        decoded = decompress(compress(plain, bits / 64)).GetPointData().GetScalars()
        ours = offset + scale * vtk_to_numpy(decoded).reshape(slab.shape).astype(float)
        return float(np.abs(ours - slab.astype(float)).max())

    return error


# ---- the search


def _search(errors, tolerance, progress):
    """The least number of bits with which all errors are within the tolerance."""
    # Whichever part asks for more than those before it raises the bits. In random order that
    # happens seldom: of n parts to ln n.
    order = list(np.random.default_rng(0).permutation(len(errors)))
    bits, unseen, most_seen = LEAST_BITS, order, 0
    while unseen:
        error = errors[unseen[0]]
        if error(bits) > tolerance:
            bits = _bisect(error, bits, tolerance)
            # errors do not fall at every step: those that did fit may not
            unseen = [i for i in order if i != unseen[0]]
        else:
            unseen = unseen[1:]
        most_seen = max(most_seen, len(errors) - len(unseen))
        progress(most_seen / len(errors))
    return bits


def _bisect(error, too_few, tolerance):
    """The bits with which an error is within the tolerance, more than those that do not do."""
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
