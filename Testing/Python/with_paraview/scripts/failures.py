"""What cannot be shown is told once, in the panel's words, and shown again when it can be."""

import session
from paraview import simple

FRAMES = 4
view = session.start()
holed = simple.ProgrammableFilter(Input=session.make_wavelet(12))
holed.Script = """
import numpy
values = numpy.array(inputs[0].PointData["RTData"]).copy()
values[4321] = numpy.nan
output.PointData.append(values, "RTData")
"""
display = session.show_isosurface(holed, view, Isovalues=[150.0])
session.look(view)
whole = session.screenshot(view, "failures_whole.png")
assert session.covered(whole) > 0.1, "one NaN hides little"


def check_told(name, words, setting, value, shows):
    """Change a property, and back; it is told once in several frames."""
    before = display.GetPropertyValue(setting)
    with session.messages() as listener:
        setattr(display, setting, value)
        for _ in range(FRAMES):
            view.GetActiveCamera().Azimuth(1)
            simple.Render(view)
    text = listener.GetOutput()
    assert text.count(words) == 1, (name, text)
    picture = session.screenshot(view, f"failures_{name}.png")
    assert (session.covered(picture) > 0.1) == shows, name
    with session.messages() as listener:
        setattr(display, setting, before)
        for _ in range(2):
            simple.Render(view)
    assert not listener.GetOutput(), listener.GetOutput()
    view.GetActiveCamera().Azimuth(-FRAMES)
    again = session.screenshot(view, f"failures_{name}_again.png")
    assert (abs(again - whole).max(axis=2) > 8).mean() < 0.001, name


check_told("nan", "Mask NaN", "MaskNaN", 0, False)
check_told("budget", "MiB is too small", "MemoryBudget", 1, True)
simple.Hide(holed, view)
flat = simple.ExtractSubset(Input=holed, VOI=[-12, 12, -12, 12, 0, 0])
with session.messages() as listener:
    session.show_isosurface(flat, view, Isovalues=[150.0])
    for _ in range(FRAMES):
        simple.Render(view)
assert listener.GetOutput().count("Only volumes") == 1, listener.GetOutput()
session.finish()
