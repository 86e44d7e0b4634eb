"""Draw an image, so that OpenGL compiles its stages, and print what they took as JSON.

    draw_images.py VARIANT

The window may belong to a device that does nothing: nothing is waited for that it would have
to write.
"""

import json
import sys

import progiso
from progiso.data import fetch
from progiso.measure.isosurface import Isosurface
from progiso.vtkProgIsoFilters import vtkCompressedVolume

SIZE = (64, 64)
#: Bytes beside the least budget: the cache is smaller than the volume, and evicts.
ROOM = 1 << 16


def main(variant: str) -> None:
    image = progiso.compress(progiso.read(fetch("gyroid", size=64)), rate=4)
    volume = vtkCompressedVolume()
    volume.Read(image)
    volume.ClearRanges()  # they are found by a stage, too
    volume.Write(image)
    view = Isosurface(image, 0.0, SIZE, cached=variant == "cached")
    view.set_passes_per_render(2)
    view.renderer.ResetCamera()
    view.render()
    if variant == "cached":  # now with a cache that evicts
        view.mapper.SetMemoryBudget(view.statistics()["memory"]["least_budget"] + ROOM)
    for _ in range(3):  # what the first image does without comes with the others
        view.renderer.GetActiveCamera().Azimuth(30)
        view.render()
    programs = view.statistics()["loading"]["programs"]
    print(json.dumps({stage: times["ms"] / 1e3 for stage, times in programs.items()}))


main(*sys.argv[1:])
