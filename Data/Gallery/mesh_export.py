"""An isosurface, raycast and as triangles for a file, both from the same compressed data."""

import sys
import tempfile
from pathlib import Path

import pyvista as pv

import progiso
from progiso.data import fetch


def draw(size=(800, 400), samples=32):
    """Return a plotter with the scene."""
    volume = progiso.compress(progiso.read(fetch("gyroid", size=samples, k=1.5)), rate=12)
    mesh = pv.wrap(progiso.contour(volume, 0))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "surface.ply")
        progiso.save_surface(mesh, file)
        mesh = pv.read(file)
    plotter = pv.Plotter(off_screen=True, window_size=size, shape=(1, 2), border=False)
    plotter.set_background("#f4f1ea", all_renderers=True)
    plotter.add_text("raycast", font_size=10, color="black")
    plotter.progiso.add_isosurface(volume, 0, color="#3f88c5", specular=0.4)
    plotter.subplot(0, 1)
    plotter.add_text(f"{mesh.n_cells} triangles", font_size=10, color="black")
    plotter.add_mesh(mesh, color="#f49d37", show_edges=True, edge_color="#7a4a12", line_width=1)
    plotter.link_views()
    plotter.view_vector((0.8, 0.6, 0.75), viewup=(0, 0, 1))
    plotter.camera.zoom(1.02)
    return plotter


if __name__ == "__main__":
    draw().screenshot(sys.argv[1] if sys.argv[1:] else Path(__file__).with_suffix(".png"))
