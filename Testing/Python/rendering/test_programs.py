"""Stages compile in the background where the driver can: images do not wait for what they can do
without, and windows that someone watches wait for nothing."""

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkHardwareSelector
from vtkmodules.vtkRenderingUI import vtkGenericRenderWindowInteractor

import progiso
from helpers.gl_hooks import Compiler
from helpers.images import blobs, make_image, noise, reference_volume
from helpers.scenes import CACHED, Scene, least_budget, orbit

SOON = {"CacheAges", "CacheEvict", "CastStragglers", "CacheUnwind", "CacheGrow"}


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((60, 56, 64), 12, waves=6)), rate=8)


def scene_of(image, **settings):
    return Scene(image, 0.1, orbit(reference_volume(image), 1, 4), lit=True, **settings)


@pytest.fixture
def compiler():
    """Return a driver that compiles in the background, and takes the place of OpenGL's own."""
    with Compiler() as compiler:
        yield compiler


def compiled_by(compiler, scene):
    """Return the scene, in a context whose programs `compiler` compiles."""
    scene.volume.SetVisibility(False)
    scene.window.Render()  # loads OpenGL
    scene.volume.SetVisibility(True)
    compiler.take_over()
    return scene


@pytest.fixture(scope="module")
def expected(image):
    """The picture, and what it took, where nothing compiles in the background."""
    scene = scene_of(image, **CACHED)
    return scene.picture(), scene.statistics()


def watched(compiler, image, **settings):
    """Return a scene in a window with an interactor, and the renders that it has asked for."""
    scene = scene_of(image, **settings)
    if scene.window.IsA("vtkEGLRenderWindow"):
        pytest.skip("an EGL window is off-screen, hence always complete")
    scene.window.SetOffScreenRendering(False)
    scene.volume.SetVisibility(False)  # the interactor renders
    scene.interactor = vtkGenericRenderWindowInteractor()
    scene.interactor.SetRenderWindow(scene.window)
    timers = []
    scene.interactor.AddObserver("CreateTimerEvent", lambda *_: timers.append(True))
    scene.interactor.Initialize()
    scene.renderer.ResetCameraClippingRange()
    return compiled_by(compiler, scene), timers


def fire(scene, timers):
    timers.pop()
    scene.interactor.TimerEvent()


def test_all_programs_are_asked_for_at_once(image, compiler, expected):
    """Those without which there is no picture come first."""
    scene = compiled_by(compiler, scene_of(image, **CACHED))
    assert np.array_equal(scene.picture(), expected[0])
    at_once = set(expected[1]["loading"]["programs"]) - SOON
    assert len(compiler.linked) == len(set(compiler.linked))
    assert set(compiler.linked[: len(at_once)]) == at_once
    assert set(compiler.linked[len(at_once) :]) <= SOON
    programs = scene.statistics()["loading"]["programs"]
    assert all(times["ms"] > 0 for times in programs.values())


@pytest.mark.parametrize("settings", [{}, CACHED], ids=["whole", "cached"])
@pytest.mark.parametrize("held", ["MarkBlocks", "CastRays", "Composite"])
def test_a_watched_window_does_not_wait(image, compiler, expected, held, settings):
    """It stays empty until the programs are there, and asks for another render until then."""
    compiler.held = {held}
    scene, timers = watched(compiler, image, TimeAllowance=0.002, **settings)
    scene.window.Render()
    for _ in range(3):
        assert timers and not scene.mapper.GetConverged()
        assert scene.mapper.GetCompletedFraction() == 0
        assert np.ptp(scene.picture().reshape(-1, 3), axis=0).max() == 0
        assert not scene.mapper.WasRenderedIn(scene.renderer)
        fire(scene, timers)
    compiler.held = set()
    while timers:
        fire(scene, timers)
    assert scene.mapper.GetConverged() and scene.mapper.GetNumberOfGLErrors() == 0
    assert np.array_equal(scene.picture(), expected[0])


@pytest.mark.parametrize("settings", [{}, CACHED], ids=["whole", "cached"])
def test_a_driver_without_threads_is_found_out(image, compiler, expected, settings):
    """It compiles a program a render, so that the window can be used in between."""
    compiler.slow = 0.06
    scene, timers = watched(compiler, image, TimeAllowance=0.002, **settings)
    counts = []
    for _ in range(4):
        scene.window.Render()
        counts.append(len(compiler.linked))
        assert timers and scene.mapper.GetCompletedFraction() == 0
    assert np.diff(counts).tolist() == [1, 1, 1]
    timers[1:] = []
    while timers:
        fire(scene, timers)
    assert scene.mapper.GetConverged() and scene.mapper.GetNumberOfGLErrors() == 0
    assert np.array_equal(scene.picture(), expected[0])
    assert "Select" not in compiler.linked


def test_programs_of_later_clicks_compile_while_idle(image, compiler):
    """When a watched image is complete: Select, and the scene's stages with another feature."""
    scene, timers = watched(compiler, image, TimeAllowance=0.0, **CACHED)
    scene.window.Render()
    while not scene.mapper.GetConverged():
        assert "Select" not in compiler.linked and compiler.linked.count("CastRays") == 1
        fire(scene, timers)
    assert compiler.linked.count("Select") == 1 and compiler.linked.count("CastRays") == 4
    assert compiler.linked.count("DecodeBlocks") == 1
    compiler.linked.clear()
    scene.volume.GetProperty().GetIsoSurfaceValues().SetValue(1, 0.2)
    scene.mapper.EmptyCache()
    scene.window.Render()
    while scene.mapper.GetCompletedFraction() == 0:
        fire(scene, timers)
    assert scene.mapper.GetCompletedFraction() < 1  # the first pass is there
    assert set(compiler.linked) <= SOON
    while timers:
        fire(scene, timers)
    assert scene.mapper.GetConverged() and scene.mapper.GetNumberOfGLErrors() == 0


def test_a_click_waits(image, compiler):
    """What is selected must be there: a selection waits for the programs."""
    compiler.held = {"CastRays"}
    scene, _timers = watched(compiler, image, TimeAllowance=0.002, **CACHED)
    scene.window.Render()
    assert not scene.mapper.GetConverged()
    selector = vtkHardwareSelector()
    selector.SetRenderer(scene.renderer)
    selector.SetArea(0, 0, 159, 119)
    selected = selector.Select()
    assert selected.GetNumberOfNodes() == 1 and scene.mapper.GetConverged()


def test_an_image_does_without_what_is_not_compiled(image, compiler, expected):
    """Stragglers are cast as other rays are until their stage is there, which then is used."""
    compiler.held = set(SOON)
    scene = compiled_by(compiler, scene_of(image, **CACHED))
    assert np.array_equal(scene.picture(), expected[0])
    assert not SOON & set(scene.statistics()["stages"])
    compiler.held = set()
    scene.mapper.EmptyCache()
    assert np.array_equal(scene.picture(), expected[0])
    assert "CastStragglers" in scene.statistics()["stages"]


def test_a_full_cache_waits_for_eviction(compiler):
    """Rays that are refused blocks get no farther without it."""
    image = progiso.compress(make_image(noise((96, 96, 96))), rate=8)
    camera = orbit(reference_volume(image), 1, 4)
    budget = least_budget(image, 0.97, camera, **CACHED)
    expected = Scene(image, 0.97, camera, lit=True).picture()
    compiler.held = set(SOON)
    scene = Scene(image, 0.97, camera, lit=True, MemoryBudget=budget, **CACHED)
    assert np.array_equal(compiled_by(compiler, scene).picture(), expected)
    about = scene.statistics()
    assert {"CacheAges", "CacheEvict"} <= set(about["stages"])
    decoded = sum(p["decoded_blocks"] for p in about["passes"])
    assert decoded > about["passes"][-1]["cached_blocks"]


def test_scenes_share_the_stages_that_do_not_depend_on_them(image, compiler):
    """Light, cropping and a second isovalue change nothing in the decoder."""
    scene = compiled_by(compiler, scene_of(image, **CACHED))
    scene.render()
    first = set(compiler.linked)
    compiler.linked.clear()
    scene.volume.GetProperty().SetShade(False)
    scene.mapper.SetCropping(True)
    scene.volume.GetProperty().GetIsoSurfaceValues().SetValue(1, 0.2)
    scene.render()
    kept = {"DecodeBlocks", "CacheReset"}
    assert "BlockRanges" not in first and kept <= first and not kept & set(compiler.linked)
    assert {"CastRays", "Composite"} <= set(compiler.linked)
