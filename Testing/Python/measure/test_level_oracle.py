"""The caster of levels of detail against closed forms, dense sampling, and the caster itself."""

import math

import numpy as np
import pytest

from helpers.interpolation import interpolate
from progiso.measure import tolerances
from progiso.oracle import caster, levels
from progiso.oracle.caster import Camera, Slack, Volume
from progiso.oracle.levels import Level, Pyramid, find_stretches

SIZE = (32, 24)
ANGLE = 60.0

#: Distance between samples in pixels, at a depth of 1, in an image of that size and angle.
PITCH = 2 * math.tan(math.radians(ANGLE / 2)) / SIZE[1]

#: Part of a distance between samples at which a level begins to go over to the next.
QUARTER = 2**-0.25

HALVED = ((2, 2, 2), (4, 4, 4))


def pyramid_of(values_of, samples, steps=HALVED, matrix=None, hidden_of=None):
    """Make a pyramid of functions that take a level's number and its samples' places x, y, z."""
    made, before = [], (1, 1, 1)
    for number, step in enumerate([(1, 1, 1), *steps]):
        samples = [n if s == b else n // 2 + 1 for n, s, b in zip(samples, step, before)]
        z, y, x = np.indices(samples[::-1], dtype=float)
        values = values_of(number, x * step[0], y * step[1], z * step[2])
        cells = tuple(n - 1 for n in values.shape)
        made.append(Level(values, step, None if hidden_of is None else hidden_of(number, cells)))
        before = step
    matrix = np.eye(4) if matrix is None else matrix
    volume = Volume(made[0].values, matrix, made[0].hidden)
    return Pyramid(volume, tuple(made[1:]))


def unrelated(seed, samples, **options):
    """Make a pyramid whose levels have nothing in common."""
    rng = np.random.default_rng(seed)
    return pyramid_of(lambda _, x, y, z: rng.normal(size=x.shape), samples, **options)


def ramp(gradient, displacement=0.0):
    """Make a linear field; each level's is less by the displacement than the one's before."""

    def values_of(number, x, y, z):
        return gradient[0] * x + gradient[1] * y + gradient[2] * z - number * displacement

    return values_of


def rays_of(camera):
    """Return origins, directions and the cosines to the view direction, of the image's shape."""
    origins, directions = (part.reshape(*SIZE[::-1], 3) for part in camera.rays(SIZE))
    return origins, directions, directions @ camera.forward


def camera_at(distance, samples, aside=(0.11, 0.07), parallel_scale=None):
    """Look along x, and a little aside, from a distance before the volume's first sample."""
    middle = (np.array(samples) - 1) / 2
    position = (-distance, middle[1] * (1 - aside[0]), middle[2] * (1 + aside[1]))
    return Camera(position, tuple(middle), (0.1, 1.0, 0.2), ANGLE, parallel_scale)


def table(stretches):
    return [(s.level, s.begin, s.end, s.first_weight, s.last_weight) for s in stretches]


# --- which level is drawn where -------------------------------------------------------------------


def test_stretches_of_halves():
    """Samples twice as far apart are drawn from twice the depth on."""
    pyramid = unrelated(1, (20, 20, 20))
    found = table(find_stretches(pyramid, camera_at(30, (20, 20, 20)), SIZE[1], tolerance=0.5))
    two, four = 2 / (0.5 * PITCH), 4 / (0.5 * PITCH)
    expected = [
        (0, 0, QUARTER * two, 0, 0),
        (0, QUARTER * two, two, 0, 1),
        (1, two, QUARTER * four, 0, 0),
        (1, QUARTER * four, four, 0, 1),
        (2, four, math.inf, 0, 0),
    ]
    assert np.array(found) == pytest.approx(np.array(expected), rel=1e-12)


def test_stretches_of_an_anisotropic_volume():
    """Levels as far apart along their worst axis follow each other by a quarter of an octave."""
    matrix = np.diag([1.0, 1.0, 4.0, 1.0])
    steps = ((2, 2, 1), (4, 4, 1), (8, 8, 2))
    pyramid = unrelated(2, (40, 40, 10), steps=steps, matrix=matrix)
    found = table(find_stretches(pyramid, camera_at(30, (40, 40, 10)), SIZE[1]))
    four, eight = 4 / PITCH, 8 / PITCH
    expected = [
        (0, 0, QUARTER * four, 0, 0),
        (0, QUARTER * four, four, 0, 1),
        (1, four, four / QUARTER, 0, 1),
        (2, four / QUARTER, QUARTER * eight, 0, 0),
        (2, QUARTER * eight, eight, 0, 1),
        (3, eight, math.inf, 0, 0),
    ]
    assert np.array(found) == pytest.approx(np.array(expected), rel=1e-12)


@pytest.mark.parametrize("spacing", [1.0, 0.37])
def test_level_and_weight_grow_without_a_step(spacing):
    steps = ((2, 2, 1), (4, 4, 1), (8, 8, 2), (16, 16, 4))
    matrix = np.diag([spacing, spacing, 3.1 * spacing, 1.0])
    pyramid = unrelated(3, (70, 50, 40), steps=steps, matrix=matrix)
    stretches = find_stretches(pyramid, camera_at(1, (70, 50, 40)), SIZE[1])
    assert [s.begin for s in stretches[1:]] == [s.end for s in stretches[:-1]]
    drawn = np.concatenate(
        [s.level + s.weight(np.linspace(s.begin, s.end, 101)) for s in stretches[:-1]]
    )
    steps = np.diff(drawn)
    assert steps.min() >= 0 and steps.max() < 0.011
    assert drawn[0] == 0 and drawn[-1] == stretches[-1].level == 4


@pytest.mark.parametrize(
    ("pitch", "level", "weight"),
    [
        (1.0, 0, 0.0),
        (QUARTER * 2, 0, 0.0),
        (QUARTER * 2 * 0.75 + 2 * 0.25, 0, 0.25),
        (2.0, 1, 0.0),
        (QUARTER * 4 * 0.1 + 4 * 0.9, 1, 0.9),
        (4.0, 2, 0.0),
        (100.0, 2, 0.0),
    ],
)
def test_parallel_projection_has_one_stretch(pitch, level, weight):
    pyramid = unrelated(1, (20, 20, 20))
    camera = camera_at(30, (20, 20, 20), parallel_scale=pitch / 0.5 * SIZE[1] / 2)
    found = table(find_stretches(pyramid, camera, SIZE[1], tolerance=0.5))
    expected = [(level, -math.inf, math.inf, weight, weight)]
    assert np.array(found) == pytest.approx(np.array(expected), abs=1e-12)


# --- what rays see --------------------------------------------------------------------------------


@pytest.mark.parametrize("hidden", [False, True])
def test_one_level_is_the_volume(hidden):
    rng = np.random.default_rng(4)
    samples = (23, 18, 21)
    hide = (lambda _, cells: rng.uniform(size=cells) < 0.1) if hidden else None
    pyramid = unrelated(4, samples, steps=(), hidden_of=hide)
    for parallel_scale in (None, 11.0):
        camera = camera_at(30, samples, parallel_scale=parallel_scale)
        options = {"slack": tolerances.SLACK, "clip": (33.0, 47.0)}
        found = levels.cast(pyramid, 0.2, camera, SIZE, **options)
        expected = caster.cast(pyramid.volume, 0.2, camera, SIZE, **options)
        for name in ("depth", "early", "late", "voxels"):
            assert np.array_equal(getattr(found, name), getattr(expected, name)), name
        assert found.spacing == expected.spacing and np.isfinite(found.depth).sum() > 100
        assert np.array_equal(found.level, np.where(np.isfinite(found.depth), 0, -1))


def test_near_rays_see_the_volume_and_far_ones_the_last_level():
    samples = (21, 25, 29)
    pyramid = unrelated(5, samples)
    camera = camera_at(30, samples)
    last = Volume(pyramid.coarser[1].values, np.diag([4.0, 4, 4, 1]))
    for tolerance, number, volume in ((0.1, 0, pyramid.volume), (100, 2, last)):
        found = levels.cast(pyramid, 0.1, camera, SIZE, tolerance=tolerance, slack=tolerances.SLACK)
        expected = caster.cast(volume, 0.1, camera, SIZE, slack=tolerances.SLACK)
        hit = np.isfinite(expected.depth)
        assert np.array_equal(found.depth, expected.depth) and hit.sum() > 100
        assert np.array_equal(found.voxels[hit], expected.voxels[hit])
        assert np.array_equal(found.level, np.where(hit, number, -1))


@pytest.mark.parametrize("parallel_scale", [None, 45.0])
def test_ramp(parallel_scale):
    """All levels reproduce a linear field, and end where the volume does."""
    samples, gradient = (70, 41, 38), np.array([0.9, -0.3, 0.25])
    pyramid = pyramid_of(ramp(gradient), samples)
    camera = camera_at(25, samples, parallel_scale=parallel_scale)
    origins, directions, _ = rays_of(camera)
    seen = []
    for isovalue in (5.0, 30.0, 58.0):
        found = levels.cast(pyramid, isovalue, camera, SIZE)
        expected = (isovalue - origins @ gradient) / (directions @ gradient)
        place = origins + expected[..., None] * directions
        outside = np.maximum(-place, place - (np.array(samples) - 1)).max(axis=-1)
        hit, miss = outside < -1e-6, outside > 1e-6
        assert hit.sum() > 50 and miss.sum() > 50
        assert np.isfinite(found.depth[hit]).all() and np.isinf(found.depth[miss]).all()
        assert np.abs(found.depth - expected)[hit].max() < tolerances.ORACLE_EXACT
        seen.extend(found.level[hit])
    assert set(seen) == ({0, 1, 2} if parallel_scale is None else {1})


def test_even_axes_end_at_the_last_sample():
    """A plane between the volume's last sample and the level's is not seen."""
    pyramid = pyramid_of(lambda _, x, y, z: x, (20, 9, 9), steps=((2, 2, 2),))
    camera = Camera((-60.0, 4, 4), (0, 4, 4), parallel_scale=102.0)
    for isovalue, seen in ((18.99, True), (19.01, False)):
        found = levels.cast(pyramid, isovalue, camera, (101, 101))
        assert pyramid.coarser[0].values.max() == 20
        assert (found.level.max() == 1) == seen and np.isfinite(found.depth).any() == seen


@pytest.mark.parametrize("displacement", [1.5, -1.5])
def test_planes_that_levels_displace(displacement):
    """A blend of linear fields is quadratic in nothing but the weight: its planes are known.

    Level l shows x = isovalue + l * displacement. In between the plane moves with the weight, which
    is linear in the depth, and so is the field: it has one root, wherever levels change.
    """
    samples = (90, 31, 34)
    gradient = np.array([1.0, 0.0, 0.0])
    pyramid = pyramid_of(ramp(gradient, displacement), samples)
    camera = camera_at(15, samples)
    origins, directions, across = rays_of(camera)
    ends = np.array([0, QUARTER * 2, 2, QUARTER * 4, 4, 100]) / PITCH
    drawn = np.array([0.0, 0, 1, 1, 2, 2])
    seen = np.zeros(3, int)
    for isovalue in np.linspace(3, 85, 40):
        found = levels.cast(pyramid, isovalue, camera, SIZE)
        # in each stretch the field is linear in the distance t: value + t * slope
        expected = np.full(across.shape, np.inf)
        for (begin, end), (low, high) in zip(zip(ends, ends[1:]), zip(drawn, drawn[1:])):
            gain = (high - low) / (end - begin)
            value = origins @ gradient - isovalue - displacement * (low - gain * begin)
            slope = directions @ gradient - displacement * gain * across
            t = -value / slope
            there = (t * across >= begin) & (t * across < end)
            expected[there] = np.minimum(expected[there], t[there])
        place = origins + np.where(np.isfinite(expected), expected, 0)[..., None] * directions
        outside = np.maximum(-place, place - (np.array(samples) - 1)).max(axis=-1)
        hit = np.isfinite(expected) & (outside < -1e-6)
        assert np.isfinite(found.depth[hit]).all()
        assert np.abs(found.depth - expected)[hit].max(initial=0) < tolerances.ORACLE_EXACT
        number = np.searchsorted([2 / PITCH, 4 / PITCH], (expected * across)[hit], side="right")
        assert np.array_equal(found.level[hit], number)
        seen += np.bincount(number, minlength=3)
    assert seen.min() > 200


@pytest.mark.parametrize("seed", range(3))
def test_first_root_by_dense_sampling(seed):
    """Each hit is a root with a change of side, and no side changes before it."""
    samples = (44, 15, 18)
    steps = (HALVED, ((1, 2, 2), (2, 4, 4)), ((2, 2, 1), (4, 4, 2)))[seed]
    pyramid = unrelated(seed, samples, steps=steps)
    camera, tolerance, isovalue = camera_at(8, samples), 2.8, 0.9
    stretches = find_stretches(pyramid, camera, SIZE[1], tolerance)
    found = levels.cast(pyramid, isovalue, camera, SIZE, tolerance=tolerance).depth.ravel()
    origins, directions = camera.rays(SIZE)
    place = found * (directions @ camera.forward)
    blended = [(s.begin < place) & (place < s.end) for s in stretches if s.blends]
    chosen = [*blended, np.isfinite(found) & ~np.logical_or.reduce(blended), np.isinf(found)]
    rng = np.random.default_rng(seed)
    for ray in np.concatenate([rng.choice(np.flatnonzero(rays), 15) for rays in chosen]):
        way = Sampled(pyramid, stretches, origins[ray], directions[ray], camera.forward)
        side, met = None, False
        for piece in way.pieces():
            shares = np.linspace(0, 1, 60)
            inside = piece.values(shares) >= isovalue
            side = inside[0] if side is None else side
            before = piece.begin + shares * (piece.end - piece.begin) < found[ray] - 1e-9
            assert (inside == side)[before].all(), "a side changes before the hit"
            if piece.begin <= found[ray] <= piece.end:
                share = (found[ray] - piece.begin) / (piece.end - piece.begin)
                around = piece.values(share + np.array([-1e-7, 0, 1e-7]))
                assert around[1] == pytest.approx(isovalue, abs=1e-9)
                assert (around[0] >= isovalue) != (around[2] >= isovalue)
                met = True
                break
        assert met == np.isfinite(found[ray])


class Sampled:
    """A ray's way through a pyramid, cut by the planes of cells of the level that is drawn."""

    def __init__(self, pyramid, stretches, origin, direction, forward):
        self.levels = [pyramid.volume, *pyramid.coarser]
        self.steps = pyramid.steps
        self.size = np.array(pyramid.volume.values.shape[::-1]) - 1.0
        self.stretches, self.origin, self.direction = stretches, origin, direction
        self.across = direction @ forward

    def pieces(self):
        planes = np.concatenate(
            [
                (np.arange(0, size + 1) - o) / d
                for size, o, d in zip(self.size, self.origin, self.direction)
            ]
        )
        for stretch in self.stretches:
            ends = stretch.begin / self.across, stretch.end / self.across
            # the volume's planes are the levels' and more: these would change a blend
            keep = np.concatenate(
                [np.arange(0, n + 1) % s == 0 for n, s in zip(self.size, self.steps[stretch.level])]
            )
            borders = planes.reshape(-1)[
                np.concatenate([np.isin(np.arange(0, n + 1), (0, n)) for n in self.size])
            ].reshape(3, 2)
            low = max(borders.min(axis=1).max(), ends[0], 0)
            high = min(borders.max(axis=1).min(), ends[1])
            if low < high:
                cuts = planes[keep & (planes > low) & (planes < high)]
                cuts = np.concatenate([[low], np.sort(cuts), [high]])
                for begin, end in zip(cuts, cuts[1:]):
                    if end - begin > 1e-9:
                        yield Piece(self, stretch, begin, end)


class Piece:
    """Bernstein coefficients of a blend, found by interpolation at four places."""

    def __init__(self, way, stretch, begin, end):
        self.begin, self.end = begin, end
        thirds = np.arange(4) / 3
        places = way.origin + (begin + thirds * (end - begin))[:, None] * way.direction
        weight = stretch.first_weight + (stretch.last_weight - stretch.first_weight) * np.interp(
            (begin + thirds * (end - begin)) * way.across, (stretch.begin, stretch.end), (0, 1)
        )
        self.coefficients = np.zeros(4)
        for number, part in ((0, 1 - weight), (1, weight)):
            if part.any():
                level, steps = stretch.level + number, way.steps[stretch.level + number]
                values = interpolate(way.levels[level].values, places / steps)
                self.coefficients += part * np.linalg.solve(bernstein(thirds), values)

    def values(self, s):
        return bernstein(s) @ self.coefficients


def bernstein(s):
    """Return Bernstein's four cubic polynomials [n, 4] at some places."""
    return np.stack([math.comb(3, k) * s**k * (1 - s) ** (3 - k) for k in range(4)], axis=-1)


@pytest.mark.parametrize("weight", [0.0, 0.35, 0.8])
@pytest.mark.parametrize("hides", [(), (0,), (1,), (0, 1)])
def test_a_constant_weight_blends_samples(weight, hides):
    """In parallel projection a blend of two levels is the interpolant of the blended samples.

    A cell is hidden if it is in either level.
    """
    rng = np.random.default_rng(6)
    samples = (18, 21, 16)

    def hidden_of(number, cells):
        return rng.uniform(size=cells) < 0.08 if number in hides else None

    pyramid = unrelated(6, samples, steps=((2, 2, 2),), hidden_of=hidden_of)
    pitch = QUARTER * 2 * (1 - weight) + 2 * weight
    camera = camera_at(30, samples, parallel_scale=pitch / 4 * SIZE[1] / 2)
    fine, coarse = pyramid.volume, pyramid.coarser[0]
    places = np.moveaxis(np.indices(fine.values.shape, dtype=float)[::-1], 0, -1)
    blend = (1 - weight) * fine.values + weight * interpolate(coarse.values, places / 2)
    hidden = np.zeros(np.array(fine.values.shape) - 1, bool)
    if fine.hidden is not None:
        hidden |= fine.hidden
    if coarse.hidden is not None and weight > 0:
        doubled = coarse.hidden.repeat(2, 0).repeat(2, 1).repeat(2, 2)
        hidden |= doubled[tuple(slice(n) for n in hidden.shape)]
    expected = caster.cast(Volume(blend, np.eye(4), hidden), 0.1, camera, SIZE)
    found = levels.cast(pyramid, 0.1, camera, SIZE, tolerance=4)
    hit = np.isfinite(expected.depth)
    assert hit.sum() > 100 and np.array_equal(np.isfinite(found.depth), hit)
    assert np.abs(found.depth[hit] - expected.depth[hit]).max() < tolerances.ORACLE_EXACT


def test_sphere():
    """Each level shows the sphere as well as its samples can."""
    samples, radius = (75, 61, 58), 20.0
    centre = np.array([40.0, 30, 28.5])

    def distance(_, x, y, z):
        return np.sqrt((x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2)

    pyramid = pyramid_of(distance, samples)
    seen = set()
    for away, tolerance in ((10, 1.0), (25, 1.0), (60, 1.0), (60, 0.7)):
        camera = camera_at(away, samples)
        found = levels.cast(pyramid, radius, camera, SIZE, tolerance=tolerance)
        origins, directions, _ = rays_of(camera)
        b = np.einsum("...i,...i", origins - centre, directions)
        c = np.einsum("...i,...i", origins - centre, origins - centre) - radius**2
        clear = b * b - c > 60
        assert clear.sum() > 20 and np.isfinite(found.depth[clear]).all()
        off = np.abs(found.depth - (-b - np.sqrt(np.maximum(b * b - c, 0))))[clear]
        # samples of the next level may take part
        step = 2.0 ** np.minimum(found.level[clear] + 1, 2)
        assert (off < 3 * tolerances.ORACLE_SPHERE_VOXELS * step**2).all()
        seen |= set(found.level[clear])
    assert seen == {0, 1, 2}


def test_no_ray_hits_where_levels_change():
    """A field that jumped there would have a surface of its own, on which many rays would end."""
    samples = (60, 41, 38)
    pyramid = unrelated(7, samples)
    near, on = 0, 0
    size, camera = (160, 120), camera_at(12, samples)
    across = (camera.rays(size)[1] @ camera.forward).reshape(size[::-1])
    for tolerance in np.linspace(7, 20, 6):
        found = levels.cast(pyramid, 1.2, camera, size, tolerance=tolerance)
        ends = [s.begin for s in find_stretches(pyramid, camera, size[1], tolerance)[1:]]
        off = np.abs((found.depth * across)[..., None] - ends).min(axis=-1)
        near, on = near + (off < 0.1).sum(), on + (off < 1e-6).sum()
    assert near > 1000 and on <= 1


def test_bounds_hold_what_a_disturbed_field_shows():
    """Whatever an error within the slack does to the values, the depth stays within the bounds."""
    samples = (40, 21, 24)
    pyramid = unrelated(8, samples)
    camera = camera_at(18, samples)
    options = {"tolerance": 1.4}
    found = levels.cast(pyramid, 1.0, camera, SIZE, slack=Slack(value=2e4), **options)
    assert (found.early <= found.depth).all() and (found.depth <= found.late).all()
    moved = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        # the isovalue is farther from some corner of each cell than the noise is large
        worst = 2e4 * caster.FLOAT32_ULP * 0.5

        def disturbed(values, rng=rng, worst=worst):
            return values + rng.uniform(-1, 1, values.shape) * worst

        other = Pyramid(
            Volume(disturbed(pyramid.volume.values), np.eye(4)),
            tuple(Level(disturbed(level.values), level.steps) for level in pyramid.coarser),
        )
        depth = levels.cast(other, 1.0, camera, SIZE, **options).depth
        assert ((found.early <= depth) & (depth <= found.late)).all()
        moved += (depth != found.depth).sum()
    assert moved > 1000


def test_chosen_pixels_are_those_of_the_image():
    samples = (40, 21, 24)
    pyramid = unrelated(9, samples)
    camera = camera_at(18, samples)
    whole = levels.cast(pyramid, 0.8, camera, SIZE)
    pixels = np.random.default_rng(9).integers(0, SIZE[0] * SIZE[1], 100)
    some = levels.cast(pyramid, 0.8, camera, SIZE, pixels=pixels)
    for name in ("depth", "voxels", "level"):
        assert np.array_equal(getattr(some, name), getattr(whole, name).ravel()[pixels]), name


@pytest.mark.parametrize("weight", [0.0, 0.4])
def test_conservative_rays_hit_what_they_pass(weight):
    """A ray hits in the first block that it passes where the volume has a surface, unless its level
    has one in that block or in one before."""
    samples = (41, 35, 50)
    rng = np.random.default_rng(10)
    pyramid = unrelated(10, samples)
    lone = np.where(rng.random(samples[::-1]) < 0.05, 1.0, 0.0)
    coarse = tuple(Level(0.45 + 0.1 * (x.values > 1.6), x.steps) for x in pyramid.coarser)
    pyramid = Pyramid(Volume(lone, np.eye(4)), coarse)
    apart = 4 * (levels.BLENDING * (1 - weight) + weight) if weight else 2.5
    camera = camera_at(60, samples, parallel_scale=22.3)
    options = {"tolerance": apart * SIZE[1] / (2 * 22.3)}
    plain = levels.cast(pyramid, 0.5, camera, SIZE, **options)
    found = levels.cast(pyramid, 0.5, camera, SIZE, conservative=True, **options)
    origins, directions = camera.rays(SIZE)

    def block_at(ray, depth):
        return tuple(np.floor((origins[ray] + depth * directions[ray]) / 8))

    expected = plain.depth.ravel().copy()
    crossings = caster.cast_all(pyramid.volume, [0.5], camera, SIZE)
    for ray, depth in reversed(list(zip(crossings.ray, crossings.depth))):
        hit = plain.depth.flat[ray]
        if depth < hit and (np.isinf(hit) or block_at(ray, depth) != block_at(ray, hit)):
            expected[ray] = depth
    first = expected != plain.depth.ravel()
    # rays that the level stops in the block where the volume's own surface is nearer
    nearer = crossings.ray[crossings.depth < plain.depth.flat[crossings.ray]]
    stopped = np.setdiff1d(nearer, np.flatnonzero(first))
    assert first.sum() > 100 and len(stopped) > 10
    both = np.isfinite(expected)
    assert np.array_equal(both, np.isfinite(found.depth.ravel()))
    off = found.depth.ravel()[both] - expected[both]
    assert np.abs(off).max() < tolerances.ORACLE_EXACT
    assert (found.level.ravel()[first] == 0).all()
    assert (found.level.ravel()[~first & both] == 1).all()
    assert (found.early <= found.depth).all() and (found.depth <= found.late).all()


def test_conservative_rays_are_exact_near_by():
    """Where the volume itself is drawn there is nothing else to look at."""
    samples = (40, 21, 24)
    pyramid = unrelated(11, samples)
    camera = camera_at(18, samples)
    near = levels.cast(pyramid, 0.8, camera, SIZE, tolerance=0.01, conservative=True)
    assert np.array_equal(near.depth, caster.cast(pyramid.volume, 0.8, camera, SIZE).depth)
    assert set(np.unique(near.level)) == {-1, 0}


def test_bad_pyramids_are_refused():
    volume = Volume(np.zeros((8, 8, 9)), np.eye(4))
    with pytest.raises(ValueError, match="level 1 has steps"):
        Pyramid(volume, (Level(np.zeros((3, 3, 3)), (4, 4, 4)),))
    with pytest.raises(ValueError, match=r"shape \(4, 5, 5\), but \(5, 5, 5\)"):
        Pyramid(volume, (Level(np.zeros((4, 5, 5)), (2, 2, 2)),))
    with pytest.raises(ValueError, match="level 2 has steps"):
        Pyramid(volume, (Level(np.zeros((5, 5, 5)), (2, 2, 2)),
                         Level(np.zeros((5, 5, 5)), (1, 2, 2))))  # fmt: skip
    with pytest.raises(ValueError, match="tolerance must be above 0"):
        levels.cast(Pyramid(volume), 0.5, Camera((9, 9, 30), (4, 4, 4)), SIZE, tolerance=0)
