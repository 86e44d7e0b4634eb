"""Pictures that leave a plotter are complete: screenshots, movies, images for browsers."""

import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingUI import vtkGenericRenderWindowInteractor
from vtkmodules.vtkWebCore import vtkWebApplication

from helpers.images import blobs
from helpers.plotters import SIZE, new_plotter

pyvista = pytest.importorskip("pyvista")


@pytest.fixture
def watched():
    """Yield a plotter in whose window an image is growing, a pass a render, and the prop."""
    image = pyvista.ImageData(dimensions=(64, 56, 60))
    image["field"] = blobs((60, 56, 64), 12, waves=6).ravel()
    plotter = new_plotter()
    prop = plotter.progiso.add_isosurface(image, 0.1, color="white", speculation=False)
    if plotter.render_window.IsA("vtkEGLRenderWindow"):
        pytest.skip("an EGL window is off-screen, hence always complete")
    prop.GetMapper().SetDecodeWholeVolume(False)
    prop.GetMapper().SetTimeAllowance(0)
    plotter.show(auto_close=False)
    interactor = vtkGenericRenderWindowInteractor()
    plotter.render_window.SetInteractor(interactor)
    interactor.Initialize()
    plotter.render_window.SetOffScreenRendering(False)
    for _ in range(5):  # a view has to be seen to be alone in its window
        plotter.render()
    plotter.camera.azimuth = 70
    prop.GetMapper().EmptyCache()
    plotter.render()
    assert not prop.GetMapper().GetConverged()
    yield plotter, prop
    plotter.close()


@pytest.mark.parametrize("arguments", [{}, {"scale": 2}, {"window_size": (200, 100)}])
def test_screenshots_are_complete(watched, arguments):
    plotter, prop = watched
    partial = plotter.image.copy()
    picture = plotter.screenshot(return_img=True, **arguments)
    assert prop.GetMapper().GetTimeAllowance() == 0
    plotter.render_window.SetOffScreenRendering(True)
    plotter.render()
    assert np.array_equal(picture, plotter.screenshot(return_img=True, **arguments))
    assert not np.array_equal(partial, plotter.image)


def test_movies_are_complete(watched):
    """Every frame is; a writer that only keeps frames stands for a movie's."""
    plotter, prop = watched
    frames = []

    class Writer:
        append_data = frames.append
        close = staticmethod(lambda: None)

    plotter.mwriter = Writer()
    plotter.write_frame()
    plotter.render_window.SetOffScreenRendering(True)
    plotter.render()
    assert len(frames) == 1 and np.array_equal(frames[0], plotter.image)


def test_images_for_browsers_are_complete(watched, tmp_path):
    """trame, pyvista's server backend in Jupyter, asks VTK for an off-screen window's JPEG."""
    plotter, prop = watched
    plotter.render_window.SetOffScreenRendering(True)
    prop.GetMapper().EmptyCache()
    plotter.camera.azimuth = 30
    application = vtkWebApplication()
    application.SetImageEncoding(vtkWebApplication.ENCODING_NONE)
    jpeg = tmp_path / "image.jpg"
    jpeg.write_bytes(vtk_to_numpy(application.StillRender(plotter.render_window, 100)).tobytes())
    sent = pyvista.read(jpeg).active_scalars.reshape(SIZE[1], SIZE[0], 3)[::-1].astype(int)
    shown = plotter.screenshot(return_img=True)
    assert (shown > 100).any() and np.abs(sent - shown).mean() < 3


def test_vector_graphics_hold_a_picture(plotter, ball, tmp_path):
    files = [tmp_path / "empty.svg", tmp_path / "scene.svg"]
    for file in files:
        plotter.show(auto_close=False)
        plotter.save_graphic(str(file))
        plotter.progiso.add_isosurface(ball, 10)
    empty, scene = (file.read_text(errors="ignore").split("<image")[1:] for file in files)
    assert len(scene) == 1 and len(scene[0]) > 2 * len("".join(empty))


def test_depth_images_are_complete(watched):
    plotter, _ = watched
    depth = plotter.get_image_depth()
    plotter.render_window.SetOffScreenRendering(True)
    plotter.render()
    assert np.array_equal(depth, plotter.get_image_depth(), equal_nan=True)


def test_surface_at_completes(watched):
    plotter, prop = watched
    plotter.progiso.surface_at(prop, 1, 1)
    assert prop.GetMapper().GetConverged()


ON_SCREEN = """
import pyvista, progiso
from helpers.images import blobs

image = pyvista.ImageData(dimensions=(64, 56, 60))
image["field"] = blobs((60, 56, 64), 12, waves=6).ravel()
plotter = pyvista.Plotter(window_size=(200, 200))
prop = plotter.progiso.add_isosurface(image, 0.1, speculation=False)
mapper, shown = prop.GetMapper(), []
mapper.SetDecodeWholeVolume(False)
mapper.SetTimeAllowance(0)
mapper.AddObserver("ProgressEvent", lambda *_: shown.append(mapper.GetCompletedFraction()))

def turn(step):
    if step == 5:
        mapper.EmptyCache()
        shown.clear()
        plotter.camera.azimuth = 70
    if step <= 5:
        plotter.render()
    elif mapper.GetConverged():  # by timers of its own
        print(*shown)
        plotter.iren.terminate_app()

plotter.add_timer_event(max_steps=1000, duration=20, callback=turn)
plotter.show(auto_close=False)
"""


def test_passes_show_on_screen(lacking, tmp_path):
    """In show() an interactor's loop and timers make the image grow until it is complete."""
    if not shutil.which("xvfb-run"):
        lacking("needs xvfb-run")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    environment.pop("VTK_DEFAULT_OPENGL_WINDOW", None)
    display = ["xvfb-run", "-n", str(os.getpid()), "-s", "-screen 0 640x480x24"]
    command = [*display, sys.executable, "-c", ON_SCREEN]
    shown = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=120, cwd=tmp_path
    )
    fractions = [float(word) for word in shown.stdout.split()]
    assert len(set(fractions)) > 3 and fractions[0] < 1 and fractions[-1] == 1, (
        shown.stdout + shown.stderr
    )
    assert fractions == sorted(fractions)
