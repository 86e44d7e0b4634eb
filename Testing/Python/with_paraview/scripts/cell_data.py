"""Cell data, several arrays, and components."""

from common import (
    check_converged,
    check_same,
    covered,
    finish,
    load_plugin,
    look,
    make_view,
    make_wavelet,
    screenshot,
    show_isosurface,
)
from paraview import servermanager, simple

load_plugin()
view = make_view()
wavelet = make_wavelet(16)
cells = simple.PointDatatoCellData(Input=wavelet)
cells.UpdatePipeline()
display = show_isosurface(cells, view, Isovalues=[150.0])
assert list(display.IsosurfaceArray) == ["CELLS", "RTData"], list(display.IsosurfaceArray)
look(view)
shown = screenshot(view, "cells.png")
check_converged(display)
assert covered(shown) > 0.1
simple.Hide(cells, view)

# compressed cell data: the same image
compressed = simple.ZFPCompress(Input=cells, Rate=8)
assert list(compressed.InputArray) == ["CELLS", "RTData"], list(compressed.InputArray)
show_isosurface(compressed, view, Isovalues=[150.0])
check_same(shown, screenshot(view, "cells_compressed.png"))
simple.Hide(compressed, view)

# a second array, chosen in place of the first
second = simple.Calculator(Input=wavelet, ResultArrayName="negative", Function="-RTData")
display = show_isosurface(second, view, IsosurfaceArray=["POINTS", "negative"])
values = second.PointData["negative"].GetRange()
display.Isovalues = [-150.0]
chosen = screenshot(view, "second_array.png")
assert covered(chosen) > 0.1
display.IsosurfaceArray = ["POINTS", "RTData"]
display.Isovalues = [150.0]
check_same(chosen, screenshot(view, "first_array.png"), tolerance=1)
simple.Hide(second, view)

# a component of a vector array
vectors = simple.Calculator(
    Input=wavelet, ResultArrayName="vectors", Function="iHat + RTData*jHat + 2*RTData*kHat"
)
display = show_isosurface(
    vectors, view, IsosurfaceArray=["POINTS", "vectors"], IsosurfaceComponent=2, Isovalues=[300.0]
)
check_same(chosen, screenshot(view, "component.png"), tolerance=1)
simple.Hide(vectors, view)

# no array chosen, and no active scalars: the first array, as the filter and the mapper take it
image = servermanager.Fetch(wavelet)
image.GetPointData().SetActiveScalars(None)
inactive = simple.TrivialProducer()
inactive.GetClientSideObject().SetOutput(image)
display = show_isosurface(inactive, view, IsosurfaceArray=["POINTS", ""], Isovalues=[150.0])
assert list(display.IsosurfaceArray) == ["POINTS", ""], list(display.IsosurfaceArray)
default = screenshot(view, "default_array.png")
check_same(chosen, default, tolerance=1)

finish(covered=covered(shown), range=values)
