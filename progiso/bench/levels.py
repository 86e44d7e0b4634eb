"""Measure how levels of detail might be made: filters, and the rate that coarse levels need.

Everything here is NumPy's, slow and plain, and independent of the pyramid that `progiso.compress`
makes: filters that lost are here, too. Half-band and [1 2 1]/4 put coarse sample j where fine
sample 2j lies; means of 2 lie half a fine voxel further.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._typing import Array
from ..compression import describe
from ..geometry import image_from_array, samples_of
from ..io import compress
from .errors import of_one_image
from .fields import Field, plain
from .settings import Settings

LEVELS = 3

#: Radii of the spheres, in fine voxels.
RADII = (24.0, 48.0)

#: Bits per sample of level 0.
RATES = (1.0, 2.0, 4.0, 8.0)

#: Bits per sample beyond level 0's that a coarse level is given at most, to find the least.
MOST_MORE = 8


def _at(values: Array, index: Array) -> Array:
    """Take samples along the first axis; beyond the border those mirrored in its sample."""
    last = len(values) - 1
    inside = np.clip(index, 0, last)
    mirrored = np.clip(np.where(index < 0, -index, 2 * last - index), 0, last)
    taken = values[inside]
    outside = index != inside
    taken[outside] += taken[outside] - values[mirrored[outside]]
    return taken


def _half_band(values: Array) -> Array:
    at = np.arange(0, len(values) + 1, 2)
    middle, near, far = (_at(values, at - d) + _at(values, at + d) for d in (0, 1, 3))
    return np.float32(0.25) * middle + np.float32(0.28125) * near - np.float32(0.03125) * far


def _limited(values: Array) -> Array:
    """Keep samples on the border, and the others within the range of the three around them."""
    at = np.arange(0, len(values) + 1, 2)
    near = [values[np.clip(at + d, 0, len(values) - 1)] for d in (-1, 0, 1)]
    limited = np.clip(_half_band(values), np.minimum.reduce(near), np.maximum.reduce(near))
    limited[0], limited[-1] = values[0], values[-1]
    return limited


def _replicated(values: Array) -> Array:
    """Continue the samples beyond the border by those on it, and then as `_limited`."""
    below, above = values[:1].repeat(4, 0), values[-1:].repeat(6, 0)
    return _limited(np.concatenate([below, values, above]))[2 : 3 + len(values) // 2]


def _one_two_one(values: Array) -> Array:
    at = np.arange(0, len(values) + 1, 2)
    middle, near = (_at(values, at - d) + _at(values, at + d) for d in (0, 1))
    return np.float32(0.25) * (middle + near)


def _mean(values: Array) -> Array:
    last = len(values) - 1
    odd = values[np.minimum(np.arange(1, last + 2, 2), last)]
    return np.float32(0.5) * (values[::2] + odd)


@dataclass(frozen=True)
class Filter:
    """A way to make coarse samples of fine ones, along the first axis.

    Attributes
    ----------
    coarsen : callable
        Takes the fine samples.
    shift : float
        Where coarse sample 0 lies, in fine voxels.
    """

    coarsen: Callable[[Array], Array]
    shift: float = 0.0


#: What the pyramid is made with.
CHOSEN = Filter(_limited)

FILTERS = {
    "half-band, limited": CHOSEN,
    "the same, border replicated": Filter(_replicated),
    "half-band": Filter(_half_band),
    "[1 2 1]/4": Filter(_one_two_one),
    "means of 2³": Filter(_mean, 0.5),
}


def chosen_bits(level: int) -> int:
    """Return the bits per sample beyond level 0's that the pyramid gives to a level from 1 on."""
    return level + 2


def coarsened(values: Array, kind: Filter) -> Array:
    """Make the next level of a volume.

    Parameters
    ----------
    values : numpy.ndarray, shape (depth, height, width)
    kind : Filter

    Returns
    -------
    numpy.ndarray
        Half as many along each axis.
    """
    for axis in (2, 1, 0):
        moved = np.moveaxis(values, axis, 0)
        values = np.moveaxis(kind.coarsen(np.ascontiguousarray(moved)), 0, axis)
    return values


def interpolated(coarse: Array, shape: Sequence[int], shift: float, step: int) -> Array:
    """Evaluate the trilinear interpolant of a level at samples of level 0.

    Parameters
    ----------
    coarse : numpy.ndarray
    shape : sequence of int
        Of level 0.
    shift : float
        Where the first coarse sample lies, in fine voxels.
    step : int
        Distance of coarse samples, in fine voxels.

    Returns
    -------
    numpy.ndarray of that shape
        Beyond the outermost coarse samples, where means lack any, these are taken.
    """
    for axis in range(3):
        at = np.clip((np.arange(shape[axis]) - shift) / step, 0, coarse.shape[axis] - 1)
        low = np.minimum(at.astype(int), max(coarse.shape[axis] - 2, 0))
        high = np.minimum(low + 1, coarse.shape[axis] - 1)
        weight = (at - low).astype(np.float32).reshape([-1 if i == axis else 1 for i in range(3)])
        coarse = coarse.take(low, axis) * (1 - weight) + coarse.take(high, axis) * weight
    return coarse


def measure_spheres(radii: Sequence[float] = RADII) -> dict[str, Any]:
    """Measure how far each level's surface lies from a sphere, inward, in its own voxels.

    The field is the distance to the sphere, whose values are displacements themselves.

    Parameters
    ----------
    radii : sequence of float
        In voxels of level 0.

    Returns
    -------
    dict
        ``spheres``: for every radius, filter and level the sphere's ``coarse_radius``, the mean
        displacement that the filter alone brings (``filter``, at samples within a voxel of the
        sphere), and that of the interpolant (``surface``, at the points where the sphere crosses
        edges of the fine grid), each times that radius; and ``largest`` as it is.
    """
    return {"spheres": [row for radius in radii for row in _sphere_rows(radius)]}


def _sphere_rows(radius: float) -> list[dict[str, Any]]:
    side = int(2 * radius) + 2**LEVELS * 2
    center = side / 2 + np.array([0.1, 0.27, 0.43])
    axes = np.ogrid[:side, :side, :side]
    distance = np.sqrt(sum((axis - c) ** 2 for axis, c in zip(axes, center)))
    field = (radius - distance).astype(np.float32)
    near = np.nonzero(np.abs(field) < 0.5)
    rows = []
    for name, kind in FILTERS.items():
        values, shift = field, 0.0
        for level in range(1, LEVELS + 1):
            step = 2**level
            values = coarsened(values, kind)
            shift += kind.shift * step / 2
            samples = [shift + step * axis for axis in np.ogrid[tuple(map(slice, values.shape))]]
            true = radius - np.sqrt(sum((s - c) ** 2 for s, c in zip(samples, center)))
            at = np.abs(true) < step
            off = (values - true)[at] / step
            surface = (interpolated(values, field.shape, shift, step) - field)[near] / step
            coarse_radius = radius / step
            rows.append(
                {
                    "filter_name": name,
                    "level": level,
                    "coarse_radius": coarse_radius,
                    "filter": float(-off.mean() * coarse_radius),
                    "surface": float(-surface.mean() * coarse_radius),
                    "largest": float(np.abs(surface).max()),
                }
            )
    return rows


def measure_levels(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure filters and rates on a field.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings

    Returns
    -------
    dict
        ``filters``: for every filter and level how far the coarse interpolant is off the fine
        samples (``largest`` and ``rms``), and how far its samples lie beyond the range of the fine
        ones (``overshoot``, and which part of them, ``outside``), in parts of the range. ``rates``:
        for every rate of level 0 and every level the ``least`` whole number of bits per sample more
        at which its samples are off by no more than those of level 0, and what part of that
        ``error`` they are off with the bits that `chosen_bits` gives. With ``left_out`` nothing
        else.
    """
    return of_one_image(field, settings, lambda: _measure(field))


def _measure(field: Field) -> dict[str, Any]:
    values = samples_of(plain(field)).astype(np.float32)
    return {
        "filters": [row for name, kind in FILTERS.items() for row in _rows(values, name, kind)],
        "rates": _rates(values, RATES),
    }


def _rows(values: Array, name: str, kind: Filter) -> list[dict[str, Any]]:
    low, high = float(values.min()), float(values.max())
    rows, coarse, shift = [], values, 0.0
    for level in range(1, LEVELS + 1):
        step = 2**level
        coarse = coarsened(coarse, kind)
        shift += kind.shift * step / 2
        off = interpolated(coarse, values.shape, shift, step) - values
        beyond = np.maximum(coarse - high, low - coarse)
        rows.append(
            {
                "filter_name": name,
                "level": level,
                "largest": float(np.abs(off).max()) / (high - low),
                "rms": float(np.sqrt(np.square(off, dtype=float).mean())) / (high - low),
                "overshoot": max(0.0, float(beyond.max())) / (high - low),
                "outside": float((beyond > 0).mean()),
            }
        )
    return rows


def _rates(values: Array, rates: Sequence[float]) -> list[dict[str, Any]]:
    return [{"rate": rate, "levels": list(_rate_rows(values, rate))} for rate in rates]


def _rate_rows(values: Array, rate: float) -> Iterator[dict[str, float]]:
    goal = _largest_error(values, rate)
    for level in range(1, LEVELS + 1):
        values = coarsened(values, CHOSEN)
        least = next(
            (more for more in range(MOST_MORE + 1) if _largest_error(values, rate + more) <= goal),
            MOST_MORE + 1,
        )
        chosen = _largest_error(values, rate + chosen_bits(level))
        yield {"level": level, "least": least, "error": chosen / goal if goal else 0.0}


def _largest_error(values: Array, rate: float) -> float:
    volume = compress(image_from_array(values.ravel(), values.shape[::-1]), rate=min(rate, 32.0))
    return float(describe(volume)["largest_error"])
