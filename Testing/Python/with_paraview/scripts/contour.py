"""ZFP Contour in a pipeline shows the surface that Contour makes of the decoded image."""

import session
from paraview import simple

view = session.start()
compressed = simple.ZFPCompress(Input=session.make_wavelet(), Rate=8)
decoded = simple.ZFPDecompress(Input=compressed)
values = [120.0, 180.0]


def show_surface(source, name):
    """Return a surface's pixels, shown alone, and its numbers of points and triangles."""
    simple.Show(source, view)
    session.look(view)
    pixels = session.screenshot(view, name)
    simple.Hide(source, view)
    information = source.GetDataInformation()
    return pixels, (information.GetNumberOfPoints(), information.GetNumberOfCells())


compressed.UpdatePipeline()
ours = simple.ZFPContour(Input=compressed)
# as Contour does, begins with the middle of the values' range
(default,) = ours.Isosurfaces
session.check_close(
    default, session.middle(compressed.FieldData["ProgIso.ZFP.Range"].GetRange()), "isovalue"
)
ours.Isosurfaces = values
theirs = simple.Contour(Input=decoded, ContourBy=["POINTS", "RTData"], Isosurfaces=values)
first, sizes = show_surface(ours, "contour_ours.png")
second, expected = show_surface(theirs, "contour_theirs.png")
assert sizes == expected and sizes[1] > 0, (sizes, expected)
assert session.covered(first) > 0.1
session.check_same(first, second, tolerance=1)  # triangles come in another order

# a plain image is refused, in one sentence
with session.messages() as listener:
    plain = simple.ZFPContour(Input=session.make_wavelet())
    plain.UpdatePipeline()
assert listener.GetOutput().count("compress it first") == 1, listener.GetOutput()
assert plain.GetDataInformation().GetNumberOfPoints() == 0

session.finish(covered=session.covered(first), default=default, points=sizes[0], triangles=sizes[1])
