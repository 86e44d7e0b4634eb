"""A plain image as isosurface: default isovalue, colours, statistics, no restart without need."""

import session
from paraview import simple

view = session.start()
wavelet = session.make_wavelet()
display = session.show_isosurface(wavelet, view)
session.look(view)

# the isovalue starts in the middle of the range
values = wavelet.PointData["RTData"].GetRange()
session.check_close(display.Isovalues[0], session.middle(values), "isovalue at first")
assert list(display.IsosurfaceArray) == ["POINTS", "RTData"], list(display.IsosurfaceArray)

# solid colour
display.DiffuseColor = [1.0, 0.5, 0.25]
display.Isovalues = [150.0]
solid = session.screenshot(view, "plain_solid.png")
info = session.check_converged(display)
assert 0.1 < session.covered(solid) < 0.9, session.covered(solid)
brightest = solid.reshape(-1, 3)[solid.sum(axis=2).argmax()]
assert brightest[0] > brightest[1] > brightest[2], f"solid colour shows as {brightest}"

# a second image of the same scene costs no new passes and is the same
again = session.screenshot(view, "plain_again.png")
session.check_same(solid, again)
assert session.information(display)["passes"] == info["passes"], session.information(display)

# the colour map at the isovalue: blue below the range's middle, red above it
simple.ColorBy(display, ("POINTS", "RTData"))
display.RescaleTransferFunctionToDataRange(False, True)
display.SetScalarBarVisibility(view, False)
display.Isovalues = [90.0]
low = session.screenshot(view, "plain_mapped_low.png")
display.Isovalues = [240.0]
high = session.screenshot(view, "plain_mapped_high.png")
foreground = [image.reshape(-1, 3)[image.sum(axis=2).argmax()] for image in (low, high)]
assert foreground[0][2] > foreground[0][0], f"low isovalue shows as {foreground[0]}"
assert foreground[1][0] > foreground[1][2], f"high isovalue shows as {foreground[1]}"

# hidden and shown again
simple.Hide(wavelet, view)
assert session.covered(session.screenshot(view, "plain_hidden.png")) == 0.0
simple.Show(wavelet, view)
session.check_same(high, session.screenshot(view, "plain_mapped_high.png"))

session.finish(info=info, covered=session.covered(solid))
