"""Holes where points are blanked, or NaN is to be hidden; an error where it is not."""

import session
from paraview import simple

view = session.start()
wavelet = session.make_wavelet()

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
    """Return a picture of a source alone."""
    display = session.show_isosurface(
        source,
        view,
        Isovalues=[150.0],
        DiffuseColor=[0.9, 0.85, 0.7],
        CompressionRate=12.0,
        **properties,
    )
    session.look(view)
    pixels = session.screenshot(view, name)
    session.check_converged(display)
    simple.Hide(source, view)
    return pixels


whole = shoot(wavelet, "hidden_nothing.png")
seen = shoot(spoiled, "hidden_nan.png")  # by default
assert 0 < session.covered(seen) and (abs(seen - whole).max(axis=2) > 8).mean() > 0.02
session.check_same(seen, shoot(blanked, "hidden_points.png"))
session.check_same(seen, shoot(simple.ZFPCompress(Input=spoiled, Rate=12), "hidden_compressed.png"))
session.check_same(
    seen, shoot(simple.ZFPCompress(Input=blanked, Rate=12), "hidden_compressed_points.png")
)

with session.messages() as listener:
    simple.ZFPCompress(Input=spoiled, MaskNaN=0).UpdatePipeline()
assert "Mask NaN" in listener.GetOutput(), listener.GetOutput()

session.finish(covered=session.covered(seen))
