"""ParaView's own window, used from inside (see gui.sh): what the scripts that do so share.

A script has a generator of steps, which yields the milliseconds for which the window is left alone,
and calls `start` with it. What it finds goes into `found`, and so into gui.json.
"""

import json
import os
import pathlib
import traceback

from paraview import simple

# two Qt in one process would end it: take the window's own
if "libQt6Core" in pathlib.Path("/proc/self/maps").read_text():
    from PyQt6 import QtCore, QtGui, QtTest, QtWidgets
else:
    from PyQt5 import QtCore, QtGui, QtTest, QtWidgets

__all__ = ["QtCore", "QtGui", "QtTest", "QtWidgets"]

BUILD = pathlib.Path(os.environ["PROGISO_GUI_BUILD"])
OUTPUT = pathlib.Path(os.environ["PROGISO_GUI_OUTPUT"])
(PLUGIN,) = BUILD.glob("lib*/**/plugins/ProgIso/ProgIso.so")
simple.LoadPlugin(str(PLUGIN), remote=False, ns=vars(simple))
LEFT, NO_BUTTON = QtCore.Qt.MouseButton.LeftButton, QtCore.Qt.MouseButton.NoButton
NO_KEY = QtCore.Qt.KeyboardModifier.NoModifier

view = simple.GetActiveViewOrCreate("RenderView")
main = next(
    w for w in QtWidgets.QApplication.topLevelWidgets() if w.objectName() == "pqClientMainWindow"
)
found = {}


def finish(**more):
    """Write what was found. To a file: ParaView keeps what is printed for as long as it likes."""
    OUTPUT.joinpath("gui.json.new").write_text(json.dumps({**found, **more}) + "\n")
    OUTPUT.joinpath("gui.json.new").rename(OUTPUT / "gui.json")


def start(scenario):
    """Run a generator's steps once the window is there, then write what was found."""
    steps = scenario()
    QtCore.QTimer.singleShot(1500, lambda: run(steps))


def run(steps):
    """Take the scenario's next step."""
    try:
        QtCore.QTimer.singleShot(next(steps), lambda: run(steps))
    except StopIteration:
        finish()
    except Exception:
        found.clear()
        finish(error=traceback.format_exc())


def picture(name):
    """Save a picture of the whole screen."""
    QtWidgets.QApplication.primaryScreen().grabWindow(0).save(str(OUTPUT / f"gui_{name}.png"))


def make_room_for_panel():
    """Show only the panel beside the view, wide enough to read."""
    main.findChild(QtWidgets.QDockWidget, "pipelineBrowserDock").hide()
    dock = main.findChild(QtWidgets.QDockWidget, "propertiesDock")
    main.resizeDocks([dock], [480], QtCore.Qt.Orientation.Horizontal)


def visible(kind, *name):
    """Return the widgets of a kind, or of a kind and name, that are seen in the window."""
    return [w for w in main.findChildren(kind, *name) if w.isVisible()]


def labels():
    """Return the texts in the display's part of the panel, from top to bottom."""
    frame = main.findChild(QtWidgets.QWidget, "DisplayFrame")
    kinds = (QtWidgets.QLabel, QtWidgets.QCheckBox)
    shown = [w for kind in kinds for w in frame.findChildren(kind) if w.isVisible() and w.text()]
    shown.sort(key=lambda w: w.mapTo(frame, QtCore.QPoint(0, 0)).y())
    texts = []
    for widget in shown:
        document = QtGui.QTextDocument()
        document.setHtml(widget.text())
        texts.append(document.toPlainText())
    return texts


def send_mouse(widget, kind, place, held=NO_BUTTON):
    """Send a mouse event of the left button, as a user's hand makes it."""
    button = NO_BUTTON if kind == "MouseMove" else LEFT
    kind = getattr(QtCore.QEvent.Type, kind)
    event = QtGui.QMouseEvent(kind, place, button, held, NO_KEY)
    QtWidgets.QApplication.sendEvent(widget, event)


def action(name):
    """Return the window's action (menu entry or button) of a name."""
    kind = getattr(QtGui, "QAction", None) or QtWidgets.QAction  # moved in Qt 6
    return main.findChild(kind, name)
