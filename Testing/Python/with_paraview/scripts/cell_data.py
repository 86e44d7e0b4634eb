"""Cell data, several arrays, and components."""

import session
from paraview import servermanager, simple

view = session.start()
wavelet = session.make_wavelet(16)
cells = simple.PointDatatoCellData(Input=wavelet)
cells.UpdatePipeline()
display = session.show_isosurface(cells, view, Isovalues=[150.0])
assert list(display.IsosurfaceArray) == ["CELLS", "RTData"], list(display.IsosurfaceArray)
session.look(view)
shown = session.screenshot(view, "cells.png")
session.check_converged(display)
assert session.covered(shown) > 0.1
simple.Hide(cells, view)

# compressed cell data: the same image
compressed = simple.ZFPCompress(Input=cells, Rate=8)
assert list(compressed.InputArray) == ["CELLS", "RTData"], list(compressed.InputArray)
session.show_isosurface(compressed, view, Isovalues=[150.0])
session.check_same(shown, session.screenshot(view, "cells_compressed.png"))
simple.Hide(compressed, view)

# a second array, chosen in place of the first
second = simple.Calculator(Input=wavelet, ResultArrayName="negative", Function="-RTData")
display = session.show_isosurface(second, view, IsosurfaceArray=["POINTS", "negative"])
values = second.PointData["negative"].GetRange()
display.Isovalues = [-150.0]
chosen = session.screenshot(view, "second_array.png")
assert session.covered(chosen) > 0.1
display.IsosurfaceArray = ["POINTS", "RTData"]
display.Isovalues = [150.0]
session.check_same(chosen, session.screenshot(view, "first_array.png"), tolerance=1)
simple.Hide(second, view)

# a component of a vector array
vectors = simple.Calculator(
    Input=wavelet, ResultArrayName="vectors", Function="iHat + RTData*jHat + 2*RTData*kHat"
)
display = session.show_isosurface(
    vectors, view, IsosurfaceArray=["POINTS", "vectors"], IsosurfaceComponent=2, Isovalues=[300.0]
)
session.check_same(chosen, session.screenshot(view, "component.png"), tolerance=1)
simple.Hide(vectors, view)

# no array chosen, and no active scalars: the first array, as the filter and the mapper take it
image = servermanager.Fetch(wavelet)
image.GetPointData().SetActiveScalars(None)
inactive = simple.TrivialProducer()
inactive.GetClientSideObject().SetOutput(image)
display = session.show_isosurface(inactive, view, IsosurfaceArray=["POINTS", ""], Isovalues=[150.0])
assert list(display.IsosurfaceArray) == ["POINTS", ""], list(display.IsosurfaceArray)
default = session.screenshot(view, "default_array.png")
session.check_same(chosen, default, tolerance=1)

session.finish(covered=session.covered(shown), range=values)
