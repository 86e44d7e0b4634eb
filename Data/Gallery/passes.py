"""How an image grows: after two passes, three, five, and when it is complete."""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import progiso
from progiso.data import fetch


def draw(size=(800, 640)):
    """Return the pixels of the four images, side by side and below each other."""
    scan = progiso.compress(progiso.read(fetch("ct-cranium")), rate=8)
    plotter = pv.Plotter(off_screen=True, window_size=(size[0] // 2, size[1] // 2))
    plotter.set_background("#14181d")
    prop = plotter.progiso.add_isosurface(scan, 226, color="oldlace", speculation=False)
    plotter.view_vector((0.5, 1.0, 0.15), viewup=(0, 0, 1))
    plotter.camera.zoom(1.75)
    mapper = prop.GetMapper()
    mapper.SetDecodeWholeVolume(False)  # which would make one pass of it
    mapper.SetMaximumPassesPerRender(1)
    plotter.show(auto_close=False)
    mapper.EmptyCache()
    plotter.camera.azimuth = 1  # a new image
    images, passes = [], 0
    while not images or not mapper.GetConverged():
        plotter.render()
        passes += 1
        if passes in (2, 3, 5):  # the first asks for blocks, none of them is there yet
            images.append(np.array(plotter.image))
    images.append(np.array(plotter.image))
    return np.vstack([np.hstack(images[:2]), np.hstack([images[2], images[-1]])])


if __name__ == "__main__":
    progiso.write_png(draw(), sys.argv[1] if sys.argv[1:] else Path(__file__).with_suffix(".png"))
