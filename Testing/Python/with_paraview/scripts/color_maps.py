"""Colour maps of another array, beside Contour's surface: logarithmic, stepped, by category, with
colours beyond the range and for NaN, and with opacities."""

import numpy
import session
from paraview import simple

view = session.start()
fields = simple.ProgrammableFilter(Input=session.make_wavelet(16))
fields.Script = """
import numpy
points = inputs[0]
x = numpy.linspace(-16, 16, 33)[None, None, :] + numpy.zeros((33, 33, 1))
output.PointData.append(points.PointData["RTData"], "RTData")
output.PointData.append(numpy.exp(0.8 * x).ravel(), "decades")
output.PointData.append(x.ravel().copy(), "right")
holes = x.copy()
holes[x > 6] = numpy.nan
output.PointData.append(holes.ravel(), "holes")
"""
look = {"IsosurfaceArray": ["POINTS", "RTData"], "Isovalues": [150.0], "CompressionRate": 24.0}
display = session.show_isosurface(fields, view, **look)
session.look(view, azimuth=0, elevation=0)
contour = simple.Contour(Input=fields, ContourBy=["POINTS", "RTData"], Isosurfaces=[150.0])
mesh = simple.Show(contour, view)
mesh.SetRepresentationType("Surface")
simple.Hide(contour, view)


def map_of(array, points, **properties):
    colours = simple.GetColorTransferFunction(array)
    colours.ColorSpace = "RGB"
    colours.RGBPoints = points
    for name, value in properties.items():
        setattr(colours, name, value)
    return colours


def compare(name, array, points, *, tolerance=0.04, **properties):
    """Check that few pixels differ from Contour's; return our picture."""
    pictures = []
    for shown, of in ((display, fields), (mesh, contour)):
        simple.Show(of, view)
        simple.ColorBy(shown, ("POINTS", array))  # which gives the map the data's range
        shown.SetScalarBarVisibility(view, False)
        map_of(array, points, **properties)
        pictures.append(session.screenshot(view, f"color_maps_{name}_{len(pictures)}.png"))
        simple.Hide(of, view)
    ours, theirs = pictures
    seen = abs(theirs - theirs[0, 0]).max(axis=2) > 8
    differ = (abs(ours - theirs).max(axis=2) > 24)[seen].mean()
    assert seen.mean() > 0.1 and differ < tolerance, (name, differ)
    return ours


def green(pixels):
    """Return the share of pixels that are."""
    return ((pixels[:, :, 1] > 60) & (pixels[:, :, 0] < 30)).mean()


RAMP = [-8.0, 0, 0, 1, 0.0, 1, 1, 1, 8.0, 1, 0, 0]
GREEN = [0, 1, 0]
compare("ends", "right", RAMP, Discretize=0)
compare("steps", "right", RAMP, Discretize=1, NumberOfTableValues=5)
beyond = {"UseBelowRangeColor": 1, "UseAboveRangeColor": 1}
beyond |= {"BelowRangeColor": GREEN, "AboveRangeColor": GREEN}
assert green(compare("beyond", "right", RAMP, Discretize=0, **beyond)) > 0.05
decades = [1e-5, 0, 0, 1, 1.0, 1, 1, 0, 1e5, 1, 0, 0]
compare("decades", "decades", decades, Discretize=0, UseLogScale=1)
assert green(compare("holes", "holes", RAMP, Discretize=0, NanColor=GREEN)) > 0.02

# two thirds of the surface become nearly clear
opacities = simple.GetOpacityTransferFunction("right")
opacities.Points = [-8.0, 0.05, 0.5, 0, 2.9, 0.05, 0.5, 0, 3.1, 1.0, 0.5, 0, 8.0, 1.0, 0.5, 0]
simple.Show(fields, view)
simple.ColorBy(display, ("POINTS", "right"))
display.SetScalarBarVisibility(view, False)
plain = {"Discretize": 0, "UseBelowRangeColor": 0, "UseAboveRangeColor": 0}
map_of("right", RAMP, EnableOpacityMapping=1, **plain)
clear = session.screenshot(view, "color_maps_opacities.png")
map_of("right", RAMP, EnableOpacityMapping=0)
full = session.screenshot(view, "color_maps_opaque.png")
width = full.shape[1]
left, right = (
    abs(picture[:, half].astype(int) - full[0, 0]).max(axis=2)[seen[:, half]].mean()
    for seen in [abs(full - full[0, 0]).max(axis=2) > 8]
    for half in (slice(width // 3), slice(2 * width // 3, width))
    for picture in [clear]
)
assert right > 3 * left, (left, right)

# categories: each sample has one, and there are none in between
simple.Hide(fields, view)
labels = simple.Calculator(Input=fields, ResultArrayName="label", Function="floor(right/6)")
look["IsosurfaceArray"] = ["POINTS", "RTData"]
display = session.show_isosurface(labels, view, **look)
simple.ColorBy(display, ("POINTS", "label"))
display.SetScalarBarVisibility(view, False)
categories = simple.GetColorTransferFunction("label")
categories.InterpretValuesAsCategories = 1
categories.Annotations = ["-2", "a", "-1", "b", "0", "c", "1", "d"]
categories.IndexedColors = [1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0]
categories.NanColor = [1, 1, 1]
pixels = session.screenshot(view, "color_maps_categories.png").astype(int)
seen = abs(pixels - pixels[0, 0]).max(axis=2) > 8
shades = pixels[seen] > 0.5 * pixels[seen].max(axis=1, keepdims=True)
for shade in ([1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0]):
    assert (shades == numpy.array(shade, bool)).all(axis=1).mean() > 0.05, shade
session.finish()
