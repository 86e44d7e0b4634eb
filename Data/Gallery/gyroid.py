"""A noisy gyroid, 512³, compressed slab by slab (2 bits a sample), coloured by isovalue."""

import sys
from pathlib import Path

import pyvista as pv

import progiso
from progiso.data import compressed


def draw(size=(640, 480), samples=512):
    """Return a plotter with the scene."""
    volume = progiso.read(compressed("gyroid", size=samples, rate=2, k=3))
    plotter = pv.Plotter(off_screen=True, window_size=size)
    plotter.set_background("#151a21")
    plotter.progiso.add_isosurface(
        volume,
        [0.0, 0.9],
        cmap="plasma",
        clim=[-0.3, 1.2],
        opacity=[0.45, 1.0],
        scalar_bar_args={
            "title": "isovalue",
            "color": "white",
            "vertical": True,
            "position_x": 0.86,
        },
    )
    plotter.view_vector((1.0, -0.75, 0.6), viewup=(0, 0, 1))
    plotter.camera.zoom(0.95)
    return plotter


if __name__ == "__main__":
    draw().screenshot(sys.argv[1] if sys.argv[1:] else Path(__file__).with_suffix(".png"))
