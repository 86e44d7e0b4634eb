"""What a translucent picture should be: isosurfaces blended along the caster's rays."""

import numpy as np

from progiso.oracle.caster import cast_all


def places(crossings, volume, camera, size):
    """Return the crossings' places in index space."""
    origins, directions = camera.rays(size)
    world = origins[crossings.ray] + crossings.depth[:, None] * directions[crossings.ray]
    return to_index(volume, world)


def to_index(volume, world):
    """Return places of the world in index space."""
    inverse = np.linalg.inv(volume.index_to_world)
    return world @ inverse[:3, :3].T + inverse[:3, 3]


def regions(points, planes):
    """Return the numbers of the cropping regions, of 27, that points lie in."""
    low, high = np.array(planes[::2]), np.array(planes[1::2])
    return ((points > low).astype(int) + (points > high)) @ [1, 3, 9]


def kept(flags, numbers):
    """Tell which regions are drawn, by their numbers and the mapper's flags."""
    return (flags >> numbers & 1).astype(bool)


def crossings_of(volume, isovalues, camera, size, clip=(0.0, np.inf), cropping=None):
    """Find all crossings; with `cropping` (planes, flags) only those in regions that are drawn."""
    crossings = cast_all(volume, isovalues, camera, size, clip)
    if cropping is None:
        return crossings
    planes, flags = cropping
    return crossings.only(kept(flags, regions(places(crossings, volume, camera, size), planes)))


def blend(crossings, looks, background, size, end=np.inf):
    """Blend the layers that lie before `end`; `looks` are (red, green, blue, opacity).

    Return levels [row, column, rgb].
    """
    looks = np.asarray(looks, float)
    pixels = size[0] * size[1]
    color, opacity = np.zeros((pixels, 3)), np.zeros(pixels)
    first = np.searchsorted(crossings.ray, np.arange(pixels))
    count = np.searchsorted(crossings.ray, np.arange(pixels), side="right") - first
    end = np.broadcast_to(np.asarray(end, float).ravel(), pixels)
    for layer in range(count.max(initial=0)):
        rays = np.flatnonzero(count > layer)
        at = first[rays] + layer
        rays, at = rays[crossings.depth[at] < end[rays]], at[crossings.depth[at] < end[rays]]
        look = looks[crossings.surface[at]]
        share = (1 - opacity[rays]) * look[:, 3]
        color[rays] += share[:, None] * look[:, :3]
        opacity[rays] += share
    background = np.broadcast_to(np.asarray(background, float).reshape(-1, 3), (pixels, 3))
    return (255 * (color + (1 - opacity)[:, None] * background)).reshape(size[1], size[0], 3)


def capped(volume, isovalues, camera, size, cropping):
    """Mark the pixels where VTK's mapper shows a surface at the border of a region.

    It draws one wherever a ray comes back into a region that is drawn on another side than it left
    the last one, and none where the two make up for each other.
    """
    planes, flags = cropping
    origins, directions = camera.rays(size)
    points, ways = (
        to_index(volume, origins),
        directions @ np.linalg.inv(volume.index_to_world[:3, :3]).T,
    )
    last = np.array(volume.values.shape[::-1]) - 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        faces = np.stack(
            [
                (np.array([0.0, end]) - points[:, [axis]]) / ways[:, [axis]]
                for axis, end in enumerate(last)
            ]
        )
        inner = [
            (np.array(planes[2 * axis : 2 * axis + 2]) - points[:, [axis]]) / ways[:, [axis]]
            for axis in range(3)
        ]
    enter, leave = faces.min(axis=2).max(axis=0), faces.max(axis=2).min(axis=0)
    hit = enter < leave
    cuts = np.sort(
        np.clip(
            np.concatenate([*inner, enter[:, None], leave[:, None]], axis=1),
            enter[:, None],
            leave[:, None],
        )
    )
    state, caps = np.zeros(len(points), int), np.zeros(len(points), bool)
    was_drawn = np.zeros(len(points), bool)
    for begin, end in zip(cuts.T, cuts.T[1:]):
        middle = points + (0.5 * (begin + end))[:, None] * ways
        drawn = hit & (end - begin > 1e-9) & kept(flags, regions(middle, planes))
        at_begin, at_end = (
            side(volume, isovalues, points + t[:, None] * ways) for t in (begin, end)
        )
        starts = drawn & ~was_drawn & (begin > enter + 1e-9)
        caps |= starts & (at_begin != state)
        state = np.where(drawn, at_end, state)
        was_drawn = np.where(hit & (end - begin > 1e-9), drawn, was_drawn)
    return caps.reshape(size[1], size[0])


def side(volume, isovalues, points):
    """Count the isovalues below the interpolant at points in index space."""
    size = np.array(volume.values.shape[::-1])
    points = np.clip(np.nan_to_num(points), 0, size - 1)
    cell = np.minimum(points.astype(int), size - 2)
    u = points - cell
    value = np.zeros(len(points))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(np.array(corner) == 1, u, 1 - u), axis=1)
        x, y, z = (cell + corner).T
        value += weight * volume.values[z, y, x]
    return (value[:, None] > np.sort(isovalues)).sum(axis=1)
