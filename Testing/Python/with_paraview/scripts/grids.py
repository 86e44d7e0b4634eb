"""Filters that change the grid of a compressed volume keep it right, or it is refused."""

import numpy
import session
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

view = session.start()
ISOVALUE = 150.0


def placed(source, spacing=(0.5, 1.0, 2.0), origin=(3.0, -4.0, 5.0), turn=False):
    """Give an image another place by a filter."""
    directions = [0, -1, 0, 1, 0, 0, 0, 0, 1] if turn else [1, 0, 0, 0, 1, 0, 0, 0, 1]
    place = simple.ProgrammableFilter(Input=source, CopyArrays=1)
    place.Script = f"""
image = self.GetImageDataOutput()
image.ShallowCopy(self.GetInput())
image.SetSpacing({spacing})
image.SetOrigin({origin})
image.SetDirectionMatrix({directions})
"""
    return place


def contour(source):
    """Return the surface of a compressed volume, and what was reported."""
    with session.messages() as listener:
        surface = simple.ZFPContour(Input=source, Isosurfaces=[ISOVALUE])
        surface.UpdatePipeline()
    return surface, listener.GetOutput()


def triangles(mesh):
    """Return the centres of a mesh's triangles, each coordinate sorted."""
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return numpy.sort(points[corners].mean(axis=1), axis=0)


def flying_edges(plain):
    """Return VTK's own surface of a decompressed image.

    Not by ParaView's Contour, which does not know the directions of an image's axes.
    """
    algorithm = vtkFlyingEdges3D()
    algorithm.SetInputData(simple.servermanager.Fetch(plain))
    algorithm.SetValue(0, ISOVALUE)
    algorithm.Update()
    return algorithm.GetOutput()


def check_right(compressed, plain):
    """Check that the surface is the one that VTK makes of the decompressed image."""
    surface, messages = contour(compressed)
    assert not messages, messages
    mesh, expected = simple.servermanager.Fetch(surface), flying_edges(plain)
    found, wanted = triangles(mesh), triangles(expected)
    assert len(found) == len(wanted) > 100, (len(found), len(wanted))
    assert abs(found - wanted).max() < 1e-4
    bounds = surface.GetDataInformation().GetBounds()
    assert numpy.allclose(bounds, expected.GetBounds(), atol=1e-4)
    assert mesh.GetCellData().GetArray("vtkGhostType") is None
    return surface, len(found)


def check_refused(compressed, words):
    """Check that contour and representation say one thing, and make nothing of it."""
    surface, messages = contour(compressed)
    assert surface.GetDataInformation().GetNumberOfCells() == 0
    assert messages.count("ERR") + messages.count("ERROR") >= 1 and words in messages, messages
    with session.messages() as listener:
        session.show_isosurface(compressed, view, Isovalues=[ISOVALUE])
        picture = session.screenshot(view, "grids_refused.png")
    assert words in listener.GetOutput(), listener.GetOutput()
    assert session.covered(picture) == 0.0
    simple.Hide(compressed, view)


wavelet = session.make_wavelet(16)
image = placed(wavelet, turn=True)
compressed = simple.ZFPCompress(Input=image, Rate=12)
plain = simple.ZFPDecompress(Input=compressed)
_, whole = check_right(compressed, plain)

# a subset has its own triangles, bounds and export
VOI = [-7, 9, -16, 3, 2, 16]
subset = simple.ExtractSubset(Input=compressed, VOI=VOI)
surface, number = check_right(subset, simple.ExtractSubset(Input=plain, VOI=VOI))
assert number < 0.7 * whole
path = session.OUTPUT / "subset.stl"
simple.SaveData(str(path), surface, FileType="Binary")
assert int.from_bytes(path.read_bytes()[80:84], "little") == number
again = simple.ZFPDecompress(Input=subset)
again.UpdatePipeline()
assert list(again.GetDataInformation().GetExtent()) == VOI
assert again.PointData.GetArray("vtkGhostType") is None
check_right(simple.PassArrays(Input=subset), simple.ExtractSubset(Input=plain, VOI=VOI))

# resampled: by strides, to other places, to as many samples elsewhere
MOVED = "moved or resampled"
check_refused(simple.ExtractSubset(Input=compressed, SampleRateI=2), MOVED)
check_refused(
    simple.ExtractSubset(Input=compressed, SampleRateI=2, SampleRateJ=2, SampleRateK=2), MOVED
)
upright = simple.ZFPCompress(Input=wavelet, Rate=12)
size = {"SamplingDimensions": [33, 33, 33]}
same = simple.ResampleToImage(Input=upright, **size)
check_right(same, simple.ZFPDecompress(Input=upright))
elsewhere = simple.ResampleToImage(
    Input=upright, UseInputBounds=0, SamplingBounds=[-8, 8, -8, 8, -8, 8], **size
)
check_refused(elsewhere, MOVED)
check_refused(simple.ResampleToImage(Input=upright, SamplingDimensions=[20, 20, 20]), MOVED)

# moved: spacing, origin, directions
for other in ({"spacing": (1, 1, 1)}, {"origin": (0, 0, 0)}, {"turn": False}):
    check_refused(placed(compressed, **{"turn": True, **other}), MOVED)
check_right(placed(compressed, turn=True), plain)

# blanked: what the image hides has no surface
blank = """
image = self.GetImageDataOutput()
image.ShallowCopy(self.GetInput())
flags = image.AllocatePointGhostArray()
for x in range(33):
    for y in range(12):
        flags.SetValue(x + 33 * (y + 33 * 16), 2)  # HIDDENPOINT
"""
first = simple.ProgrammableFilter(Input=image, CopyArrays=1, Script=blank)
later = simple.ProgrammableFilter(Input=compressed, CopyArrays=1, Script=blank)
expected, _ = contour(simple.ZFPCompress(Input=first, Rate=12))
found, messages = contour(later)
assert not messages, messages
number = found.GetDataInformation().GetNumberOfCells()
assert number == expected.GetDataInformation().GetNumberOfCells() < whole

# two volumes in one image are neither; other arrays beside a volume do no harm
check_refused(
    simple.AppendAttributes(Input=[compressed, simple.ZFPCompress(Input=image, Rate=4)]),
    "stream of another volume",
)
both = simple.AppendAttributes(Input=[compressed, simple.ZFPDecompress(Input=compressed)])
check_right(both, plain)

# what is no image any more is refused by ParaView itself
_, messages = contour(simple.Transform(Input=compressed))
assert "vtkImageData is required" in messages, messages

session.finish(whole=whole)
