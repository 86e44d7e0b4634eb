"""A compressed volume, which has no arrays, as progressive isosurface; and the filters that make and undo it."""

from common import (
    check_close,
    check_converged,
    check_same,
    covered,
    finish,
    load_plugin,
    look,
    make_view,
    make_wavelet,
    middle,
    screenshot,
    show_isosurface,
)
from paraview import servermanager, simple

load_plugin()
view = make_view()
wavelet = make_wavelet()
wavelet.UpdatePipeline()
compressed = simple.ZFPCompress(Input=wavelet, Rate=12)
assert list(compressed.InputArray) == ["POINTS", "RTData"], list(compressed.InputArray)
compressed.UpdatePipeline()
assert compressed.PointData.GetNumberOfArrays() == 0
compressed.SMProxy.UpdatePropertyInformation()
assert servermanager.vtkSMPropertyHelper(compressed.SMProxy, "ActualRate").GetAsDouble() == 12.0

# the isovalue starts in the middle of the compressed volume's range
display = show_isosurface(compressed, view)
values = wavelet.PointData["RTData"].GetRange()
check_close(display.Isovalues[0], middle(values), "isovalue at first")

look(view)
display.DiffuseColor = [0.9, 0.85, 0.7]
display.Isovalues = [150.0]
shown = screenshot(view, "compressed.png")
info = check_converged(display)
assert 0.1 < covered(shown) < 0.9, covered(shown)

# the plain image compressed to the same rate looks the same
simple.Hide(compressed, view)
plain = show_isosurface(
    wavelet, view, Isovalues=[150.0], CompressionRate=12.0, DiffuseColor=[0.9, 0.85, 0.7]
)
check_same(shown, screenshot(view, "compressed_plain.png"))
simple.Hide(wavelet, view)

# decompressed: the original to within what 12 bits per voxel lose
decompressed = simple.ZFPDecompress(Input=compressed)
decompressed.UpdatePipeline()
restored = decompressed.PointData["RTData"].GetRange()
assert abs(restored[0] - values[0]) < 1 and abs(restored[1] - values[1]) < 1, (restored, values)

# upstream changes arrive
simple.Show(compressed, view)
wavelet.Maximum = 400.0
compressed.UpdatePipeline()
assert covered(screenshot(view, "compressed_changed.png")) > 0
check_converged(display)

finish(info=info, covered=covered(shown))
