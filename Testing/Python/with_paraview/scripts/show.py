"""Run by pvpython or pvbatch: show the representation in several states; see test_paraview.py for the arguments."""

import json
import sys

from paraview.simple import *  # noqa: F403

plugin, volume, folder = sys.argv[1:4]
LoadPlugin(plugin, remote=False, ns=globals())

view = CreateView("RenderView")
view.ViewSize = [300, 300]
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [0.125, 0.19, 0.25]
facts = {}


def look(position, focal, up=(0, 1, 0)):
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp, view.CameraViewAngle = (
        position,
        focal,
        up,
        30,
    )


def shoot(name, display):
    """Take a screenshot and note the representation's figures."""
    SaveScreenshot(f"{folder}/{name}.png", view, ImageResolution=[300, 300])
    display.SMProxy.UpdatePropertyInformation()
    keys = (
        "NumberOfPasses",
        "CompletedFraction",
        "TotalMilliseconds",
        "GPUBytes",
        "CompressedBytes",
    )
    facts[name] = {key: list(display.GetProperty(key))[0] for key in keys}


def iso(display, isovalue):
    display.SetRepresentationType("Progressive Isosurface")
    display.Isovalues = [isovalue]
    display.DiffuseColor = [0.9, 0.8, 0.6]
    return display


# A plain image.
wavelet = Wavelet(WholeExtent=[-20, 20, -16, 16, -12, 12])
look([70, 50, 60], [0, 0, 0])
plain = iso(Show(wavelet, view), 150)
ColorBy(plain, None)
plain.CompressionRate = 8
shoot("paraview-plain", plain)

# The same compressed first: the same picture.
compressed = ZFPCompress(Input=wavelet, Rate=8)
packed = iso(
    Show(compressed, view), 150
)  # without arrays its colour is solid (ColorBy(…, None) fails on such data in ParaView 5.11)
Hide(wavelet, view)
shoot("paraview-compressed", packed)
assert "Progressive Isosurface" in packed.GetProperty("Representation").Available

# Another isovalue, moved and turned, with a mesh that cuts through.
packed.Isovalues = [120]
packed.Position, packed.Orientation = [3, 2, 1], [0, 0, 30]
sphere = Sphere(Radius=9, Center=[14, 6, 8], ThetaResolution=40, PhiResolution=40)
mesh = Show(sphere, view)
mesh.DiffuseColor = mesh.AmbientColor = [0.3, 0.5, 0.9]
shoot("paraview-among-meshes", packed)
Hide(sphere, view)
packed.Position, packed.Orientation = [0, 0, 0], [0, 0, 0]

# A budget without room for all of a volume decoded: the same picture in passes; without speculation in more of them.
large = ZFPCompress(Input=Wavelet(WholeExtent=[-50, 50] * 3), Rate=8)
Hide(compressed, view)
bounded = iso(Show(large, view), 180)
look([150, 110, 130], [0, 0, 0])
shoot("paraview-whole", bounded)
bounded.MemoryBudget = 5
shoot("paraview-budget", bounded)
bounded.Speculation, bounded.MemoryBudget = 0, 0
view.StillRender()  # decoded as a whole again: what the cache held is gone
bounded.MemoryBudget = 5
shoot("paraview-no-speculation", bounded)
Hide(large, view)

# Decompression, and a compressed volume from a file.
restored = ZFPDecompress(Input=compressed)
restored.UpdatePipeline()
facts["restored"] = list(restored.PointData["RTData"].GetRange())
reader = OpenDataFile(volume)
loaded = iso(Show(reader, view), 0.5)
look([150, 110, 130], [32, 32, 32], [0, 0, 1])
shoot("paraview-file", loaded)

with open(f"{folder}/facts.json", "w") as file:
    json.dump(facts, file)
print("done")
