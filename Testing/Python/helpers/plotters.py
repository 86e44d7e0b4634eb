"""pyvista's plotters, and what they show."""

import pytest

pyvista = pytest.importorskip("pyvista")


SIZE = (240, 240)


def new_plotter(**arguments):
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE, **arguments)
    plotter.set_background("black")
    return plotter


def isovalues(prop):
    return prop.GetProperty().GetIsoSurfaceValues()


def picture(plotter):
    """What a plotter shows now; its screenshot alone would be of the last render."""
    plotter.render()
    return plotter.screenshot(return_img=True)


def colour(plotter):
    """Colour in the centre, from 0 to 1."""
    return pytest.approx(picture(plotter)[SIZE[1] // 2, SIZE[0] // 2] / 255, abs=0.02)
