"""Points that are hovered, selected and snapped to, and the visible range, are the surface's.

Unsnapped picks end where the ray enters the voxel that holds the hit: ParaView's helper intersects
the selected cell of the image.
"""

import numpy
import session
from paraview import servermanager, simple

ISOVALUE = 157.0
view = session.start()
source = session.make_wavelet(10)
display = session.show_isosurface(source, view, Isovalues=[ISOVALUE])
session.look(view)
pixels = session.screenshot(view, "picking.png")
hit = abs(pixels - pixels[0, 0]).max(axis=2) > 8
rows, columns = numpy.nonzero(hit)
PLACES = [(int(columns[i]), int(rows[i])) for i in range(200, len(rows), len(rows) // 12)]

simple.Hide(source, view)
contour = simple.Contour(Input=source, ContourBy=["POINTS", "RTData"], Isosurfaces=[ISOVALUE])
shown = simple.Show(contour, view)
shown.SetRepresentationType("Surface")
simple.ColorBy(shown, None)
simple.Render(view)
surface = {place: session.pick(view, *place, snap=False) for place in PLACES}
simple.Hide(contour, view)
simple.Show(source, view)
simple.Render(view)

checked = 0
for place, expected in surface.items():
    snapped, entered = (session.pick(view, *place, snap=snap) for snap in (True, False))
    if expected is None or snapped is None:
        continue  # at the silhouette
    assert (snapped == numpy.round(snapped)).all(), "a point of the image"
    assert abs(snapped - expected).max() < 0.6, (place, snapped, expected)
    assert abs(entered - expected).max() < 1.1, (place, entered, expected)
    checked += 1
assert checked > 8, checked


def selected(select):
    """Return how many points a selection of all pixels has, and the range of their values."""
    select(Rectangle=[0, 0, *(n - 1 for n in session.SIZE)], View=view)
    selection = servermanager._getPyProxy(source.SMProxy.GetSelectionInput(0))
    part = simple.ExtractSelection(Input=source, Selection=selection)
    part.UpdatePipeline()
    count = part.GetDataInformation().GetNumberOfPoints()
    values = part.PointData["RTData"].GetRange()
    simple.ClearSelection(source)
    return count, values


points, values = selected(simple.SelectSurfacePoints)
corners, around = selected(simple.SelectSurfaceCells)
assert points > 200 and corners > points
assert around[0] <= values[0] < ISOVALUE < values[1] <= around[1], (values, around)

simple.ColorBy(display, ("POINTS", "RTData"))
display.RescaleTransferFunctionToVisibleRange(view)
colours = simple.GetColorTransferFunction("RTData").RGBPoints
session.check_close(colours[0], values[0], "lowest visible value")
session.check_close(colours[-4], values[1], "highest visible value")
session.finish(picks=checked, points=points, range=values)
