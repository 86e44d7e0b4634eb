"""Where volumes lie, how large they are, and from where they are seen: scales, shapes, cameras."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ..camera import orbit_camera
from . import tolerances
from .case import Case, worst_of
from .fields import blobs, coordinates, noise
from .scene import check_depths, check_views, compressed, looking, parallel

_SHAPE, _ISOVALUE = (30, 27, 33), 0.1
_NOISE = tolerances.GRAZING_FRACTION_NOISE

_TURNED = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]
_SHEARED = np.array([[1, 0.4, 0], [0, 1, 0.2], [0.1, 0, 1]])
_MIRRORED = np.diag([-1.0, 1, 1])


def _around(image):
    """Cameras about an image, or where it is long, about its middle; one in parallel projection."""
    low, high = np.array(image.GetBounds()).reshape(3, 2).T
    reach = np.full(3, np.median(high - low) / 2)
    bounds = np.stack([(low + high) / 2 - reach, (low + high) / 2 + reach]).T.ravel()
    cameras = [orbit_camera(bounds, i, 4) for i in (1, 2, 3)]
    return [*cameras[:2], parallel(cameras[2], 1.5 * reach[0])]


def _placed(settings, shape=_SHAPE, **geometry):
    """A smooth field that lies somewhere."""
    image = compressed(blobs(shape, 7), **geometry)
    return check_views(settings, image, (_ISOVALUE,), _around(image))


def _user(matrix, settings):
    """The prop's matrix on top of the image's own axes."""
    user = np.eye(4)
    user[:3, :3], user[:3, 3] = matrix, (3, -20, 8)
    geometry = {"direction": _TURNED, "spacing": (1, 1.5, 0.8), "origin": (1, 2, 3)}
    return check_depths(settings, compressed(blobs(_SHAPE, 8), **geometry), _ISOVALUE, user=user)


# --- sizes -----------------------------------------------------------------------------------------


def _small(shape, settings):
    image = compressed(noise(shape, 11))
    return check_views(settings, image, (_ISOVALUE,), _around(image), grazing=_NOISE)


def _long(axis, settings):
    """65536 samples along an axis, 2 and 3 along the others, seen along it from an end and from amid."""
    shape = [2, 3]
    shape.insert(2 - axis, 65536)
    image = compressed(noise(tuple(shape), 12))
    unit, size = np.eye(3)[axis], np.array(shape[::-1]) - 1
    cameras = []
    for start in (-3.0, 40000.3, 65500.0):
        focus = size / 2 * (1 - unit) + (start + 20) * unit
        eye = focus + 0.02 * np.roll(unit, 1) - 20 * unit + 0.9 * np.roll(unit, 2)
        cameras.append(looking(eye, focus, np.roll(unit, 1), 40))
    return check_views(settings, image, (0.5,), cameras, grazing=_NOISE, clip=(0.01, 1e5))


# --- cameras ---------------------------------------------------------------------------------------


def _from(position, settings, **options):
    """A camera at a position of the volume's, which looks across it; one wide, one narrow."""
    image = compressed(blobs(_SHAPE, 7))
    target = np.array(_SHAPE[::-1]) * (0.31, 0.57, 0.42)
    cameras = [looking(position, target, view_angle=angle) for angle in (30, 100)]
    options = {"clip": (1e-3, 1e3), **options}
    return check_views(settings, image, (_ISOVALUE, -0.2), cameras, **options)


def _angle(degrees, settings):
    """As far away as it takes to see the volume, not nearer than its middle."""
    image = compressed(blobs(_SHAPE, 7))
    orbit = orbit_camera(image, 1, 4)
    centre = np.array(orbit.focal_point)
    away = (np.array(orbit.position) - centre) / np.linalg.norm(orbit.position - centre)
    reach = 15 / np.tan(np.radians(degrees / 2))
    camera = replace(orbit, position=tuple(centre + reach * away), view_angle=degrees)
    clip = (max(0.01, reach - 60), reach + 60)
    return check_depths(settings, image, _ISOVALUE, camera, clip=clip)


def _along_axes(settings):
    """Rays along the axes, the central ones through corners of cells and every other within faces."""
    image = compressed(blobs((25, 25, 25), 6))
    cameras = []
    for axis in range(3):
        for sign in (-1, 1):
            eye = np.full(3, 12.0) + sign * 50 * np.eye(3)[axis]
            camera = looking(eye, (12, 12, 12), np.roll([0, 1, 0], axis), 40)
            cameras += [camera, parallel(camera, 12.25), parallel(camera, 11.5)]
    return check_views(settings, image, (0.05,), cameras, size=(49, 49), grazing=1 / 8)


def _along_diagonals(settings):
    """Parallel rays along the diagonals of faces and of cells, through edges and corners."""
    image = compressed(blobs((25, 25, 25), 6))
    cameras = []
    for away in ((1, 1, 0), (-1, 0, 1), (0, 1, -1), (1, 1, 1), (-1, 1, -1), (1, -1, -1)):
        eye = np.full(3, 12.0) + 40 * np.array(away)
        up = np.eye(3)[int(np.argmin(np.abs(away)))] if 0 in away else np.array([1, -away[0] * away[1], 0])
        cameras.append(parallel(looking(eye, (12, 12, 12), up), 12.25))
    return check_views(settings, image, (0.05,), cameras, size=(49, 49), grazing=1 / 8)


def _clipped(settings):
    """Near and far planes through the surface; both, a voxel apart."""
    image = compressed(blobs(_SHAPE, 7))
    camera = orbit_camera(image, 1, 4)
    distance = float(np.linalg.norm(np.subtract(camera.position, camera.focal_point)))
    for clip in ((distance, distance + 50), (1.0, distance), (distance - 0.5, distance + 0.5)):
        yield check_depths(settings, image, _ISOVALUE, camera, clip=clip)


def _one_voxel(settings):
    """A voxel fills the screen: from nearby, from afar by a narrow view, and in parallel projection."""
    values = blobs(_SHAPE, 7)
    image = compressed(values)
    at = _surface_near(values, np.array(_SHAPE[::-1]) / 2)
    away = np.array([0.48, -0.6, 0.64])
    near = looking(at + 1.5 * away, at, view_angle=30)
    far = looking(at + 2000 * away, at, view_angle=0.02)
    for camera, clip in ((near, (0.01, 100)), (far, (1900, 2100)), (parallel(near, 0.4), (0.01, 100))):
        yield check_depths(settings, image, _ISOVALUE, camera, clip=clip)


def _surface_near(values, point):
    """A place on the surface, on an edge of the grid, near a point."""
    x, y, z = coordinates(values.shape)
    inside = values >= _ISOVALUE
    edge = inside[:, :, :-1] & ~inside[:, :, 1:]
    off = sum((c[:, :, :-1] - p) ** 2 for c, p in zip((x, y, z), point))
    k, j, i = np.unravel_index(np.argmin(np.where(edge, off, np.inf)), edge.shape)
    a, b = values[k, j, i], values[k, j, i + 1]
    return np.array([i + (a - _ISOVALUE) / (a - b), j, k], float)


# --- images ----------------------------------------------------------------------------------------


def _image(size, settings):
    image = compressed(blobs(_SHAPE, 7))
    return check_views(settings, image, (_ISOVALUE,), _around(image), size=size)


def _largest_image(settings):
    """Judged at 40000 of its pixels: the caster would take minutes for all."""
    image = compressed(blobs(_SHAPE, 7))
    settings = replace(settings, repeat=1)
    return check_depths(settings, image, _ISOVALUE, size=(8192, 8192), sample=40_000)


def _worst(views, settings):
    return worst_of(views(settings))


CASES = (
    *(
        Case(f"spacing {x:g}, {y:g}, {z:g}", partial(_placed, spacing=(x, y, z)), y == 1000)
        for x, y, z in ((1, 1000, 1), (0.001, 1, 1), (1, 1, 0.001), (0.01, 10, 1), (1000, 1, 0.001))
    ),
    Case("origin 1e6, spacing 1e-3", partial(_placed, origin=(1e6, -1e6, 1e6), spacing=(1e-3,) * 3)),
    Case("scale 1e-9", partial(_placed, spacing=(1e-9,) * 3)),
    Case("scale 1e9", partial(_placed, spacing=(1e9,) * 3)),
    Case("direction matrix: turned", partial(_placed, direction=_TURNED, spacing=(1, 0.7, 1.3)), False),
    Case("direction matrix: sheared", partial(_placed, direction=_SHEARED, spacing=(1, 0.7, 1.3))),
    Case("direction matrix: mirrored", partial(_placed, direction=_MIRRORED, origin=(5, -6, 7))),
    Case("extent that begins at -7, 20, 3", partial(_placed, extent_start=(-7, 20, 3)), False),
    Case("samples of cells", partial(_placed, cells=True, spacing=(1, 0.5, 2)), False),
    Case("prop's matrix: turned, scaled 1, 2, 0.5", partial(_user, _TURNED @ np.diag([1, 2, 0.5])), False),
    Case("prop's matrix: sheared", partial(_user, _SHEARED)),
    Case("prop's matrix: mirrored", partial(_user, _MIRRORED), False),
    *(
        Case(f"{x}x{y}x{z} samples", partial(_small, (z, y, x)), (x, y, z) in ((2, 2, 2), (5, 6, 7)))
        for x, y, z in ((2, 2, 2), (3, 2, 5), (4, 4, 4), (5, 6, 7), (17, 13, 9), (2, 3, 65))
    ),
    *(Case(f"65536 samples along {'xyz'[i]}", partial(_long, i), i == 2) for i in range(3)),
    Case("camera inside", partial(_from, (13.3, 12.1, 17.7))),
    Case("camera on a face of the volume", partial(_from, (0.0, 11.3, 13.1))),
    Case("camera on a corner of the volume", partial(_from, (0.0, 0.0, 0.0)), False),
    Case("camera on a plane of voxels", partial(_from, (16.0, 9.3, 11.7))),
    Case("camera on a voxel, in the corner of a block", partial(_from, (16.0, 12.0, 8.0))),
    Case("rays along the axes, within faces, through edges", _along_axes),
    Case("rays along the diagonals, through edges and corners", _along_diagonals),
    *(
        Case(f"view angle {degrees:g}°", partial(_angle, degrees), degrees in (0.01, 170))
        for degrees in (0.01, 1, 90, 170)
    ),
    Case("near and far planes through the surface", partial(_worst, _clipped)),
    Case("one voxel fills the screen", partial(_worst, _one_voxel)),
    Case("image of 1x1 pixels", partial(_image, (1, 1))),
    Case("image of 1x480 pixels", partial(_image, (1, 480)), False),
    Case("image of 8192x8192 pixels", _largest_image, False),
)
