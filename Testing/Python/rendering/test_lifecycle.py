"""Blocks, OpenGL's objects and mappers that are kept, given back and copied; and errors."""

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderWindow, vtkVolume

import progiso
from helpers.comparison import GREEN, NESTED, OPAQUE, RED, ComparisonScene, paint, picture_of, show
from helpers.geometry import TURNED, ball, planes
from helpers.gl_objects import count_objects
from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.scenes import CACHED


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)


def decoded(scene):
    """Return how many blocks were decoded for the last image."""
    return sum(
        row["decoded_blocks"] for row in progiso.statistics(scene.mapper, scene.renderer)["passes"]
    )


# --- decoded blocks -------------------------------------------------------------------------------

LOOKS = {
    "colour": lambda scene: paint(
        scene.volumes[0], {value: (*RED, look[3]) for value, look in scene.surfaces.items()}
    ),
    "light": lambda scene: scene.shine((1, 0, 0)),
    "shading": lambda scene: scene.volumes[0].GetProperty().SetAmbient(0.7),
    "obstacle": lambda scene: scene.renderer.AddActor(ball(24, centre=(26, 28, 24))),
}
VIEWS = {
    "smaller window": lambda scene: scene.window.SetSize(100, 80),
    "nearer": lambda scene: scene.camera.Zoom(1.2),
    "opacity": lambda scene: paint(
        scene.volumes[0], {v: (*look[:3], 0.4) for v, look in scene.surfaces.items()}
    ),
    "clipping": lambda scene: scene.mapper.AddClippingPlane(next(planes((1, 0, 0)))),
    "cropping": lambda scene: scene.mapper.SetCropping(True),
}


def change(image, surfaces, how):
    """Make a change after a picture; return the scene and the passes before."""
    scene = ComparisonScene(ours=True)
    scene.surfaces = surfaces
    scene.clipping_range = 10, 300
    show(scene, image, surfaces, **CACHED).GetProperty().ShadeOn()
    scene.mapper.SetCroppingRegionPlanes(0, 30, 0, 30, 0, 30)
    before = scene.picture()
    assert decoded(scene) > 100
    passes = progiso.statistics(scene.mapper, scene.renderer)["passes"]
    how(scene)
    after = scene.picture()
    assert before.shape != after.shape or not np.array_equal(before, after)
    return scene, passes


@pytest.mark.parametrize("name", LOOKS)
def test_another_look_costs_no_pass(image, name):
    """Hits of opaque isosurfaces stay; the picture is composed anew."""
    scene, passes = change(image, OPAQUE, LOOKS[name])
    assert progiso.statistics(scene.mapper, scene.renderer)["passes"] == passes


@pytest.mark.parametrize("name", [*LOOKS, *VIEWS])
def test_layers_are_blended_anew_from_what_is_decoded(image, name):
    """Every change of translucent isosurfaces restarts the picture; the blocks that its rays met
    are still decoded."""
    scene, passes = change(image, NESTED, (LOOKS | VIEWS)[name])
    assert progiso.statistics(scene.mapper, scene.renderer)["passes"] != passes
    assert decoded(scene) <= 0.02 * sum(row["decoded_blocks"] for row in passes)


def test_a_new_isovalue_decodes_only_what_it_adds(image):
    scene = ComparisonScene(ours=True)
    show(scene, image, {0.1: (*GREEN, 1.0)}, **CACHED)
    scene.render()
    first = decoded(scene)
    paint(scene.volumes[0], {0.12: (*GREEN, 1.0)})
    scene.render()
    assert 0 <= decoded(scene) < 0.5 * first
    scene.mapper.EmptyCache()
    paint(scene.volumes[0], {0.1: (*GREEN, 1.0)})
    scene.render()
    assert decoded(scene) == first


# --- OpenGL's objects -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "settings", [{}, {**CACHED, "DetailedStatistics": True}, {**CACHED, "SpeculationLimit": 1}]
)
def test_nothing_is_left_behind(image, settings):
    """After fifty mappers OpenGL has as many objects as after the first."""
    scene = ComparisonScene(ours=True)
    scene.look_at(image)
    scene.renderer.AddActor(ball(8))
    for cycle in range(50):
        surfaces = (NESTED, OPAQUE)[cycle % 2]
        volume = scene.add(image, surfaces, **settings)
        volume.GetProperty().ShadeOn()
        scene.render()
        if cycle == 2:
            within = count_objects(scene.window)
        scene.renderer.RemoveVolume(volume)
        volume.ReleaseGraphicsResources(scene.window)
        scene.volumes.clear()
        del volume
        if cycle == 2:
            first = count_objects(scene.window)
    assert count_objects(scene.window) == first
    assert within["Buffer"] > first["Buffer"] and within["Program"] > first["Program"]


def test_released_and_rendered_again(image):
    scene = ComparisonScene(ours=True)
    volume = show(scene, image, NESTED)
    first = scene.picture()
    for _ in range(3):
        volume.ReleaseGraphicsResources(scene.window)
        assert np.array_equal(scene.picture(), first)


def test_the_window_is_made_anew(image):
    """The old window's context is gone with all that was in it."""
    scene = ComparisonScene(ours=True)
    show(scene, image, NESTED)
    first = scene.picture()
    scene.window.Finalize()
    assert np.array_equal(scene.picture(), first)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(scene.window.GetSize())
    scene.window.RemoveRenderer(scene.renderer)
    window.AddRenderer(scene.renderer)
    scene.window = window
    assert np.array_equal(scene.picture(), first)


def test_released_while_another_window_is_current(image):
    """Of two windows' volumes the first is removed while the second window is current."""
    scenes = ComparisonScene(ours=True), ComparisonScene(ours=True)
    for scene in scenes:
        show(scene, image, NESTED)
    pictures = [scene.picture() for scene in scenes]
    assert np.array_equal(*pictures)
    before = count_objects(scenes[1].window)
    scenes[0].renderer.RemoveVolume(scenes[0].volumes[0])
    scenes[0].volumes.clear()
    assert count_objects(scenes[1].window) == before
    assert np.array_equal(scenes[1].picture(), pictures[1])
    assert np.ptp(scenes[0].picture().reshape(-1, 3), axis=0).max() == 0


def test_other_things_in_the_window_are_left_as_they_were(image):
    """The mapper leaves OpenGL's state as it found it: what VTK draws next looks the same as
    without it."""
    plain, scene = ComparisonScene(ours=True), ComparisonScene(ours=True)
    for each in (plain, scene):
        each.look_at(image)
        each.clipping_range = 1, 500
        each.renderer.AddActor(ball(9, opacity=0.5))
    volume = scene.add(image, NESTED)
    scene.render()
    scene.renderer.RemoveVolume(volume)
    scene.render()
    plain.render()
    assert np.array_equal(picture_of(scene.window), picture_of(plain.window))


# --- copies and texts -----------------------------------------------------------------------------


def test_a_volume_is_copied(image):
    """A shallow copy shares mapper and property and draws the same."""
    scene = ComparisonScene(ours=True)
    original = show(scene, image, NESTED, matrix=TURNED)
    first = scene.picture()
    for kind in (type(original), vtkVolume):
        copy = kind()
        copy.ShallowCopy(original)
        assert copy.GetMapper() is original.GetMapper()
        scene.renderer.RemoveAllViewProps()
        scene.renderer.AddVolume(copy)
        assert np.array_equal(scene.picture(), first)


def test_a_mapper_is_copied(image):
    """The copy has what vtkAbstractMapper copies: the clipping planes."""
    scene, other = ComparisonScene(ours=True), ComparisonScene(ours=True)
    show(scene, image).GetMapper().AddClippingPlane(next(planes((1, 0, 0))))
    show(other, image).GetMapper().ShallowCopy(scene.mapper)
    assert other.mapper.GetClippingPlanes() is scene.mapper.GetClippingPlanes()
    assert np.array_equal(scene.picture(), other.picture())


def test_everything_prints(image):
    scene = ComparisonScene(ours=True)
    volume = show(scene, image, NESTED)
    scene.mapper.SetMemoryBudget(123456789)
    text = str(scene.mapper)
    for name in (
        "Rate",
        "Component",
        "SpeculationLimit",
        "MemoryBudget",
        "DecodeWholeVolume",
        "LargestBuffer",
        "PixelsPerStraggler",
        "TimeAllowance",
    ):
        assert name in text
    assert "123456789" in text and "vtkIsosurfaceVolume" in str(volume)


# --- limits ---------------------------------------------------------------------------------------


def complaints(scene):
    with vtk_messages() as messages:
        scene.window.Render()
    return messages


def test_too_many_isovalues(image):
    """More than 256 that show are refused by one clear error; those that do not are not counted."""
    surfaces = {-0.8 + 1.6 * i / 256: (1, 1, i / 256, 0.2) for i in range(257)}
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces)
    (message,) = complaints(scene)
    assert "at most 256 isovalues that show" in message and "257" in message
    assert np.ptp(picture_of(scene.window).reshape(-1, 3), axis=0).max() == 0
    surfaces[-0.8] = (1, 1, 1, 0.0)
    paint(scene.volumes[0], surfaces)
    assert not complaints(scene)
    assert np.ptp(picture_of(scene.window).reshape(-1, 3), axis=0).max() > 50


def test_too_many_clipping_planes(image):
    scene = ComparisonScene(ours=True)
    mapper = show(scene, image).GetMapper()
    for count in range(17):
        assert not complaints(scene)
        plane = vtkPlane()
        plane.SetOrigin(-100, 0, 0)
        plane.SetNormal(1, 0.01 * count, 0)
        mapper.AddClippingPlane(plane)
    (message,) = complaints(scene)
    assert "at most 16 clipping planes" in message and "17" in message


def test_too_many_lights(image):
    scene = ComparisonScene(ours=True)
    show(scene, image).GetProperty().ShadeOn()
    for _ in range(17):
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        scene.renderer.AddLight(light)
    (message,) = complaints(scene)
    assert "at most 16 lights that are switched on" in message and "17" in message
    light.SwitchOff()
    assert not complaints(scene)


@pytest.mark.parametrize("surfaces", [{}, {0.1: (*GREEN, 0.0)}, {5.0: (*GREEN, 1.0)}])
@pytest.mark.parametrize("settings", [{}, CACHED])
def test_nothing_to_show(image, surfaces, settings):
    """No isovalue, a fully transparent one and one outside the values make a complete, empty
    picture, and no error."""
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces, **settings)
    assert not complaints(scene)
    assert scene.mapper.GetConverged() and scene.mapper.GetCompletedFraction() == 1
    assert np.ptp(picture_of(scene.window).reshape(-1, 3), axis=0).max() == 0
    assert not np.isfinite(progiso.depth(scene.mapper)).any()
