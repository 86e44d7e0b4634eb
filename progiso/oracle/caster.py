"""Cast rays at the exact trilinear isosurface, on the CPU in double precision.

Every ray visits each cell that it crosses, found by an exact grid walk. Inside a cell the trilinear
interpolant along a ray is a cubic; its extrema split the ray's way through the cell into monotone
pieces, so that no root can be missed, double ones included. The surface lies where ``f >=
isovalue`` changes along the ray within the volume; the volume's border has no caps.

Rounding decides what a ray sees where its profile grazes the isovalue, and no caster in single
precision can be asked to decide such a ray as this one does. So every ray is cast three times in
one walk: for the isovalue itself (`Cast.depth`), and for the first place where the other side is
*possible* (`Cast.early`) and where it is *certain* (`Cast.late`) if every value may be off by the
`Slack` given. A correct depth lies between the two, and may be a miss only if no crossing is
certain.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from typing_extensions import Self
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkRenderingCore import vtkCamera

FLOAT32_ULP = 2.0**-24
CHUNK = 1 << 16
_SAME_AXES, _SAME_PLACE = np.eye(3), np.eye(4)


@dataclass(frozen=True)
class Slack:
    """Bounds what rounding may do to a caster in single precision.

    Attributes
    ----------
    value
        error of an interpolated value, in units in the last place (float32) of the cell's largest
        difference from the isovalue.
    position
        error of a sample's position, in voxels.
    """

    value: float = 0.0
    position: float = 0.0


@dataclass(frozen=True)
class Volume:
    """Holds samples and where they are.

    Attributes
    ----------
    values
        array [z, y, x] of the samples.
    index_to_world
        4x4 matrix that takes an array index (x, y, z) to world coordinates.
    hidden
        array [z, y, x] of booleans, one a cell: where there is no surface; samples that only such
        cells have need not be finite.
    """

    values: np.ndarray
    index_to_world: np.ndarray
    hidden: np.ndarray | None = None

    @classmethod
    def from_geometry(
        cls,
        values: np.ndarray,
        origin: Sequence[float] = (0, 0, 0),
        spacing: Sequence[float] = (1, 1, 1),
        direction: np.ndarray | Sequence[Sequence[float]] = _SAME_AXES,
        extent_start: Sequence[int] = (0, 0, 0),
        user: np.ndarray = _SAME_PLACE,
        shift: float = 0.0,
    ) -> Volume:
        """Place `values` as ``vtkImageData`` does; `shift` is 0.5 where they belong to cells."""
        matrix = np.eye(4)
        matrix[:3, :3] = np.asarray(direction, float).reshape(3, 3) * np.asarray(spacing, float)
        matrix[:3, 3] = np.asarray(origin, float) + matrix[:3, :3] @ (
            np.asarray(extent_start, float) + shift
        )
        return cls(np.asarray(values), np.asarray(user, float) @ matrix)

    @classmethod
    def from_image(
        cls,
        values: np.ndarray,
        image: vtkImageData,
        user: np.ndarray = _SAME_PLACE,
        shift: float = 0.0,
    ) -> Volume:
        """Place `values` where an image lies; `user` and `shift` as in `from_geometry`."""
        direction = image.GetDirectionMatrix()
        matrix = [[direction.GetElement(r, c) for c in range(3)] for r in range(3)]
        start = image.GetExtent()[::2]
        return cls.from_geometry(
            values, image.GetOrigin(), image.GetSpacing(), matrix, start, user, shift
        )

    @property
    def spacing(self) -> float:
        """Return the largest of the axes' spacings, in world units."""
        return float(np.linalg.norm(self.index_to_world[:3, :3], axis=0).max())


@dataclass(frozen=True)
class Camera:
    """Makes rays as a VTK camera does: through pixel centres, from the top row on."""

    position: tuple[float, ...]
    focal_point: tuple[float, ...]
    view_up: tuple[float, ...] = (0.0, 1.0, 0.0)
    view_angle: float = 30.0
    parallel_scale: float | None = None

    @classmethod
    def from_vtk(cls, camera: vtkCamera) -> Camera:
        """Copy a ``vtkCamera``."""
        return cls(
            camera.GetPosition(),
            camera.GetFocalPoint(),
            camera.GetViewUp(),
            camera.GetViewAngle(),
            camera.GetParallelScale() if camera.GetParallelProjection() else None,
        )

    @property
    def forward(self) -> np.ndarray:
        """Return the unit vector perpendicular to the image plane."""
        return _unit(np.subtract(self.focal_point, self.position, dtype=float))

    def rays(
        self, size: tuple[int, int], pixels: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Make origins and unit directions, each [height * width, 3], of an image's rays.

        `size` is width and height. `pixels`, counted through the rows from the top, has only some
        of the rays made.
        """
        width, height = size
        position, forward = np.asarray(self.position, float), self.forward
        right = _unit(np.cross(forward, np.asarray(self.view_up, float)))
        up = np.cross(right, forward)
        row, column = np.divmod(
            np.arange(width * height) if pixels is None else np.asarray(pixels), width
        )
        x, y = (column + 0.5) / width * 2 - 1, 1 - (row + 0.5) / height * 2
        offset = x.reshape(-1, 1) * (width / height) * right + y.reshape(-1, 1) * up
        if self.parallel_scale is not None:
            return position + self.parallel_scale * offset, np.broadcast_to(forward, offset.shape)
        directions = forward + np.tan(np.radians(self.view_angle) / 2) * offset
        return np.broadcast_to(position, offset.shape), directions / np.linalg.norm(
            directions, axis=1, keepdims=True
        )


@dataclass(frozen=True)
class Cast:
    """What the rays see, in arrays of the image's shape.

    Distances are in world units; `inf` is a miss.

    Attributes
    ----------
    depth
        distance along the ray to the surface.
    early, late
        first distance at which the surface is possible and certain, given the slack.
    voxels
        voxels (length in index space) that a ray goes in one world unit.
    spacing
        of the axis with the largest one, in world units.
    """

    depth: np.ndarray
    early: np.ndarray
    late: np.ndarray
    voxels: np.ndarray
    spacing: float = 0.0

    def reshape(self, shape: tuple[int, ...]) -> Self:
        """Return the same with arrays of another shape."""
        arrays: dict[str, Any] = {
            name: value.reshape(shape)
            for name, value in vars(self).items()
            if isinstance(value, np.ndarray)
        }
        return replace(self, **arrays)


def cast(
    volume: Volume,
    isovalue: float,
    camera: Camera,
    size: tuple[int, int],
    *,
    slack: Slack = Slack(),
    clip: tuple[float, float] = (0.0, np.inf),
    pixels: np.ndarray | None = None,
) -> Cast:
    """Cast one ray through the centre of each of the image's pixels, or of some.

    Parameters
    ----------
    volume : Volume
    isovalue : float
    camera : Camera
    size : (int, int)
        width and height of the image.
    slack : Slack
    clip : (float, float)
        distances of the clipping planes, across the view, between which the rays go.
    pixels : array of int, optional
        counted through the rows from the top: the only ones that are cast; the result is a list of
        them.

    Returns
    -------
    Cast
    """
    origins, directions = camera.rays(size, pixels)
    across = directions @ camera.forward
    begin, end = clip[0] / across, clip[1] / across
    result = cast_rays(volume, isovalue, origins, directions, slack=slack, begin=begin, end=end)
    return result.reshape((size[1], size[0]) if pixels is None else (-1,))


def cast_rays(
    volume: Volume,
    isovalue: float,
    origins: np.ndarray,
    directions: np.ndarray,
    *,
    slack: Slack = Slack(),
    begin: np.ndarray | float = 0.0,
    end: np.ndarray | float = np.inf,
) -> Cast:
    """Cast the rays ``origins + t * directions``, t from `begin` to `end`; see `cast`.

    Directions have unit length.
    """
    grid = Grid(volume, float(isovalue), slack)
    start, step = index_rays(volume, origins, directions)

    def walk(rays: np.ndarray, enter: np.ndarray, leave: np.ndarray) -> np.ndarray:
        walk = Walk(grid, start[:, rays], step[:, rays], enter, leave)
        walk.run()
        return walk.progress.result()

    hits = cast_at_box(grid.size, start, step, begin, end, slack, walk)
    return Cast(hits[1], hits[0], hits[2], np.linalg.norm(step, axis=0), volume.spacing)


@dataclass(frozen=True)
class Crossings:
    """Where rays cross isosurfaces, one entry a crossing.

    The crossings of a ray are together, in their order along it.

    Attributes
    ----------
    ray
        number of the ray, counted through the image's rows from the top.
    depth
        distance along the ray.
    surface
        number of the isovalue.
    """

    ray: np.ndarray
    depth: np.ndarray
    surface: np.ndarray

    def only(self, kept: np.ndarray) -> Crossings:
        """Return the crossings that a mask keeps."""
        return Crossings(self.ray[kept], self.depth[kept], self.surface[kept])


def cast_all(
    volume: Volume,
    isovalues: Sequence[float],
    camera: Camera,
    size: tuple[int, int],
    clip: tuple[float, float] = (0.0, np.inf),
) -> Crossings:
    """Find all crossings of the image's rays with the surfaces of several isovalues; see `cast`.

    Returns
    -------
    Crossings
    """
    origins, directions = camera.rays(size)
    across = directions @ camera.forward
    start, step = index_rays(volume, origins, directions)
    enter, leave = clip_to_box(
        start,
        step,
        clip[0] / across,
        clip[1] / across,
        np.zeros(3),
        np.array(volume.values.shape[::-1]) - 1.0,
    )
    rays = np.flatnonzero(enter <= leave)
    parts = []
    for number, isovalue in enumerate(isovalues):
        grid = Grid(volume, float(isovalue), Slack())
        found = _FullWalk(grid, start[:, rays], step[:, rays], enter[rays], leave[rays]).crossings()
        parts.append((rays[found[0]], found[1], np.full(len(found[0]), number)))
    ray, depth, surface = (np.concatenate(part) for part in zip(*parts))
    order = np.lexsort((depth, ray))
    return Crossings(ray[order], depth[order], surface[order])


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


# --- the grid -------------------------------------------------------------------------------------


class Grid:
    """Holds the samples and which cells matter to a ray that started inside or outside.

    What else a ray has to know of a cell is made when it gets there, so that a volume takes little
    more memory than its samples.
    """

    def __init__(self, volume: Volume, isovalue: float, slack: Slack) -> None:
        values = volume.values
        if volume.hidden is not None:
            values = np.where(_touched(~volume.hidden), values, 0)
        if values.ndim != 3 or min(values.shape) < 2:
            raise ValueError(
                f"at least two samples are needed along each axis, got shape {values.shape}"
            )
        if not all(np.isfinite(values[z]).all() for z in range(len(values))):
            raise ValueError("the volume holds values that are not finite")
        self.size = np.array(values.shape[::-1])
        self.strides = np.array([1, self.size[0], self.size[0] * self.size[1]])
        self.samples = values.ravel()
        self.isovalue = isovalue
        self.slack = slack
        self.offsets = np.array(
            [sum(d for d, bit in zip(self.strides, name) if bit == "1") for name in _CORNERS]
        )
        # Cells are stored like samples, so that one index finds both.
        matters = np.zeros(values.shape, np.uint8)
        for z in range(0, len(values) - 1, _SLAB):
            cells = self._matters(values[z : z + _SLAB + 1])
            matters[z : z + len(cells), :-1, :-1] = cells
        self.hidden = None
        if volume.hidden is not None:
            matters[:-1, :-1, :-1][volume.hidden] = 0
            self.hidden = np.pad(volume.hidden, ((0, 1),) * 3).ravel()
        self.matters = matters.ravel()

    def _matters(self, values: np.ndarray) -> np.ndarray:
        """Mark the cells between samples [z, y, x] that can matter."""
        excess = values.astype(float) - self.isovalue
        low, high = _cell_extremes(excess, np.minimum), _cell_extremes(excess, np.maximum)
        error = self._error(low, high)
        # Bit 0: a ray that started inside can get out here. Bit 1: one that started outside can get
        # in.
        matters = (low <= error).astype(np.uint8) | ((high >= -error).astype(np.uint8) << 1)
        # Bits 2 and 3: the same without any error. A cell at or above the isovalue throughout is
        # not left for rounding's sake.
        return matters | ((low < 0).astype(np.uint8) << 2) | ((high >= 0).astype(np.uint8) << 3)

    def _error(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Bound the error in cells whose corners exceed the isovalue by `low` to `high`."""
        largest = np.maximum(np.abs(low), np.abs(high))
        return self.slack.value * FLOAT32_ULP * largest + self.slack.position * (high - low)

    def cells(self, index: np.ndarray) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Make the trilinear polynomials of cells, keyed by their variables, and their errors."""
        excess = self.samples[index + self.offsets[:, None]].astype(float) - self.isovalue
        c = dict(zip(_CORNERS, excess))
        polynomials = {
            "": c["000"],
            "x": c["100"] - c["000"],
            "y": c["010"] - c["000"],
            "z": c["001"] - c["000"],
            "xy": c["110"] - c["100"] - c["010"] + c["000"],
            "xz": c["101"] - c["100"] - c["001"] + c["000"],
            "yz": c["011"] - c["010"] - c["001"] + c["000"],
            "xyz": (c["111"] - c["110"] - c["101"] + c["100"])
            - (c["011"] - c["010"] - c["001"] + c["000"]),
        }
        return polynomials, self._error(excess.min(axis=0), excess.max(axis=0))

    def cubics(
        self, corner: np.ndarray, first: np.ndarray, last: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Make the cubics between two places in cells, given by their corners; see `_along`.

        All are columns, in index space. Their errors come with them.
        """
        a, b = np.clip(first - corner, 0, 1), np.clip(last - corner, 0, 1)
        cells, error = self.cells(self.strides @ corner)
        return _along(cells, a, b - a), error


_CORNERS = [f"{i:03b}" for i in range(8)]

#: Layers of cells that are looked at together while a volume is prepared.
_SLAB = 16


def _touched(cells: np.ndarray) -> np.ndarray:
    """Mark the samples that are corners of marked cells."""
    samples = np.zeros(np.array(cells.shape) + 1, bool)
    for corner in np.ndindex(2, 2, 2):
        samples[tuple(slice(c, c + n) for c, n in zip(corner, cells.shape))] |= cells
    return samples


def _cell_extremes(samples: np.ndarray, pick: np.ufunc) -> np.ndarray:
    for axis in range(3):
        head = [slice(None)] * 3
        tail = [slice(None)] * 3
        head[axis], tail[axis] = slice(None, -1), slice(1, None)
        samples = pick(samples[tuple(head)], samples[tuple(tail)])
    return samples


# --- a ray's way through the grid -----------------------------------------------------------------


def clip_to_box(
    start: np.ndarray,
    step: np.ndarray,
    begin: np.ndarray | float,
    end: np.ndarray | float,
    low: np.ndarray,
    high: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Find where rays enter and leave a box; they miss it where ``enter > leave``.

    Rays are columns of `start` and `step`, and go from `begin` to `end`.
    """
    near, far = np.asarray(begin), np.asarray(end)
    for axis in range(3):
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = (low[axis] - start[axis]) / step[axis], (high[axis] - start[axis]) / step[axis]
        parallel = step[axis] == 0
        between = (start[axis] >= low[axis]) & (start[axis] <= high[axis])
        near = np.maximum(
            near, np.where(parallel, np.where(between, -np.inf, np.inf), np.minimum(a, b))
        )
        far = np.minimum(
            far, np.where(parallel, np.where(between, np.inf, -np.inf), np.maximum(a, b))
        )
    return near, far


def index_rays(
    volume: Volume, origins: np.ndarray, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Take rays to index space; origins and directions are columns there."""
    to_index = np.linalg.inv(volume.index_to_world[:3, :3])
    start = (np.asarray(origins, float) - volume.index_to_world[:3, 3]) @ to_index.T
    return start.T, (np.asarray(directions, float) @ to_index.T).T


def cast_at_box(
    size: np.ndarray,
    start: np.ndarray,
    step: np.ndarray,
    begin: np.ndarray | float,
    end: np.ndarray | float,
    slack: Slack,
    walk: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray],
) -> np.ndarray:
    """Cast rays given in index space at a volume of `size` samples.

    `walk` takes the numbers of some rays that meet the volume, and where they enter and leave it.

    Returns
    -------
    array [3, n]
        `early`, `depth` and `late`, as `walk` returns them of its rays.
    """
    count = start.shape[1]
    begin, end = np.broadcast_to(begin, count), np.broadcast_to(end, count)
    last = (size - 1).astype(float)
    hits = np.full((3, count), np.inf)
    enter, leave = clip_to_box(start, step, begin, end, np.zeros(3), last)
    if slack.position:
        # A ray that just touches or just misses the box may have either result in another caster.
        touch, off = clip_to_box(
            start, step, begin, end, np.full(3, -slack.position), last + slack.position
        )
        core, out = clip_to_box(
            start, step, begin, end, np.full(3, slack.position), last - slack.position
        )
        edge = (touch <= off) & (core > out)
        hits[0, edge] = touch[edge]
    meeting = np.flatnonzero(enter <= leave)
    for chunk in range(0, len(meeting), CHUNK):
        rays = meeting[chunk : chunk + CHUNK]
        found = walk(rays, enter[rays], leave[rays])
        hits[:, rays] = np.stack([np.minimum(hits[0, rays], found[0]), found[1], found[2]])
    if slack.position:
        hits[2, edge] = np.inf
    return hits


@dataclass
class Progress:
    """What is known of rays on their way.

    Attributes
    ----------
    hits
        array [3, n] of `early`, `depth` and `late` so far.
    side
        +1 of rays that began inside, -1 of those outside, 0 while that is not known.
    unsure
        marks rays on whose side rounding decides: they may cross anywhere or nowhere.
    """

    hits: np.ndarray
    side: np.ndarray
    unsure: np.ndarray

    @classmethod
    def none(cls, count: int) -> Progress:
        """Begin with so many rays."""
        return cls(np.full((3, count), np.inf), np.zeros(count), np.zeros(count, bool))

    def of(self, rays: np.ndarray) -> Progress:
        """Copy what is known of some rays."""
        return Progress(self.hits[:, rays], self.side[rays], self.unsure[rays])

    def update(self, rays: np.ndarray, progress: Progress) -> None:
        """Set what is known of some rays."""
        self.hits[:, rays] = progress.hits
        self.side[rays], self.unsure[rays] = progress.side, progress.unsure

    def result(self) -> np.ndarray:
        """Return the hits of rays that have come to their end."""
        hits = self.hits.copy()
        hits[2, self.unsure] = np.inf
        return hits


class Walk:
    """Walks rays from cell to cell, to their last crossing or to where they leave.

    Parameters
    ----------
    grid : Grid
    start, step : array [3, n]
        The rays' origins and directions, in the grid's index space.
    enter, leave : array [n]
        Distances between which the rays go, within the volume.
    progress : Progress, optional
        Of rays that have come some way before; it is carried on.
    """

    def __init__(
        self,
        grid: Grid,
        start: np.ndarray,
        step: np.ndarray,
        enter: np.ndarray,
        leave: np.ndarray,
        progress: Progress | None = None,
    ) -> None:
        self.grid = grid
        self.enter = enter
        # Distances count from the entry, so that a far camera costs no digits.
        self.start = start + enter * step
        self.step = step
        self.leave = leave - enter
        self.progress = progress = progress or Progress.none(len(enter))
        self.hits, self.side, self.unsure = progress.hits, progress.side, progress.unsure
        cells = np.clip(np.floor(self.start), 0, (grid.size - 2)[:, None]).astype(np.int64)
        self.index = grid.strides @ cells
        self.near = np.zeros(len(enter))
        forward = step > 0
        self.plane = (cells + forward).astype(float)
        self.left = np.where(forward, (grid.size - 2)[:, None] - cells, cells)
        self.sign = np.where(forward, 1, -1)
        with np.errstate(divide="ignore", invalid="ignore"):
            self.inverse = 1.0 / step
            self.far = np.where(step == 0, np.inf, (self.plane - self.start) / step)

    def _find_sides(self, rays: np.ndarray) -> None:
        """Set +1 for rays that are inside where they are, and -1 for those outside.

        Where rounding decides, any outcome is possible. A ray in a hidden cell keeps 0 until it
        comes out.
        """
        hidden = self._hidden(rays)
        if hidden is not None:
            self.side[rays[hidden]] = 0
            rays = rays[~hidden]
        rays = rays[self.side[rays] == 0]
        if not len(rays):
            return
        cubic, error = self._field(rays, self.near[rays])
        excess = cubic[0]
        unsure = rays[(np.abs(excess) <= error) & (error > 0)]
        self.unsure[unsure] = True
        self.hits[0, unsure] = np.minimum(
            self.hits[0, unsure], self.enter[unsure] + self.near[unsure]
        )
        self.side[rays] = np.where(excess >= 0, 1.0, -1.0)

    def _corner(self, rays: np.ndarray) -> np.ndarray:
        index, (_, sy, sz) = self.index[rays], self.grid.strides
        return np.stack([index % sy, index % sz // sy, index // sz])

    def _hidden(self, rays: np.ndarray) -> np.ndarray | None:
        """Mark the rays whose cells are hidden; None where none can be."""
        return None if self.grid.hidden is None else self.grid.hidden[self.index[rays]]

    def _matters(self, rays: np.ndarray) -> np.ndarray:
        """Return the bits of the rays' cells that tell what they can matter for; see `Grid`."""
        return self.grid.matters[self.index[rays]]

    def _field(self, rays: np.ndarray, far: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Make the cubics of rays in their cells from `near` to `far`, and their errors."""
        start, step = self.start[:, rays], self.step[:, rays]
        return self.grid.cubics(
            self._corner(rays), start + self.near[rays] * step, start + far * step
        )

    def run(self) -> None:
        """Walk all rays to their end."""
        rays = np.arange(len(self.enter))
        while len(rays):
            self._find_sides(rays)
            axis = np.argmin(self.far[:, rays], axis=0)
            far = np.maximum(np.minimum(self.far[axis, rays], self.leave[rays]), self.near[rays])
            bit = np.where(self.side[rays] > 0, 1, 2)
            at = np.flatnonzero(self._matters(rays) & bit)
            if len(at):
                self._intersect(rays[at], far[at])
            self.near[rays] = far
            rays = self._advance(rays, axis)

    def _advance(self, rays: np.ndarray, axis: np.ndarray) -> np.ndarray:
        """Step to the next cells; return the rays that have one and still look for a crossing."""
        go = (
            (self.left[axis, rays] > 0)
            & (self.hits[2, rays] == np.inf)
            & (self.far[axis, rays] < self.leave[rays])
        )
        rays, axis = rays[go], axis[go]
        sign = self.sign[axis, rays]
        self.index[rays] += sign * self.grid.strides[axis]
        self.left[axis, rays] -= 1
        self.plane[axis, rays] += sign
        self.far[axis, rays] = (self.plane[axis, rays] - self.start[axis, rays]) * self.inverse[
            axis, rays
        ]
        return rays

    def _intersect(self, rays: np.ndarray, far: np.ndarray) -> None:
        """Look for the crossings of rays in their cells, between the distances `near` and `far`."""
        near, side = self.near[rays], self.side[rays]
        cubic, error = self._field(rays, far)
        cubic = cubic * side
        knots = _monotone_knots(cubic)
        values = _evaluate(cubic[:, None, :], knots)
        exact = (self._matters(rays) & np.where(side > 0, 4, 8)) != 0
        for row, threshold in enumerate((error, np.zeros_like(error), -error)):
            # Equal to the isovalue is inside: reached from outside, not left from inside.
            crossed = np.where(
                (side > 0) & (threshold == 0), values < threshold, values <= threshold
            )
            if row == 1:
                crossed &= exact
            new = np.flatnonzero(crossed.any(axis=0) & (self.hits[row, rays] == np.inf))
            if len(new):
                s = _first_root(cubic[:, new], knots[:, new], crossed[:, new], threshold[new])
                self.hits[row, rays[new]] = (
                    self.enter[rays[new]] + near[new] + s * (far[new] - near[new])
                )


class _FullWalk(Walk):
    """Walks on through all crossings, in both directions."""

    def crossings(self) -> list[np.ndarray]:
        """Return the rays and the distances of all crossings."""
        self.found: list[tuple[np.ndarray, np.ndarray]] = []
        rays = np.arange(len(self.enter))
        while len(rays):
            axis = np.argmin(self.far[:, rays], axis=0)
            far = np.maximum(np.minimum(self.far[axis, rays], self.leave[rays]), self.near[rays])
            at = np.flatnonzero((self.grid.matters[self.index[rays]] & 12) == 12)
            self._collect(rays[at], far[at])
            self.near[rays] = far
            rays = self._advance(rays, axis)
        return [np.concatenate(part) for part in zip(*self.found)]

    def _collect(self, rays: np.ndarray, far: np.ndarray) -> None:
        """Collect crossings in the rays' cells, one at most a monotone piece of the cubic."""
        near = self.near[rays]
        cubic = self._field(rays, far)[0]
        knots = _monotone_knots(cubic)
        inside = _evaluate(cubic[:, None, :], knots) >= 0
        for piece in range(3):
            at = np.flatnonzero(inside[piece] != inside[piece + 1])
            falling = cubic[:, at] * np.where(inside[piece, at], 1, -1)
            there = np.repeat([[False], [True]], len(at), axis=1)
            s = _first_root(falling, knots[piece : piece + 2, at], there, np.zeros(len(at)))
            self.found.append(
                (rays[at], self.enter[rays[at]] + near[at] + s * (far[at] - near[at]))
            )


# --- the cubic along a ray ------------------------------------------------------------------------


def _along(c: dict[str, np.ndarray], a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Compute the coefficients [4, n] of the interpolants `c` at ``a + s * b``, constant first.

    Places are in the cell, from 0 to 1.
    """
    (ax, ay, az), (bx, by, bz) = a, b
    constant = (
        c[""] + c["x"] * ax + c["y"] * ay + c["z"] * az
        + c["xy"] * ax * ay + c["xz"] * ax * az + c["yz"] * ay * az + c["xyz"] * ax * ay * az
    )  # fmt: skip
    linear = (
        c["x"] * bx + c["y"] * by + c["z"] * bz
        + c["xy"] * (ax * by + ay * bx)
        + c["xz"] * (ax * bz + az * bx)
        + c["yz"] * (ay * bz + az * by)
        + c["xyz"] * (ax * ay * bz + ax * az * by + ay * az * bx)
    )  # fmt: skip
    square = (
        c["xy"] * bx * by + c["xz"] * bx * bz + c["yz"] * by * bz
        + c["xyz"] * (ax * by * bz + ay * bx * bz + az * bx * by)
    )  # fmt: skip
    return np.stack([constant, linear, square, c["xyz"] * bx * by * bz])


def _evaluate(cubic: np.ndarray, s: np.ndarray) -> np.ndarray:
    return ((cubic[3] * s + cubic[2]) * s + cubic[1]) * s + cubic[0]


def _monotone_knots(cubic: np.ndarray) -> np.ndarray:
    """Return [4, n] ascending: 0, the cubic's extrema (clipped to 0 to 1), 1."""
    c, b, a = cubic[1], 2 * cubic[2], 3 * cubic[3]
    root = np.sqrt(np.maximum(b * b - 4 * a * c, 0))
    q = -0.5 * (b + np.where(b < 0, -root, root))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        extrema = np.stack([q / a, c / q])
    extrema = np.sort(
        np.clip(np.nan_to_num(extrema, nan=0.0, posinf=1.0, neginf=0.0), 0, 1), axis=0
    )
    return np.concatenate([np.zeros((1, len(c))), extrema, np.ones((1, len(c)))])


def _first_root(
    cubic: np.ndarray, knots: np.ndarray, crossed: np.ndarray, threshold: np.ndarray
) -> np.ndarray:
    """Find where the cubic falls to the threshold; `crossed` marks the knots at which it has."""
    first = np.argmax(crossed, axis=0)
    column = np.arange(len(first))
    low, high = knots[np.maximum(first - 1, 0), column], knots[first, column]
    for _ in range(54):
        middle = 0.5 * (low + high)
        above = _evaluate(cubic, middle) > threshold
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return high
