"""Fields that are hard on the arithmetic: steep, flat, thin, ambiguous and degenerate ones."""

from __future__ import annotations

from functools import partial

import numpy as np

from ..camera import orbit_camera
from . import tolerances
from .case import Case
from .fields import blobs, coordinates, noise
from .scene import check_depths, check_views, compressed, looking, parallel

_SHAPE = (28, 25, 31)


def _reference(settings):
    """What others' times are compared with."""
    return check_depths(settings, compressed(blobs(_SHAPE, 3)), 0.1)


def _distance(shape, radius=9.0):
    """Voxels outside a sphere that stands off the grid."""
    x, y, z = coordinates(shape)
    centre = np.array(shape[::-1]) / 2 - (0.37, 0.61, 0.13)
    return np.sqrt(sum((c - m) ** 2 for c, m in zip((x, y, z), centre))) - radius


def _front(slope, height, settings):
    """A shock front; the isovalues lie in its middle and on either shoulder."""
    values = height * np.tanh(slope / height * _distance(_SHAPE))
    image = compressed(values.astype(np.float32))
    return check_views(settings, image, [height * at for at in (0.0, 0.9, -0.999)])


def _step(settings):
    image = compressed(np.where(_distance(_SHAPE) < 0, 1.0, 0.0).astype(np.float32))
    return check_views(settings, image, (0.5, 1e-6, 1 - 2.0**-20))


def _gradients(settings):
    """From one end to the other the gradient goes from 1e-12 to 1e12 a voxel."""
    shape = (24, 24, 64)
    decades = np.linspace(-12, 12, shape[2])
    values = blobs(shape, 4).astype(float) * 10.0**decades
    return check_views(settings, compressed(values.astype(np.float32)), (0.0, 1e-9, 1.0, 1e9))


def _scaled(scale, settings):
    values = blobs(_SHAPE, 5) * np.float32(scale)
    return check_depths(settings, compressed(values), 0.1 * float(np.float32(scale)))


def _plateau(settings):
    """Within a few units in the last place of the isovalue everywhere."""
    steps = np.round(3 * noise(_SHAPE, 6))
    values = (1 + steps * 2.0**-23).astype(np.float32)
    image = compressed(values)
    note = "values within 1e-6 of the isovalue"
    return check_views(
        settings, image, (1 + 2.0**-24,), grazing=tolerances.GRAZING_FRACTION_NOISE, note=note
    )


CASES = (
    Case("plain: smooth field", _reference),
    Case("shock front, slope 1 per voxel", partial(_front, 1.0, 1.0)),
    Case("shock front, one voxel wide, slope 1e6 per voxel", partial(_front, 1e6, 1e6)),
    Case("shock front, tanh(1e6 d)", partial(_front, 1e6, 1.0)),
    Case("step from 0 to 1", _step),
    Case("gradients from 1e-12 to 1e12 in one volume", _gradients),
    Case("gradient 1e-12", partial(_scaled, 1e-12)),
    Case("gradient 1e12", partial(_scaled, 1e12)),
    Case("plateau within 3 ulps of the isovalue", _plateau),
)
