"""Colours and scalar bars of isosurfaces in a plotter, and arguments that are wrong."""

import warnings

import pytest

from helpers.plotters import colour, isovalues, new_plotter

pyvista = pytest.importorskip("pyvista")


def test_colours_for_each_isovalue(plotter, ball):
    """A colour may have every form that pyvista takes; a single one is not taken for several."""
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
    """They have the theme's colours over the range of all values, and a scalar bar that says so."""
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
        ball,
        10,
        cmap=["red", "lime", "blue"],
        clim=[1, 100],
        log_scale=True,
        lighting=False,
        scalar_bar_args={"title": "r"},
    )
    assert colour(plotter) == (0, 1, 0)
    assert list(plotter.scalar_bars.keys()) == ["r"]


def test_a_shared_scalar_bar_tells_everyones_colours(plotter, ball):
    """Bars of one title are one bar.

    Where a second surface widens it, the first one's colour follows.
    """
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


def test_nothing_to_see_is_said(plotter, ball):
    with pytest.warns(UserWarning, match="isovalue 1000 is outside"):
        plotter.progiso.add_isosurface(ball, 1000)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plotter.progiso.add_isosurface(ball, [8, 1000], color="white")
