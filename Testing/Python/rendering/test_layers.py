"""Several and translucent isosurfaces against the double-precision caster, however the work is
divided."""

import numpy as np
import pytest

import progiso
from helpers.comparison import BACKGROUND, NESTED, OPAQUE, SIZE, ComparisonScene, show
from helpers.geometry import PLANES, REGIONS, ball
from helpers.images import blobs, make_image, noise, reference_volume
from helpers.layers import blend, crossings_of
from helpers.messages import vtk_messages
from helpers.scenes import CACHED
from progiso.measure import tolerances
from progiso.oracle.caster import Camera

FIELDS = {
    "blobs": (lambda: blobs((24, 32, 28), 12, waves=2), NESTED),
    "thin": (
        lambda: blobs((40, 44, 36), 3, waves=8),
        {v: (*rgb, 0.2) for v, rgb in zip((-0.3, 0, 0.3), np.eye(3))},
    ),
    "noise": (lambda: noise((12, 14, 16)), {-0.5: (1, 0, 0, 0.3), 0.5: (0, 0.5, 1, 0.6)}),
    "opaque among them": (
        lambda: blobs((24, 32, 28), 12, waves=2),
        {**NESTED, 0.3: (1, 1, 0, 1.0)},
    ),
    "all opaque": (
        lambda: blobs((24, 32, 28), 12, waves=2),
        {v: (*rgb[:3], 1.0) for v, rgb in NESTED.items()},
    ),
}


@pytest.fixture(scope="module", params=FIELDS)
def field(request):
    values, surfaces = FIELDS[request.param]
    return progiso.compress(make_image(values()), rate=16), dict(sorted(surfaces.items()))


def expected(scene, image, surfaces, end=np.inf, background=BACKGROUND, cropping=None):
    """Return what the caster makes of a scene, unlit: its crossings and its picture."""
    crossings = crossings_of(
        reference_volume(image),
        list(surfaces),
        Camera.from_vtk(scene.camera),
        SIZE,
        scene.camera.GetClippingRange(),
        cropping,
    )
    return crossings, blend(crossings, list(surfaces.values()), background, SIZE, end)


def check_layers(picture, model):
    off = (np.abs(picture - model).max(axis=2) > tolerances.LAYERS_LEVELS).mean()
    assert off <= tolerances.LAYERS_PIXELS, f"{off:.3%} of the pixels are not the caster's"
    assert (np.abs(model - 255 * np.array(BACKGROUND)).max(axis=2) > 20).mean() > 0.2


@pytest.mark.parametrize("view", [0, 1, 3])
@pytest.mark.parametrize("settings", [{}, CACHED])
def test_layers_are_the_casters(field, view, settings):
    image, surfaces = field
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces, view, **settings)
    picture = scene.picture()
    crossings, model = expected(scene, image, surfaces)
    assert np.bincount(crossings.ray).max() >= 4
    check_layers(picture, model)
    first = np.full(SIZE[0] * SIZE[1], np.inf)
    np.minimum.at(first, crossings.ray, crossings.depth)
    depth = progiso.depth(scene.mapper).ravel()
    far = ~(np.isclose(depth, first, atol=2e-4) | np.isinf(depth) & np.isinf(first))
    assert far.mean() <= tolerances.LAYERS_PIXELS


def test_screenshots_keep_their_rows():
    """A screenshot whose rows have an odd number of bytes is right after the depths of opaque
    geometry were read: the pixel store is as it was before."""
    image = progiso.compress(make_image(blobs((24, 32, 28), 12, waves=2)), rate=16)
    scene = ComparisonScene(ours=True, size=(151, 97))
    scene.add_mesh(image, OPAQUE)
    before = scene.picture()
    volume = scene.add(image, NESTED)
    assert (scene.picture() != before).any()
    volume.VisibilityOff()
    np.testing.assert_array_equal(scene.picture(), before)


@pytest.mark.parametrize("regions", REGIONS)
@pytest.mark.parametrize("settings", [{}, CACHED])
def test_cropped_layers_are_the_casters(field, regions, settings):
    image, surfaces = field
    scene = ComparisonScene(ours=True)
    mapper = show(scene, image, surfaces, **settings).GetMapper()
    mapper.CroppingOn()
    mapper.SetCroppingRegionPlanes(PLANES)
    mapper.SetCroppingRegionFlags(REGIONS[regions])
    picture = scene.picture()
    _, model = expected(scene, image, surfaces, cropping=(PLANES, REGIONS[regions]))
    off = (np.abs(picture - model).max(axis=2) > tolerances.LAYERS_LEVELS).mean()
    assert off <= tolerances.LAYERS_PIXELS


def test_layers_end_at_opaque_geometry(field):
    """There are none behind a sphere, whose own colour is blended with those before it."""
    image, surfaces = field
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces)
    centre = np.array(image.GetCenter())
    actor = ball(8, (1, 0.9, 0.3), centre=centre)
    scene.renderer.AddActor(actor)
    picture = scene.picture()
    camera = Camera.from_vtk(scene.camera)
    origins, directions = camera.rays(SIZE)
    towards = np.einsum("ij,ij->i", centre - origins, directions)
    miss = np.linalg.norm(centre - origins - towards[:, None] * directions, axis=1)
    end = np.where(miss < 8, towards - np.sqrt(np.maximum(64 - miss**2, 0)), np.inf)
    background = np.where((miss < 8)[:, None], (1, 0.9, 0.3), BACKGROUND)
    crossings, model = expected(scene, image, surfaces, end, background)
    # a sphere of triangles lies a little within the sphere: what is near its edge or just before it
    # does not count
    edge = np.abs(miss - 8) < 0.15
    near = np.zeros(len(miss), bool)
    close = (crossings.depth > end[crossings.ray] - 0.05) & (
        crossings.depth < end[crossings.ray] + 0.25
    )
    near[crossings.ray[close]] = True
    counts = ~(edge | near).reshape(SIZE[1], SIZE[0])
    assert counts.mean() > 0.8 and (miss < 8)[counts.ravel()].sum() > 500
    off = (np.abs(picture - model).max(axis=2) > tolerances.LAYERS_LEVELS)[counts].mean()
    assert off <= tolerances.LAYERS_PIXELS


# --- the division of the work ---------------------------------------------------------------------


def least_budget(image, surfaces, lit):
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces, MemoryBudget=1).GetProperty().SetShade(lit)
    scene.renderer.AddActor(ball(20, centre=image.GetCenter()))
    with vtk_messages() as messages:
        scene.window.Render()
    words = "".join(messages).split()
    return int(words[words.index("bytes)") - 1].strip("("))


@pytest.fixture(scope="module", params=[False, True], ids=["unlit", "lit"])
def whole(request):
    """Return a volume larger than the smallest cache and buffer, whether it is lit, and picture and
    depth of one pass."""
    image = progiso.compress(make_image(blobs((60, 64, 56), 3, waves=5)), rate=32)
    scene = ComparisonScene(ours=True)
    show(scene, image, NESTED).GetProperty().SetShade(request.param)
    scene.renderer.AddActor(ball(20, centre=image.GetCenter()))
    picture = scene.picture()
    return image, request.param, picture, progiso.depth(scene.mapper)


DIVISIONS = {
    "cache": {},
    "no speculation": {"SpeculationLimit": 1},
    "some speculation": {"SpeculationLimit": 7},
    "small buffers": {"LargestBuffer": 600_000},
    "stragglers": {"PixelsPerStraggler": 4},
    "stragglers at once": {"PixelsPerStraggler": 1, "SpeculationLimit": 2},
    "no stragglers": {"PixelsPerStraggler": 0},
    "a pass per render": {"MaximumPassesPerRender": 1},
    "three passes per render": {"MaximumPassesPerRender": 3, "SpeculationLimit": 2},
    "least memory": {"MemoryBudget": "least"},
    "little memory": {"MemoryBudget": "little"},
}


@pytest.mark.parametrize("name", DIVISIONS)
def test_division_of_the_work(whole, name):
    """Neither cache nor speculation, buffers, memory or the number of passes shows in any bit."""
    image, lit, picture, depth = whole
    settings = dict(DIVISIONS[name])
    if "MemoryBudget" in settings:
        least = least_budget(image, NESTED, lit)
        settings["MemoryBudget"] = (
            least if settings["MemoryBudget"] == "least" else int(1.05 * least)
        )
    scene = ComparisonScene(ours=True)
    show(scene, image, NESTED, **settings, **CACHED).GetProperty().SetShade(lit)
    scene.renderer.AddActor(ball(20, centre=image.GetCenter()))
    scene.renderer.ResetCameraClippingRange()
    renders = 1
    scene.window.Render()
    while not scene.mapper.GetConverged():
        scene.window.Render()
        renders += 1
        assert renders < 2000
    assert (renders > 3) == ("MaximumPassesPerRender" in settings)
    assert progiso.depth(scene.mapper).tobytes() == depth.tobytes()
    assert np.array_equal(scene.picture(), picture)


def test_a_partial_picture_has_no_more_than_the_complete_one(whole):
    """Layers come in from the front: no partial picture is nearer to the background than one
    before."""
    image, lit, picture, _ = whole
    scene = ComparisonScene(ours=True)
    show(
        scene, image, NESTED, MaximumPassesPerRender=1, SpeculationLimit=1, **CACHED
    ).GetProperty().SetShade(lit)
    scene.renderer.AddActor(ball(20, centre=image.GetCenter()))
    scene.renderer.ResetCameraClippingRange()
    fractions = []
    while not scene.mapper.GetConverged() or not fractions:
        scene.window.Render()
        fractions.append(scene.mapper.GetCompletedFraction())
    assert fractions == sorted(fractions) and fractions[0] < 0.5 and fractions[-1] == 1
    assert np.array_equal(scene.picture(), picture)
