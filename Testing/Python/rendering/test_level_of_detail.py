"""Levels of detail: exact where the volume itself is drawn, whole and alike however the work is
divided, and without a step where one goes over to the next."""

import dataclasses

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

import progiso
from helpers.holes import ball, nan_image
from helpers.images import blobs, copy_of, make_image, noise, reference_volume
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, least_budget, orbit

OFF, ON, INTERACTIVE, CONSERVATIVE = range(4)
SHAPE = (90, 140, 131)


@pytest.fixture(scope="module")
def volume():
    image = make_image(blobs(SHAPE, 2, waves=6) + 0.1 * noise(SHAPE, 3))
    return progiso.compress(image, rate=8, levels=11)


def through_levels(volume, tolerance=4.2):
    """Return a camera in front of a volume, and a tolerance, so that some levels are seen."""
    return orbit(reference_volume(volume), 2, 5, view_angle=70, distance=0.6), tolerance


@pytest.fixture(scope="module")
def view(volume):
    return through_levels(volume)


def levels_of(scene):
    return [scene.mapper.GetStatistics().GetLevelPixels(i) for i in range(4)]


def doubts(scene):
    return scene.mapper.GetStatistics().GetUncertainFraction()


def test_several_levels_are_seen(volume, view):
    camera, tolerance = view
    scene = Scene(volume, 0.1, camera, lit=True, LevelOfDetail=ON, PixelTolerance=tolerance)
    depth = scene.depth()
    pixels = levels_of(scene)
    assert min(pixels[:3]) > 50 and sum(pixels) == np.isfinite(depth).sum()
    assert scene.mapper.GetStatistics().GetNumberOfLevels() == 3


def test_off_is_what_it_was_without_levels(volume, view):
    plain = progiso.compress(progiso.decompress(volume), rate=32)
    with_levels = progiso.compress(progiso.decompress(volume), rate=32, levels=11)
    images = [Scene(image, 0.1, view[0], lit=True) for image in (plain, with_levels)]
    depths = [scene.depth() for scene in images]
    assert depths[0].tobytes() == depths[1].tobytes()
    assert images[0].picture().tobytes() == images[1].picture().tobytes()
    assert images[1].statistics()["memory"] == images[0].statistics()["memory"]


@pytest.mark.parametrize("settings", [{}, CACHED])
@pytest.mark.parametrize("parallel", [False, True])
def test_near_it_is_exact(volume, view, parallel, settings):
    """Where samples are farther apart than pixels, the volume itself is drawn, bit by bit."""
    camera, _ = view
    if parallel:
        camera = dataclasses.replace(camera, parallel_scale=60.0)
    exact = Scene(volume, 0.1, camera, lit=True)
    near = Scene(volume, 0.1, camera, lit=True, LevelOfDetail=ON, PixelTolerance=0.0625, **settings)
    assert near.depth().tobytes() == exact.depth().tobytes()
    assert near.picture().tobytes() == exact.picture().tobytes()
    assert levels_of(near)[1:] == [0, 0, 0] and doubts(near) == 0


WAYS = {
    "DecodeWholeVolume": True,
    "SpeculationLimit": 64,
    "PixelsPerStraggler": -1,
    "MemoryBudget": 0,
    "MaximumPassesPerRender": 0,
    "LargestBuffer": 0,
}


def start_anew(scene, settings):
    """Have a scene's next image made in another way from nothing but compiled programs."""
    for name, value in {**WAYS, **settings}.items():
        getattr(scene.mapper, "Set" + name)(value)
    scene.mapper.EmptyCache()


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize(
    "mode, isovalues", [(ON, [0.1]), (ON, [-0.4, 0.1, 0.5]), (CONSERVATIVE, [0.1])]
)
def test_the_work_is_divided_in_any_way(volume, view, mode, isovalues, parallel):
    """Depth and picture are the same in every byte for all budgets, passes and speculations, and so
    is what is told of levels."""
    camera, tolerance = view
    if parallel:
        camera, tolerance = dataclasses.replace(camera, parallel_scale=60.0), 2.4
    on = {"LevelOfDetail": mode, "PixelTolerance": tolerance}
    least = least_budget(volume, 0.1, camera, **on)
    expected = None
    scene = Scene(volume, 0.1, camera, lit=True, **on)
    for i, isovalue in enumerate(isovalues):
        scene.volume.GetProperty().GetIsoSurfaceValues().SetValue(i, isovalue)
    for settings in (
        {},
        CACHED,
        {"SpeculationLimit": 1, **CACHED},
        {"SpeculationLimit": 7, "PixelsPerStraggler": 1, **CACHED},
        {"PixelsPerStraggler": 4, **CACHED},
        {"MemoryBudget": least},
        {"MemoryBudget": least + (least >> 3), "SpeculationLimit": 3},
        {"MaximumPassesPerRender": 1, **CACHED},
        {"LargestBuffer": 1 << 20},
    ):
        start_anew(scene, settings)
        got = scene.depth().tobytes(), scene.picture().tobytes(), levels_of(scene), doubts(scene)
        expected = expected or got
        assert got == expected, settings
    assert (doubts(scene) > 0) == (mode == ON)
    if parallel and mode == ON:  # all of the image is in one level
        assert sorted(levels_of(scene))[:3] == [0, 0, 0] and levels_of(scene)[0] == 0


@pytest.mark.parametrize("shape", [(128, 128, 128), (90, 140, 131)])
def test_conservative_loses_nothing(shape):
    """Every ray that hits the volume itself hits something, and no farther away than by the
    distance of samples; a sheet of a sample's thickness is there."""
    field = blobs(shape, 2, waves=6) - 3
    field[:, shape[1] // 2] = 1
    volume = progiso.compress(make_image(field), rate=16, levels=11)
    camera = orbit(reference_volume(volume), 1, 5, view_angle=50, distance=1.6)
    depths = []
    for mode in (OFF, ON, CONSERVATIVE):
        scene = Scene(volume, 0.5, camera, lit=True, LevelOfDetail=mode, PixelTolerance=4.0)
        depths.append(scene.depth())
        assert (doubts(scene) > 0.2) == (mode == ON)
    exact, on, conservative = depths
    hits = np.isfinite(exact)
    assert hits.sum() > 1500
    assert np.isfinite(on[hits]).mean() < 0.5  # the sheet is thinner than the levels' samples
    assert np.isfinite(conservative[hits]).all()
    assert (conservative[hits] < exact[hits] + 1e-3).all()
    assert np.mean(conservative[hits] == exact[hits]) > 0.5


def with_opacity(scene):
    scene.volume.GetProperty().GetIsoSurfaceValues().SetValue(1, 0.4)
    for value in (0.1, 0.4):
        scene.volume.GetProperty().GetScalarOpacity().AddPoint(value, 0.5)


def with_clipping(scene):
    plane = vtkPlane()
    plane.SetOrigin(65, 70, 45)
    plane.SetNormal(0.3, 0.8, -0.4)
    scene.mapper.AddClippingPlane(plane)


def with_cropping(scene):
    scene.mapper.SetCropping(True)
    scene.mapper.SetCroppingRegionPlanes(20.3, 90.1, 30.7, 99.9, 17.5, 61.2)
    scene.mapper.SetCroppingRegionFlags(0x5F3A5AC)


def with_colors(scene):
    values = np.linspace(0, 1, np.prod(SHAPE)).reshape(SHAPE)
    scene.mapper.SetColorInputData(progiso.compress(make_image(values), rate=8, levels=11))


@pytest.mark.parametrize("mode", [ON, CONSERVATIVE])
@pytest.mark.parametrize("change", [with_opacity, with_clipping, with_cropping, with_colors])
def test_everything_works_with_levels(volume, view, change, mode):
    """What a scene has is the same with the smallest cache, and nearly the same as exactly."""
    camera, tolerance = view
    on = {"LevelOfDetail": mode, "PixelTolerance": tolerance}
    depths, pictures = [], []
    for settings in ({}, on, {**on, "MemoryBudget": 1, "SpeculationLimit": 2}):
        scene = Scene(volume, 0.1, camera, lit=True, **settings)
        change(scene)
        with vtk_messages():  # the budget is the least that works, and a warning says so
            depths.append(scene.depth())
        pictures.append(scene.picture().astype(int))
    assert depths[1].tobytes() == depths[2].tobytes() and (pictures[1] == pictures[2]).all()
    assert (depths[1] != depths[0]).any()
    hits = np.isfinite(depths[0])
    assert hits.sum() > 2000 and (hits != np.isfinite(depths[1])).sum() < 0.05 * hits.sum()
    both = hits & np.isfinite(depths[1])
    assert np.median(abs(depths[0] - depths[1])[both]) < 0.4
    assert np.median(abs(pictures[0] - pictures[1])[both]) < 12


@pytest.mark.parametrize("of_property", [False, True])
def test_categories_are_those_of_the_volume_itself(volume, view, of_property):
    """A coarser level has none, whichever table tells that values are categories."""
    camera, tolerance = view
    labels = progiso.compress(make_image(np.indices(SHAPE).sum(axis=0) // 20), rate=16, levels=11)
    table = vtkColorTransferFunction()
    for value in range(20):
        table.AddRGBPoint(value, value / 20, 0.5, 1 - value / 20)
        table.SetAnnotation(value, str(value))
    table.SetIndexedLookup(True)
    scenes = [Scene(volume, 0.1, camera, LevelOfDetail=mode) for mode in (OFF, ON)]
    for scene in scenes:
        scene.mapper.SetPixelTolerance(tolerance)
        scene.mapper.SetColorInputData(labels)
        if of_property:
            scene.volume.GetProperty().SetColor(table)
        else:
            scene.mapper.SetColorLookupTable(table)
    with vtk_messages() as messages:
        exact, on = (scene.depth() for scene in scenes)
    assert not messages and on.tobytes() == exact.tobytes()
    assert scenes[1].picture().tobytes() == scenes[0].picture().tobytes()
    assert levels_of(scenes[1])[1:] == [0, 0, 0]


def test_hidden_samples_stay_hidden(view):
    """A hole is one in every level: no ray hits anything well within it."""
    hole = ball(SHAPE, 0.25)
    image = nan_image(hole, blobs(SHAPE, 2, waves=6))
    volume = progiso.compress(image, rate=8, levels=11)
    camera, tolerance = view
    depths = []
    for settings in ({}, {"MemoryBudget": 1}):
        scene = Scene(
            volume, 0.1, camera, lit=True, LevelOfDetail=ON, PixelTolerance=tolerance, **settings
        )
        with vtk_messages():
            depths.append(scene.depth())
        assert min(levels_of(scene)[:3]) > 50
    assert depths[0].tobytes() == depths[1].tobytes()
    origins, directions = camera.rays((160, 120))
    points = origins + depths[0].reshape(-1, 1) * directions
    points = points[np.isfinite(depths[0]).ravel()]
    inside = np.round(points).astype(int)
    within = ((inside >= 0) & (inside < np.array(SHAPE[::-1]))).all(axis=1)
    index = tuple(inside[within][:, ::-1].T)
    deep = ball(SHAPE, 0.25 - 5 / min(SHAPE))  # a cell of the coarsest level aside
    assert within.sum() > 2000 and not deep[index].any()


def test_no_step_between_levels(volume):
    """From frame to frame of a camera that draws back by a thousandth, no depth jumps by more than
    the frames' own way and a footprint."""
    reference = reference_volume(volume)
    jumps = []
    last = None
    for step in range(12):
        camera = orbit(reference, 2, 5, view_angle=50, distance=1.30 * 1.001**step)
        scene = Scene(volume, 0.1, camera, LevelOfDetail=ON, PixelTolerance=2.0)
        depth = scene.depth()
        if last is not None:
            both = np.isfinite(depth) & np.isfinite(last)
            jumps.append(np.percentile(abs(depth - last)[both], 98))
        last = depth
    footprint = 2 * np.tan(np.radians(25)) / 120 * 1.3 * max(SHAPE)
    assert max(jumps) < 2 * footprint and max(jumps) < 2 * np.median(jumps) + 0.1


def test_interactive_is_exact_when_still(volume, view):
    camera, tolerance = view
    settings = {"LevelOfDetail": INTERACTIVE, "PixelTolerance": tolerance}
    still = Scene(volume, 0.1, camera, lit=True, **settings)
    exact = Scene(volume, 0.1, camera, lit=True, **CACHED)
    on = Scene(volume, 0.1, camera, lit=True, LevelOfDetail=ON, PixelTolerance=tolerance)
    assert still.depth().tobytes() == exact.depth().tobytes()
    still.window.SetDesiredUpdateRate(15.0)
    assert still.depth().tobytes() == on.depth().tobytes()
    still.window.SetDesiredUpdateRate(0.0001)
    assert still.depth().tobytes() == exact.depth().tobytes()
    assert still.picture().tobytes() == exact.picture().tobytes()


def test_a_plain_image_gets_levels(view):
    image = make_image(blobs(SHAPE, 2, waves=6))
    scene = Scene(image, 0.1, view[0], LevelOfDetail=ON, PixelTolerance=view[1])
    scene.depth()
    assert min(levels_of(scene)[:3]) > 50


def test_without_levels_it_says_so_and_is_exact(volume, view):
    plain = progiso.compress(progiso.decompress(volume), rate=8)
    exact = Scene(plain, 0.1, view[0])
    scene = Scene(plain, 0.1, view[0], LevelOfDetail=ON)
    with vtk_messages() as messages:
        assert scene.depth().tobytes() == exact.depth().tobytes()
        scene.window.Render()
    text = "".join(messages)
    assert text.count("no levels of detail: compress it with levels") == 1


def test_small_volumes_need_none(view):
    image = progiso.compress(make_image(blobs((40, 50, 64), 2)), rate=8, levels=11)
    with vtk_messages() as messages:
        Scene(image, 0.1, view[0], LevelOfDetail=ON).render()
    assert not messages


def test_hits_are_picked_where_they_are_drawn(volume, view):
    camera, tolerance = view
    scene = Scene(volume, 0.1, camera, LevelOfDetail=ON, PixelTolerance=tolerance)
    depth = scene.depth()
    origins, directions = camera.rays((160, 120))
    row, column = map(int, np.argwhere(np.isfinite(depth))[1000])
    position, isovalue = [0.0] * 3, reference(0.0)
    assert scene.mapper.GetHit(column, 119 - row, position, isovalue)
    expected = (origins + depth.reshape(-1, 1) * directions)[160 * row + column]
    assert np.allclose(position, expected, atol=1e-3)
    assert isovalue.get() == pytest.approx(0.1)


def test_settings_are_kept_within_their_range(volume):
    mapper = progiso.vtkProgressiveIsosurfaceMapper()
    assert (mapper.GetLevelOfDetail(), mapper.GetPixelTolerance()) == (OFF, 1.0)
    mapper.SetLevelOfDetail(9)
    mapper.SetPixelTolerance(0.0)
    assert (mapper.GetLevelOfDetail(), mapper.GetPixelTolerance()) == (CONSERVATIVE, 0.0625)
    mapper.SetLevelOfDetailToOn()
    other = progiso.vtkProgressiveIsosurfaceMapper()
    other.CopySettings(mapper)
    assert (other.GetLevelOfDetail(), other.GetPixelTolerance()) == (ON, 0.0625)


def test_memory_follows_the_pixels():
    """A volume of eight times the samples takes no more decoded blocks for the same picture."""
    blocks = []
    for size in (96, 192):
        shape = (size,) * 3
        axes = np.meshgrid(*(np.linspace(0, 4 * np.pi, size),) * 3, indexing="ij")
        field = sum(np.sin(axes[i]) * np.cos(axes[(i + 1) % 3]) for i in range(3))
        volume = progiso.compress(make_image(field, spacing=(1 / size,) * 3), rate=8, levels=11)
        camera = orbit(reference_volume(volume), 2, 5, distance=2.0)
        scene = Scene(volume, 0.0, camera, (80, 60), lit=True, LevelOfDetail=ON, **CACHED)
        scene.render()
        blocks.append(sum(each["decoded_blocks"] for each in scene.statistics()["passes"]))
        assert shape == field.shape
    assert blocks[1] < 1.3 * blocks[0]


def test_a_camera_of_copies_is_not_shared(volume, view):
    """Two windows with other tolerances show their own levels of one volume."""
    camera, tolerance = view
    copies = [copy_of(volume), volume]
    scenes = [
        Scene(image, 0.1, camera, LevelOfDetail=ON, PixelTolerance=each)
        for image, each in zip(copies, (tolerance, 0.0625))
    ]
    for scene in scenes:
        scene.render()
    assert levels_of(scenes[0]) != levels_of(scenes[1])
