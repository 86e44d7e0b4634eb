"""An MRI scan of a brain: the cortex, cut open, and the white matter inside it."""

import sys
from pathlib import Path

import pyvista as pv

import progiso
from progiso.data import fetch


def draw(size=(640, 480)):
    """Return a plotter with the scene."""
    scan = progiso.compress(progiso.read(fetch("mri-brain")), rate=8)
    plotter = pv.Plotter(off_screen=True, window_size=size)
    plotter.set_background("#1d1b26")
    cortex = plotter.progiso.add_isosurface(scan, 45, color="#e8b4a6", specular=0.35)
    plotter.progiso.add_isosurface(scan, 100, color="#f4efe6", specular=0.1)
    plotter.progiso.clip(cortex, normal=(0.55, 0.9, 0.0))
    plotter.view_vector((-0.9, 0.55, 0.55), viewup=(0, 0, 1))
    plotter.camera.zoom(1.45)
    return plotter


if __name__ == "__main__":
    draw().screenshot(sys.argv[1] if sys.argv[1:] else Path(__file__).with_suffix(".png"))
