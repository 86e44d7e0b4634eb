"""Runs inside ParaView's own window (see gui.sh) and uses the panel as a user would.

Writes gui.json with what the panel showed, and pictures of the window, gui_NAME.png: simple,
slider, cropping, plane, advanced, levels, coarse and plain.
"""

import window
from paraview import servermanager, simple
from window import (
    LEFT,
    QtCore,
    QtWidgets,
    action,
    found,
    labels,
    picture,
    send_mouse,
    view,
    visible,
)


def images():
    """Return how many images the view has made."""
    return counter["images"]


counter = {"images": 0}


def count(*_):
    counter["images"] += 1


def scenario():
    """Use the panel; yield the milliseconds for which the window is left alone."""
    window.make_room_for_panel()
    wavelet = simple.Wavelet(WholeExtent=[-40, 40] * 3)
    compressed = simple.ZFPCompress(Input=wavelet, Rate=8, Levels=1)
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
    send_mouse(handle, "MouseButtonPress", at[0], LEFT)
    dragged = []
    for place in at[1:]:
        send_mouse(handle, "MouseMove", place, LEFT)
        dragged.append((display.Isovalues[0], images() - made))
        yield 100
    picture("slider")
    send_mouse(handle, "MouseButtonRelease", at[-1])
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

    advanced = visible(QtWidgets.QToolButton, "AdvancedButton")[0]
    advanced.click()
    yield 1500
    found["advanced"] = labels()
    picture("advanced")

    # where levels of detail draw, their parts are told
    display.LevelOfDetail, display.PixelTolerance = "On", 64.0
    simple.Render(view)
    yield 1500
    while not any(text.startswith("0: ") for text in labels()):  # the driver compiles
        yield 200
    found["levels"] = labels()
    figure = servermanager.vtkSMPropertyHelper(display.SMProxy, "UncertainFraction")
    found["uncertain"] = figure.GetAsDouble()
    picture("levels")
    advanced.click()
    yield 500
    found["coarse"] = labels()
    picture("coarse")

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


window.start(scenario)
