"""The representation in several states, for test_paraview.py.

OUTPUT has a compressed volume, volume.vti.
"""

import session
from paraview import simple

session.load_plugin()
view = simple.CreateView("RenderView")
view.ViewSize = [300, 300]
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [0.125, 0.19, 0.25]
facts = {}


def look(position, focal, up=(0, 1, 0)):
    """Place the camera."""
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = position, focal, up
    view.CameraViewAngle = 30


def shoot(name, display):
    """Take a screenshot and note the representation's figures."""
    session.screenshot(view, f"{name}.png")
    display.SMProxy.UpdatePropertyInformation()
    times = ("NumberOfPasses", "CompletedFraction", "TotalMilliseconds")
    keys = (*times, "GPUBytes", "CompressedBytes")
    facts[name] = {key: list(display.GetProperty(key))[0] for key in keys}


def show(source, isovalue):
    """Show a source as an isosurface; return its display."""
    display = simple.Show(source, view)
    display.SetRepresentationType(session.PROGRESSIVE_ISOSURFACE)
    display.Isovalues = [isovalue]
    display.DiffuseColor = [0.9, 0.8, 0.6]
    return display


# A plain image.
wavelet = simple.Wavelet(WholeExtent=[-20, 20, -16, 16, -12, 12])
look([70, 50, 60], [0, 0, 0])
plain = show(wavelet, 150)
simple.ColorBy(plain, None)
plain.CompressionRate = 8
shoot("paraview-plain", plain)

# The same compressed first: the same picture.
compressed = simple.ZFPCompress(Input=wavelet, Rate=8)
# without arrays its colour is solid (ColorBy(…, None) fails on such data in ParaView 5.11)
packed = show(compressed, 150)
simple.Hide(wavelet, view)
shoot("paraview-compressed", packed)
assert session.PROGRESSIVE_ISOSURFACE in packed.GetProperty("Representation").Available

# Another isovalue, moved and turned, with a mesh that cuts through.
packed.Isovalues = [120]
session.move(packed, [3, 2, 1])
packed.Orientation = [0, 0, 30]
sphere = simple.Sphere(Radius=9, Center=[14, 6, 8], ThetaResolution=40, PhiResolution=40)
mesh = simple.Show(sphere, view)
mesh.DiffuseColor = mesh.AmbientColor = [0.3, 0.5, 0.9]
shoot("paraview-among-meshes", packed)
simple.Hide(sphere, view)
session.move(packed, [0, 0, 0])
packed.Orientation = [0, 0, 0]

# A budget without room for all of a volume decoded: the same picture in passes; without
# speculation in more of them.
large = simple.ZFPCompress(Input=simple.Wavelet(WholeExtent=[-50, 50] * 3), Rate=8)
simple.Hide(compressed, view)
bounded = show(large, 180)
look([150, 110, 130], [0, 0, 0])
shoot("paraview-whole", bounded)
bounded.MemoryBudget = 5
shoot("paraview-budget", bounded)
bounded.Speculation, bounded.MemoryBudget = 0, 0
view.StillRender()  # decoded as a whole again: what the cache held is gone
bounded.MemoryBudget = 5
shoot("paraview-no-speculation", bounded)
simple.Hide(large, view)

# Decompression, and a compressed volume from a file.
restored = simple.ZFPDecompress(Input=compressed)
restored.UpdatePipeline()
facts["restored"] = list(restored.PointData["RTData"].GetRange())
reader = simple.OpenDataFile(str(session.OUTPUT / "volume.vti"))
loaded = show(reader, 0.5)
look([150, 110, 130], [32, 32, 32], [0, 0, 1])
shoot("paraview-file", loaded)

session.finish(**facts)
