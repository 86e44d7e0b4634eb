"""The magnitude of vectors, as what is drawn and as what colours: the pictures of Contour."""

import session
from paraview import simple

view = session.start()
vector = simple.Calculator(
    Input=session.make_wavelet(10),
    ResultArrayName="vector",
    Function="1.4*coordsX*iHat+coordsY*jHat+coordsZ*kHat",
)
scalars = simple.Calculator(Input=vector, ResultArrayName="length", Function="mag(vector)")
session.show_isosurface(scalars, view)
session.look(view)
LOOK = {"CompressionRate": 16, "DiffuseColor": [0.9, 0.85, 0.7]}


def check_same(ours, theirs, name, share=0.04):
    differing = (abs(ours - theirs).max(axis=2) > 24).mean()
    assert session.covered(ours) > 0.1 and differing < share, f"{name}: {differing}"
    return float(differing)


def shoot(source, name):
    pixels = session.screenshot(view, f"magnitude_{name}.png")
    simple.Hide(source, view)
    return pixels


def paint(display, colour):
    """Colour a display, by a map over all values: ParaView 5.13 fits maps to what is shown."""
    simple.ColorBy(display, colour)
    if colour:
        display.SetScalarBarVisibility(view, False)
        _, name, component = colour
        values = scalars.PointData[name].GetRange({"Magnitude": -1, "X": 0}[component])
        simple.GetColorTransferFunction(name).RescaleTransferFunction(*values)


def show_contour(by, isovalue, colour=None):
    contour = simple.Contour(Input=scalars, ContourBy=["POINTS", by], Isosurfaces=[isovalue])
    display = simple.Show(contour, view)
    display.DiffuseColor = LOOK["DiffuseColor"]
    paint(display, colour)
    return shoot(contour, f"{by}_{colour and colour[2]}_contour")


def show(isovalue, colour=None, **properties):
    display = session.show_isosurface(scalars, view, Isovalues=[isovalue], **LOOK, **properties)
    paint(display, colour)
    return display


seen = {}
display = show(9.0, IsosurfaceArray=["POINTS", "vector"], IsosurfaceComponent="Magnitude")
domain = display.SMProxy.GetProperty("Isovalues").FindDomain("vtkSMDoubleRangeDomain")
session.check_close(domain.GetMaximum(0), scalars.PointData["length"].GetRange()[1], "domain")
seen["drawn"] = check_same(shoot(scalars, "drawn"), show_contour("length", 9.0), "drawn")
display.IsosurfaceComponent = "Y"
display.Isovalues = [0.0]
assert domain.GetMinimum(0) < -5, domain.GetMinimum(0)

display.IsosurfaceArray = ["POINTS", "RTData"]
for component in ("Magnitude", "X"):
    colour = ("POINTS", "vector", component)
    show(157.0, colour, IsosurfaceArray=["POINTS", "RTData"])
    ours = shoot(scalars, component)
    seen[component] = check_same(ours, show_contour("RTData", 157.0, colour), component)

# the same vector gives the surface, by one component, and the colours, by another
side = simple.Calculator(Input=scalars, ResultArrayName="side", Function="vector_Z")
scalars = side
display = show(5.0, colour, IsosurfaceArray=["POINTS", "vector"], IsosurfaceComponent="Z")
ours = shoot(scalars, "component")
seen["component"] = check_same(ours, show_contour("side", 5.0, colour), "component")
session.finish(**seen)
