"""What pyvista's users expect of a plotter: colours, scalar bars, sliders, views, picking, and pictures that are complete."""

import os
import shutil
import subprocess
import sys
import warnings

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingUI import vtkGenericRenderWindowInteractor
from vtkmodules.vtkWebCore import vtkWebApplication

import progiso
from helpers.images import blobs

pyvista = pytest.importorskip("pyvista")

SIZE = (240, 240)


@pytest.fixture(scope="module")
def ball():
    """Distances from the centre: isosurfaces are spheres, the isovalue is their radius."""
    image = pyvista.ImageData(dimensions=(33, 33, 33), origin=(-16, -16, -16))
    image["distance"] = np.linalg.norm(image.points, axis=1).astype(np.float32)
    return image.progiso.compress(rate=16)


def new_plotter(**arguments):
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE, **arguments)
    plotter.set_background("black")
    return plotter


@pytest.fixture
def plotter():
    plotter = new_plotter()
    yield plotter
    plotter.close()


def isovalues(prop):
    return prop.GetProperty().GetIsoSurfaceValues()


def picture(plotter):
    """What a plotter shows now; its screenshot alone would be of the last render."""
    plotter.render()
    return plotter.screenshot(return_img=True)


def colour(plotter):
    """Colour in the centre, from 0 to 1."""
    return pytest.approx(picture(plotter)[SIZE[1] // 2, SIZE[0] // 2] / 255, abs=0.02)


# --- colours


def test_colours_for_each_isovalue(plotter, ball):
    """In every form that pyvista takes for a colour; one alone is not taken for several."""
    prop = plotter.progiso.add_isosurface(
        ball, [12, 6], color=["red", (0, 0, 255)], opacity=[0, 1], lighting=False
    )
    assert colour(plotter) == (0, 0, 1)
    isovalues(prop).SetValue(1, 15)
    assert colour(plotter) == (0, 0, 1)
    plotter.progiso.add_isosurface(ball, 16, color=[0.0, 1.0, 0.0], lighting=False)
    assert colour(plotter) == (0, 1, 0)


def test_the_theme_gives_the_colour_and_the_light(ball):
    theme = pyvista.themes.Theme()
    theme.color, theme.lighting = "cyan", False
    plotter = new_plotter(theme=theme)
    plotter.progiso.add_isosurface(ball, 10)
    assert colour(plotter) == (0, 1, 1)
    plotter.close()


def test_cmap_colours_by_isovalue(plotter, ball):
    prop = plotter.progiso.add_isosurface(
        ball, 12, cmap=["red", "lime", "blue"], clim=[0, 12], lighting=False, show_scalar_bar=False
    )
    assert colour(plotter) == (0, 0, 1)
    isovalues(prop).SetValue(0, 6)
    assert colour(plotter) == (0, 1, 0)
    assert not plotter.scalar_bars


def test_several_isovalues_are_coloured_by_value(plotter, ball):
    """With the theme's colours over the range of all values, and a scalar bar that says so."""
    prop = plotter.progiso.add_isosurface(ball, [5, 12], lighting=False)
    low, high = ball.progiso.info["range"]
    assert plotter.scalar_bars["distance"].GetLookupTable().GetRange() == pytest.approx((low, high))
    expected = pyvista.LookupTable(plotter.theme.cmap, scalar_range=(low, high)).map_value(
        12, opacity=False
    )
    assert colour(plotter) == expected
    assert prop.GetProperty().GetScalarOpacity().GetValue(12) == 1


def test_log_scale(plotter, ball):
    plotter.progiso.add_isosurface(
        ball, 10, cmap=["red", "lime", "blue"], clim=[1, 100], log_scale=True, lighting=False, scalar_bar_args={"title": "r"}
    )  # fmt: skip
    assert colour(plotter) == (0, 1, 0)
    assert list(plotter.scalar_bars.keys()) == ["r"]


def test_a_shared_scalar_bar_tells_everyones_colours(plotter, ball):
    """Bars of one title are one bar: where a second surface widens it, the first one's colour follows."""
    prop = plotter.progiso.add_isosurface(ball, 10, cmap="gray", clim=[0, 10], lighting=False)
    assert colour(plotter) == (1, 1, 1)
    plotter.progiso.add_isosurface(ball, 3, cmap="gray", clim=[0, 20], lighting=False)
    assert colour(plotter) == (0.5, 0.5, 0.5)
    assert prop.GetProperty().GetRGBTransferFunction().GetRange() == (0, 20)


WRONG = {
    "colours": ({"color": ["red"] * 3}, "color: 3 for 2 isovalues; give 1 or 2"),
    "unknown colour": ({"color": ["red", "rod"]}, "rod"),
    "both": ({"color": "red", "cmap": "viridis"}, "give either color or cmap"),
    "opacities": ({"opacity": [1, 1, 1]}, "opacity: 3 for 2"),
    "clim": ({"clim": (3, 3)}, "clim must be the least and the greatest"),
    "log of nothing": ({"clim": (0, 3), "log_scale": True}, "log_scale needs values above 0"),
}


@pytest.mark.parametrize("case", WRONG)
def test_errors_name_what_is_wrong(plotter, ball, case):
    arguments, message = WRONG[case]
    with pytest.raises(ValueError, match=message):
        plotter.progiso.add_isosurface(ball, [3, 5], **arguments)
    assert not any(prop.IsA("vtkIsosurfaceVolume") for prop in plotter.actors.values())


# --- sliders and planes


def test_slider_moves_the_isovalue(plotter, ball):
    """A volume is compressed once, and its blocks' ranges are found once."""
    image = ball.progiso.decompress()
    prop = plotter.progiso.add_isosurface_slider(
        image, rng=(4, 16), title="radius", color="lime", lighting=False
    )
    mapper = prop.GetMapper()
    assert isovalues(prop).GetValue(0) == 10
    small = np.count_nonzero(picture(plotter)[..., 1] == 255)
    held = mapper.GetInput()
    (widget,) = (
        plotter.widgets.slider_widgets if hasattr(plotter, "widgets") else plotter.slider_widgets
    )
    assert widget.GetRepresentation().GetTitleText() == "radius"
    widget.GetRepresentation().SetValue(15)
    widget.InvokeEvent("InteractionEvent")
    large = np.count_nonzero(picture(plotter)[..., 1] == 255)
    assert isovalues(prop).GetValue(0) == 15 and large == pytest.approx(small * 1.5**2, rel=0.1)
    assert progiso.is_compressed(held) and mapper.GetInput() is held


def test_clip(plotter, ball):
    """As pyvista's clip: what the normal points to goes away."""
    prop = plotter.progiso.add_isosurface(ball, 10, color="white", lighting=False)
    plotter.view_xz()
    whole = picture(plotter)[..., 0] > 128
    plotter.progiso.clip(prop, "x", (0, 0, 0))
    left = picture(plotter)[..., 0] > 128
    plotter.progiso.clip(prop, (1, 0, 0), invert=False)
    right = picture(plotter)[..., 0] > 128
    assert np.array_equal(left | right, whole) and not (left & right).any()
    assert 0 < np.argwhere(left)[:, 1].max() < np.argwhere(right)[:, 1].min()
    with pytest.raises(ValueError, match="normal must be x, y, z"):
        plotter.progiso.clip(prop, "w")


# --- views


def test_subplots_and_linked_views(ball):
    """Each view has its surface; a camera moves in both."""
    plotter = new_plotter(shape=(1, 2), border=False)
    props = []
    for column, radius in enumerate((6, 12)):
        plotter.subplot(0, column)
        plotter.set_background("black")
        props.append(plotter.progiso.add_isosurface(ball, radius, color="white", lighting=False))
    plotter.link_views()
    lit = picture(plotter)[..., 0] > 128
    middle = SIZE[0] // 2
    assert 3 * lit[:, :middle].sum() < lit[:, middle:].sum()
    for prop, column in zip(props, (middle // 2, middle + middle // 2)):
        met = plotter.progiso.surface_at(prop, column, SIZE[1] // 2)
        assert met.isovalue == isovalues(prop).GetValue(0)
        assert np.linalg.norm(met.position) == pytest.approx(met.isovalue, abs=0.05)
        assert plotter.progiso.statistics(prop)["size"] == [middle, SIZE[1]]
    assert plotter.progiso.surface_at(props[0], middle + middle // 2, SIZE[1] // 2) is None
    plotter.camera.zoom(0.5)
    smaller = picture(plotter)[..., 0] > 128
    assert (
        smaller[:, :middle].sum() < lit[:, :middle].sum()
        and smaller[:, middle:].sum() < lit[:, middle:].sum()
    )
    plotter.close()


# --- picking


def test_surface_at(plotter, ball):
    """Hits lie on the sphere, nowhere else; nothing is hit beside it."""
    prop = plotter.progiso.add_isosurface(ball, [12, 6], color="white", opacity=[0, 1])
    plotter.show(auto_close=False)
    for x, y in ((120, 120), (135, 110), (101, 128)):
        met = plotter.progiso.surface_at(prop, x, y)
        assert met.isovalue == 6 and np.linalg.norm(met.position) == pytest.approx(6, abs=0.05)
        world = np.append(met.position, 1)
        plotter.renderer.SetWorldPoint(world)
        plotter.renderer.WorldToDisplay()
        assert plotter.renderer.GetDisplayPoint()[:2] == pytest.approx((x + 0.5, y + 0.5), abs=0.51)
    assert plotter.progiso.surface_at(prop, 3, 3) is None
    with pytest.raises(ValueError, match="not in this plotter"):
        plotter.progiso.surface_at(progiso.make_isosurface(ball, 3), 1, 1)


@pytest.mark.parametrize("pickable", [True, False])
def test_hardware_picker_finds_the_prop(plotter, ball, pickable):
    prop = plotter.progiso.add_isosurface(ball, 8, pickable=pickable)
    plotter.show(auto_close=False)
    plotter.iren.picker = "hardware"
    picker = plotter.iren.picker
    assert picker.Pick(120, 120, 0, plotter.renderer) == pickable
    assert picker.GetViewProp() is (prop if pickable else None)
    if pickable:  # the prop is all that it finds: it would read the place off samples, of which a compressed volume has none
        position, isovalue = plotter.progiso.surface_at(prop, 120, 120)
        assert np.linalg.norm(position) == pytest.approx(8, abs=0.1) and isovalue == 8


def test_clicks(plotter, ball):
    prop = plotter.progiso.add_isosurface(ball, 8)
    plotter.show(auto_close=False)
    met = []
    plotter.progiso.track_surface_clicks(prop, lambda *hit: met.append(hit), side="left")
    for x, y in ((120, 120), (2, 2)):
        plotter.iren.interactor.SetEventInformation(x, y)
        plotter.iren.interactor.LeftButtonPressEvent()
    ((position, isovalue),) = met
    assert isovalue == 8 and np.linalg.norm(position) == pytest.approx(8, abs=0.05)


# --- complete pictures


@pytest.fixture
def watched():
    """A plotter in whose window an image is growing, a pass a render, and the prop."""
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
    """Every frame; a writer that only keeps them stands for a movie's."""
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
    """As trame, which pyvista's server backend in Jupyter is, asks VTK for them: an off-screen window's JPEG."""
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
    """In show(), as it is used: an interactor's loop and timers make the image grow until it is complete."""
    if not shutil.which("xvfb-run"):
        lacking("needs xvfb-run")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    environment.pop("VTK_DEFAULT_OPENGL_WINDOW", None)
    command = [
        "xvfb-run",
        "-n",
        str(os.getpid()),
        "-s",
        "-screen 0 640x480x24",
        sys.executable,
        "-c",
        ON_SCREEN,
    ]
    shown = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=120, cwd=tmp_path
    )
    fractions = [float(word) for word in shown.stdout.split()]
    assert len(set(fractions)) > 3 and fractions[0] < 1 and fractions[-1] == 1, (
        shown.stdout + shown.stderr
    )
    assert fractions == sorted(fractions)


def test_nothing_to_see_is_said(plotter, ball):
    with pytest.warns(UserWarning, match="isovalue 1000 is outside"):
        plotter.progiso.add_isosurface(ball, 1000)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plotter.progiso.add_isosurface(ball, [8, 1000], color="white")
