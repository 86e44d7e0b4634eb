"""Cast rays at levels of detail, on the CPU in double precision.

A pyramid holds a volume and coarser levels of it, whose samples lie on some of the volume's. Each
depth has its level: the coarsest whose samples are, as the camera sees them, no more than some
pixels apart. Before a level ends it goes over to the next: the field is a blend of both, whose
weight grows with the depth, so that no depth jumps (`find_stretches`).

Rays go through each stretch of depths by the walk of `caster`. Where two levels blend, a ray's way
is cut by the cells of the finer one. In such a piece both interpolants are cubics, and so is the
blend: its Bernstein coefficients are those of both, weighted by what the next level's weight is at
0, 1, 2 and 3 thirds of the piece. That is the blend itself at a piece's ends, and everywhere where
the weight is constant.

Conservative rays look at the volume itself, too: in each block that they pass without a hit where
a coarser level is drawn or blends in. There they hit where they cross the volume's own surface
between the places at which they enter and leave the block.

`Cast.early` and `Cast.late` bound what rounding may do, as in `caster`: the error of a blend is at
most that of both levels together.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .caster import (
    Camera,
    Cast,
    Grid,
    Progress,
    Slack,
    Volume,
    Walk,
    cast_at_box,
    index_rays,
)

#: A level goes over to the next in the last quarter of an octave of distances between samples.
BLENDING = 2.0**-0.25

#: Cells along each side of a block.
BLOCK_SIDE = 4

_EXACT = Slack()


@dataclass(frozen=True)
class Level:
    """Holds the samples of a coarser level.

    Attributes
    ----------
    values
        array [z, y, x] of the samples.
    steps
        samples of the volume from one of the level's to the next, along x, y and z: powers of 2.
        The first sample is the volume's first, the last one its last or beyond it.
    hidden
        array [z, y, x] of booleans, one a cell, as in `Volume`.
    """

    values: np.ndarray
    steps: tuple[int, int, int]
    hidden: np.ndarray | None = None


@dataclass(frozen=True)
class Pyramid:
    """Holds a volume and its coarser levels, from fine to coarse.

    Attributes
    ----------
    volume
        level 0.
    coarser
        levels 1 and on: each has at every axis as many samples as the one before, or half of them.
    """

    volume: Volume
    coarser: tuple[Level, ...] = ()

    def __post_init__(self) -> None:
        """Refuse levels of which one's cells are not parts of the next one's."""
        before, samples = self.steps[0], np.array(self.volume.values.shape[::-1])
        for number, (level, steps) in enumerate(zip(self.coarser, self.steps[1:]), 1):
            if not np.isin(steps // before, (1, 2)).all() or (steps % before).any():
                raise ValueError(
                    f"level {number} has steps {level.steps}: along each axis they must be those "
                    f"of the level before, {tuple(before.tolist())}, or twice as many"
                )
            halved = steps > before
            samples = np.where(halved, samples // 2 + 1, samples)
            if level.values.shape != tuple(samples[::-1]):
                raise ValueError(
                    f"level {number} has samples of shape {level.values.shape}, but "
                    f"{tuple(samples[::-1].tolist())} belong to the level before"
                )
            before = steps

    @property
    def steps(self) -> list[np.ndarray]:
        """Return every level's steps, the volume's first."""
        return [np.ones(3, int)] + [np.array(level.steps) for level in self.coarser]

    @property
    def spacings(self) -> np.ndarray:
        """Return how far samples of each level are apart, along the axis where it is most."""
        edges = np.linalg.norm(self.volume.index_to_world[:3, :3], axis=0)
        return np.array([(steps * edges).max() for steps in self.steps])

    def grids(self, isovalue: float, slack: Slack) -> list[Grid]:
        """Prepare all levels for walks."""
        whole = [self.volume]
        for level in self.coarser:
            matrix = self.volume.index_to_world @ np.diag([*level.steps, 1.0])
            whole.append(Volume(level.values, matrix, level.hidden))
        return [Grid(level, isovalue, slack) for level in whole]


@dataclass(frozen=True)
class Stretch:
    """Depths along the view at which one level is drawn, or goes over to the next.

    Attributes
    ----------
    level
        the one that is drawn; the finer one of two.
    begin, end
        depths; infinite where there is no end.
    first_weight, last_weight
        of the next level, at both; it is linear between them.
    """

    level: int
    begin: float = -np.inf
    end: float = np.inf
    first_weight: float = 0.0
    last_weight: float = 0.0

    @property
    def blends(self) -> bool:
        """Tell whether there is anything of the next level."""
        return max(self.first_weight, self.last_weight) > 0

    def weight(self, depth: np.ndarray) -> np.ndarray:
        """Return the next level's weight at depths of the stretch."""
        if self.first_weight == self.last_weight:
            return np.full(np.shape(depth), self.first_weight)
        share = np.clip((depth - self.begin) / (self.end - self.begin), 0, 1)
        return self.first_weight + share * (self.last_weight - self.first_weight)


def find_stretches(
    pyramid: Pyramid, camera: Camera, height: int, tolerance: float = 1.0
) -> list[Stretch]:
    """Find which level is drawn at which depth.

    A level is drawn up to where the next one's samples are `tolerance` pixels apart, and goes over
    to it in the quarter of an octave before, but not before it is drawn itself. Of two levels whose
    samples are as far apart, the second is drawn from a quarter of an octave later on.

    Parameters
    ----------
    pyramid : Pyramid
    camera : Camera
    height : int
        of the image, in pixels.
    tolerance : float
        how many pixels a level's samples may be apart.

    Returns
    -------
    list of Stretch
        In the order of their depths, without gaps. In parallel projection there is one.
    """
    if not tolerance > 0:
        raise ValueError(f"tolerance must be above 0 pixels, got {tolerance}")
    begin, ends = 0.0, []  # all are distances between samples that are `tolerance` pixels apart
    for spacing in pyramid.spacings[1:].tolist():
        until = max(spacing, begin / BLENDING)
        ends.append((begin, max(until * BLENDING, begin), until))
        begin = until
    last = len(ends)
    if camera.parallel_scale is not None:
        seen = tolerance * 2 * camera.parallel_scale / height
        for level, (_, blend, until) in enumerate(ends):
            if seen < until:
                weight = max((seen - blend) / (until - blend), 0.0)
                return [Stretch(level, first_weight=weight, last_weight=weight)]
        return [Stretch(last)]
    per_depth = tolerance * 2 * math.tan(math.radians(camera.view_angle) / 2) / height
    stretches = []
    for level, (begin, blend, until) in enumerate(ends):
        if begin < blend:
            stretches.append(Stretch(level, begin / per_depth, blend / per_depth))
        stretches.append(Stretch(level, blend / per_depth, until / per_depth, 0.0, 1.0))
    return [*stretches, Stretch(last, stretches[-1].end if stretches else -np.inf)]


@dataclass(frozen=True, kw_only=True)
class LevelCast(Cast):
    """What the rays see.

    `voxels` are those of the level in which the surface is seen, or else possible; without any,
    those of the volume.

    Attributes
    ----------
    level
        in which the surface is seen, the finer one where two blend; 0 where a conservative ray
        has looked at the volume itself; -1 of misses.
    """

    level: np.ndarray


def cast(
    pyramid: Pyramid,
    isovalue: float,
    camera: Camera,
    size: tuple[int, int],
    *,
    tolerance: float = 1.0,
    conservative: bool = False,
    slack: Slack = _EXACT,
    clip: tuple[float, float] = (0.0, np.inf),
    pixels: np.ndarray | None = None,
) -> LevelCast:
    """Cast one ray through the centre of each of the image's pixels, or of some.

    Parameters
    ----------
    pyramid : Pyramid
    isovalue : float
    camera : Camera
    size : (int, int)
        width and height of the image.
    tolerance : float
        how many pixels a level's samples may be apart.
    conservative : bool
        whether rays look at the volume itself where coarser levels show nothing.
    slack : Slack
        its positions are in voxels of each level.
    clip : (float, float)
        distances of the clipping planes, across the view, between which the rays go.
    pixels : array of int, optional
        counted through the rows from the top: the only ones that are cast; the result is a list of
        them.

    Returns
    -------
    LevelCast
    """
    stretches = find_stretches(pyramid, camera, size[1], tolerance)
    origins, directions = camera.rays(size, pixels)
    across = directions @ camera.forward
    start, step = index_rays(pyramid.volume, origins, directions)
    grids = pyramid.grids(float(isovalue), slack)
    kind = _ConservativeWay if conservative else _Way
    way = kind(pyramid, grids, stretches, start, step, across)
    hits = cast_at_box(
        way.grids[0].size, start, step, clip[0] / across, clip[1] / across, slack, way.walk
    )
    early, depth, late = hits
    level = np.where(way.finest, 0, _level_at(stretches, depth * across))
    level[np.isinf(depth)] = -1
    first = np.where(np.isinf(depth), early, depth)
    nearest = np.where(np.isinf(first) | way.finest, 0, _level_at(stretches, first * across))
    voxels = np.linalg.norm(step / np.array(pyramid.steps)[nearest].T, axis=0)
    result = LevelCast(depth, early, late, voxels, pyramid.volume.spacing, level=level)
    return result.reshape((size[1], size[0]) if pixels is None else (-1,))


def _level_at(stretches: Sequence[Stretch], depth: np.ndarray) -> np.ndarray:
    ends = [stretch.end for stretch in stretches[:-1]]
    return np.array([stretch.level for stretch in stretches])[
        np.searchsorted(ends, depth, side="right")
    ]


@dataclass(frozen=True)
class _Way:
    """Takes rays through all stretches; `start` and `step` are in the volume's index space."""

    pyramid: Pyramid
    grids: list[Grid]
    stretches: list[Stretch]
    start: np.ndarray
    step: np.ndarray
    across: np.ndarray

    @cached_property
    def finest(self) -> np.ndarray:
        """Mark the rays that hit where they look at the volume itself."""
        return np.zeros(len(self.across), bool)

    def walk(self, rays: np.ndarray, enter: np.ndarray, leave: np.ndarray) -> np.ndarray:
        """Return `early`, `depth` and `late` of some rays, between the distances given."""
        progress = Progress.none(len(rays))
        for stretch in self.stretches:
            begin = np.maximum(enter, stretch.begin / self.across[rays])
            end = np.minimum(leave, stretch.end / self.across[rays])
            there = np.flatnonzero((begin <= end) & np.isinf(progress.hits[2]))
            if len(there):
                part = progress.of(there)
                self._cross(stretch, rays[there], begin[there], end[there], part)
                progress.update(there, part)
        return progress.result()

    def _cross(
        self,
        stretch: Stretch,
        rays: np.ndarray,
        begin: np.ndarray,
        end: np.ndarray,
        progress: Progress,
    ) -> None:
        """Take rays through a part of a stretch."""
        self._walk_of(stretch, rays, begin, end, progress).run()

    def _walk_of(
        self,
        stretch: Stretch,
        rays: np.ndarray,
        begin: np.ndarray,
        end: np.ndarray,
        progress: Progress,
    ) -> Walk:
        grid, steps = self.grids[stretch.level], self.pyramid.steps
        scale = steps[stretch.level][:, None]
        way = (self.start[:, rays] / scale, self.step[:, rays] / scale, begin, end, progress)
        if not stretch.blends:
            return Walk(grid, *way)
        depths = begin * self.across[rays], end * self.across[rays]
        return _BlendingWalk(
            grid,
            *way,
            coarse=self.grids[stretch.level + 1],
            ratio=steps[stretch.level + 1] // steps[stretch.level],
            weights=(stretch.weight(depths[0]), stretch.weight(depths[1])),
        )


class _ConservativeWay(_Way):
    """Looks at the volume itself in blocks that rays pass without a hit."""

    def _cross(
        self,
        stretch: Stretch,
        rays: np.ndarray,
        begin: np.ndarray,
        end: np.ndarray,
        progress: Progress,
    ) -> None:
        if stretch.level == 0 and not stretch.blends:
            super()._cross(stretch, rays, begin, end, progress)
            return
        start, step = self.start[:, rays], self.step[:, rays]
        side = BLOCK_SIDE * self.pyramid.steps[stretch.level][:, None]
        block = np.floor((start + begin * step) / side)
        at, going = begin.copy(), np.arange(len(rays))
        while len(going):
            plane = (block[:, going] + (step[:, going] > 0)) * side
            with np.errstate(divide="ignore", invalid="ignore"):
                exits = (plane - start[:, going]) / step[:, going]
            exits[step[:, going] == 0] = np.inf
            axis = np.argmin(exits, axis=0)
            leave = np.clip(exits.min(axis=0), at[going], end[going])
            part = progress.of(going)
            super()._cross(stretch, rays[going], at[going], leave, part)
            self._look_within(rays[going], at[going], leave, part)
            progress.update(going, part)
            at[going] = leave
            block[axis, going] += np.sign(step[axis, going])
            going = going[(leave < end[going]) & np.isinf(part.hits[2])]

    def _look_within(
        self, rays: np.ndarray, begin: np.ndarray, end: np.ndarray, progress: Progress
    ) -> None:
        """Have rays without a certain hit look at the volume itself between two distances."""
        passing = np.flatnonzero(np.isinf(progress.hits[2]))
        some = rays[passing]
        walk = Walk(
            self.grids[0], self.start[:, some], self.step[:, some], begin[passing], end[passing]
        )
        walk.run()
        early, depth, late = walk.progress.result()
        before = progress.hits[:, passing]
        # a ray that rounding may have hit before hits here at the latest
        latest = np.where(np.isinf(before[0]), late, end[passing])
        progress.hits[0, passing] = np.minimum(before[0], early)
        progress.hits[2, passing] = np.where(np.isinf(late), np.inf, latest)
        new = np.isinf(before[1]) & np.isfinite(depth)
        progress.hits[1, passing[new]] = depth[new]
        self.finest[some[new]] = True


class _BlendingWalk(Walk):
    """Walks through the cells of a level while it goes over to the next.

    Parameters
    ----------
    way
        As of `Walk`.
    coarse : Grid
        The next level.
    ratio : array [3]
        Samples of the level from one of the next to another.
    weights : (array [n], array [n])
        Of the next level, where rays enter and leave.
    """

    def __init__(
        self,
        *way: Any,
        coarse: Grid,
        ratio: np.ndarray,
        weights: tuple[np.ndarray, np.ndarray],
    ) -> None:
        super().__init__(*way)
        self.coarse = coarse
        self.ratio = ratio[:, None]
        self.weights = weights

    def _coarse_corner(self, rays: np.ndarray) -> np.ndarray:
        return self._corner(rays) // self.ratio

    def _coarse_index(self, rays: np.ndarray) -> np.ndarray:
        return self.coarse.strides @ self._coarse_corner(rays)

    def _weight(self, rays: np.ndarray, distance: np.ndarray) -> np.ndarray:
        """Return the next level's weight at distances from where rays enter."""
        length, (first, last) = self.leave[rays], (weight[rays] for weight in self.weights)
        with np.errstate(invalid="ignore"):
            share = np.where(length > 0, distance / length, 0.0)
        return first + share * (last - first)

    def _hidden(self, rays: np.ndarray) -> np.ndarray | None:
        """Mark the rays whose cells are hidden in either level."""
        hidden = super()._hidden(rays)
        if self.coarse.hidden is None:
            return hidden
        coarse = self.coarse.hidden[self._coarse_index(rays)]
        return coarse if hidden is None else coarse | hidden

    def _matters(self, rays: np.ndarray) -> np.ndarray:
        """Return the bits of both cells: a blend lies between what their corners have."""
        bits = super()._matters(rays) | self.coarse.matters[self._coarse_index(rays)]
        hidden = self._hidden(rays)
        return bits if hidden is None else np.where(hidden, 0, bits)

    def _field(self, rays: np.ndarray, far: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Blend the cubics of both levels, from `near` to `far`."""
        near = self.near[rays]
        fine, fine_error = super()._field(rays, far)
        start, step = self.start[:, rays] / self.ratio, self.step[:, rays] / self.ratio
        coarse, coarse_error = self.coarse.cubics(
            self._coarse_corner(rays), start + near * step, start + far * step
        )
        weight = np.linspace(self._weight(rays, near), self._weight(rays, far), 4)
        blend = (1 - weight) * _to_bernstein(fine) + weight * _to_bernstein(coarse)
        return _from_bernstein(blend), fine_error + coarse_error


def _to_bernstein(cubic: np.ndarray) -> np.ndarray:
    """Take coefficients [4, n] of powers to those of Bernstein's polynomials."""
    constant, linear, square, cube = cubic
    return np.stack(
        [
            constant,
            constant + linear / 3,
            constant + (2 * linear + square) / 3,
            constant + linear + square + cube,
        ]
    )


def _from_bernstein(cubic: np.ndarray) -> np.ndarray:
    """Take coefficients [4, n] of Bernstein's polynomials to those of powers."""
    a, b, c, d = cubic
    return np.stack([a, 3 * (b - a), 3 * ((c - b) - (b - a)), (d - a) - 3 * (c - b)])
