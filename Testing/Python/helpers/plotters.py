"""pyvista's plotters, and what they show."""

import pytest

pyvista = pytest.importorskip("pyvista")


SIZE = (240, 240)


def new_plotter(**arguments):
    """Return a plotter without a display, on black."""
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE, **arguments)
    plotter.set_background("black")
    return plotter


def isovalues(prop):
    """Return the isovalues of a plotter's isosurface."""
    return prop.GetProperty().GetIsoSurfaceValues()


def picture(plotter):
    """Render and return what a plotter shows; its screenshot alone is of the last render."""
    plotter.render()
    return plotter.screenshot(return_img=True)


def colour(plotter):
    """Return the colour in the centre, from 0 to 1, for comparison."""
    return pytest.approx(picture(plotter)[SIZE[1] // 2, SIZE[0] // 2] / 255, abs=0.02)
