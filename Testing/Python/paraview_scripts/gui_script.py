"""Runs inside ParaView's own window (see gui.sh): shows a compressed volume as progressive isosurface, as a user would, and reports
how the image refined while the window stayed responsive. Writes gui.json when it has converged."""

import json
import os
import pathlib

from paraview import servermanager, simple

BUILD = pathlib.Path(os.environ["PROGISO_GUI_BUILD"])
OUTPUT = pathlib.Path(os.environ["PROGISO_GUI_OUTPUT"])
(PLUGIN,) = BUILD.glob("lib*/**/plugins/ProgIso/ProgIso.so")
simple.LoadPlugin(str(PLUGIN), remote=False, ns=vars(simple))

view = simple.GetActiveViewOrCreate("RenderView")
wavelet = simple.Wavelet(WholeExtent=[-64, 64] * 3)
wavelet.UpdatePipeline()
compressed = simple.ZFPCompress(Input=wavelet, Rate=8)
display = simple.Show(compressed, view)
display.SetRepresentationType("Progressive Isosurface")
display.Isovalues = [150.0]
display.DiffuseColor = [0.94, 0.86, 0.71]
simple.SetActiveSource(compressed)
camera = view.GetActiveCamera()
camera.Azimuth(30)
camera.Elevation(20)
simple.ResetCamera(view)

completed = []


def look_at_progress(*_):
    """After each image of the window: how far is it?"""
    display.SMProxy.UpdatePropertyInformation()
    helper = servermanager.vtkSMPropertyHelper(display.SMProxy, "CompletedFraction")
    completed.append(helper.GetAsDouble())
    if completed[-1] == 1.0 and completed.count(1.0) == 1:
        passes = servermanager.vtkSMPropertyHelper(display.SMProxy, "NumberOfPasses").GetAsInt()
        # to a file: ParaView keeps what is printed in its own buffers for as long as it likes
        report = json.dumps({"refined": True, "completed": completed, "passes": passes})
        OUTPUT.joinpath("gui.json.new").write_text(report + "\n")
        OUTPUT.joinpath("gui.json.new").rename(OUTPUT / "gui.json")


# From here on the window's event loop makes the images: an interactive one, then whatever the mapper asks for.
view.GetRenderWindow().AddObserver("EndEvent", look_at_progress)
camera.Azimuth(5)
view.SMProxy.InteractiveRender()
