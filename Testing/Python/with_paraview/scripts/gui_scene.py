"""Runs inside ParaView's own window (see gui.sh): choosing the representation, hovering, blocks.

Writes gui.json, gui_loading.png and gui_blocks.png, pictures of the window.
"""

import window
from paraview import servermanager, simple
from window import LEFT, QtCore, QtWidgets, action, found, picture, send_mouse, view, visible

OURS = "Progressive Isosurface"


def choose(representation):
    """Choose a representation in the panel, as a user does."""
    box = [b for b in visible(QtWidgets.QComboBox) if b.findText(representation) >= 0][0]
    box.setCurrentText(representation)
    box.textActivated.emit(representation)


class Bar:
    """What the progress bar of the window shows, event by event, until `stop`."""

    def __init__(self):
        self.label = window.main.statusBar().findChild(QtWidgets.QLabel, "ProgressBar")
        self.handler = servermanager.ActiveConnection.Session.GetProgressHandler()
        self.handler.SetProgressInterval(0.0)  # small volumes take less than the usual one
        self.shown = []
        self.observer = self.handler.AddObserver("ProgressEvent", self.note)

    def note(self, *_):
        self.shown.append((self.label.text(), self.handler.GetLastProgress()))
        if self.label.text().startswith("Loading") and "pictured" not in found:
            found["pictured"] = True
            picture("loading")

    def stop(self):
        """Return what it has shown since the last call."""
        shown, self.shown = self.shown, []
        return shown


def hover(mode, x, y):
    """Move the mouse over a place of the view, in parts of its size, in a mode of selection.

    Yields waits, and returns the text that the window shows there.
    """
    (widget,) = [w for w in visible(QtWidgets.QWidget) if w.inherits("QVTKOpenGLNativeWidget")]

    def close_hint():
        hint = QtWidgets.QApplication.activeModalWidget()
        if hint:
            hint.accept()

    QtCore.QTimer.singleShot(800, close_hint)  # ParaView explains each mode once
    action(mode).trigger()
    yield 500
    for step in (0.02, 0.01, 0.0):
        place = QtCore.QPointF(widget.width() * (x - step), widget.height() * y)
        send_mouse(widget, "MouseMove", place)
        yield 300
    yield 1000
    tips = [w for w in QtWidgets.QApplication.topLevelWidgets() if w.inherits("QTipLabel")]
    text = "".join(tip.text() for tip in tips if tip.isVisible())
    if mode.startswith("actionInteractive"):
        send_mouse(widget, "MouseButtonPress", place, LEFT)
        send_mouse(widget, "MouseButtonRelease", place)
        yield 700
    action(mode).trigger()
    yield 300
    return text


def scenario():
    """Use the window; yield the milliseconds to leave it alone."""
    window.make_room_for_panel()
    wavelet = simple.Wavelet(WholeExtent=[-20, 20] * 3)
    simple.Show(wavelet, view)
    simple.SetActiveSource(wavelet)
    simple.ResetCamera(view)
    simple.Render(view)
    yield 2500

    # no work of a first image without a bar
    bar = Bar()
    choose(OURS)
    yield 2500
    found["choosing"] = bar.stop()
    display = simple.GetDisplayProperties(wavelet, view)
    found["chosen"] = display.Representation[0]
    display.Isovalues = [157.0]
    simple.Render(view)
    yield 1000
    found["isovalue"] = bar.stop()

    # the cell and the point below the mouse
    found["cell"] = yield from hover("actionHoveringSurfaceCells", 0.56, 0.62)
    found["point"] = yield from hover("actionHoveringSurfacePoints", 0.56, 0.62)
    yield from hover("actionInteractiveSelectSurfaceCells", 0.56, 0.62)
    found["clicked"] = list(wavelet.GetSelectionInput(0).Input[0].IDs)
    simple.ClearSelection(wavelet)
    simple.Hide(wavelet, view)

    # blocks that meet, with one octant left out, each with its outline
    extents = [(-40, 0, -40, 40, -40, 40), (0, 40, -40, 0, -40, 40), (0, 40, 0, 40, -40, 0)]
    parts = [simple.Wavelet(WholeExtent=extent) for extent in extents]
    for part in parts:
        simple.Show(part, view).AmbientColor = [1.0, 0.9, 0.3]
    blocks = simple.GroupDatasets(Input=parts, OutputType="vtkMultiBlockDataSet")
    display = simple.Show(blocks, view)
    simple.SetActiveSource(blocks)
    yield 1000
    choose(OURS)
    display.Isovalues = [160.0]
    display.DiffuseColor = [0.55, 0.75, 0.9]
    simple.GetActiveCamera().Azimuth(30)
    simple.GetActiveCamera().Elevation(25)
    simple.ResetCamera(view)
    simple.Render(view)
    yield 3000
    found["blocks"] = display.Representation[0]
    found["summary"] = visible(QtWidgets.QLabel, "Summary")[0].text()
    picture("blocks")


window.start(scenario)
