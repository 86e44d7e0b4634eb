"""ZFP Compress: rates, labels, tolerances, other arrays, and what cannot be compressed."""

import numpy
import session
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

view = session.start()
image = session.make_wavelet(12)


def figures(source):
    """Return the rate and the largest error of a compressed volume."""
    source.UpdatePipeline()
    source.UpdatePropertyInformation()
    return source.ActualRate, source.LargestError


def values(source, name):
    array = servermanager.Fetch(source).GetPointData().GetArray(name)
    return vtk_to_numpy(array).astype(float)


def errors(source):
    """Return what an update reports."""
    with session.messages() as listener:
        source.UpdatePipeline()
    return listener.GetOutput()


# a rate, which zfp rounds to whole bits a block
compressed = simple.ZFPCompress(Input=image, Rate=5.01)
rate, error = figures(compressed)
assert rate == 321 / 64 and error > 0, (rate, error)
found = values(simple.ZFPDecompress(Input=compressed), "RTData")
assert abs(abs(found - values(image, "RTData")).max() - error) < 1e-3

# a tolerance in place of a rate
rates = []
for tolerance in (10.0, 0.1):
    compressed.Tolerance = tolerance
    rate, error = figures(compressed)
    assert 0 < error <= tolerance, (rate, error)
    rates.append(rate)
assert rates[0] < rates[1], rates
compressed.Tolerance = 1e-9
assert "No rate keeps the samples within 1e-09" in errors(compressed)
compressed.Tolerance = 0

# labels keep apart, at the rate that they need
labels = simple.Calculator(Input=image, Function="floor(RTData / 60) * 100")
labels.ResultArrayName = "labels"
kept = simple.ZFPCompress(Input=labels, InputArray=["POINTS", "labels"], Rate=2)
assert kept.KeepLabels == 1, "as on the command line"
rate, error = figures(kept)
assert rate > 2 and error < 0.5, (rate, error)
kept.KeepLabels = 0
rate, error = figures(kept)
assert rate == 2 and error > 0.5, (rate, error)

# rates out of range are an error, the same everywhere
for rate in (0.0, -1.0, 33.0):
    compressed.Rate = rate
    messages = errors(compressed)
    assert f"Rate is {rate:g} bits" in messages and "in (0, 32]" in messages, messages

with session.messages() as listener:
    shown = session.show_isosurface(image, view, Isovalues=[150.0], CompressionRate=40.0)
    picture = session.screenshot(view, "compress_rate.png")
assert "Rate is 40 bits" in listener.GetOutput(), listener.GetOutput()
assert session.covered(picture) == 0.0
shown.CompressionRate = 8.0
assert session.covered(session.screenshot(view, "compress_rate.png")) > 0.1
simple.Hide(image, view)

# other arrays come along, to the surface, too
both = simple.Calculator(Input=image, Function="coords")
both.ResultArrayName = "place"
passed = simple.ZFPCompress(Input=both, InputArray=["POINTS", "RTData"], Rate=16, PassOtherArrays=1)
passed.UpdatePipeline()
assert list(passed.PointData.keys()) == ["place"], passed.PointData.keys()
surface = simple.ZFPContour(Input=passed, Isosurfaces=[150.0], ComputeGradients=1)
mesh = servermanager.Fetch(surface)
arrays = mesh.GetPointData()
assert numpy.allclose(
    vtk_to_numpy(arrays.GetArray("place")), vtk_to_numpy(mesh.GetPoints().GetData()), atol=1e-4
)
assert arrays.GetArray("Normals") and arrays.GetArray("Gradients") and arrays.GetArray("RTData")

# the length of vectors, as ParaView numbers it
lengths = simple.ZFPCompress(Input=both, InputArray=["POINTS", "place"], Component=3, Rate=24)
found = values(simple.ZFPDecompress(Input=lengths), "place")
wanted = numpy.sqrt((values(both, "place") ** 2).sum(axis=1))
assert numpy.allclose(found, wanted, atol=1e-3), abs(found - wanted).max()

# levels of detail: coarser copies, decoded where they lie, also by the filter behind
long = simple.Wavelet(WholeExtent=[-40, 40, -9, 10, -9, 10])
levels = simple.ZFPCompress(Input=long, Rate=16, Levels=3)
level = simple.ZFPDecompress(Input=levels, Level=1)
coarse = servermanager.Fetch(level)
assert coarse.GetDimensions() == (41, 11, 11) and coarse.GetSpacing() == (2, 2, 2)
assert coarse.GetBounds()[::2] == servermanager.Fetch(long).GetBounds()[::2]
assert level.GetDataInformation().GetExtent() == (0, 40, 0, 10, 0, 10)
contour = simple.Contour(Input=level, ContourBy=["POINTS", "RTData"], Isosurfaces=[150.0])
assert servermanager.Fetch(contour).GetNumberOfCells() > 100
level.Level = 2
assert "no level 2: the volume has 1 levels" in errors(level)

# a contour takes the place of what it is made of, also of a progressive isosurface
display = session.show_isosurface(passed, view, Isovalues=[150.0])
hints = surface.SMProxy.GetHints()
assert hints.FindNestedElementByName("Visibility").GetAttribute("replace_input") == "1"

session.finish(surface=mesh.GetNumberOfCells())
