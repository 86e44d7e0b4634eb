"""Inputs that cannot be drawn: one error that says why, an empty image, and no crash."""

import json
import zipfile

import session
from paraview import simple

view = session.start()


def show_and_listen(source, name):
    """Return the pixels of `source` as an isosurface, and what was said on the way."""
    with session.messages() as listener:
        display = simple.Show(source, view)
        display.SetRepresentationType(session.PROGRESSIVE_ISOSURFACE)
        simple.ResetCamera(view)
        return session.screenshot(view, name), listener.GetOutput()


def check_refused(source, expected, name):
    pixels, messages = show_and_listen(source, name)
    assert session.covered(pixels) == 0.0, name
    assert expected in messages, f"{name}: {expected!r} not in {messages!r}"
    simple.Delete(source)


empty = simple.PassArrays(Input=session.make_wavelet())
empty.PointDataArrays = []
check_refused(empty, "no compressed volume", "errors_no_array.png")


def image_with(script):
    """Return an image whose arrays a script makes."""
    source = simple.ProgrammableSource(OutputDataSetType="vtkImageData")
    source.ScriptRequestInformation = """
pipeline = self.GetExecutive()
self.GetOutputInformation(0).Set(pipeline.WHOLE_EXTENT(), (-4, 4, -4, 4, -4, 4), 6)
"""
    source.Script = f"""
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkStringArray
import numpy
image = self.GetImageDataOutput()
image.SetExtent(-4, 4, -4, 4, -4, 4)
z, y, x = numpy.meshgrid(*[numpy.arange(-4, 5.0)] * 3, indexing="ij")
{script}
"""
    return source


# not `strings`: ParaView puts NumPy's names beside the script's own
worded = image_with("""
words = vtkStringArray()
words.SetName("words")
words.SetNumberOfValues(image.GetNumberOfPoints())
image.GetPointData().AddArray(words)
""")
messages = show_and_listen(worded, "errors_strings.png")[1]
assert messages.count("Progressive Isosurface:") == 1 and '"words" of numbers' in messages, messages
simple.Delete(worded)

# scalars without a name, which ParaView does not list, are drawn
nameless = image_with("""
image.GetPointData().SetScalars(numpy_to_vtk((x**2 + y**2 + z**2).ravel(), deep=1))
""")
session.show_isosurface(nameless, view, Isovalues=[9.0])
session.look(view)
assert session.covered(session.screenshot(view, "errors_nameless.png")) > 0.05
simple.Delete(nameless)

# exports of meshes lack the surface, and say so
exported = session.make_wavelet(10)
session.show_isosurface(exported, view, Isovalues=[157.0])
simple.Render(view)
for suffix in ("x3d", "gltf"):
    with session.messages() as listener:
        simple.ExportView(str(session.OUTPUT / f"scene.{suffix}"), view=view)
    assert listener.GetOutput().count("is no mesh") == 1, listener.GetOutput()
    simple.Render(view)
simple.Delete(exported)

# points have no colours of cells: the solid colour, and a warning
cells = simple.PointDatatoCellData(Input=session.make_wavelet(10), PassPointData=1)
with session.messages() as listener:
    display = session.show_isosurface(cells, view, IsosurfaceArray=["POINTS", "RTData"])
    simple.ColorBy(display, ("CELLS", "RTData"))
    for _ in range(3):
        simple.Render(view)
messages = listener.GetOutput()
assert messages.count("Progressive Isosurface:") == 1, messages
assert "Cell Data to Point Data" in messages, messages
simple.Delete(cells)

damaged = simple.ProgrammableFilter(
    Input=simple.ZFPCompress(Input=session.make_wavelet()), CopyArrays=1
)
damaged.Script = """
image = self.GetImageDataOutput()
image.ShallowCopy(self.GetInput())
bits = image.GetFieldData().GetArray("ProgIso.ZFP.BlockBits").NewInstance()
bits.SetName("ProgIso.ZFP.BlockBits")
bits.InsertNextValue(5)
image.GetFieldData().AddArray(bits)
"""
check_refused(damaged, "Progressive Isosurface: ", "errors_damaged.png")

# isovalues that no sample has: a warning, not an error, once until one is in the range again
warnings = []
with session.messages() as listener:
    display = session.show_isosurface(session.make_wavelet(), view, Isovalues=[150.0])
    for isovalues in ([150.0], [1000.0], [2000.0, -5.0], [2000.0, 150.0], [-5.0]):
        display.Isovalues = isovalues
        simple.Render(view)
        simple.Render(view)
        warnings.append(listener.GetOutput().count("outside the values of the array, 33.9"))
assert warnings == [0, 1, 1, 1, 2], (warnings, listener.GetOutput())
assert "ERROR" not in listener.GetOutput()

# an export for vtk.js has no box of the volume's samples in the place of its surface, and says so
for source in list(simple.GetSources().values()):
    simple.Delete(source)
session.show_isosurface(session.make_wavelet(10), view, Isovalues=[157.0])
simple.Render(view)
with session.messages() as listener:
    simple.ExportView(str(session.OUTPUT / "scene.vtkjs"), view=view)
assert listener.GetOutput().count("is no mesh") == 1, listener.GetOutput()
with zipfile.ZipFile(session.OUTPUT / "scene.vtkjs") as archive:
    scene = json.loads(archive.read("index.json"))["scene"]
assert scene == [], scene

session.finish(messages="seen")
