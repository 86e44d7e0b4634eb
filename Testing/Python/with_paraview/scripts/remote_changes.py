"""Whatever is changed, a server of two processes shows what one process does: one change after the
other of the same scene, here and there."""

import server
import session
from paraview import simple

PROCESSES = 2
#: Grey levels, and the share of pixels that may differ by more: light at the seam of the pieces.
LEVELS, SHARE = 12, 2e-3


#: Samples at two time steps, of the piece that is asked for.
STEPS = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonExecutionModel import vtkExtentTranslator
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline

information = self.GetOutputInformation(0)
translator = vtkExtentTranslator()
translator.SetWholeExtent(-12, 12, -12, 12, -12, 12)
translator.SetPiece(information.Get(pipeline.UPDATE_PIECE_NUMBER()))
translator.SetNumberOfPieces(information.Get(pipeline.UPDATE_NUMBER_OF_PIECES()))
translator.SetGhostLevel(0)
translator.PieceToExtent()
extent = translator.GetExtent()
time = information.Get(pipeline.UPDATE_TIME_STEP()) if information.Has(
    pipeline.UPDATE_TIME_STEP()) else 0.0
image = self.GetImageDataOutput()
image.SetExtent(extent)
axes = [numpy.arange(extent[a], extent[a + 1] + 1.0) for a in (4, 2, 0)]
z, y, x = numpy.meshgrid(*axes, indexing="ij")
squares = x**2 + 2 * y**2 + z**2 + 9 * time * abs(x)
fields = {"RTData": 250 - 10 * numpy.sqrt(squares), "left": 3 * x}
for name, values in fields.items():
    array = numpy_to_vtk(values.ravel(), deep=1)
    array.SetName(name)
    image.GetPointData().AddArray(array)
"""


def make_source():
    """Return a source with two scalars, a vector and two time steps."""
    pieces = simple.ProgrammableSource(OutputDataSetType="vtkImageData", Script=STEPS)
    pieces.ScriptRequestInformation = """
information = self.GetOutputInformation(0)
pipeline = self.GetExecutive()
information.Set(pipeline.WHOLE_EXTENT(), (-12, 12, -12, 12, -12, 12), 6)
information.Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
information.Set(pipeline.TIME_STEPS(), (0.0, 1.0), 2)
information.Set(pipeline.TIME_RANGE(), (0.0, 1.0), 2)
"""
    return simple.Calculator(Input=pieces, ResultArrayName="vector", Function="coords")


def color(name, *component):
    def change(display, view):
        simple.ColorBy(display, name and ("POINTS", name, *component))
        display.SetScalarBarVisibility(view, False)

    return change


def setting(**properties):
    def change(display, view):
        for name, value in properties.items():
            setattr(display, name, value)

    return change


def time_step(time):
    def change(display, view):
        view.ViewTime = time

    return change


def hide_and_show(display, view):
    display.Visibility = 0
    simple.Render(view)
    display.Visibility = 1


CHANGES = [
    setting(Isovalues=[150.0]),
    color("RTData"),
    color(None),
    setting(Isovalues=[120.0]),
    color("left"),
    hide_and_show,
    color("vector", "Y"),
    color("vector", "Magnitude"),
    color("left"),
    time_step(1.0),
    setting(Opacity=0.5),
    color(None),
    setting(Opacity=1.0, MaskNaN=1),
    setting(IsosurfaceArray=["POINTS", "left"], Isovalues=[9.0]),
    color("RTData"),
    hide_and_show,
    time_step(0.0),
    setting(IsosurfaceArray=["POINTS", "RTData"], CompressionRate=12.0, Isovalues=[80.0, 200.0]),
    color("left"),
]


def show_changes(name):
    """Return a picture after each change."""
    view = session.make_view([160, 120])
    source = make_source()
    display = session.show_isosurface(source, view, IsosurfaceArray=["POINTS", "RTData"])
    session.look(view)
    pictures = []
    for number, change in enumerate(CHANGES):
        change(display, view)
        pictures.append(session.screenshot(view, f"changes_{name}_{number}.png"))
    return pictures


session.load_plugin()
here = show_changes("here")
with server.connected(PROCESSES):
    there = show_changes("there")
for number, (one, two) in enumerate(zip(here, there, strict=True)):
    assert session.covered(one) > 0.04 < session.covered(two), f"nothing after {number}"
    differing = (abs(one - two).max(axis=2) > LEVELS).mean()
    assert differing <= SHARE, f"after change {number}: {differing} of the pixels differ"
session.finish(changes=len(CHANGES))
