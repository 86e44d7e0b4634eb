"""What the mapper keeps and gives back: decoded blocks, OpenGL's objects, itself; and what it says when it cannot."""

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderWindow, vtkVolume

import progiso
from helpers.comparison import GREEN, NESTED, OPAQUE, RED, Stage, paint, picture_of, show
from helpers.geometry import TURNED, ball, planes
from helpers.gl_objects import objects
from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.scenes import CACHED


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)


def decoded(stage):
    return sum(
        row["decoded_blocks"] for row in progiso.statistics(stage.mapper, stage.renderer)["passes"]
    )


# --- decoded blocks ----------------------------------------------------------------------------------------------------------

LOOKS = {
    "colour": lambda stage: paint(
        stage.volumes[0], {value: (*RED, look[3]) for value, look in stage.surfaces.items()}
    ),
    "light": lambda stage: stage.shine((1, 0, 0)),
    "shading": lambda stage: stage.volumes[0].GetProperty().SetAmbient(0.7),
    "obstacle": lambda stage: stage.renderer.AddActor(ball(24, centre=(26, 28, 24))),
}
VIEWS = {
    "smaller window": lambda stage: stage.window.SetSize(100, 80),
    "nearer": lambda stage: stage.camera.Zoom(1.2),
    "opacity": lambda stage: paint(
        stage.volumes[0], {v: (*look[:3], 0.4) for v, look in stage.surfaces.items()}
    ),
    "clipping": lambda stage: stage.mapper.AddClippingPlane(next(planes((1, 0, 0)))),
    "cropping": lambda stage: stage.mapper.SetCropping(True),
}


def change(image, surfaces, how):
    """Make a change after a picture; return the stage and the passes before."""
    stage = Stage(True)
    stage.surfaces = surfaces
    stage.clipping_range = 10, 300
    show(stage, image, surfaces, **CACHED).GetProperty().ShadeOn()
    stage.mapper.SetCroppingRegionPlanes(0, 30, 0, 30, 0, 30)
    before = stage.picture()
    assert decoded(stage) > 100
    passes = progiso.statistics(stage.mapper, stage.renderer)["passes"]
    how(stage)
    after = stage.picture()
    assert before.shape != after.shape or not np.array_equal(before, after)
    return stage, passes


@pytest.mark.parametrize("name", LOOKS)
def test_another_look_costs_no_pass(image, name):
    """Of opaque isosurfaces: the hits stay, the picture is composed anew."""
    stage, passes = change(image, OPAQUE, LOOKS[name])
    assert progiso.statistics(stage.mapper, stage.renderer)["passes"] == passes


@pytest.mark.parametrize("name", [*LOOKS, *VIEWS])
def test_layers_are_blended_anew_from_what_is_decoded(image, name):
    """Of translucent isosurfaces every change restarts the picture; what its rays had met is still decoded."""
    stage, passes = change(image, NESTED, (LOOKS | VIEWS)[name])
    assert progiso.statistics(stage.mapper, stage.renderer)["passes"] != passes
    assert decoded(stage) <= 0.02 * sum(row["decoded_blocks"] for row in passes)


def test_a_new_isovalue_decodes_only_what_it_adds(image):
    stage = Stage(True)
    show(stage, image, {0.1: (*GREEN, 1.0)}, **CACHED)
    stage.render()
    first = decoded(stage)
    paint(stage.volumes[0], {0.12: (*GREEN, 1.0)})
    stage.render()
    assert 0 <= decoded(stage) < 0.5 * first
    stage.mapper.EmptyCache()
    paint(stage.volumes[0], {0.1: (*GREEN, 1.0)})
    stage.render()
    assert decoded(stage) == first


# --- OpenGL's objects --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "settings", [{}, {**CACHED, "DetailedStatistics": True}, {**CACHED, "SpeculationLimit": 1}]
)
def test_nothing_is_left_behind(image, settings):
    """Mappers come and go, fifty of them: OpenGL has as many objects as after the first."""
    stage = Stage(True)
    stage.look_at(image)
    stage.renderer.AddActor(ball(8))
    for cycle in range(50):
        surfaces = (NESTED, OPAQUE)[cycle % 2]
        volume = stage.add(image, surfaces, **settings)
        volume.GetProperty().ShadeOn()
        stage.render()
        if cycle == 2:
            within = objects(stage.window)
        stage.renderer.RemoveVolume(volume)
        volume.ReleaseGraphicsResources(stage.window)
        stage.volumes.clear()
        del volume
        if cycle == 2:
            first = objects(stage.window)
    assert objects(stage.window) == first
    assert within["Buffer"] > first["Buffer"] and within["Program"] > first["Program"]


def test_released_and_rendered_again(image):
    stage = Stage(True)
    volume = show(stage, image, NESTED)
    first = stage.picture()
    for _ in range(3):
        volume.ReleaseGraphicsResources(stage.window)
        assert np.array_equal(stage.picture(), first)


def test_the_window_is_made_anew(image):
    """Its context is gone, and so is what was in it."""
    stage = Stage(True)
    show(stage, image, NESTED)
    first = stage.picture()
    stage.window.Finalize()
    assert np.array_equal(stage.picture(), first)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(stage.window.GetSize())
    stage.window.RemoveRenderer(stage.renderer)
    window.AddRenderer(stage.renderer)
    stage.window = window
    assert np.array_equal(stage.picture(), first)


def test_released_while_another_window_is_current(image):
    """Each window has one of two volumes; the first's is removed while the second is current."""
    stages = Stage(True), Stage(True)
    for stage in stages:
        show(stage, image, NESTED)
    pictures = [stage.picture() for stage in stages]
    assert np.array_equal(*pictures)
    before = objects(stages[1].window)
    stages[0].renderer.RemoveVolume(stages[0].volumes[0])
    stages[0].volumes.clear()
    assert objects(stages[1].window) == before
    assert np.array_equal(stages[1].picture(), pictures[1])
    assert np.ptp(stages[0].picture().reshape(-1, 3), axis=0).max() == 0


def test_other_things_in_the_window_are_left_as_they_were(image):
    """The mapper leaves OpenGL's state to VTK as it found it: what is drawn after it looks the same as without it."""
    plain, stage = Stage(True), Stage(True)
    for scene in (plain, stage):
        scene.look_at(image)
        scene.clipping_range = 1, 500
        scene.renderer.AddActor(ball(9, opacity=0.5))
    volume = stage.add(image, NESTED)
    stage.render()
    stage.renderer.RemoveVolume(volume)
    stage.render()
    plain.render()
    assert np.array_equal(picture_of(stage.window), picture_of(plain.window))


# --- copies and texts --------------------------------------------------------------------------------------------------------


def test_a_volume_is_copied(image):
    """A shallow copy shares mapper and property and draws the same."""
    stage = Stage(True)
    original = show(stage, image, NESTED, matrix=TURNED)
    first = stage.picture()
    for kind in (type(original), vtkVolume):
        copy = kind()
        copy.ShallowCopy(original)
        assert copy.GetMapper() is original.GetMapper()
        stage.renderer.RemoveAllViewProps()
        stage.renderer.AddVolume(copy)
        assert np.array_equal(stage.picture(), first)


def test_a_mapper_is_copied(image):
    """What vtkAbstractMapper copies, the clipping planes, arrives."""
    stage, other = Stage(True), Stage(True)
    show(stage, image).GetMapper().AddClippingPlane(next(planes((1, 0, 0))))
    show(other, image).GetMapper().ShallowCopy(stage.mapper)
    assert other.mapper.GetClippingPlanes() is stage.mapper.GetClippingPlanes()
    assert np.array_equal(stage.picture(), other.picture())


def test_everything_prints(image):
    stage = Stage(True)
    volume = show(stage, image, NESTED)
    stage.mapper.SetMemoryBudget(123456789)
    text = str(stage.mapper)
    for name in (
        "Rate",
        "Component",
        "SpeculationLimit",
        "MemoryBudget",
        "DecodeWholeVolume",
        "LargestBuffer",
        "TimeAllowance",
    ):
        assert name in text
    assert "123456789" in text and "vtkIsosurfaceVolume" in str(volume)


# --- limits ------------------------------------------------------------------------------------------------------------------


def complaints(stage):
    with vtk_messages() as messages:
        stage.window.Render()
    return messages


def test_too_many_isovalues(image):
    """More than 16 that show are refused by one clear error; those that do not show do not count."""
    surfaces = {-0.8 + 0.1 * i: (1, 1, i / 16, 0.2) for i in range(17)}
    stage = Stage(True)
    show(stage, image, surfaces)
    (message,) = complaints(stage)
    assert "at most 16 isovalues that show" in message and "17" in message
    assert np.ptp(picture_of(stage.window).reshape(-1, 3), axis=0).max() == 0
    surfaces[-0.8] = (1, 1, 1, 0.0)
    paint(stage.volumes[0], surfaces)
    assert not complaints(stage)
    assert np.ptp(picture_of(stage.window).reshape(-1, 3), axis=0).max() > 50


def test_too_many_clipping_planes(image):
    stage = Stage(True)
    mapper = show(stage, image).GetMapper()
    for count in range(17):
        assert not complaints(stage)
        plane = vtkPlane()
        plane.SetOrigin(-100, 0, 0)
        plane.SetNormal(1, 0.01 * count, 0)
        mapper.AddClippingPlane(plane)
    (message,) = complaints(stage)
    assert "at most 16 clipping planes" in message and "17" in message


def test_too_many_lights(image):
    stage = Stage(True)
    show(stage, image).GetProperty().ShadeOn()
    for _ in range(17):
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        stage.renderer.AddLight(light)
    (message,) = complaints(stage)
    assert "at most 16 lights that are switched on" in message and "17" in message
    light.SwitchOff()
    assert not complaints(stage)


@pytest.mark.parametrize("surfaces", [{}, {0.1: (*GREEN, 0.0)}, {5.0: (*GREEN, 1.0)}])
@pytest.mark.parametrize("settings", [{}, CACHED])
def test_nothing_to_show(image, surfaces, settings):
    """No isovalue, one that is fully transparent, one outside the values: no error, an empty picture, complete."""
    stage = Stage(True)
    show(stage, image, surfaces, **settings)
    assert not complaints(stage)
    assert stage.mapper.GetConverged() and stage.mapper.GetCompletedFraction() == 1
    assert np.ptp(picture_of(stage.window).reshape(-1, 3), axis=0).max() == 0
    assert not np.isfinite(progiso.depth(stage.mapper)).any()
