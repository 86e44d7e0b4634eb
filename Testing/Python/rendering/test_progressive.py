"""Images appear pass by pass in a window that someone watches, and complete everywhere else."""

import numpy as np
import pytest
from vtkmodules.vtkRenderingUI import vtkGenericRenderWindowInteractor

import progiso
from helpers.images import blobs, make_image, reference_volume
from helpers.scenes import CACHED, Scene, orbit


class Watched(Scene):
    """A scene in a window with an interactor, whose timers wait until they are fired by hand."""

    def __init__(self, image, **settings):
        camera = orbit(reference_volume(image), 1, 4)
        super().__init__(image, 0.1, camera, SpeculationLimit=1, **CACHED, **settings)
        if self.window.IsA("vtkEGLRenderWindow"):
            pytest.skip("an EGL window is off-screen, hence always complete")
        self.window.SetOffScreenRendering(False)
        self.interactor = vtkGenericRenderWindowInteractor()
        self.interactor.SetRenderWindow(self.window)
        self.timers = 0
        self.interactor.AddObserver("CreateTimerEvent", self.count_timer)
        self.interactor.Initialize()
        self.renderer.ResetCameraClippingRange()

    def count_timer(self, *_):
        self.timers += 1

    def fire(self):
        """Fire one waiting timer."""
        self.timers -= 1
        self.interactor.TimerEvent()


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((60, 56, 64), 12, waves=6)), rate=8)


@pytest.fixture(scope="module")
def complete(image):
    """Return the depth image of a window that nobody watches."""
    scene = Scene(image, 0.1, orbit(reference_volume(image), 1, 4))
    assert scene.render() == 1
    return scene.depth()


def test_watched_window_refines(image, complete):
    """Each render adds to the image and asks for another, until it is complete."""
    scene = Watched(image, TimeAllowance=0.0)
    scene.window.Render()
    fractions = [scene.mapper.GetCompletedFraction()]
    assert not scene.mapper.GetConverged() and 0 < fractions[0] < 1
    while scene.timers:
        scene.fire()
        fractions.append(scene.mapper.GetCompletedFraction())
        assert len(fractions) < 500
    assert scene.mapper.GetConverged() and len(fractions) > 3
    assert fractions == sorted(fractions) and fractions[-1] == 1
    assert progiso.depth(scene.mapper).tobytes() == complete.tobytes()


def test_partial_images_hold_only_final_pixels(image, complete):
    """A pixel is the complete image's or still empty."""
    scene = Watched(image, TimeAllowance=0.0)
    scene.window.Render()
    partial = progiso.depth(scene.mapper)
    shown = np.isfinite(partial)
    assert 0 < shown.sum() < np.isfinite(complete).sum()
    assert np.array_equal(partial[shown], complete[shown])


def test_time_allowance_holds(image, complete):
    """With time enough one render completes the image."""
    scene = Watched(image, TimeAllowance=1e9)
    scene.window.Render()
    assert scene.mapper.GetConverged()
    assert progiso.depth(scene.mapper).tobytes() == complete.tobytes()


def test_captures_are_complete(image, complete):
    """Pictures of a watched window are taken without swapping buffers: they wait for the whole
    image."""
    scene = Watched(image, TimeAllowance=0.0)
    scene.window.Render()
    assert not scene.mapper.GetConverged()
    scene.window.SwapBuffersOff()
    scene.window.Render()
    assert scene.mapper.GetConverged()
    assert progiso.depth(scene.mapper).tobytes() == complete.tobytes()


def test_a_moved_camera_starts_anew(image):
    scene = Watched(image, TimeAllowance=0.0)
    scene.window.Render()
    scene.fire()
    before = scene.mapper.GetCompletedFraction()
    scene.renderer.GetActiveCamera().Azimuth(40)
    scene.renderer.ResetCameraClippingRange()
    scene.window.Render()
    assert len(scene.statistics()["passes"]) == 1
    assert scene.mapper.GetCompletedFraction() < max(before, 1)
