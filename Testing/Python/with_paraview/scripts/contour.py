"""ZFP Contour in a pipeline: the surface that ParaView's Contour makes of the decoded image, shown the same."""

from common import (
    check_close,
    check_same,
    covered,
    finish,
    load_plugin,
    look,
    make_view,
    make_wavelet,
    middle,
    screenshot,
)
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

load_plugin()
view = make_view()
compressed = simple.ZFPCompress(Input=make_wavelet(), Rate=8)
decoded = simple.ZFPDecompress(Input=compressed)
values = [120.0, 180.0]


def show_surface(source, name):
    """Pixels of a surface, shown alone, and how many points and triangles it has."""
    simple.Show(source, view)
    look(view)
    pixels = screenshot(view, name)
    simple.Hide(source, view)
    information = source.GetDataInformation()
    return pixels, (information.GetNumberOfPoints(), information.GetNumberOfCells())


compressed.UpdatePipeline()
ours = simple.ZFPContour(Input=compressed)
# as Contour does, begins with the middle of the values' range
(default,) = ours.Isosurfaces
check_close(default, middle(compressed.FieldData["ProgIso.ZFP.Range"].GetRange()), "isovalue")
ours.Isosurfaces = values
theirs = simple.Contour(Input=decoded, ContourBy=["POINTS", "RTData"], Isosurfaces=values)
first, sizes = show_surface(ours, "contour_ours.png")
second, expected = show_surface(theirs, "contour_theirs.png")
assert sizes == expected and sizes[1] > 0, (sizes, expected)
assert covered(first) > 0.1
check_same(first, second, tolerance=1)  # triangles come in another order

# a plain image is refused, in one sentence
usual = vtkOutputWindow.GetInstance()
listener = vtkStringOutputWindow()
vtkOutputWindow.SetInstance(listener)
plain = simple.ZFPContour(Input=make_wavelet())
plain.UpdatePipeline()
vtkOutputWindow.SetInstance(usual)
assert listener.GetOutput().count("compress it first") == 1, listener.GetOutput()
assert plain.GetDataInformation().GetNumberOfPoints() == 0

finish(covered=covered(first), default=default, points=sizes[0], triangles=sizes[1])
