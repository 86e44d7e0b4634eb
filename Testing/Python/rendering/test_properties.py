"""What must hold for any scene, on random ones.

Neither how the work is divided, nor how the volume lies in its blocks and axes, nor which run it is
shows in a picture; no ray slips through a closed surface. For more examples, PROGISO_EXAMPLES of
each (2000 by default):

    pytest Testing/Python/rendering/test_properties.py --hypothesis-profile long
"""

import hashlib
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import progiso
from helpers.images import make_image, reference_values, samples_of
from helpers.random_scenes import SIZE, pictures_of_every_kind, random_camera, random_field
from helpers.scenes import Scene, check_depth, least_budget
from progiso.measure import tolerances
from progiso.oracle.caster import Camera, Volume, cast
from progiso.verify import cracks

#: Rays that can hit, of which no share is judged.
FEW = 200

#: What decides how the work is divided; the budget in units of the least.
DIVISIONS = st.fixed_dictionaries(
    {"DecodeWholeVolume": st.booleans()},
    optional={
        "SpeculationLimit": st.integers(1, 64),
        "MaximumPassesPerRender": st.integers(1, 5),
        "MemoryBudget": st.floats(1, 2),
        "DetailedStatistics": st.just(True),
    },
)
SHAPES = st.tuples(*[st.integers(2, 24)] * 3)
SEEDS = st.integers(0, 10**6)


def within_budget(division, image, isovalue, camera):
    """Put the least budget's bytes into a division of the work."""
    if "MemoryBudget" not in division:
        return division
    others = {name: value for name, value in division.items() if name != "MemoryBudget"}
    least = least_budget(image, isovalue, camera, SIZE, **others)
    return {**others, "MemoryBudget": int(division["MemoryBudget"] * least)}


def same_pictures(scene, other):
    """Hold depths and colours against each other, bit for bit."""
    depth, expected = other.depth(), scene.depth()
    different = np.argwhere(depth.view(np.uint32) != expected.view(np.uint32))
    assert len(different) == 0, (
        f"{len(different)} pixels, first {different[0]}:"
        f" {depth[tuple(different[0])]}, not {expected[tuple(different[0])]}"
    )
    assert other.picture().tobytes() == scene.picture().tobytes()


# --- division of the work, and repetition ---------------------------------------------------------


@given(
    kind=st.sampled_from(["noise", "smooth", "waves"]),
    shape=st.one_of(
        SHAPES, SHAPES, st.tuples(*[st.integers(40, 72)] * 3)
    ),  # the last more than the least cache holds
    seed=SEEDS,
    rate=st.sampled_from([1, 3.25, 8, 32]),
    quantile=st.sampled_from([0.02, 0.3, 0.5, 0.9]),
    lit=st.booleans(),
    division=DIVISIONS,
)
def test_division_of_the_work(kind, shape, seed, rate, quantile, lit, division):
    """Speculation, memory budget, passes a render, buffers and decoding as a whole: not one bit of
    the picture."""
    values = random_field(kind, shape, seed)
    image, isovalue = (
        progiso.compress(make_image(values), rate=rate),
        float(np.quantile(values, quantile)),
    )
    camera = random_camera(shape, seed)
    whole = Scene(image, isovalue, camera, SIZE, lit=lit)
    division = within_budget(division, image, isovalue, camera)
    same_pictures(whole, Scene(image, isovalue, camera, SIZE, lit=lit, **division))
    # a picture does not depend on what the mapper has shown before, either
    whole.isovalue, whole.camera = isovalue + 0.1, random_camera(shape, seed + 1)
    whole.render()
    whole.isovalue, whole.camera = isovalue, camera
    same_pictures(whole, Scene(image, isovalue, camera, SIZE, lit=lit))


def test_another_process():
    """A process shows what any other shows, bit for bit."""
    program = (
        "import hashlib\nfrom helpers import random_scenes as t\n"
        "print(hashlib.sha256(t.pictures_of_every_kind()).hexdigest())"
    )
    paths = [path for path in sys.path if path]
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path[:0] = {paths!r}\n{program}"],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split()[-1] == hashlib.sha256(pictures_of_every_kind()).hexdigest()


# --- how the volume lies --------------------------------------------------------------------------

#: An axis that goes the other way has its origin at its other end.
AXES = st.permutations(range(3)).map(tuple)
SIGNS = st.tuples(*[st.sampled_from([1, -1])] * 3)


def lying_otherwise(values, axes, signs):
    """The same samples in the same places, but stored along other axes, some of them backwards."""
    # array axis 2 - i holds world axis axes[i]
    stored = np.transpose(values, [2 - axes[2], 2 - axes[1], 2 - axes[0]])
    direction, origin = np.zeros((3, 3)), np.zeros(3)
    for i in range(3):
        direction[axes[i], i] = signs[i]
        if signs[i] < 0:
            stored = np.flip(stored, 2 - i)
            origin[axes[i]] = values.shape[2 - axes[i]] - 1
    return make_image(stored, direction=direction, origin=origin)


def padded(values, before, after):
    """The samples among others that are farther below zero than any of theirs, at another phase of
    the blocks."""
    value = float(np.floor(values.min())) - 0.5
    pad = list(zip(before[::-1], after[::-1]))
    return make_image(
        np.pad(values, pad, constant_values=value), origin=[-float(n) for n in before]
    )


def lossless(plain):
    """Compress samples so that they stay what they are."""
    image = progiso.compress(plain, rate=32)
    assert np.array_equal(reference_values(image), samples_of(plain))
    return image


@given(
    kind=st.sampled_from(["noise", "smooth", "waves"]),
    shape=SHAPES,
    seed=SEEDS,
    isovalue=st.sampled_from([0.0, 0.1003, 0.5]),
    axes=AXES,
    signs=SIGNS,
    cached=st.booleans(),
)
def test_axes(kind, shape, seed, isovalue, axes, signs, cached):
    """Permuted and mirrored axes: what the caster sees in the volume as it was, and the same
    colours."""
    values, camera = random_field(kind, shape, seed), random_camera(shape, seed)
    scenes = []
    for lie in (((0, 1, 2), (1, 1, 1)), (axes, signs)):
        image = lossless(lying_otherwise(values, *lie))
        scenes.append(Scene(image, isovalue, camera, SIZE, lit=True, DecodeWholeVolume=not cached))
    check_same_surface(scenes, Volume.from_geometry(values), kind)


@given(
    kind=st.sampled_from(["noise", "smooth", "waves"]),
    shape=SHAPES,
    seed=SEEDS,
    isovalue=st.sampled_from([0.0, 0.1003, 0.5]),
    before=st.tuples(*[st.integers(0, 3)] * 3),
    after=st.tuples(*[st.integers(0, 3)] * 3),
    cached=st.booleans(),
)
def test_phase_of_the_blocks(kind, shape, seed, isovalue, before, after, cached):
    """A surface within a volume, wherever it lies in the blocks: what the caster sees in the volume
    as it was."""
    values, camera = random_field(kind, shape, seed), random_camera(shape, seed)
    # closed, so that what is padded adds no surface, by as much as the normals reach
    values = np.pad(values, 2, constant_values=-1.0)
    scenes = []
    for pads in (((0, 0, 0), (0, 0, 0)), (before, after)):
        image = lossless(padded(values, *pads))
        scenes.append(Scene(image, isovalue, camera, SIZE, lit=True, DecodeWholeVolume=not cached))
    check_same_surface(scenes, Volume.from_geometry(values), kind)


def check_same_surface(scenes, volume, kind):
    """Hold scenes of the same samples against one caster, and their colours against each other."""
    grazing = tolerances.GRAZING_FRACTION if kind == "smooth" else tolerances.GRAZING_FRACTION_NOISE
    depths = [scene.depth() for scene in scenes]
    for scene, depth in zip(scenes, depths):
        expected = cast(
            volume,
            scene.isovalue,
            scene.camera,
            SIZE,
            slack=tolerances.SLACK,
            clip=scene.clipping_range,
        )
        few = np.isfinite(expected.early).sum() < FEW  # of a speck all rays may graze
        check_depth(depth, expected, 1.0 if few else grazing)
    off = np.abs(
        np.subtract(
            *depths, out=np.full(depths[0].shape, np.inf), where=np.isfinite(depths).all(axis=0)
        )
    )
    colors = [scene.picture()[off <= 2 * tolerances.DEPTH_VOXELS].astype(int) for scene in scenes]
    assert np.abs(np.subtract(*colors)).max(initial=0) <= tolerances.LIE_LEVELS


# --- no cracks ------------------------------------------------------------------------------------

CLOSED = st.sampled_from([(kind, rate) for kind in cracks.RATES for rate in cracks.RATES[kind]])


@given(
    closed=CLOSED,
    shape=st.tuples(*[st.integers(9, 24)] * 3),
    seed=SEEDS,
    inside=st.booleans(),
    division=DIVISIONS,
)
def test_no_ray_slips_through(closed, shape, seed, inside, division):
    """Every ray that has to meet a closed surface does, and none that misses the volume."""
    (kind, rate), rng = closed, np.random.default_rng(seed)
    field = cracks.closed_field(kind, shape, rng)
    image = cracks.compressed_field(field, rate)
    camera = (cracks.camera_inside if inside else cracks.camera_outside)(field, rng)
    scale = camera.parallel_scale if camera.parallel else None
    camera = Camera(camera.position, camera.focal_point, camera.view_up, camera.view_angle, scale)
    scene = Scene(
        image,
        cracks.ISOVALUE,
        camera,
        SIZE,
        **within_budget(division, image, cracks.ISOVALUE, camera),
    )
    depth = scene.depth(cracks.CLIPPING_INSIDE if inside else None)
    missed, invented, judged = cracks.slipped(depth, field, camera)
    assert not missed.any() and not invented.any()
    assert judged == depth.size or not inside


@pytest.mark.parametrize("kind", ["hollow", "thin"])
def test_a_hole_shows(kind):
    """The judge sees rays that leave through a hole in the skin, and surfaces where there is
    nothing."""
    rng = np.random.default_rng(3)
    field = cracks.closed_field(kind, (16, 18, 20), rng)
    hole = field.values.copy()
    hole[field.skin & (np.arange(20) > field.high[0])] = 1.0  # the whole side
    image = progiso.compress(make_image(hole), rate=32)
    assert not field.is_closed(samples_of(progiso.decompress(image)))
    camera = cracks.camera_inside(field, rng)
    camera = Camera(camera.position, np.add(camera.position, (1, 0, 0)), view_angle=100)
    depth = Scene(image, cracks.ISOVALUE, camera, SIZE).depth(cracks.CLIPPING_INSIDE)
    missed, invented, _ = cracks.slipped(depth, field, camera)
    assert missed.any() and np.array_equal(missed, np.isinf(depth)) and not invented.any()
    away = Camera((100, 100, 100), (200, 100, 100))
    assert cracks.slipped(np.ones(SIZE[::-1]), field, away)[1].all()
