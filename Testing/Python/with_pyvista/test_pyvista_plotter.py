"""Sliders, clipping, views and picking in a plotter."""

import numpy as np
import pytest

import progiso
from helpers.plotters import SIZE, isovalues, new_plotter, picture

pyvista = pytest.importorskip("pyvista")


# --- sliders and planes ---------------------------------------------------------------------------


def test_slider_moves_the_isovalue(plotter, ball):
    """The volume is compressed once, and its blocks' ranges are found once."""
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
    """As in pyvista's clip, what the normal points to goes away."""
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


# --- views ----------------------------------------------------------------------------------------


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


# --- levels of detail -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def large_ball():
    """Return distances from the centre, of so many samples that a level of detail is made."""
    image = pyvista.ImageData(dimensions=(73, 73, 73), origin=(-36, -36, -36))
    image["distance"] = np.linalg.norm(image.points, axis=1).astype(np.float32)
    return image


@pytest.mark.parametrize(
    "options, levels",
    [
        ({}, 0),
        ({"level_of_detail": "on"}, 1),
        ({"level_of_detail": "interactive"}, 1),
        ({"level_of_detail": "on", "levels": 0}, 0),
        ({"levels": 3}, 1),
    ],
)
@pytest.mark.parametrize("slider", [False, True])
def test_plain_images_get_levels_of_detail(plotter, large_ball, options, levels, slider):
    """They do where these may be drawn, unless the caller says how many."""
    if slider:
        prop = plotter.progiso.add_isosurface_slider(large_ball, value=30, **options)
    else:
        prop = plotter.progiso.add_isosurface(large_ball, 30, **options)
    assert len(progiso.describe(prop.GetMapper().GetInput())["levels"]) == levels
    assert prop.GetMapper().GetLevelOfDetail() == ("off", "on", "interactive").index(
        options.get("level_of_detail", "off")
    )


def test_the_view_is_coarse_while_the_mouse_turns_it(plotter, large_ball):
    """As soon as the button is released it is exact again."""
    prop = plotter.progiso.add_isosurface(
        large_ball, 30, level_of_detail="interactive", pixel_tolerance=64
    )
    plotter.enable_trackball_style()
    plotter.show(auto_close=False)
    found, interactor = [], plotter.iren.interactor

    def look():
        found.append(plotter.progiso.statistics(prop)["levels"])

    look()
    interactor.SetEventInformation(120, 120, 0, 0, chr(0), 0, None)
    interactor.LeftButtonPressEvent()
    for x in (130, 140):
        interactor.SetEventInformation(x, 120, 0, 0, chr(0), 0, None)
        interactor.MouseMoveEvent()
        look()
    interactor.LeftButtonReleaseEvent()
    look()
    before, *moving, after = found
    assert list(before) == list(after) == [0] and before[0] > 1000 and after[0] > 1000
    assert all(levels[0] == 0 and levels[1] > 1000 for levels in moving), moving


@pytest.mark.parametrize("method", ["add_isosurface", "add_isosurface_slider"])
def test_no_such_level_of_detail(plotter, large_ball, method):
    with pytest.raises(ValueError, match="'on', 'interactive' or 'conservative', got"):
        getattr(plotter.progiso, method)(large_ball, (10, 30), level_of_detail="fast")
    assert not plotter.actors


# --- picking --------------------------------------------------------------------------------------


def test_surface_at(plotter, ball):
    """Hits lie on the sphere; nothing is hit beside it."""
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
    if pickable:
        # the prop is all that it finds: it would read the place off samples, of which a compressed
        # volume has none
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
