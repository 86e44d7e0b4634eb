"""Another array colours the surface through its own map; the isosurface array gives one colour
again."""

import session
from paraview import simple

view = session.start()
source = simple.Calculator(
    Input=session.make_wavelet(), ResultArrayName="right", Function="coordsX"
)
display = session.show_isosurface(
    source, view, IsosurfaceArray=["POINTS", "RTData"], Isovalues=[150.0]
)
session.look(view, azimuth=0, elevation=0)
simple.ColorBy(display, ("POINTS", "RTData"))
display.SetScalarBarVisibility(view, False)
plain = session.screenshot(view, "color_by_isosurface_array.png")

simple.ColorBy(display, ("POINTS", "right"))
display.SetScalarBarVisibility(view, False)
colours = simple.GetColorTransferFunction("right")
colours.ColorSpace = "RGB"
colours.RGBPoints = [-24.0, 0.0, 0.0, 1.0, 24.0, 1.0, 0.0, 0.0]
coloured = session.screenshot(view, "color_by_right.png")
assert session.covered(coloured) == session.covered(plain) > 0.1, "the same surface"
seen = abs(coloured - coloured[0, 0]).max(axis=2) > 8
width = coloured.shape[1]
left, right = (
    coloured[:, half][seen[:, half]].mean(axis=0)
    for half in (slice(width // 2), slice(width // 2, width))
)
assert left[2] > 2 * left[0] and right[0] > 2 * right[2], (left, right)

colours.RGBPoints = [-24.0, 0.0, 0.0, 1.0, 24.0, 0.0, 1.0, 0.0]
other = session.screenshot(view, "color_by_other_map.png")
assert other[:, width // 2 :, 1].mean() > 1.5 * coloured[:, width // 2 :, 1].mean(), (
    "a change of the map shows"
)

simple.ColorBy(display, ("POINTS", "RTData"))
display.SetScalarBarVisibility(view, False)
session.check_same(plain, session.screenshot(view, "color_by_again.png"))
session.finish(left=left, right=right)
