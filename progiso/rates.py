"""Choosing a rate: the least that keeps every sample within a tolerance."""

from __future__ import annotations

import math
from numbers import Real

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from ._vtk import image_data
from .compression import compress, decompress, find_array, is_compressed
from .geometry import image_from_array

#: Bits of a block of 64 samples at the lowest and at the highest rate.
LEAST_BITS, MOST_BITS = 9, 2048

#: Samples that are compressed at a time, at least 4 slices.
_SLAB = 1 << 20


def least_rate(image, tolerance, relative=False, array=None, component=0, progress=None):
    """Find the least rate at which no sample is off by more than a tolerance.

    At the rate that is returned every sample has been compressed, decompressed and compared with
    the original. At some lower rate they may all fit by chance: errors do not fall at every one of
    the rates, which are a 64th of a bit apart, and not all of them are tried. It takes about
    the time of compressing and decompressing the image twice, and memory for some slices.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Plain, at least 2 samples along every axis.
    tolerance : float
        Largest error of a sample, above 0, in the units of the image's values.
    relative : bool, default: False
        Whether the tolerance is in units of the values' range, their maximum less their minimum.
    array, component : str, int
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
        tells what they can. When there is no such array or component, or a sample is not finite.
    RuntimeError
        When the image is compressed already or flat.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> image = progiso.image_from_array(np.arange(512.0), (8, 8, 8))
    >>> rate = progiso.least_rate(image, 0.5)
    >>> decoded = progiso.decompress(progiso.compress(image, rate)).GetPointData().GetScalars()
    >>> max(abs(decoded.GetValue(i) - i) for i in range(512)) <= 0.5
    True
    """
    if not isinstance(tolerance, Real) or not 0 < tolerance < math.inf:
        raise ValueError(f"tolerance must be a number above 0, got {tolerance!r}")
    slabs = _slabs(image, array, component)
    low, high = _range(slabs)
    if relative:
        if low == high:
            raise ValueError(f"all samples are {low:g}: give a tolerance in their own units")
        tolerance = tolerance * (high - low)
    return _search(slabs, tolerance, progress or (lambda _: None)) / 64


def _slabs(image, array, component):
    """The samples, some slices of whole blocks at a time, each an array [z, y, x]."""
    if is_compressed(image_data(image)):
        raise RuntimeError("the image is a compressed volume: the samples that it had are lost")
    found, of_cells = find_array(image, array)
    if not 0 <= component < found.GetNumberOfComponents():
        raise ValueError(
            f"component must be from 0 to {found.GetNumberOfComponents() - 1}, got {component}"
        )
    dimensions = [n - int(of_cells) for n in image.GetDimensions()]
    if min(dimensions) < 2:
        shape = "x".join(map(str, dimensions))
        raise RuntimeError(f"the image has {shape} samples: at least 2 are needed along each axis")
    values = vtk_to_numpy(found).reshape(*dimensions[::-1], -1)[..., component]
    slices = 4 * max(1, _SLAB // (4 * dimensions[0] * dimensions[1]))
    begins = list(range(0, dimensions[2], slices))
    if len(begins) > 1 and dimensions[2] - begins[-1] < 2:
        begins.pop()  # a single slice is no volume
    return [values[a:b] for a, b in zip(begins, [*begins[1:], dimensions[2]])]


def _range(slabs):
    """Least and largest of all samples."""
    extremes = [(float(slab.min()), float(slab.max())) for slab in slabs]
    low, high = (pick(column) for pick, column in zip((min, max), zip(*extremes)))
    if not all(math.isfinite(value) for pair in extremes for value in pair):
        count = sum(slab.size - int(np.isfinite(slab).sum()) for slab in slabs)
        raise ValueError(f"{count} samples are NaN or infinite: no rate keeps them")
    return low, high


def _search(slabs, tolerance, progress):
    """The least number of bits a block that fits all slabs."""
    # Whichever slab asks for more than those before it raises the bits. In random order that
    # happens seldom: of n slabs to ln n.
    order = list(np.random.default_rng(0).permutation(len(slabs)))
    bits, unseen, most_seen = LEAST_BITS, order, 0
    while unseen:
        slab = slabs[unseen[0]]
        if largest_error(slab, bits) > tolerance:
            bits = _bisect(slab, bits, tolerance)
            # errors do not fall at every step: those that did fit may not
            unseen = [i for i in order if i != unseen[0]]
        else:
            unseen = unseen[1:]
        most_seen = max(most_seen, len(slabs) - len(unseen))
        progress(most_seen / len(slabs))
    return bits


def _bisect(slab, too_few, tolerance):
    """The bits that fit a slab, more than those that do not."""
    error = largest_error(slab, MOST_BITS)
    if error > tolerance:
        raise ValueError(
            f"no rate keeps the samples within {tolerance:g}: at 32 bits some are off by {error:g}"
        )
    enough = MOST_BITS
    while enough - too_few > 1:
        middle = (enough + too_few) // 2
        if largest_error(slab, middle) > tolerance:
            too_few = middle
        else:
            enough = middle
    return enough


def largest_error(values, bits):
    """How far samples are off once they have been compressed.

    Parameters
    ----------
    values : numpy.ndarray, shape (depth, height, width)
    bits : int
        Of a block of 64 samples.

    Returns
    -------
    float
    """
    plain = image_from_array(np.ascontiguousarray(values).ravel(), values.shape[::-1])
    decoded = decompress(compress(plain, bits / 64)).GetPointData().GetScalars()
    return float(np.abs(vtk_to_numpy(decoded).reshape(values.shape) - values.astype(float)).max())
