"""Check fields that strain the arithmetic: steep, flat, thin, ambiguous and degenerate ones."""

from __future__ import annotations

from functools import partial

import numpy as np

from ..measure import tolerances
from .case import Case, Outcome, Settings
from .fields import blobs, coordinates, noise
from .scene import check_depths, check_views, compressed, looking, parallel

_SHAPE = (28, 25, 31)


def _reference(settings: Settings) -> Outcome:
    """Render a plain field, for the other cases' times to be compared with."""
    return check_depths(settings, compressed(blobs(_SHAPE, 3)), 0.1)


def _distance(shape: tuple[int, ...], radius: float = 9.0) -> np.ndarray:
    """Return the distance in voxels from a sphere that is not aligned with the grid."""
    x, y, z = coordinates(shape)
    centre = np.array(shape[::-1]) / 2 - (0.37, 0.61, 0.13)
    return np.sqrt(sum((c - m) ** 2 for c, m in zip((x, y, z), centre))) - radius


def _front(slope: float, height: float, settings: Settings) -> Outcome:
    """Render a shock front; the isovalues lie in its middle and on either shoulder."""
    values = height * np.tanh(slope / height * _distance(_SHAPE))
    image = compressed(values.astype(np.float32))
    return check_views(settings, image, [height * at for at in (0.0, 0.9, -0.999)])


def _step(settings: Settings) -> Outcome:
    image = compressed(np.where(_distance(_SHAPE) < 0, 1.0, 0.0).astype(np.float32))
    return check_views(settings, image, (0.5, 1e-6, 1 - 2.0**-20))


def _gradients(settings: Settings) -> Outcome:
    """Render a field whose gradient goes from 1e-12 to 1e12 a voxel, from end to end."""
    shape = (24, 24, 64)
    decades = np.linspace(-12, 12, shape[2])
    values = blobs(shape, 4).astype(float) * 10.0**decades
    return check_views(settings, compressed(values.astype(np.float32)), (0.0, 1e-9, 1.0, 1e9))


def _scaled(scale: float, settings: Settings) -> Outcome:
    values = blobs(_SHAPE, 5) * np.float32(scale)
    return check_depths(settings, compressed(values), 0.1 * float(np.float32(scale)))


def _plateau(settings: Settings) -> Outcome:
    """Render a field that is within a few units in the last place of the isovalue everywhere."""
    steps = np.round(3 * noise(_SHAPE, 6))
    image = compressed((1 + steps * 2.0**-23).astype(np.float32))
    return check_depths(settings, image, 1 + 2.0**-24, grazing=_NOISE)


def _flat_plateau(settings: Settings) -> Outcome:
    """Render a wide plateau at the isovalue that sinks by 1e-6 to its steep rim."""
    distance = _distance(_SHAPE)
    values = 5 - 1e-6 * np.exp2(distance) - np.maximum(distance, 0)
    image = compressed(values.astype(np.float32))
    return check_views(settings, image, (5 - 1e-6, 5 - 2e-6, 4.9999))


def _checkerboard(settings: Settings) -> Outcome:
    x, y, z = coordinates((15, 14, 17))
    image = compressed(np.where((x + y + z) % 2 == 0, 1.0, -1.0).astype(np.float32))
    return check_views(settings, image, (0.3, -0.9, 0.0), grazing=_NOISE)


def _noise(cached: bool, settings: Settings) -> Outcome:
    image = compressed(noise((18, 21, 16), 7))
    return check_views(settings, image, (0.0, 1.5, 2.5), grazing=_NOISE, cached=cached)


def _thin_shell(settings: Settings) -> Outcome:
    """Render a shell of a tenth of a voxel, of which samples hold specks and needles."""
    values = np.exp(-((_distance(_SHAPE) / 0.1) ** 2))
    return check_views(settings, compressed(values.astype(np.float32)), (0.5, 0.01))


def _sheet(settings: Settings) -> Outcome:
    """Render one slanted layer of samples, which has holes between voxels."""
    x, y, z = coordinates(_SHAPE)
    values = np.where(np.abs(0.31 * x + 0.47 * y + z - 22) < 0.4, 1.0, 0.0)
    return check_views(settings, compressed(values.astype(np.float32)), (0.5, 0.99))


# --- cells and their cubics -----------------------------------------------------------------------


def _product(centre: float, axes: tuple[int, ...], size: int = 9) -> np.ndarray:
    """Make the product of coordinates about a point: one trilinear field, exactly."""
    factors = [c - centre for c in coordinates((size,) * 3)]
    return np.prod([factors[axis] for axis in axes], axis=0).astype(np.float32)


def _saddles(settings: Settings) -> Outcome:
    """Render cells whose corners alternate, at and about the values of their saddles."""
    image = compressed(_product(4.5, (0, 1, 2), 10))
    return check_views(settings, image, (0.0, 1e-7, -1e-7, 1e-3, -1e-3, 0.125), grazing=_SINGULAR)


def _root_of_order(order: int, settings: Settings) -> Outcome:
    """Cast rays along the diagonal of a product of coordinates, a power of the distance."""
    axes = tuple(range(order))
    towards = np.array([1.0, 1.0, 1.0 if order == 3 else 0.0])
    camera = parallel(looking(4 - 20 * towards, (4, 4, 4), (0, 0, 1)), 1.5)
    image = compressed(_product(4.0, axes))
    isovalues = (0.0, 1e-9, -1e-9, 1e-5, -1e-5, 1e-2)
    return check_views(
        settings, image, isovalues, (camera,), size=_odd(settings.size), grazing=_SINGULAR
    )


def _odd(size: tuple[int, int]) -> tuple[int, int]:
    """Make a size odd, so that a pixel is in its middle."""
    width, height = (n // 2 * 2 + 1 for n in size)
    return width, height


def _touching(settings: Settings) -> Outcome:
    """Cast rays that touch the surface in one point without crossing it."""
    camera = parallel(looking((-16, -16, 4), (4, 4, 4), (0, 0, 1)), 1.5)
    image = compressed(-_product(4.0, (0, 1)))
    return check_views(
        settings, image, (0.0, -1e-9, 1e-9), (camera,), size=_odd(settings.size), grazing=_SINGULAR
    )


def _square(settings: Settings) -> Outcome:
    """Cast rays in planes of constant z: a cell's cubic has no term of third order."""
    camera = parallel(looking((-30, -20, 8), (8, 9, 8), (0, 0, 1)), 9)
    return check_depths(settings, compressed(noise((17, 19, 17), 8)), 0.3, camera, grazing=_NOISE)


def _line(settings: Settings) -> Outcome:
    """Cast rays along an axis: the interpolant is linear in every cell."""
    cameras = []
    for axis in range(3):
        position = np.full(3, 8.0)
        position[axis] = -30
        cameras.append(parallel(looking(position, (8, 8, 8), np.roll([0, 1, 0], axis)), 9))
    return check_views(settings, compressed(noise((17,) * 3, 9)), (0.3,), cameras, grazing=_NOISE)


def _extruded(seed: int = 10) -> np.ndarray:
    """Make noise in y and z that does not change along x."""
    return np.repeat(noise((17, 17, 1), seed), 17, axis=2)


def _constant(settings: Settings) -> Outcome:
    """Cast rays along which nothing changes: none of them crosses a surface."""
    camera = parallel(looking((-30, 8, 8), (8, 8, 8), (0, 0, 1)), 9)
    return check_depths(settings, compressed(_extruded()), 0.3, camera, hits=False)


def _nearly_constant(settings: Settings) -> Outcome:
    """Cast rays along which next to nothing changes."""
    camera = parallel(looking((-30, 8.4, 8.28), (8, 8, 8), (0, 0, 1)), 9)
    return check_depths(settings, compressed(_extruded()), 0.3, camera, grazing=_NOISE)


def _zero(settings: Settings) -> Outcome:
    """Render cells of zeros at isovalue zero: they are inside, the surface lies at their rim."""
    values = np.minimum(np.round(4 * blobs((24, 20, 28), 11)), 0)
    image = compressed(values.astype(np.float32))
    return check_views(settings, image, (0.0,), grazing=1.0)


_NOISE = tolerances.GRAZING_FRACTION_NOISE
_SINGULAR = tolerances.GRAZING_FRACTION_SINGULAR

CASES = (
    Case("plain: smooth field", _reference),
    Case("shock front, slope 1 per voxel", partial(_front, 1.0, 1.0), quick=False),
    Case("shock front, one voxel wide, slope 1e6 per voxel", partial(_front, 1e6, 1e6)),
    Case("shock front, tanh(1e6 d)", partial(_front, 1e6, 1.0)),
    Case("step from 0 to 1", _step, quick=False),
    Case("gradients from 1e-12 to 1e12 in one volume", _gradients),
    Case("gradient 1e-12", partial(_scaled, 1e-12), quick=False),
    Case("gradient 1e12", partial(_scaled, 1e12), quick=False),
    Case("values within 3 ulps of the isovalue", _plateau),
    Case("plateau, 1e-6 below the isovalue", _flat_plateau),
    Case("checkerboard at Nyquist", _checkerboard),
    Case("white noise", partial(_noise, False)),
    Case("white noise, pass by pass", partial(_noise, True), quick=False),
    Case("shell of a tenth of a voxel", _thin_shell),
    Case("sheet of one layer of samples", _sheet, quick=False),
    Case("saddle cells", _saddles),
    Case("double root along the rays", partial(_root_of_order, 2)),
    Case("triple root along the rays", partial(_root_of_order, 3)),
    Case("rays that touch in one point", _touching),
    Case("cubic degenerates to a square", _square),
    Case("cubic degenerates to a line", _line),
    Case("cubic degenerates to a constant", _constant),
    Case("cubic nearly constant", _nearly_constant),
    Case("cubic identically zero", _zero),
)
