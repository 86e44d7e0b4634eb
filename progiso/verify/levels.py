"""Check images with levels of detail: depths, where surfaces lie, zooms, and what is thin.

Depths are held against the caster that knows the law of levels (`progiso.oracle.levels`), in voxels
of the level in which a ray hits. How far a level lies beside the true surface is measured at
spheres, whether anything jumps in zooms, and what a conservative image loses at sheets and threads
of a sample's thickness. Rays through places where levels change are in `level_cracks`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..camera import Camera, orbit_camera
from ..compression import decompress, describe
from ..geometry import samples_of
from ..io import compress
from ..measure import tolerances
from ..options import MAX_LEVELS
from ..oracle import caster, levels
from ..oracle.levels import BLENDING, Level, Pyramid
from .case import Case, Outcome, Settings, worst_of
from .fields import blobs, coordinates, make_image, noise
from .scene import RATE, Picture, decoded, judge, looking, parallel, shoot

_SHAPE = (90, 140, 131)
_NOISE = tolerances.GRAZING_FRACTION_NOISE

#: Part of the hits that a level must have to count as seen.
_SEEN = 0.01

#: Voxels of a ray in a block of a level, at most.
_BLOCK_DIAGONAL = 4 * 3**0.5


def with_levels(values: np.ndarray, rate: float = RATE, **geometry: Any) -> vtkImageData:
    """Compress values [z, y, x] with all levels; `geometry` as in `fields.make_image`."""
    return compress(make_image(values, **geometry), rate=rate, levels=MAX_LEVELS)


def pyramid_of(image: vtkImageData) -> Pyramid:
    """Decode a compressed volume and all of its levels by libzfp, for the caster."""
    about = describe(image)["levels"]
    return Pyramid(
        decoded(image),
        tuple(
            Level(samples_of(decompress(image, level=number)), tuple(each["steps"]))
            for number, each in enumerate(about, 1)
        ),
    )


def gyroid(shape: tuple[int, ...], wavelength: float = 40.0) -> np.ndarray:
    """Make a field whose surfaces are everywhere, and smooth; the wavelength is in samples."""
    z, y, x = (2 * np.pi / wavelength * c for c in coordinates(shape)[::-1])
    field = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return field.astype(np.float32)


def _near(image: vtkImageData, side: int, distance: float) -> Camera:
    """Look at a volume's centre from so many of its largest sides away."""
    camera = orbit_camera(image, side, 5)
    offset = np.subtract(camera.position, camera.focal_point) * distance / 1.5
    return looking(camera.focal_point + offset, camera.focal_point, camera.view_up, 70.0)


# --- depths ---------------------------------------------------------------------------------------


def _check(
    settings: Settings,
    image: vtkImageData,
    isovalue: float,
    camera: Camera,
    tolerance: float,
    seen: Sequence[int],
    grazing: float = tolerances.GRAZING_FRACTION,
    conservative: bool = False,
) -> Outcome:
    """Compare an image with the caster's of the same levels, of which all of `seen` must be."""
    view = Picture(image, isovalue, settings.size, pixel_tolerance=tolerance)
    if conservative:
        view.mapper.SetLevelOfDetailToConservative()
    shot = shoot(view, camera, settings.repeat)
    expected = levels.cast(
        pyramid_of(image),
        isovalue,
        shot.eye,
        settings.size,
        tolerance=tolerance,
        conservative=conservative,
        slack=tolerances.SLACK,
        clip=shot.clip,
    )
    hits = expected.level >= 0
    parts = np.bincount(expected.level[hits], minlength=max(seen) + 1) / max(hits.sum(), 1)
    note = ", ".join(f"{part:.0%} in level {i}" for i, part in enumerate(parts) if part)
    outcome = judge(shot, expected, grazing=grazing, note=note)
    few = [i for i in seen if parts[i] < _SEEN]
    lacking = f"levels {few} are hardly seen" if few else ""
    return replace(outcome, defect="; ".join(filter(None, (outcome.defect, lacking))))


def _through_levels(
    make: Callable[[], np.ndarray],
    isovalue: float,
    settings: Settings,
    grazing: float = tolerances.GRAZING_FRACTION,
    apart: float = 1 / 36,
) -> Outcome:
    """Look from near, so that the volume itself and levels are seen in one image.

    Samples may be `apart` by that part of the image's height.
    """
    image = with_levels(make())
    camera = _near(image, 2, 0.6)
    return _check(settings, image, isovalue, camera, settings.size[1] * apart, (0, 1), grazing)


def _in_parallel(settings: Settings) -> Outcome:
    """Draw one level, parts of the way to the next, and the last one."""
    image = with_levels(gyroid(_SHAPE) + 0.1 * noise(_SHAPE))
    camera = parallel(orbit_camera(image, 1, 5), 75.0)
    outcomes = []
    for level, weight in ((0, 0.3), (0, 0.9), (1, 0.5), (2, 0.0)):
        apart = 2.0 ** (level + 1) * (BLENDING * (1 - weight) + weight)
        tolerance = apart * settings.size[1] / (2 * 75.0)
        outcomes.append(_check(settings, image, 0.1, camera, tolerance, (level,)))
    return worst_of(outcomes)


def _stretched(settings: Settings) -> Outcome:
    """Draw levels that halve the fine axes first."""
    image = with_levels(gyroid((35, 128, 71)), spacing=(0.7, 0.3, 1.9))
    camera = _near(image, 1, 0.9)
    return _check(settings, image, 0.1, camera, settings.size[1] / 40, (0, 1))


def _depths_of_thin(settings: Settings) -> Outcome:
    """Draw what is thin conservatively, from where the volume itself and levels are drawn."""
    image = with_levels(thin_field(_SHAPE, 5))
    camera = _near(image, 2, 0.8)
    return _check(settings, image, 0.0, camera, settings.size[1] / 30, (0, 2), conservative=True)


def _from_inside(settings: Settings) -> Outcome:
    """Look from a place where the volume itself is drawn around, and levels farther away."""
    image = with_levels(blobs(_SHAPE, 2, waves=6))
    camera = looking((30.2, 40.7, 30.1), (100.0, 90.0, 60.0), (0, 0, 1), 80.0)
    return _check(settings, image, 0.1, camera, settings.size[1] / 30, (0, 1, 2))


# --- where the surface of a level lies ------------------------------------------------------------

#: How far the surface of a level lies within a sphere in the mean, in the level's voxels, times the
#: sphere's radius in them. The trilinear interpolant cuts corners by 1/6 (a twelfth along each axis
#: of a second derivative, of which two are 1/r); the filter adds up to 0.006
#: (Testing/Benchmarks/results/levels.md), and the rest is for rays that are not spread evenly.
#: [1 2 1]/4 would have 0.29 at level 1, and means 0.23.
_DISPLACEMENT = 0.18


def _octant(radius: float, level: int) -> tuple[np.ndarray, np.ndarray]:
    """Make the eighth of a ball, as distances, and its centre: large ones take less memory so."""
    centre = 2.0**level * 4 + np.array([0.37, 0.61, 0.13])
    # larger than 32 of the level's voxels: a smaller volume has no such level
    side = max(int(radius + 2.0**level * 8), 2**level * 32 + 1)
    away = [np.square(np.arange(side, dtype=np.float32) - np.float32(c)) for c in centre]
    squares = away[2][:, None, None] + away[1][:, None] + away[0]
    return np.float32(radius) - np.sqrt(squares, out=squares), centre


def _sphere(level: int, radius: int, settings: Settings) -> tuple[float, float]:
    """Draw a sphere of so many voxels of the level; return its displacement and the time."""
    step = 2.0**level
    values, centre = _octant(step * radius, level)
    scale = 0.6 * step * radius
    target = centre + step * radius / 3**0.5
    camera = parallel(looking(target + 2 * step * radius, target, (0, 0, 1)), scale)
    # within the depths of this level alone, in proportion
    tolerance = step * (2 * BLENDING) ** 0.5 * settings.size[1] / (2 * scale)
    view = Picture(with_levels(values), 0.0, settings.size, pixel_tolerance=tolerance)
    try:
        milliseconds = view.time(camera, settings.repeat)
        depth, (eye, _) = view.depth(), view.rays()
        pixels = [view.mapper.GetStatistics().GetLevelPixels(i) for i in range(level + 2)]
    finally:
        view.close()
    if pixels[level] == 0 or sum(pixels) != pixels[level]:
        raise ValueError(f"level {level} should be drawn alone, but pixels of levels are {pixels}")
    origins, directions = eye.rays(settings.size)
    hits = np.isfinite(depth).ravel()
    points = (origins + np.where(hits, depth.ravel(), 0)[:, None] * directions)[hits]
    # four voxels of the level from the octant's faces, the filter knows what is beyond
    kept = (points > step * 4).all(axis=1)
    inward = radius - np.linalg.norm(points[kept] - centre, axis=1) / step
    return float(inward.mean()), milliseconds


def _spheres(level: int, settings: Settings) -> Outcome:
    found = {radius: _sphere(level, radius, settings) for radius in (8, 16, 32)}
    products = ", ".join(f"{radius}: {off * radius:.3f}" for radius, (off, _) in found.items())
    return worst_of(
        Outcome(
            abs(off),
            _DISPLACEMENT / radius,
            milliseconds,
            unit="voxels of the level",
            note=f"mean displacement inwards times radius, by radius in voxels: {products}",
        )
        for radius, (off, milliseconds) in found.items()
    )


# --- zooms ----------------------------------------------------------------------------------------

#: How far a depth may jump in a step of a zoom by a thousandth, in footprints of a pixel times the
#: tolerance, which is how far samples are apart at most. Of the zoom itself: rays move by a twelfth
#: of a sample at the image's edge, across waves of six samples that a level may lack, and depths
#: come at a slant. Of the levels alone, rays held still: a step moves the next level's weight by a
#: thousandth of 1 - `BLENDING`, 0.6 %, of the 0.3 that levels are apart. A switch without blending
#: has all of the 0.3.
_JUMP = 0.25
_JUMP_OF_LEVELS = 0.01

#: What the depths of neighbours may differ by, in footprints, to be of one surface.
_CONTINUOUS = 5.0

#: Of the pictures of a zoom: errors are counted in pixels, whose number does not matter.
_SIZE = (160, 120)

#: From frame to frame.
_STEP = 1.001
_FRAMES = 8

#: Pixels between samples, in parts of the image's height.
_APART = 1 / 40


def _landscape() -> vtkImageData:
    """Make a slope with waves, short ones that coarser levels lack, and no folds."""
    x, y, z = coordinates(_SHAPE)
    waves = 0.4 * np.sin(x * 2 * np.pi / 6.3) * np.sin(y * 2 * np.pi / 5.7)
    waves += np.sin(x * 2 * np.pi / 17) * np.cos(y * 2 * np.pi / 23)
    height = 0.4 * _SHAPE[0] + 0.1 * (x - 65) + 0.15 * (y - 70) + waves
    return with_levels((height - z).astype(np.float32))


def _above(distance: float = 1.0, zoom: float = 1.0) -> Camera:
    """Look down at the landscape, from farther away or with a narrower view angle."""
    target = np.array([65.0, 75.0, 38.0])
    position = target + distance * np.array([5.0, -80.0, 75.0])
    angle = 2 * np.degrees(np.arctan(np.tan(np.radians(30)) / zoom))
    return looking(position, target, (0, 0, 1), angle)


#: A camera, and what the tolerance is multiplied by.
_Frame = tuple[Camera, float]

_STEPS = tuple(_STEP**i for i in range(_FRAMES))

#: Parallel scales from which levels 0 and 1 begin and end to go over to the next, in some steps.
_SCALES = tuple(
    apart * part * _STEP ** (-_FRAMES / 2) / (2 * _APART)
    for apart in (2.0, 4.0)
    for part in (BLENDING, 1.0)
)


def _drawn_back() -> list[list[_Frame]]:
    return [[(_above(distance=step), 1.0) for step in _STEPS]]


def _narrowed() -> list[list[_Frame]]:
    return [[(_above(zoom=step), 1.0) for step in _STEPS]]


def _scaled() -> list[list[_Frame]]:
    return [[(parallel(_above(), scale * step), 1.0) for step in _STEPS] for scale in _SCALES]


def _held_still() -> list[list[_Frame]]:
    cameras = [_above(), *(parallel(_above(), scale) for scale in _SCALES)]
    return [[(camera, step) for step in _STEPS] for camera in cameras]


def _zoom(zooms: Callable[[], list[list[_Frame]]], limit: float, _settings: Settings) -> Outcome:
    """Zoom through changes of levels, and find the largest jump of a depth."""
    image = _landscape()
    tolerance = _SIZE[1] * _APART
    exact = Picture(image, 0.0, _SIZE)
    view = Picture(image, 0.0, _SIZE, pixel_tolerance=tolerance)
    try:
        found = [_jumps(exact, view, frames, tolerance) for frames in zooms()]
    finally:
        exact.close()
        view.close()
    jumps = np.concatenate([each for each, _, _ in found])
    beside = max(far for _, far, _ in found)
    least = _SIZE[0] * _SIZE[1] * len(found)
    return Outcome(
        float(jumps.max(initial=0)),
        limit,
        max(slowest for _, _, slowest in found),
        "footprints",
        f"{len(jumps)} depths from frame to frame, mean jump {jumps.mean():.2g}; levels are up to "
        f"{beside:.2g} beside the exact image",
        defect="" if len(jumps) > least else "too few depths are of one surface",
    )


def _jumps(
    exact: Picture, view: Picture, frames: Sequence[_Frame], tolerance: float
) -> tuple[np.ndarray, float, float]:
    """Return how depths jump from frame to frame, how far they are off, and the longest time.

    What the camera's motion changes is in the exact image, too. What counts is how far the image
    with levels is from it, and by how much that changes, in footprints times the tolerance.
    """
    jumps, far, slowest, last = [], 0.0, 0.0, None
    margin = int(np.ceil(tolerance)) + 1  # as far as silhouettes of levels may be apart
    for camera, part in frames:
        view.mapper.SetPixelTolerance(part * tolerance)
        exact.render_from(camera)
        slowest = max(slowest, view.render_from(camera))
        depths, eye = (exact.depth(), view.depth()), view.rays()[0]
        footprints = [_footprint(depth, eye) for depth in depths]
        smooth = [_is_continuous(*each, margin) for each in zip(depths, footprints)]
        both = smooth[0] & smooth[1]
        beside = np.where(both, depths[1], 0) - np.where(both, depths[0], 0)
        beside /= tolerance * footprints[0]
        if last is not None:
            jumps.append(np.abs(beside - last[0])[both & last[1]])
        far = max(far, float(np.abs(beside[both]).max(initial=0)))
        last = beside, both
    return np.concatenate(jumps), far, slowest


def _footprint(depth: np.ndarray, eye: caster.Camera) -> np.ndarray:
    """Return how wide a pixel is at its depth, in world units."""
    height, width = depth.shape
    if eye.parallel_scale is not None:
        return np.full(depth.shape, 2 * eye.parallel_scale / height)
    across = (eye.rays((width, height))[1] @ eye.forward).reshape(depth.shape)
    return (
        np.where(np.isfinite(depth), depth, 1)
        * across
        * 2
        * np.tan(np.radians(eye.view_angle) / 2)
        / height
    )


def _is_continuous(depth: np.ndarray, footprint: np.ndarray, margin: int) -> np.ndarray:
    """Mark the pixels around which, as far as depths tell, so many pixels see one surface."""
    hit = np.isfinite(depth)
    smooth = hit.copy()
    with np.errstate(invalid="ignore"):
        for axis in (0, 1):
            for by in (-1, 1):
                smooth &= np.abs(np.roll(depth, by, axis) - depth) <= _CONTINUOUS * footprint
    for _ in range(margin):
        for axis in (0, 1):
            smooth = smooth & np.roll(smooth, 1, axis) & np.roll(smooth, -1, axis)
    smooth[:margin] = smooth[-margin:] = smooth[:, :margin] = smooth[:, -margin:] = False
    return smooth


# --- what is thin ---------------------------------------------------------------------------------


def thin_field(shape: tuple[int, ...], seed: int = 0) -> np.ndarray:
    """Make bent sheets and threads that are hardly thicker than a sample, around zero."""
    rng = np.random.default_rng(seed)
    points = np.stack(coordinates(shape))
    field = np.full(shape, -1.0)
    for _ in range(3):
        normal = rng.normal(size=3)
        normal /= np.linalg.norm(normal)
        waves = blobs(shape, int(rng.integers(1 << 16)), waves=2)
        beside = np.tensordot(normal, points, 1)
        away = beside - np.median(beside) + rng.uniform(-20, 20) + 6 * waves
        inside = rng.uniform(size=2) * 0.5 * np.array(shape[:2])
        part = (points[2] > inside[0]) & (points[1] > inside[1])
        np.maximum(field, np.where(part, 0.9 - np.abs(away), -1), out=field)
    for _ in range(12):
        place, along = rng.uniform(0, shape[::-1]), rng.normal(size=3)
        along /= np.linalg.norm(along)
        offset = points - place[:, None, None, None]
        away = np.sqrt(np.maximum((offset**2).sum(axis=0) - np.tensordot(along, offset, 1) ** 2, 0))
        np.maximum(field, 1.1 - away, out=field)
    return np.clip(field, -1, 1).astype(np.float32)


def _conservative(
    settings: Settings, *, in_parallel: bool = False, cached: bool = False
) -> Outcome:
    """Draw what is thin exactly, with levels, and conservatively, which must not lose any of it."""
    image = with_levels(thin_field(_SHAPE, 5))
    camera, tolerance = _near(image, 2, 0.8), settings.size[1] / 30
    if in_parallel:  # levels 1 and 2 blend
        camera, tolerance = parallel(camera, 75.0), 3.7 * settings.size[1] / 150
    view = Picture(image, 0.0, settings.size, pixel_tolerance=tolerance, cached=cached)
    depths = []
    for mode in (view.mapper.SetLevelOfDetailToOff, view.mapper.SetLevelOfDetailToOn):
        mode()
        view.render_from(camera)
        depths.append(view.depth())
    view.mapper.SetLevelOfDetailToConservative()
    shot = shoot(view, camera, settings.repeat)
    exact, on = depths
    hits, seen = np.isfinite(exact), np.isfinite(shot.depth)
    both = hits & seen
    apart = _distance_of_samples(pyramid_of(image), shot.eye, tolerance, exact)
    behind = (shot.depth[both] - exact[both]) / apart[both]
    missed = int(np.sum(hits & ~seen))
    lost = np.mean(np.isinf(on[hits]))
    later = np.mean(behind > tolerances.DEPTH_VOXELS)
    return Outcome(
        np.inf if missed else float(behind.max(initial=0)),
        _BLOCK_DIAGONAL,
        shot.milliseconds,
        "voxels of the level",
        f"{hits.sum()} rays hit exactly, of which levels alone lose {lost:.0%}; "
        f"{later:.1%} hit behind, in a block in which the level has a surface, too",
        defect="; ".join(filter(None, (shot.defect, f"{missed} rays miss" if missed else ""))),
    )


def _distance_of_samples(
    pyramid: Pyramid, eye: caster.Camera, tolerance: float, depth: np.ndarray
) -> np.ndarray:
    """Return how far samples are apart in the level of depths, in the finer one where two blend."""
    height, width = depth.shape
    stretches = levels.find_stretches(pyramid, eye, height, tolerance)
    across = (eye.rays((width, height))[1] @ eye.forward).reshape(depth.shape)
    ends = [stretch.end for stretch in stretches[:-1]]
    number = np.searchsorted(ends, np.where(np.isfinite(depth), depth, 0) * across, side="right")
    return pyramid.spacings[[stretch.level for stretch in stretches]][number]


CASES = (
    Case("levels of a gyroid", partial(_through_levels, partial(gyroid, _SHAPE), 0.1)),
    Case(
        "levels of white noise",
        partial(_through_levels, partial(noise, _SHAPE), 0.3, grazing=_NOISE, apart=1 / 28),
        quick=False,
    ),
    Case("levels of blobs", partial(_through_levels, partial(blobs, _SHAPE, 2, 6), 0.1), False),
    Case("levels, parallel projection, on the way to the next", _in_parallel, quick=False),
    Case("levels, spacing 0.7, 0.3, 1.9", _stretched),
    Case("levels, camera inside", _from_inside, quick=False),
    *(
        Case(
            f"spheres of 8, 16 and 32 voxels of level {level}", partial(_spheres, level), level < 2
        )
        for level in (1, 2, 3)
    ),
    Case(
        "levels: zoom by steps of 0.1 %, rays held still",
        partial(_zoom, _held_still, _JUMP_OF_LEVELS),
    ),
    Case(
        "levels: zoom by steps of 0.1 %, camera drawn back",
        partial(_zoom, _drawn_back, _JUMP),
        False,
    ),
    Case("levels: zoom by steps of 0.1 %, view angle", partial(_zoom, _narrowed, _JUMP), False),
    Case(
        "levels: zoom by steps of 0.1 %, parallel projection", partial(_zoom, _scaled, _JUMP), False
    ),
    Case("conservative: sheets and threads of a sample", _conservative),
    Case("conservative: depths of the same", _depths_of_thin, quick=False),
    Case(
        "conservative: the same, parallel projection",
        partial(_conservative, in_parallel=True),
        False,
    ),
    Case(
        "conservative: the same, blocks as rays meet them",
        partial(_conservative, cached=True),
        False,
    ),
)
