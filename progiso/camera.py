"""Cameras as plain values, and the orbit that benchmarks and verification use."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import KW_ONLY, asdict, dataclass
from itertools import product
from typing import Any, Protocol

from vtkmodules.vtkRenderingCore import vtkCamera

from ._typing import Vector

_Vector3 = tuple[float, float, float]


class _HasBounds(Protocol):
    """An image, a mesh or a prop."""

    def GetBounds(self) -> Sequence[float]: ...


@dataclass(frozen=True)
class Camera:
    """A camera in world coordinates.

    Parameters
    ----------
    position, focal_point, view_up : tuple of float
        As in `vtkCamera`. `view_up` must not be parallel to the view direction.
    view_angle : float, default: 30
        Vertical opening of a perspective view in degrees, in (0, 180).
    parallel : bool, default: False
        Parallel instead of perspective projection.
    parallel_scale : float, default: 1
        Half the height of a parallel view in world units.

    Examples
    --------
    >>> Camera((0, 0, 10), (0, 0, 0), (0, 1, 0)).parallel
    False
    """

    position: tuple[float, ...]
    focal_point: tuple[float, ...]
    view_up: tuple[float, ...]
    _: KW_ONLY
    view_angle: float = 30.0
    parallel: bool = False
    parallel_scale: float = 1.0

    @classmethod
    def from_vtk(cls, camera: vtkCamera) -> Camera:
        """Copy a `vtkCamera`.

        Returns
        -------
        Camera
        """
        return cls(
            camera.GetPosition(),
            camera.GetFocalPoint(),
            camera.GetViewUp(),
            view_angle=camera.GetViewAngle(),
            parallel=bool(camera.GetParallelProjection()),
            parallel_scale=camera.GetParallelScale(),
        )

    def apply(self, camera: vtkCamera) -> None:
        """Set a `vtkCamera` to this one; its clipping range is left to the renderer."""
        camera.SetPosition(self.position)
        camera.SetFocalPoint(self.focal_point)
        camera.SetViewUp(self.view_up)
        camera.SetViewAngle(self.view_angle)
        camera.SetParallelProjection(self.parallel)
        camera.SetParallelScale(self.parallel_scale)

    def to_dict(self) -> dict[str, Any]:
        """Return the camera as JSON-ready values; `parallel_scale` only of a parallel view.

        Returns
        -------
        dict
        """
        values = {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(self).items()}
        if not self.parallel:
            del values["parallel_scale"]
        return values


def orbit_camera(target: _HasBounds | Vector, i: int, n: int) -> Camera:
    """Return camera `i` of an orbit of `n` around a volume.

    The positions lie on a Fibonacci sphere about the centre of the volume's axis-aligned bounds,
    its radius 1.5 times the largest side of these bounds: y = (2i/n − 1) + 1/n, r = √(1 − y²),
    φ = iπ(3 − √5), direction (r cos φ, y, r sin φ). The view angle is 50°, the focal point the
    centre, and up is (0, 1, 0). As |y| ≤ 1 − 1/n, up is never parallel to the view.

    Parameters
    ----------
    target : vtkmodules.vtkCommonDataModel.vtkImageData, vtkProp, or sequence of 6 float
        What has bounds, or the bounds (xmin, xmax, ymin, ymax, zmin, zmax) in world units.
    i : int
        Position, from 0 to n − 1.
    n : int
        Number of positions, at least 1.

    Returns
    -------
    Camera

    Raises
    ------
    ValueError
        When `i` or `n` is out of range or the bounds are empty.

    Examples
    --------
    >>> orbit_camera((0, 2, 0, 2, 0, 2), 0, 1)
    Camera(position=(4.0, 1.0, 1.0), focal_point=(1.0, 1.0, 1.0), view_up=(0.0, 1.0, 0.0), \
view_angle=50.0, parallel=False, parallel_scale=1.0)
    """
    if n < 1 or not 0 <= i < n:
        raise ValueError(f"orbit position {i}/{n}: it takes 0 ≤ I < N")
    centre, sides = _centre_and_sides(target)
    radius = 1.5 * max(sides)
    y = (2 * i / n - 1) + 1 / n
    r = math.sqrt(1 - y * y)
    phi = i * math.pi * (3 - math.sqrt(5))
    direction = (r * math.cos(phi), y, r * math.sin(phi))
    position = _vector(c + radius * d for c, d in zip(centre, direction))
    return Camera(position, centre, (0.0, 1.0, 0.0), view_angle=50.0)


def view_camera(
    target: _HasBounds | Vector,
    *,
    direction: Vector = (0.45, 1.0, 0.3),
    view_up: Vector = (0.0, 0.0, 1.0),
    parallel: bool = False,
    aspect: float = 1.0,
    zoom: float = 1.0,
) -> Camera:
    """Return a camera that looks at a volume's centre and just fits its bounds into the picture.

    Parameters
    ----------
    target : vtkmodules.vtkCommonDataModel.vtkImageData, vtkProp, or sequence of 6 float
        What has bounds, or the bounds, in world units.
    direction : sequence of 3 float, default: (0.45, 1, 0.3)
        From the volume's centre to the camera; any length. The default is a little above and to
        the side of +y, where the faces of the catalogue's scans look.
    view_up : sequence of 3 float, default: (0, 0, 1)
        What is up in the picture; not parallel to `direction`.
    parallel : bool, default: False
        Parallel projection instead of perspective with a view angle of 30°.
    aspect : float, default: 1
        Width over height of the picture.
    zoom : float, default: 1
        Magnification, above 0; more than 1 may cut off the volume's corners.

    Returns
    -------
    Camera

    Raises
    ------
    ValueError
        When the directions are zero or parallel, the bounds are empty, or `zoom` is not positive.

    Examples
    --------
    >>> view_camera((-1, 1, -1, 1, -1, 1), direction=(1, 0, 0)).focal_point
    (0.0, 0.0, 0.0)
    """
    if not zoom > 0:
        raise ValueError(f"zoom must be above 0, got {zoom}")
    centre, sides = _centre_and_sides(target)
    right, up, forward = _basis(direction, view_up)
    corners = [[s * e / 2 for s, e in zip(sides, signs)] for signs in product((-1, 1), repeat=3)]
    # Half heights that corners need in the picture, and how far they stand out to the camera.
    heights = [max(abs(_dot(c, up)), abs(_dot(c, right)) / aspect) / zoom for c in corners]
    slope = math.tan(math.radians(15))
    distance = max(_dot(c, forward) + h / slope for c, h in zip(corners, heights))
    position = _vector(c + distance * f for c, f in zip(centre, forward))
    return Camera(
        position,
        centre,
        _vector(view_up),
        view_angle=30.0,
        parallel=parallel,
        parallel_scale=max(heights),
    )


def _vector(numbers: Iterable[float]) -> _Vector3:
    x, y, z = map(float, numbers)
    return x, y, z


def _centre_and_sides(target: _HasBounds | Vector) -> tuple[_Vector3, _Vector3]:
    """Return the centre and the side lengths of bounds, or of what has bounds."""
    bounds = target.GetBounds() if hasattr(target, "GetBounds") else target
    if len(bounds) != 6:
        raise ValueError(f"bounds are six numbers, got {len(bounds)}")
    low, high = bounds[0::2], bounds[1::2]
    sides = _vector(b - a for a, b in zip(low, high))
    if not all(math.isfinite(side) for side in sides) or min(sides) < 0 or max(sides) == 0:
        raise ValueError(f"the bounds {tuple(bounds)} are empty")
    return _vector(float(a + b) / 2 for a, b in zip(low, high)), sides


def _basis(direction: Vector, view_up: Vector) -> tuple[_Vector3, _Vector3, _Vector3]:
    """Return the unit vectors to the right, up and towards the camera."""
    right = _cross(view_up, direction)
    lengths = math.hypot(*direction) * math.hypot(*view_up)
    if not lengths > 0 or not math.hypot(*right) > 1e-6 * lengths:
        raise ValueError(
            f"the view direction {direction} and up {view_up} must not be parallel or zero"
        )
    forward, right = _unit(direction), _unit(right)
    return right, _cross(forward, right), forward


def _dot(a: Vector, b: Vector) -> float:
    return sum(x * y for x, y in zip(a, b))


def _cross(a: Vector, b: Vector) -> _Vector3:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(a: Vector) -> _Vector3:
    length = math.hypot(*a)
    return _vector(x / length for x in a)
