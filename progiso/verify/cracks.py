"""Look for rays that slip through closed surfaces, by fields where every hit is known.

A random field has a *core*, a box whose samples are all at least the isovalue, and around it a
closed skin of samples that are all below. Between them the trilinear surface has no hole. So a
camera in the core must see a surface at every pixel; one outside must see one wherever the ray
meets the core, and nothing where it misses the volume. That the samples are so is checked as they
are decoded.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..camera import Camera
from ..compression import decompress
from ..geometry import samples_of
from ..measure.isosurface import Isosurface
from ..oracle import caster
from .case import Case, Outcome, Settings
from .scene import compressed

ISOVALUE = 0.0

#: Bits per sample at which most fields of a kind are closed; a thin skin needs all of them.
RATES = {"noise": (8.0, 16.0, 32.0), "smooth": (4.0, 8.0), "hollow": (8.0, 32.0), "thin": (32.0,)}

#: How the work is divided: `Isosurface`'s arguments, and the budget in units of the least.
DIVISIONS: tuple[tuple[dict[str, bool], float | None], ...] = (
    ({}, None),
    ({"cached": True}, None),
    ({"cached": True, "speculation": False}, None),
    ({"cached": True}, 1.05),
)

#: Rays that come closer than this to an edge of a box, in voxels, are not judged.
_MARGIN = 1e-4

#: Images of a kind of field, two of each volume.
_IMAGES = 24

#: Clipping planes of a camera in the core, in voxels.
CLIPPING_INSIDE = (0.01, 1e4)


@dataclass(frozen=True)
class ClosedField:
    """Holds samples with a core and a skin.

    Attributes
    ----------
    values : numpy.ndarray of float32, shape (depth, height, width)
        The isovalue is `ISOVALUE`.
    low, high : numpy.ndarray of int, shape (3,)
        First and last sample of the core along x, y and z. It is at least 3 samples wide.
    skin : numpy.ndarray of bool
        Which samples make up the skin.
    """

    values: np.ndarray
    low: np.ndarray
    high: np.ndarray
    skin: np.ndarray

    def is_closed(self, decoded: np.ndarray) -> bool:
        """Tell whether core and skin are on their sides of the isovalue in decoded samples."""
        core = decoded[_box(self.low, self.high)]
        return bool((core >= ISOVALUE).all() and (decoded[self.skin] < ISOVALUE).all())


def closed_field(kind: str, shape: tuple[int, ...], seed: int | np.random.Generator) -> ClosedField:
    """Make a closed random field.

    Parameters
    ----------
    kind : str
        ``noise``, white noise around a small core; ``smooth``, a ball with waves; ``hollow``, noise
        that is above the isovalue but for the outermost samples; ``thin``, the same on both sides
        of a box that is one sample thick and hardly below the isovalue.
    shape : tuple of int
        Samples along z, y and x, at least 9.
    seed : int or numpy.random.Generator

    Returns
    -------
    ClosedField
    """
    rng = np.random.default_rng(seed)
    values, low, high = _KINDS[kind](rng, shape)
    skin = np.zeros(shape, bool)
    if kind == "thin":
        skin[_box(low - 1, high + 1)] = True
        skin[_box(low, high)] = False
        values[skin] = -1e-6 * rng.uniform(1, 2, skin.sum())
    else:
        skin[:] = True
        skin[1:-1, 1:-1, 1:-1] = False
        values[skin] = -rng.uniform(0.5, 2, skin.sum())
    return ClosedField(values.astype(np.float32), low, high, skin)


def _noise(
    rng: np.random.Generator, shape: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    values = rng.normal(0.7, 1.0, shape)
    low, high = _random_box(rng, shape, 3)
    values[_box(low, high)] = rng.uniform(0.5, 2, (3, 3, 3))
    return values, low, high


def _smooth(
    rng: np.random.Generator, shape: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    axes = np.meshgrid(*[np.linspace(-1, 1, n) for n in shape], indexing="ij")
    values = 0.6 - np.sqrt(sum(axis**2 for axis in axes))
    for _ in range(4):
        wave = sum(f * axis for f, axis in zip(rng.normal(0, 6, 3), axes))
        values += 0.1 * np.cos(wave + rng.uniform(0, 2 * np.pi))
    centre = np.array(shape[::-1]) // 2
    values[_box(centre - 1, centre + 1)] = np.maximum(values[_box(centre - 1, centre + 1)], 0.1)
    half = 1
    while (values[_box(centre - half - 1, centre + half + 1)] > 0.05).all():
        half += 1
    return values, centre - half, centre + half


def _hollow(
    rng: np.random.Generator, shape: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return rng.uniform(0.5, 2, shape), np.ones(3, int), np.array(shape[::-1]) - 2


def _thin(
    rng: np.random.Generator, shape: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return rng.uniform(0.1, 1, shape), *_random_box(rng, shape, None)


_KINDS = {"noise": _noise, "smooth": _smooth, "hollow": _hollow, "thin": _thin}


def _random_box(
    rng: np.random.Generator, shape: tuple[int, ...], width: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """Choose the first and last samples of a box, at least 3 wide, 2 off the border."""
    sizes = np.array(shape[::-1])
    widths = rng.integers(3, sizes - 3) if width is None else np.full(3, width)
    low = rng.integers(2, sizes - 1 - widths)
    return low, low + widths - 1


def _box(low: np.ndarray, high: np.ndarray) -> tuple[slice, ...]:
    """Make the index of a box in samples [z, y, x]."""
    return tuple(slice(a, b + 1) for a, b in zip(low[::-1], high[::-1]))


# ---- cameras


def camera_inside(field: ClosedField, rng: np.random.Generator) -> Camera:
    """Place a camera in the core, a voxel from its boundary, half the time on a sample.

    Returns
    -------
    progiso.Camera
        In the field's index space.
    """
    position = rng.uniform(field.low + 1, field.high - 1)
    if rng.integers(2):
        position = np.round(position)
    return _camera(position, position + _direction(rng), rng)


def camera_outside(field: ClosedField, rng: np.random.Generator) -> Camera:
    """Place a camera outside the volume that looks at the core, perspective or parallel."""
    sizes = np.array(field.values.shape[::-1])
    target = rng.uniform(field.low, field.high)
    if rng.integers(2):
        target = np.round(target)
    position = target + rng.uniform(1.8, 4) * np.linalg.norm(sizes) * _direction(rng)
    return _camera(position, target, rng, bool(rng.integers(2)), float(0.3 * sizes.max()))


def _camera(
    position: np.ndarray,
    target: np.ndarray,
    rng: np.random.Generator,
    parallel: bool = False,
    scale: float = 1.0,
) -> Camera:
    forward = target - position
    up = np.eye(3)[np.argmin(np.abs(forward))]
    angle = rng.uniform(10, 40) if parallel else rng.uniform(10, 150)
    place, seen, upwards = (tuple(map(float, v)) for v in (position, target, up))
    return Camera(place, seen, upwards, view_angle=angle, parallel=parallel, parallel_scale=scale)


def _direction(rng: np.random.Generator) -> np.ndarray:
    """Draw a unit vector, half the time along an axis or a diagonal, to meet edges and corners."""
    special = list(itertools.product((-1.0, 0.0, 1.0), repeat=3))
    special.remove((0.0, 0.0, 0.0))
    vector = rng.normal(size=3) if rng.integers(2) else np.array(special[rng.integers(26)])
    return vector / np.linalg.norm(vector)


# ---- judging


def slipped(
    depth: np.ndarray, field: ClosedField, camera: caster.Camera
) -> tuple[np.ndarray, np.ndarray, int]:
    """Find the rays that go wrong.

    Parameters
    ----------
    depth : numpy.ndarray, shape (height, width)
        Of the field in its index space, ``inf`` where nothing is hit; row 0 is the top.
    field : ClosedField
    camera : progiso.oracle.caster.Camera

    Returns
    -------
    missed, invented : numpy.ndarray of bool, shape (height, width)
        Rays that meet the core and see no surface, and rays that miss the volume and see one.
    judged : int
        Rays that do either.
    """
    origins, directions = camera.rays(depth.shape[::-1])
    last = np.array(field.values.shape[::-1]) - 1
    due = _meets(origins, directions, field.low + _MARGIN, field.high - _MARGIN)
    off = ~_meets(origins, directions, np.full(3, -_MARGIN), last + _MARGIN)
    hit = np.isfinite(depth)
    due, off = due.reshape(depth.shape), off.reshape(depth.shape)
    return due & ~hit, off & hit, int(due.sum() + off.sum())


def _meets(
    origins: np.ndarray, directions: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Tell which rays meet a box."""
    enter, leave = caster.clip_to_box(origins.T, directions.T, 0.0, np.inf, low, high)
    return enter <= leave


# ---- measuring


@dataclass
class _Count:
    """Counts what has been cast so far."""

    rays: int = 0
    wrong: int = 0
    images: int = 0
    volumes: int = 0
    slowest_ms: float = 0.0
    first: str = ""


def count_cracks(kind: str, rays: int, side: int = 64, seed: int = 0) -> Outcome:
    """Cast rays at closed surfaces, from inside and outside, and count those that go wrong.

    Rates and the ways to divide the work take turns. The images are as large as it takes to have
    about `_IMAGES` of them, at most 2048 pixels wide.

    Parameters
    ----------
    kind : str
        See `closed_field`.
    rays : int
        At least so many are judged.
    side : int
        Largest side of the volumes in samples, at least 18.
    seed : int
        Of everything random.

    Returns
    -------
    case.Outcome
        In wrong rays; the note tells the first that went wrong, by all that it takes to repeat it.
    """
    start, count = perf_counter(), _Count()
    width = int(np.clip(np.sqrt(rays / _IMAGES), 32, 2048))
    turns = itertools.product(DIVISIONS, RATES[kind])
    for number, (division, rate) in enumerate(itertools.cycle(turns)):
        if count.rays >= rays:
            break
        rng = np.random.default_rng([seed, number])
        shape = tuple(map(int, rng.integers(side // 2, side + 1, 3)))
        field = closed_field(kind, shape, rng)
        about = f"volume {number} of seed {seed}, {shape}, rate {rate:g}, {division}"
        _look_around(field, rate, (width, width), division, rng, about, count)
    seconds = perf_counter() - start
    note = f"{count.images} images of {count.volumes} volumes, {seconds:.1f} s in all"
    unit = f"of {count.rays} rays"
    return Outcome(
        count.wrong, 0, count.slowest_ms, unit, "; ".join(filter(None, (note, count.first)))
    )


def _look_around(
    field: ClosedField,
    rate: float,
    size: tuple[int, int],
    division: tuple[dict[str, bool], float | None],
    rng: np.random.Generator,
    about: str,
    count: _Count,
) -> None:
    """Look at a volume from inside and outside; add to the count."""
    arguments, share = division
    view = Isosurface(compressed_field(field, rate), ISOVALUE, size, **arguments)
    for place in (camera_inside, camera_outside):
        camera = place(field, rng)
        view.look(camera)
        seen = view.renderer.GetActiveCamera()
        if place is camera_inside:
            seen.SetClippingRange(CLIPPING_INSIDE)
        if share is not None:
            view.mapper.SetMemoryBudget(int(share * least_budget(view)))
        count.slowest_ms = max(count.slowest_ms, view.render())
        missed, invented, judged = slipped(view.depth(), field, caster.Camera.from_vtk(seen))
        wrong = missed | invented
        if wrong.any() and not count.first:
            row, column = np.argwhere(wrong)[0]
            count.first = f"first wrong: row {row}, column {column}, {camera}, {about}"
        count.rays += judged
        count.wrong += int(wrong.sum())
        count.images += 1
    count.volumes += 1
    view.close()


def least_budget(view: Isosurface) -> int:
    """Return the least memory budget that a view can work with, as its last image says."""
    if not view.statistics()["passes"]:
        view.render()
    return view.statistics()["memory"]["least_budget"]


def compressed_field(field: ClosedField, rate: float) -> vtkImageData:
    """Compress a closed field, at a higher rate where it is no longer closed at this one.

    Raises
    ------
    ValueError
        When no rate will do.
    """
    while rate <= 32:
        image = compressed(field.values, rate)
        if field.is_closed(samples_of(decompress(image))):
            return image
        rate *= 2
    raise ValueError("the field is closed at no rate")


def _case(kind: str, settings: Settings) -> Outcome:
    return count_cracks(kind, settings.rays // len(RATES))


CASES = tuple(
    Case(name, partial(_case, kind))
    for kind, name in {
        "noise": "no crack in white noise",
        "smooth": "no crack in a smooth field",
        "hollow": "no crack in a box of noise",
        "thin": "no crack in a sheet of one sample, 1e-6 deep",
    }.items()
)
