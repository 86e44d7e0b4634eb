"""The same image within the memory that the mapper would like, and within little."""

import sys
from pathlib import Path

import pyvista as pv

import progiso
from progiso.data import compressed


def draw(size=(800, 400), samples=512, budget=24 * 2**20):
    """Return a plotter with the scene."""
    volume = progiso.read(compressed("gyroid", size=samples, rate=2, k=12))
    plotter = pv.Plotter(off_screen=True, window_size=size, shape=(1, 2), border=False)
    plotter.set_background("#0d1117", all_renderers=True)
    props = []
    for column, (bound, color) in enumerate(((0, "#8fb8de"), (budget, "#9ae19d"))):
        plotter.subplot(0, column)
        props.append(plotter.progiso.add_isosurface(volume, 0, color=color, memory_budget=bound))
    plotter.link_views()
    plotter.view_vector((1.0, -0.6, 0.5), viewup=(0, 0, 1))
    plotter.camera.zoom(1.02)
    plotter.show(auto_close=False)
    for column, prop in enumerate(props):
        memory = plotter.progiso.statistics(prop)["memory"]
        spent = (memory["total"] - memory["compressed"]) / 2**20
        plotter.subplot(0, column)
        plotter.add_text(f"{spent:.0f} MiB beside the volume", font_size=10, color="white")
    plotter.render()
    return plotter


if __name__ == "__main__":
    draw().screenshot(sys.argv[1] if sys.argv[1:] else Path(__file__).with_suffix(".png"))
