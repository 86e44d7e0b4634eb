"""Holes: NaN where it is to be hidden, and blanked points, plain and compressed; an error where NaN is not."""

from common import (
    check_converged,
    check_same,
    covered,
    finish,
    load_plugin,
    look,
    make_view,
    make_wavelet,
    screenshot,
    show_isosurface,
)
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

load_plugin()
view = make_view()
wavelet = make_wavelet()

# scripts of programmable filters share these names with this script
HOLE = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
image = self.GetImageDataOutput()
image.DeepCopy(self.GetInput())
values = vtk_to_numpy(image.GetPointData().GetArray("RTData"))
z, y, x = numpy.indices(image.GetDimensions()[::-1])
hole = ((x - 24) ** 2 + (y - 24) ** 2 + (z - 40) ** 2 < 16**2).ravel()
"""
spoiled = simple.ProgrammableFilter(Input=wavelet, Script=HOLE + "values[hole] = numpy.nan")
MARK = """
ghosts = numpy_to_vtk(numpy.where(hole, 2, 0).astype(numpy.uint8), deep=True)
ghosts.SetName("vtkGhostType")
image.GetPointData().AddArray(ghosts)
"""
blanked = simple.ProgrammableFilter(Input=wavelet, Script=HOLE + MARK)


def shoot(source, name, **properties):
    """A picture of a source alone."""
    display = show_isosurface(
        source,
        view,
        Isovalues=[150.0],
        DiffuseColor=[0.9, 0.85, 0.7],
        CompressionRate=12.0,
        **properties,
    )
    look(view)
    pixels = screenshot(view, name)
    check_converged(display)
    simple.Hide(source, view)
    return pixels


whole = shoot(wavelet, "hidden_nothing.png")
seen = shoot(spoiled, "hidden_nan.png", MaskNaN=1)
assert 0 < covered(seen) and (abs(seen - whole).max(axis=2) > 8).mean() > 0.02
check_same(seen, shoot(blanked, "hidden_points.png"))
check_same(
    seen, shoot(simple.ZFPCompress(Input=spoiled, Rate=12, MaskNaN=1), "hidden_compressed.png")
)
check_same(seen, shoot(simple.ZFPCompress(Input=blanked, Rate=12), "hidden_compressed_points.png"))

usual, listener = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
vtkOutputWindow.SetInstance(listener)
simple.ZFPCompress(Input=spoiled).UpdatePipeline()
vtkOutputWindow.SetInstance(usual)
assert "NaN" in listener.GetOutput(), listener.GetOutput()

finish(covered=covered(seen))
