"""Look for rays that slip through where one level of detail goes over to the next.

Two fields are known in every level. Levels of a ramp are the same ramp, so that its plane is where
it is. Those of distances from a large sphere have a surface beside the sphere by no more than the
second derivative has the interpolant cut corners. So every ray that comes from one side of such a
surface and gets well to the other must hit, and near it, whatever the levels: the pictures have
their centre where two levels meet.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from ..camera import Camera
from ..compression import describe
from ..measure import tolerances
from ..oracle import caster, levels
from .case import Case, Outcome, Settings
from .cracks import CLIPPING_INSIDE, DIVISIONS, least_budget
from .levels import with_levels
from .scene import Picture, looking, parallel

#: Images of a kind, four of each volume.
_IMAGES = 24
_LOOKS = 4

#: Part of all rays that each kind gets.
_SHARE = 8

#: What samples at 32 bits and coordinates in single precision may move a surface by, in voxels of
#: the level.
_ROUNDING = 1e-4

#: How far a level's surface lies beside a sphere at most, in the level's voxels, times its radius
#: in them: a trilinear interpolant is off by an eighth of a second derivative along each axis.
_CORNERS = 3 / 8


@dataclass(frozen=True)
class Surface:
    """Tells how far places are beside a plane or a sphere.

    Attributes
    ----------
    place : numpy.ndarray
        On the plane, or the sphere's centre.
    normal : numpy.ndarray
        Of the plane, of unit length; it points inwards.
    radius : float
        Infinite of a plane.
    """

    place: np.ndarray
    normal: np.ndarray
    radius: float = np.inf

    def depth_of(self, points: np.ndarray) -> np.ndarray:
        """Return how deep points [..., 3] are inside, in voxels; negative outside."""
        offset = points - self.place
        if np.isinf(self.radius):
            return offset @ self.normal
        return self.radius - np.linalg.norm(offset, axis=-1)

    def values(self, shape: tuple[int, ...]) -> np.ndarray:
        """Sample the depths [z, y, x]."""
        points = np.moveaxis(np.indices(shape, dtype=float)[::-1], 0, -1)
        return self.depth_of(points).astype(np.float32)

    def margin(self, apart: np.ndarray) -> np.ndarray:
        """Return how far the surface of a level may lie beside, its samples so far `apart`."""
        return _ROUNDING * apart + _CORNERS * apart**2 / self.radius


def random_surface(kind: str, shape: tuple[int, ...], rng: np.random.Generator) -> Surface:
    """Draw a ``plane`` through the middle of a volume, or a ``sphere`` of 40 to 400 voxels."""
    middle = (np.array(shape[::-1]) - 1) / 2 + rng.uniform(-10, 10, 3)
    normal = _direction(rng)
    if kind == "plane":
        return Surface(middle, normal)
    radius = float(40 * 10 ** rng.uniform())
    return Surface(middle + radius * normal, normal, radius)


def _direction(rng: np.random.Generator) -> np.ndarray:
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


# ---- judging


def judge_rays(
    depth: np.ndarray,
    surface: Surface,
    shape: tuple[int, ...],
    eye: caster.Camera,
    clip: tuple[float, float],
    tolerance: float,
    coarsest: float,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Find the rays that go wrong.

    Parameters
    ----------
    depth : numpy.ndarray, shape (height, width)
    surface : Surface
    shape : tuple of int
        Of the volume, whose spacing is 1.
    eye : progiso.oracle.caster.Camera
    clip : tuple of float
        Distances of the clipping planes.
    tolerance : float
        Pixels that samples may be apart.
    coarsest : float
        How far those of the coarsest level are.

    Returns
    -------
    wrong, judged : numpy.ndarray of bool, shape (height, width)
        Of the rays that must hit or must not, those that do otherwise; and those that hit where
        the surface is not.
    worst : float
        How far a hit is beside the surface, in parts of what is allowed.
    """
    origins, directions = eye.rays(depth.shape[::-1])
    across = directions @ eye.forward
    last = np.array(shape[::-1]) - 1
    enter, leave = caster.clip_to_box(
        origins.T, directions.T, clip[0] / across, clip[1] / across, np.zeros(3), last
    )
    meets = enter <= leave
    enter, leave = np.where(meets, enter, 0), np.where(meets, leave, 0)
    closest = np.clip(((surface.place - origins) * directions).sum(axis=1), enter, leave)
    first, middle, end = (
        surface.depth_of(origins + t[:, None] * directions) for t in (enter, closest, leave)
    )
    margin = 2 * surface.margin(np.array(coarsest))
    due = meets & (
        ((first < -margin) & (np.maximum(middle, end) > margin))
        | ((first > margin) & (end < -margin))
    )
    # the depth along a ray has its maximum nearest to a sphere's centre, its minima at the ends
    off = ~meets | (np.maximum.reduce([first, middle, end]) < -margin)
    off |= meets & (np.minimum(first, end) > margin)
    flat = depth.ravel()
    hit = np.isfinite(flat)
    reached = np.where(hit, flat, 0)
    beside = np.abs(surface.depth_of(origins + reached[:, None] * directions))
    apart = _distance_of_samples(reached * across, eye, depth.shape[0], tolerance, coarsest)
    allowed = surface.margin(apart) + tolerances.DEPTH_RELATIVE * reached
    share = np.where(hit, beside / allowed, 0.0)
    wrong = (due & ~hit) | (off & hit) | (share > 1)
    return wrong.reshape(depth.shape), (due | off | hit).reshape(depth.shape), float(share.max())


def _distance_of_samples(
    depth: np.ndarray, eye: caster.Camera, height: int, tolerance: float, coarsest: float
) -> np.ndarray:
    """Return how far samples are apart at depths across the view, of the coarser of two levels."""
    if eye.parallel_scale is not None:
        pixel = np.full(depth.shape, 2 * eye.parallel_scale / height)
    else:
        pixel = 2 * np.tan(np.radians(eye.view_angle) / 2) / height * depth
    with np.errstate(divide="ignore"):
        number = np.floor(np.log2(tolerance * pixel / levels.BLENDING * (1 + 1e-6)))
    return np.exp2(np.clip(number, 0, np.log2(coarsest)))


# ---- measuring


@dataclass
class _Count:
    """Counts what has been cast so far."""

    rays: int = 0
    wrong: int = 0
    images: int = 0
    slowest_ms: float = 0.0
    worst: float = 0.0
    first: str = ""


def count_slipped(kind: str, rays: int, seed: int = 0) -> Outcome:
    """Cast rays at surfaces that are known in all levels, and count those that go wrong.

    The ways to divide the work take turns. The images are as large as it takes to have about
    `_IMAGES` of them, at most 1024 pixels wide.

    Parameters
    ----------
    kind : str
        See `random_surface`.
    rays : int
        At least so many are judged.
    seed : int
        Of everything random.

    Returns
    -------
    case.Outcome
        In wrong rays; the note tells the first that went wrong, by all that it takes to repeat it.
    """
    start, count = perf_counter(), _Count()
    width = int(np.clip(np.sqrt(rays / _IMAGES), 32, 1024))
    for number, division in enumerate(itertools.cycle(DIVISIONS)):
        if count.rays >= rays:
            break
        rng = np.random.default_rng([seed, number])
        # a level that ends beyond the volume's last samples does not have the field there
        shape = tuple(map(int, 4 * rng.integers(20, 40, 3) + 1))
        surface = random_surface(kind, shape, rng)
        about = f"volume {number} of seed {seed}, {shape}, {division}"
        _look_around(surface, shape, (width, width), division, rng, about, count)
    seconds = perf_counter() - start
    note = (
        f"{count.images} images, {seconds:.1f} s in all; hits are beside the surface by up to "
        f"{count.worst:.0%} of what is allowed"
    )
    return Outcome(
        count.wrong,
        0,
        count.slowest_ms,
        f"of {count.rays} rays",
        "; ".join(filter(None, (note, count.first))),
    )


def _look_around(
    surface: Surface,
    shape: tuple[int, ...],
    size: tuple[int, int],
    division: tuple[dict[str, bool], float | None],
    rng: np.random.Generator,
    about: str,
    count: _Count,
) -> None:
    """Look at a volume from some places; add to the count."""
    arguments, share = division
    image = with_levels(surface.values(shape))
    coarsest = max(describe(image)["levels"][-1]["steps"])
    view = Picture(
        image,
        0.0,
        size,
        clip=CLIPPING_INSIDE,
        pixel_tolerance=1.0,
        cached=arguments.get("cached", False),
        speculation=arguments.get("speculation", True),
    )
    for _ in range(_LOOKS):
        camera, tolerance = _camera(surface, shape, size[1], coarsest, rng)
        view.mapper.SetPixelTolerance(tolerance)
        view.look(camera)
        if share is not None:
            view.mapper.SetMemoryBudget(int(share * least_budget(view)))
        count.slowest_ms = max(count.slowest_ms, view.render())
        eye, clip = view.rays()
        wrong, judged, worst = judge_rays(
            view.depth(), surface, shape, eye, clip, tolerance, coarsest
        )
        if wrong.any() and not count.first:
            row, column = np.argwhere(wrong)[0]
            count.first = (
                f"first wrong: row {row}, column {column}, {camera}, tolerance {tolerance}, {about}"
            )
        count.rays += int(judged.sum())
        count.wrong += int(wrong.sum())
        count.worst = max(count.worst, worst)
        count.images += 1
    view.close()


def _camera(
    surface: Surface,
    shape: tuple[int, ...],
    height: int,
    coarsest: int,
    rng: np.random.Generator,
) -> tuple[Camera, float]:
    """Look at a place on the surface in the volume, and have two levels meet there.

    Returns
    -------
    camera : progiso.Camera
        Inside the volume or outside, on either side of the surface; some are parallel.
    tolerance : float
        In pixels.
    """
    middle = (np.array(shape[::-1]) - 1) / 2
    target = middle + rng.uniform(-15, 15, 3)
    inwards = surface.normal if np.isinf(surface.radius) else surface.place - target
    target = target - surface.depth_of(target) * inwards / np.linalg.norm(inwards)
    direction = _direction(rng)
    distance = rng.uniform(20, 250)
    up = np.eye(3)[np.argmin(np.abs(direction))]
    camera = looking(target + distance * direction, target, up, rng.uniform(20, 110))
    seen = 2 * distance * np.tan(np.radians(camera.view_angle) / 2)
    if rng.integers(4) == 0:
        camera = parallel(camera, seen / 2)
    # where a level ends, or where it begins to go over to the next
    apart = 2.0 ** rng.integers(1, np.log2(coarsest) + 1) * levels.BLENDING ** rng.integers(2)
    return camera, float(np.clip(apart * height / seen, 1 / 16, 64))


def _case(kind: str, settings: Settings) -> Outcome:
    return count_slipped(kind, settings.rays // _SHARE)


CASES = (
    Case("levels: no crack in a plane", partial(_case, "plane")),
    Case("levels: no crack in a sphere", partial(_case, "sphere")),
)
