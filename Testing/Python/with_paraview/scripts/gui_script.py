"""Runs inside ParaView's own window (see gui.sh) and shows an isosurface as a user would.

Reports how the image refined while the window stayed responsive, and what the panel said meanwhile.
Writes gui.json when the image is complete.
"""

import json
import os
import pathlib

from paraview import servermanager, simple

# two Qt in one process would end it: take the window's own
if "libQt6Core" in pathlib.Path("/proc/self/maps").read_text():
    from PyQt6 import QtCore, QtWidgets
else:
    from PyQt5 import QtCore, QtWidgets

BUILD = pathlib.Path(os.environ["PROGISO_GUI_BUILD"])
OUTPUT = pathlib.Path(os.environ["PROGISO_GUI_OUTPUT"])
(PLUGIN,) = BUILD.glob("lib*/**/plugins/ProgIso/ProgIso.so")
simple.LoadPlugin(str(PLUGIN), remote=False, ns=vars(simple))

view = simple.GetActiveViewOrCreate("RenderView")
wavelet = simple.Wavelet(WholeExtent=[-96, 96] * 3)
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

window = next(
    w for w in QtWidgets.QApplication.topLevelWidgets() if w.objectName() == "pqClientMainWindow"
)
seen = []  # after each image: the representation's figures, and what the panel shows


def panel():
    """Return the widget that shows the statistics, and those in it by name."""
    (bar,) = window.findChildren(QtWidgets.QProgressBar, "Completed")
    widget = bar.parentWidget()
    return widget, {
        w.objectName(): w for w in widget.findChildren(QtWidgets.QWidget) if w.objectName()
    }


def arrange():
    """Give the panel room, scroll it to the statistics, and let the event loop make an image."""
    window.findChild(QtWidgets.QDockWidget, "pipelineBrowserDock").hide()
    dock = window.findChild(QtWidgets.QDockWidget, "propertiesDock")
    window.resizeDocks([dock], [480], QtCore.Qt.Orientation.Horizontal)
    QtWidgets.QApplication.processEvents()
    widget, _ = panel()
    area = widget.parentWidget()
    while not isinstance(area, QtWidgets.QScrollArea):
        area = area.parentWidget()
    area.ensureWidgetVisible(widget)
    view.ImageReductionFactor = 1  # the interactive image has all rays
    display.MemoryBudget = 36  # too little for the whole volume, so that there are passes to see
    view.SMProxy.AddObserver("EndEvent", look_at_progress)
    # from here on the window's event loop makes the images: an interactive one, then whatever the
    # mapper asks for
    camera.Azimuth(5)
    view.SMProxy.InteractiveRender()


def figure(name):
    return servermanager.vtkSMPropertyHelper(display.SMProxy, name).GetAsDouble()


def look_at_progress(*_):
    """After each image note how far it is, and what the panel says."""
    _, shows = panel()
    seen.append(
        {
            "completed": figure("CompletedFraction"),
            "passes": figure("NumberOfPasses"),
            "held": figure("GPUBytes") - figure("CompressedBytes"),
            "budget": figure("BudgetBytes"),
            "bar": shows["Completed"].value() / shows["Completed"].maximum(),
            "text": shows["Completed"].text(),
            "image": shows["Image"].text(),
            "memory": shows["Memory"].text(),
            "rows": shows["Passes"].rowCount(),
            "times": [
                float(shows["Passes"].item(row, 1).text())
                for row in range(shows["Passes"].rowCount())
            ],
        }
    )
    if len(seen) == 3:
        OUTPUT.joinpath("gui_refining").touch()  # the moment for a picture of the window
    if seen[-1]["completed"] == 1.0 and len(seen) > 1:
        QtCore.QTimer.singleShot(500, report)


def report():
    # to a file: ParaView keeps what is printed in its own buffers for as long as it likes
    OUTPUT.joinpath("gui.json.new").write_text(json.dumps({"seen": seen}) + "\n")
    OUTPUT.joinpath("gui.json.new").rename(OUTPUT / "gui.json")


QtCore.QTimer.singleShot(2000, arrange)  # when the panel is there
