"""A compressed volume, which has no arrays, as isosurface, and the filters of compression."""

import session
from paraview import servermanager, simple

view = session.start()
wavelet = session.make_wavelet()
wavelet.UpdatePipeline()
compressed = simple.ZFPCompress(Input=wavelet, Rate=12)
assert list(compressed.InputArray) == ["POINTS", "RTData"], list(compressed.InputArray)
compressed.UpdatePipeline()
assert compressed.PointData.GetNumberOfArrays() == 0
compressed.SMProxy.UpdatePropertyInformation()
assert servermanager.vtkSMPropertyHelper(compressed.SMProxy, "ActualRate").GetAsDouble() == 12.0

# the isovalue starts in the middle of the compressed volume's range
display = session.show_isosurface(compressed, view)
values = wavelet.PointData["RTData"].GetRange()
session.check_close(display.Isovalues[0], session.middle(values), "isovalue at first")

session.look(view)
display.DiffuseColor = [0.9, 0.85, 0.7]
display.Isovalues = [150.0]
shown = session.screenshot(view, "compressed.png")
info = session.check_converged(display)
assert 0.1 < session.covered(shown) < 0.9, session.covered(shown)

# the plain image compressed to the same rate looks the same
simple.Hide(compressed, view)
plain = session.show_isosurface(
    wavelet, view, Isovalues=[150.0], CompressionRate=12.0, DiffuseColor=[0.9, 0.85, 0.7]
)
session.check_same(shown, session.screenshot(view, "compressed_plain.png"))
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
assert session.covered(session.screenshot(view, "compressed_changed.png")) > 0
session.check_converged(display)

session.finish(info=info, covered=session.covered(shown))
