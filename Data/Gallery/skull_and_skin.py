"""A CT scan with two isosurfaces: the bone, and the skin through which it shows."""

import sys
from pathlib import Path

import pyvista as pv

import progiso
from progiso.data import fetch


def draw(size=(640, 480)):
    """Return a plotter with the scene."""
    scan = progiso.compress(progiso.read(fetch("ct-cranium")), rate=8)
    plotter = pv.Plotter(off_screen=True, window_size=size)
    plotter.set_background("#dfe5ea")
    head = plotter.progiso.add_isosurface(
        scan,
        [226, -200],
        color=["#f3ead3", "#e0a284"],
        opacity=[1.0, 0.4],
        specular=0.3,
    )
    # the headrest goes: what it leaves of a box, and behind the ear
    head.GetMapper().SetCroppingRegionPlanes(33, 213, 12, 245, 0, 161)
    head.GetMapper().CroppingOn()
    plotter.progiso.clip(head, (1, -1, 0), origin=(153, 0, 0))
    plotter.view_vector((0.75, 1.0, 0.25), viewup=(0, 0, 1))
    plotter.camera.zoom(1.7)
    return plotter


if __name__ == "__main__":
    draw().screenshot(sys.argv[1] if sys.argv[1:] else Path(__file__).with_suffix(".png"))
