"""Check pictures at rates from 1 to 32; the notes tell what compression changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..camera import orbit_camera
from ..compression import decompress
from ..geometry import samples_of
from ..measure.agreement import depth_error
from ..measure.topology import topology
from ..oracle import caster
from .case import Case, Outcome, Settings
from .fields import coordinates, make_image, marschner_lobb
from .scene import check_depths, compressed, decoded

_ISOVALUE = 0.5

_RATES = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)


def _sheet(n: int) -> np.ndarray:
    """Make a curved sheet, one sample thick: high on it, low on either side."""
    x, y, z = coordinates((n, n, n))
    centre = n / 2 - 0.3
    off = np.sqrt((x - centre) ** 2 + (y - centre) ** 2 + (z - centre) ** 2) - 0.37 * n
    return np.exp(-((off / 0.6) ** 2)).astype(np.float32)


def _rate(field: Callable[[int], np.ndarray], rate: float, settings: Settings) -> Outcome:
    values = field(41)
    plain, image = make_image(values), compressed(values, rate)
    outcome = check_depths(settings, image, _ISOVALUE, volume=decoded(image))
    return replace(outcome, note=f"{outcome.note}; {_worth(plain, image, settings.size)}")


def _worth(plain: vtkImageData, image: vtkImageData, size: tuple[int, int]) -> str:
    """Tell how compression changes the surface, by the caster and FlyingEdges."""
    orbit = orbit_camera(plain, 1, 4)
    eye = caster.Camera(orbit.position, orbit.focal_point, orbit.view_up, orbit.view_angle)
    original = caster.Volume.from_image(samples_of(plain), plain)
    exact, ours = (caster.cast(v, _ISOVALUE, eye, size) for v in (original, decoded(image)))
    error = depth_error(ours.depth, exact.depth, exact.voxels)
    before, after = (topology(i, _ISOVALUE) for i in (plain, decompress(image)))
    return (
        f"against the field without compression depths are off by {_figure(error['median'])} "
        f"(median) and {_figure(error['p99'])} voxels (99 %), {error['missed']:.2%} of the rays "
        f"miss and {error['invented']:.2%} invent a hit, {after['components']} surfaces for "
        f"{before['components']}, {after['genus']} handles for {before['genus']}"
    )


def _figure(value: float | None) -> str:
    return "–" if value is None else f"{value:.2g}"


CASES = tuple(
    Case(f"{name}, rate {rate}", partial(_rate, field, rate), field is _sheet and rate in (1, 8))
    for name, field in (("Marschner-Lobb", marschner_lobb), ("sheet of one sample", _sheet))
    for rate in _RATES
)
