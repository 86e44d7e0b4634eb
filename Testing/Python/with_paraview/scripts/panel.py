"""What the panel offers arrives where it is drawn.

That is isovalues, opacity, colour map, light and memory, in several views, undone and done again.
"""

import session
from paraview import servermanager, simple

session.load_plugin()
# from the start, as in ParaView's window: a proxy's first state must be known
stack, builder = servermanager.vtkSMUndoStack(), servermanager.vtkSMUndoStackBuilder()
builder.SetUndoStack(stack)
servermanager.vtkSMProxyManager.GetProxyManager().SetUndoStackBuilder(builder)

view = session.make_view()
wavelet = session.make_wavelet()
display = session.show_isosurface(wavelet, view, Isovalues=[150.0], DiffuseColor=[0.9, 0.85, 0.7])
session.look(view)
first = session.screenshot(view, "panel.png")


def drawn_property(of=view):
    """Return the volume property that the mapper reads.

    Its only owner is the representation's prop.
    """
    (prop,) = (
        p for p in of.GetRenderer().GetViewProps() if p.IsA("vtkPVLODVolume") and p.GetVisibility()
    )
    return prop.GetProperty()


def isovalues(of=view):
    """Return the isovalues that a view draws."""
    values = drawn_property(of).GetIsoSurfaceValues()
    return [values.GetValue(i) for i in range(values.GetNumberOfContours())]


# several isovalues, fewer again
assert isovalues() == [150.0]
display.Isovalues = [120.0, 150.0, 200.0]
simple.Render(view)
assert isovalues() == [120.0, 150.0, 200.0] == list(display.Isovalues), isovalues()
assert session.covered(session.screenshot(view, "panel_several.png")) > session.covered(first)
display.Isovalues = [150.0]
simple.Render(view)
assert isovalues() == [150.0], isovalues()
session.check_same(first, session.screenshot(view, "panel_again.png"))
low, high = wavelet.PointData["RTData"].GetRange()
domain = display.GetProperty("Isovalues").SMProperty.FindDomain("vtkSMDoubleRangeDomain")
session.check_close(domain.GetMinimum(0), low, "lower end of the slider")
session.check_close(domain.GetMaximum(0), high, "upper end of the slider")

# light
power, display.SpecularPower = display.SpecularPower, 3.0
for name, value in (("Ambient", 0.4), ("Diffuse", 0.5), ("Specular", 0.8)):
    before = getattr(display, name)
    setattr(display, name, value)
    lit = session.screenshot(view, f"panel_{name}.png")
    assert abs(lit - first).mean() > 1.0, name
    setattr(display, name, before)
session.check_same(first, session.screenshot(view, "panel_again.png"))
display.Specular = 0.8
broad = session.screenshot(view, "panel_broad.png")
display.SpecularPower = 90.0
assert (broad - session.screenshot(view, "panel_narrow.png")).mean() > 1.0, (
    "highlights narrow with the power"
)
display.Specular, display.SpecularPower = 0.0, power

# opacity: the solid one, and that of a colour map which maps opacities
display.Opacity = 0.25
simple.Render(view)
session.check_close(drawn_property().GetScalarOpacity().GetValue(150.0), 0.25, "opacity")
faint = session.screenshot(view, "panel_faint.png")
assert abs(faint - faint[0, 0]).mean() < 0.8 * abs(first - first[0, 0]).mean(), (
    "the background is seen through it"
)
simple.ColorBy(display, ("POINTS", "RTData"))
display.SetScalarBarVisibility(view, False)
colours, opacities = (
    simple.GetColorTransferFunction("RTData"),
    simple.GetOpacityTransferFunction("RTData"),
)
opacities.Points = [
    low,
    0.0,
    0.5,
    0.0,
    100.0,
    0.2,
    0.5,
    0.0,
    200.0,
    0.6,
    0.5,
    0.0,
    high,
    1.0,
    0.5,
    0.0,
]
colours.EnableOpacityMapping = 1
simple.Render(view)
session.check_close(
    drawn_property().GetScalarOpacity().GetValue(150.0), 0.25 * 0.4, "opacity by the map"
)
colours.EnableOpacityMapping = 0
display.Opacity = 1.0
simple.Render(view)
session.check_close(drawn_property().GetScalarOpacity().GetValue(150.0), 1.0, "opaque again")
red, green, blue = colours.RGBPoints[1:4]
session.check_close(
    drawn_property().GetRGBTransferFunction().GetRedValue(colours.RGBPoints[0]),
    red,
    "colour of the map",
)
simple.ColorBy(display, None)
session.check_same(first, session.screenshot(view, "panel_solid.png"))

# undo and redo
builder.Begin("isosurfaces")
display.Isovalues = [90.0, 220.0]
display.MemoryBudget = 64
builder.End()
builder.PushToStack()
assert stack.CanUndo()
stack.Undo()
proxies = servermanager.ProxyManager().SMProxyManager  # as ParaView's window does after both
proxies.UpdateRegisteredProxies(1)
assert list(display.Isovalues) == [150.0] and display.MemoryBudget == 0, (
    list(display.Isovalues),
    display.MemoryBudget,
)
session.check_same(first, session.screenshot(view, "panel_undone.png"))
stack.Redo()
proxies.UpdateRegisteredProxies(1)
assert list(display.Isovalues) == [90.0, 220.0] and display.MemoryBudget == 64
simple.Render(view)
assert isovalues() == [90.0, 220.0], isovalues()
session.check_close(session.information(display)["budget"], 64 * 2**20, "budget done again")
display.Isovalues, display.MemoryBudget = [150.0], 0

# a second view of the same data has its own isovalue and figures, and leaves the first alone
other_view = session.make_view()
view.UseFXAA = 0  # a new view sets it anew, in all
other = session.show_isosurface(wavelet, other_view, Isovalues=[220.0], Speculation=0)
session.look(other_view)
seen = session.screenshot(other_view, "panel_other.png")
assert session.covered(seen) > 0.02 and abs(seen - first).max() > 100
assert isovalues(other_view) == [220.0] and isovalues(view) == [150.0]
session.check_same(first, session.screenshot(view, "panel_first.png"))
session.check_converged(display)
session.check_converged(other)
simple.Hide(wavelet, other_view)
assert session.covered(session.screenshot(other_view, "panel_hidden.png")) == 0.0
session.check_same(first, session.screenshot(view, "panel_first.png"))

session.finish(covered=session.covered(first))
