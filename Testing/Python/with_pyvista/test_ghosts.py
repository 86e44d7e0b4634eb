"""Points that are ghosts in pyvista are hidden."""

import numpy as np
import pytest

import progiso
from helpers.holes import HIDDEN_POINT, ISOVALUE, SHAPE, SIZE, ball, hidden_points
from helpers.images import blobs, make_image
from helpers.scenes import Scene
from progiso.oracle.caster import Camera


def test_ghosts_in_pyvista():
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.wrap(make_image(blobs(SHAPE, 3)))
    grid.point_data["vtkGhostType"] = np.where(ball(SHAPE, 12).ravel(), HIDDEN_POINT, 0).astype(
        np.uint8
    )
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    prop = plotter.progiso.add_isosurface(grid, ISOVALUE, rate=12)
    plotter.screenshot()
    expected, hidden = hidden_points()
    scene = Scene(expected, ISOVALUE, Camera.from_vtk(plotter.camera), SIZE)
    assert np.isfinite(progiso.depth(prop.GetMapper())).any()
    assert np.array_equal(np.isfinite(progiso.depth(prop.GetMapper())), np.isfinite(scene.depth()))
