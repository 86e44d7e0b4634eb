"""Runs inside ParaView's own window (see gui.sh) and uses the panel as a user would.

Writes gui.json with what the panel showed, and pictures of the window: gui_simple.png,
gui_slider.png, gui_cropping.png, gui_plane.png, gui_advanced.png and gui_plain.png.
"""

import json
import os
import pathlib
import traceback

from paraview import simple

# two Qt in one process would end it: take the window's own
if "libQt6Core" in pathlib.Path("/proc/self/maps").read_text():
    from PyQt6 import QtCore, QtGui, QtWidgets
else:
    from PyQt5 import QtCore, QtGui, QtWidgets

BUILD = pathlib.Path(os.environ["PROGISO_GUI_BUILD"])
OUTPUT = pathlib.Path(os.environ["PROGISO_GUI_OUTPUT"])
(PLUGIN,) = BUILD.glob("lib*/**/plugins/ProgIso/ProgIso.so")
simple.LoadPlugin(str(PLUGIN), remote=False, ns=vars(simple))
LEFT, NO_BUTTON = QtCore.Qt.MouseButton.LeftButton, QtCore.Qt.MouseButton.NoButton
NO_KEY = QtCore.Qt.KeyboardModifier.NoModifier

view = simple.GetActiveViewOrCreate("RenderView")
window = next(
    w for w in QtWidgets.QApplication.topLevelWidgets() if w.objectName() == "pqClientMainWindow"
)
found = {}


def finish(**more):
    """Write what was found. To a file: ParaView keeps what is printed for as long as it likes."""
    OUTPUT.joinpath("gui.json.new").write_text(json.dumps({**found, **more}) + "\n")
    OUTPUT.joinpath("gui.json.new").rename(OUTPUT / "gui.json")


def picture(name):
    """Save a picture of the whole screen."""
    QtWidgets.QApplication.primaryScreen().grabWindow(0).save(str(OUTPUT / f"gui_{name}.png"))


def visible(kind, name=""):
    """Return the widgets of a kind that are seen in the window."""
    return [w for w in window.findChildren(kind, name) if w.isVisible()]


def labels():
    """Return the texts in the display's part of the panel, from top to bottom."""
    frame = window.findChild(QtWidgets.QWidget, "DisplayFrame")
    kinds = (QtWidgets.QLabel, QtWidgets.QCheckBox)
    shown = [w for kind in kinds for w in frame.findChildren(kind) if w.isVisible() and w.text()]
    shown.sort(key=lambda w: w.mapTo(frame, QtCore.QPoint(0, 0)).y())
    texts = []
    for widget in shown:
        document = QtGui.QTextDocument()
        document.setHtml(widget.text())
        texts.append(document.toPlainText())
    return texts


def images():
    """Return how many images the view has made."""
    return counter["images"]


counter = {"images": 0}


def count(*_):
    counter["images"] += 1


def press(widget, kind, place, held):
    """Send a mouse event of the left button, as a user's hand makes it."""
    button = NO_BUTTON if kind == "MouseMove" else LEFT
    kind = getattr(QtCore.QEvent.Type, kind)
    event = QtGui.QMouseEvent(kind, place, button, held, NO_KEY)
    QtWidgets.QApplication.sendEvent(widget, event)


def action(name):
    kind = getattr(QtGui, "QAction", None) or QtWidgets.QAction  # moved in Qt 6
    return window.findChild(kind, name)


def scenario():
    """Use the panel; yield the milliseconds for which the window is left alone."""
    window.findChild(QtWidgets.QDockWidget, "pipelineBrowserDock").hide()
    dock = window.findChild(QtWidgets.QDockWidget, "propertiesDock")
    window.resizeDocks([dock], [480], QtCore.Qt.Orientation.Horizontal)
    wavelet = simple.Wavelet(WholeExtent=[-40, 40] * 3)
    compressed = simple.ZFPCompress(Input=wavelet, Rate=8)
    display = simple.Show(compressed, view)
    found["default"] = display.Representation[0]
    simple.SetActiveSource(compressed)
    view.SMProxy.AddObserver("EndEvent", count)
    simple.GetActiveCamera().Azimuth(30)
    simple.ResetCamera(view)
    simple.Render(view)
    yield 2500
    found["simple"] = labels()
    picture("simple")

    # the slider: the surface follows, and a drag is one step to undo
    (slider,) = visible(QtWidgets.QWidget, "IsovalueSlider")
    handle = slider.findChild(QtWidgets.QSlider)
    before, made = list(display.Isovalues), images()
    y = handle.height() / 2
    at = [QtCore.QPointF(handle.width() * f, y) for f in (0.5, 0.54, 0.58, 0.62, 0.66)]
    press(handle, "MouseButtonPress", at[0], LEFT)
    dragged = []
    for place in at[1:]:
        press(handle, "MouseMove", place, LEFT)
        dragged.append((display.Isovalues[0], images() - made))
        yield 100
    picture("slider")
    press(handle, "MouseButtonRelease", at[-1], NO_BUTTON)
    yield 800
    found["before"], found["dragged"], found["after"] = before, dragged, list(display.Isovalues)
    action("actionEditUndo").trigger()
    yield 500
    found["undone"] = list(display.Isovalues)
    action("actionEditRedo").trigger()
    yield 500
    found["redone"] = list(display.Isovalues)

    # cutting open
    (box,) = visible(QtWidgets.QCheckBox, "UseCropping")
    box.click()
    yield 300
    display.CroppingScale, display.CroppingOrigin = [0.5, 1.0, 1.0], [-20.0, 0.0, 0.0]
    simple.Render(view)
    yield 1500
    found["cropped"] = int(display.UseCropping)
    picture("cropping")
    box.click()
    (plane,) = visible(QtWidgets.QCheckBox, "UseClipPlane")
    plane.click()
    yield 1500
    found["clipped"] = int(display.UseClipPlane)
    found["second"] = len(visible(QtWidgets.QCheckBox, "UseClipPlane2"))
    picture("plane")
    plane.click()
    yield 300

    (advanced,) = [
        b for b in window.findChildren(QtWidgets.QToolButton, "AdvancedButton") if b.isVisible()
    ][:1]
    advanced.click()
    yield 1500
    found["advanced"] = labels()
    picture("advanced")
    advanced.click()

    # a plain image has more to choose, vectors their component
    simple.Hide(compressed, view)
    vectors = simple.Calculator(Input=wavelet, Function="coords", ResultArrayName="place")
    display = simple.Show(vectors, view)
    display.SetRepresentationType("Progressive Isosurface")
    display.IsosurfaceArray = ["POINTS", "RTData"]
    simple.SetActiveSource(vectors)
    simple.Render(view)
    yield 2000
    found["plain"] = labels()
    display.IsosurfaceArray = ["POINTS", "place"]
    yield 1000
    found["vectors"] = labels()
    picture("plain")


def run(steps):
    """Take the scenario's next step."""
    try:
        QtCore.QTimer.singleShot(next(steps), lambda: run(steps))
    except StopIteration:
        finish()
    except Exception:
        found.clear()
        finish(error=traceback.format_exc())


QtCore.QTimer.singleShot(1500, lambda: run(scenario()))  # when the window is there
