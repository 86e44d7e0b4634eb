"""Check volumes, cameras and images of extreme shape, place and size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..camera import Camera, orbit_camera
from ..measure import tolerances
from ..oracle import caster
from .case import Case, Outcome, Settings
from .fields import blobs, noise
from .scene import check_depths, check_views, compressed, decoded, looking, parallel

_SHAPE = (28, 25, 31)
_CENTRE = np.array([15.0, 12.0, 13.5])
_ISOVALUE = 0.1
_NOISE = tolerances.GRAZING_FRACTION_NOISE
_ROTATION = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]


def _field(**geometry: Any) -> vtkImageData:
    return compressed(blobs(_SHAPE, 7), **geometry)


def _placed(settings: Settings, user: np.ndarray | None = None, **geometry: Any) -> Outcome:
    """Look in perspective and in parallel projection, from a side of the orbit each."""
    image = _field(**geometry)
    bounds = image.GetBounds()
    if user is not None:
        corners = np.array(np.meshgrid(bounds[:2], bounds[2:4], bounds[4:])).reshape(3, -1)
        world = user[:3, :3] @ corners + user[:3, 3:]
        bounds = tuple(np.stack([world.min(axis=1), world.max(axis=1)], axis=1).ravel())
    first, second = (orbit_camera(bounds, i, 3) for i in (0, 1))
    reach = np.linalg.norm(np.subtract(second.position, second.focal_point))
    cameras = first, parallel(second, float(reach / 3))
    return check_views(settings, image, (_ISOVALUE,), cameras, user=user)


def _stretched(spacing: tuple[float, float, float], settings: Settings) -> Outcome:
    """Look at beams and plates, from as near as their middle side asks for."""
    image = _field(spacing=spacing)
    low, high = np.array(image.GetBounds()).reshape(3, 2).T
    reach = np.full(3, np.median(high - low) / 2)
    bounds = np.stack([(low + high) / 2 - reach, (low + high) / 2 + reach], axis=1).ravel()
    first, second, third = (orbit_camera(bounds, i, 4) for i in (1, 2, 3))
    cameras = first, second, parallel(third, 1.5 * reach[0])
    return check_views(settings, image, (_ISOVALUE,), cameras)


def _matrix(linear: np.ndarray | Sequence[Sequence[float]]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = 3, -20, 8
    return matrix


def _shape(shape: tuple[int, ...], settings: Settings) -> Outcome:
    image = compressed(noise(shape, 11))
    cameras = [orbit_camera(image, i, 3) for i in range(2)]
    return check_views(settings, image, (0.1,), cameras, grazing=_NOISE)


def _long(axis: int, settings: Settings) -> Outcome:
    """Look at 65536 samples along an axis, from beside its far end."""
    values = np.moveaxis(noise((5, 6, 65536), 12), 2, 2 - axis)
    centre = np.roll([65500.0, 2.5, 2.0], axis)
    aside = np.roll([-9.0, 20.0, 14.0], axis)
    camera = looking(centre + aside, centre, np.roll([0.0, 0.0, 1.0], axis), 40)
    return check_depths(settings, compressed(values), 0.2, camera, grazing=_NOISE)


def _along_a_long_one(settings: Settings) -> Outcome:
    """Cast rays that go 65000 voxels before they hit."""
    values = np.zeros((4, 4, 65536), np.float32)
    values[..., 65000:] = 0.3 + noise((4, 4, 536), 13) / 10
    camera = looking((-10, 1.4, 1.6), (65000, 1.5, 1.5), (0, 0, 1), 0.003)
    return check_depths(settings, compressed(values), 0.2, camera, size=(24, 18), grazing=_NOISE)


# --- cameras --------------------------------------------------------------------------------------


def _from(
    position: Sequence[float],
    settings: Settings,
    towards: Sequence[float] = (0.3, 0.5, -0.2),
    angle: float = 70.0,
) -> Outcome:
    """Look from a place in the volume or at its border."""
    camera = looking(position, np.add(position, towards), (0.1, 0.2, 1), angle)
    return check_depths(settings, _field(), _ISOVALUE, camera)


def _along_axes(settings: Settings) -> Outcome:
    """Cast parallel rays along an axis, every other one in a plane of voxels."""
    image = compressed(blobs((25, 25, 25), 6))
    cameras = []
    for axis in range(3):
        position = np.full(3, 12.0)
        position[axis] += 50
        camera = looking(position, (12, 12, 12), np.roll([0, 1, 0], axis))
        cameras += [parallel(camera, 12.0), parallel(camera, 12.25)]
    # along the volume's border rays graze it
    return check_views(settings, image, (0.05,), cameras, size=(49, 49), grazing=1 / 8)


def _through_corners(settings: Settings) -> Outcome:
    """Cast rays that stay in faces, edges or corners of cells."""
    image = compressed(blobs((17, 17, 17), 6))
    cameras = [
        parallel(looking(position, (8, 8, 8)), scale)
        for position, scale in (((48, 8, 48), 8.25), ((48, 48, 48), 12.0), ((48, 48, 8), 8.25))
    ]
    return check_views(settings, image, (0.05,), cameras, size=(33, 33), grazing=1 / 8)


def _angle(degrees: float, settings: Settings) -> Outcome:
    """Look at this view angle, from where the volume fills it or two voxels beside its centre."""
    distance = 16 / np.tan(np.radians(degrees) / 2)
    towards = np.array([0.5, 0.7, 0.3])
    position = _CENTRE + max(distance, 2.0) * towards / np.linalg.norm(towards)
    camera = looking(position, _CENTRE, (0, 0, 1), degrees)
    return check_depths(settings, _field(), _ISOVALUE, camera)


def _clipped(settings: Settings) -> Outcome:
    """Cut through the surface by the near and the far plane."""
    image = _field()
    camera = orbit_camera(image, 1, 4)
    distance = float(np.linalg.norm(np.subtract(camera.position, camera.focal_point)))
    return check_depths(settings, image, _ISOVALUE, camera, clip=(distance - 4.0, distance + 3.0))


def _zoomed(scale: float, settings: Settings) -> Outcome:
    """Fill the image with a cell that the surface crosses, and with less of it."""
    image = _field()
    camera = orbit_camera(image, 1, 4)
    first = _place(image, camera)
    offset = np.subtract(camera.position, camera.focal_point)
    near = replace(camera, focal_point=tuple(first), position=tuple(first + offset))
    angle = 2 * np.degrees(np.arctan(scale / np.linalg.norm(offset)))
    cameras = replace(near, view_angle=float(angle)), parallel(near, scale)
    return check_views(settings, image, (_ISOVALUE,), cameras)


def _place(image: vtkImageData, camera: Camera) -> np.ndarray:
    """Find where the ray to a camera's focal point, or one beside it, meets the surface."""
    eye = caster.Camera(camera.position, camera.focal_point, camera.view_up, camera.view_angle)
    found = caster.cast(decoded(image), _ISOVALUE, eye, (9, 9))
    origins, directions = eye.rays((9, 9))
    at = np.flatnonzero(np.isfinite(found.depth))[0]
    return origins[at] + found.depth.flat[at] * directions[at]


def _image(size: tuple[int, int], settings: Settings) -> Outcome:
    return check_depths(settings, _field(), _ISOVALUE, size=size)


def _large_image(settings: Settings) -> Outcome:
    """Render one image of 67 million rays, of which the caster casts some."""
    once = replace(settings, repeat=0)
    return check_depths(once, _field(), _ISOVALUE, size=(8192, 8192), sample=20_000)


CASES = (
    Case("spacing 1 to 1000", partial(_placed, spacing=(0.01, 10, 1))),
    *(
        Case(f"spacing {x:g}, {y:g}, {z:g}", partial(_stretched, (x, y, z)), quick=False)
        for x, y, z in ((1, 1000, 1), (0.001, 1, 1), (1, 1, 0.001), (1000, 1, 0.001))
    ),
    Case(
        "origin 1e6, spacing 1e-3", partial(_placed, origin=(1e6, -1e6, 1e6), spacing=(1e-3,) * 3)
    ),
    Case("scale 1e-9", partial(_placed, spacing=(1e-9,) * 3)),
    Case("scale 1e9", partial(_placed, spacing=(1e9,) * 3)),
    Case(
        "rotated direction",
        partial(_placed, direction=_ROTATION, spacing=(1, 0.7, 1.3), origin=(5, -6, 7)),
        quick=False,
    ),
    Case("mirrored direction", partial(_placed, direction=np.diag([-1.0, 1, 1]))),
    Case(
        "sheared direction",
        partial(_placed, direction=[[1, 0.4, 0], [0, 1, 0.2], [0.1, 0, 1]], spacing=(1, 0.7, 1.3)),
    ),
    Case(
        "sheared by the prop's matrix",
        partial(
            _placed, user=_matrix([[1, 0.4, 0], [0, 1, 0.2], [0.1, 0, 1.5]]), spacing=(1, 2, 1)
        ),
    ),
    Case(
        "mirrored by the prop's matrix",
        partial(_placed, user=_matrix(np.diag([1, 1, -1.0]))),
        False,
    ),
    Case("cells, not points", partial(_placed, cells=True, spacing=(1, 0.5, 2)), quick=False),
    Case("2 x 2 x 2 samples", partial(_shape, (2, 2, 2))),
    Case("5 x 7 x 9 samples", partial(_shape, (9, 7, 5)), quick=False),
    Case("2 x 9 x 33 samples", partial(_shape, (33, 9, 2)), quick=False),
    *(
        Case(f"65536 samples along {name}, from beside", partial(_long, axis), quick=False)
        for axis, name in enumerate("xyz")
    ),
    Case("65536 samples along x, from end to end", _along_a_long_one, quick=False),
    Case("camera inside", partial(_from, (14.3, 11.2, 13.7))),
    Case("camera on a plane of voxels", partial(_from, (14.3, 11.2, 14.0)), quick=False),
    Case("camera on a voxel", partial(_from, (15.0, 12.0, 14.0))),
    Case(
        "camera on a face of the volume", partial(_from, (0.0, 12.4, 13.7), towards=(1, 0.1, 0.2))
    ),
    Case(
        "camera on a corner of the volume",
        partial(_from, (0.0, 0.0, 0.0), towards=(1, 1, 1)),
        False,
    ),
    Case("rays along the axes, on planes of voxels", _along_axes),
    Case("rays through corners and edges of cells", _through_corners),
    Case("view angle 0.01 degrees", partial(_angle, 0.01)),
    Case("view angle 1 degree", partial(_angle, 1.0), quick=False),
    Case("view angle 170 degrees", partial(_angle, 170.0)),
    Case("near and far plane through the surface", _clipped),
    Case("zoom: a voxel fills the image", partial(_zoomed, 0.5)),
    Case("zoom: a millionth of a voxel fills the image", partial(_zoomed, 0.5e-6)),
    Case("image of 1 x 1", partial(_image, (1, 1))),
    Case("image of 1 x 999", partial(_image, (1, 999)), quick=False),
    Case("image of 8192 x 8192", _large_image, quick=False),
)
