"""The same pictures on any number of processes, each of which draws its piece (in pvbatch)."""

import math

import numpy
import session
from paraview import servermanager, simple

assert session.BUILD.is_dir()
view = session.start(size=[320, 240])
camera = view.GetActiveCamera()
camera.SetFocalPoint(1, 0, 4)
camera.SetPosition(68, 47, 73)
camera.SetViewUp(0, 1, 0)
camera.SetClippingRange(1, 200)

EXTENT = [-23, 25, -24, 24, -20, 29]  # no multiple of four anywhere, also not where it is cut
look = {"Isovalues": [150.0], "DiffuseColor": [0.9, 0.85, 0.7]}


def shoot(source, name, **properties):
    """Save a picture of a source alone; return its display."""
    display = session.show_isosurface(source, view, **{**look, **properties})
    session.screenshot(view, f"{name}.png")
    simple.Hide(source, view)
    return display


wavelet = simple.Wavelet(WholeExtent=EXTENT)
display = shoot(wavelet, "plain", CompressionRate=4)
processes = servermanager.ActiveConnection.GetNumberOfDataPartitions()

compressed = simple.ZFPCompress(Input=wavelet, Rate=4)
first = list(session.show_isosurface(compressed, view).Isovalues)
assert math.isclose(
    first[0], session.middle(wavelet.PointData["RTData"].GetRange()), rel_tol=1e-6
), "range of all pieces"
shoot(compressed, "compressed")
decompressed = simple.ZFPDecompress(Input=compressed)
shoot(decompressed, "decompressed", CompressionRate=16)

cells = simple.PointDatatoCellData(Input=wavelet)
shoot(cells, "cells", CompressionRate=6)
shoot(simple.ZFPCompress(Input=cells, Rate=6), "cells-compressed")

for name in ("file-compressed", "file-plain"):
    shoot(simple.OpenDataFile(str(session.OUTPUT.parent / f"{name}.vti")), name)

# a file that one process reads
zfp = simple.OpenDataFile(str(session.OUTPUT.parent / "file.zfp"))
zfp.DataOrigin = [-22, -20, -18]
shoot(zfp, "file-zfp")
simple.ZFPDecompress(Input=zfp).UpdatePipeline()  # nothing to do for the others

# a source that makes pieces, but no ghost cells: they are exchanged
pieces = simple.ProgrammableSource(OutputDataSetType="vtkImageData")
pieces.ScriptRequestInformation = f"""
information = self.GetOutputInformation(0)
information.Set(self.GetExecutive().WHOLE_EXTENT(), {EXTENT}, 6)
information.Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
"""
pieces.Script = f"""
from vtkmodules.vtkCommonExecutionModel import vtkExtentTranslator
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
from vtkmodules.util.numpy_support import numpy_to_vtk
import numpy
information = self.GetOutputInformation(0)
translator = vtkExtentTranslator()
translator.SetWholeExtent({EXTENT})
translator.SetPiece(information.Get(pipeline.UPDATE_PIECE_NUMBER()))
translator.SetNumberOfPieces(information.Get(pipeline.UPDATE_NUMBER_OF_PIECES()))
translator.SetGhostLevel(0)
translator.PieceToExtent()
extent = translator.GetExtent()
image = self.GetImageDataOutput()
image.SetExtent(extent)
axes = [numpy.arange(extent[a], extent[a + 1] + 1.0) for a in (4, 2, 0)]
z, y, x = numpy.meshgrid(*axes, indexing="ij")
values = 150 + 60 * (numpy.sin(0.3 * x) * numpy.cos(0.4 * y) + numpy.sin(0.2 * z + 0.1 * x))
array = numpy_to_vtk(values.ravel(), deep=1)
array.SetName("values")
image.GetPointData().SetScalars(array)
"""
shoot(pieces, "pieces", CompressionRate=8)

# several isosurfaces, and translucent ones, which composite in the order of the pieces
shoot(wavelet, "several", Isovalues=[90.0, 210.0], CompressionRate=4)
shoot(compressed, "translucent", Isovalues=[120.0, 200.0], Opacity=0.4)

# triangles of each piece; those beyond it are marked as another's
contour = simple.ZFPContour(Input=compressed, Isosurfaces=[150.0])
shown = simple.Show(contour, view)
shown.SetRepresentationType("Surface")
simple.ColorBy(shown, None)
session.screenshot(view, "contour.png")


def area_of(surface):
    """Return the area of a surface's triangles, of all processes."""
    areas = simple.IntegrateVariables(Input=surface)
    areas.UpdatePipeline()
    return areas.CellData["Area"].GetRange()[0]


# of the whole, and of a subset
subset = simple.ExtractSubset(Input=compressed, VOI=[-13, 15, -24, 3, -9, 29])
subset_contour = simple.ZFPContour(Input=subset, Isosurfaces=[150.0])
area = [area_of(surface) for surface in (contour, subset_contour)]
assert 0 < area[1] < 0.8 * area[0], area
simple.Hide(contour, view)

# among other geometry, which hides it and is hidden by it
sphere = simple.Sphere(Radius=9, Center=[16, 8, 18], ThetaResolution=40, PhiResolution=40)
shown = simple.Show(sphere, view)
shown.DiffuseColor = [0.3, 0.5, 0.9]
shoot(compressed, "among-meshes", Opacity=1.0)
shoot(compressed, "translucent-among-meshes", Opacity=0.4)

session.finish(processes=int(numpy.asarray(processes)), area=area)
