"""Mirrored data look as Contour's surface does: by a display's scale, and by ParaView's Reflect.

A scale below 0 turns VTK's meshes inside out: they are dark then, so that only their outlines are
compared. Reflect makes an unstructured grid of an image (ParaView 5.11 and 5.13), for which the
representation is not offered; where it makes images, they are compared, too.
"""

import session
from paraview import simple

LOOK = {"DiffuseColor": [0.9, 0.85, 0.7], "ColorArrayName": [None, ""]}
FLAT = {"Ambient": 1.0, "Diffuse": 0.0}
ISOVALUE = 157.0
#: The share of the surface's pixels that may differ: its edges.
SHARE = 0.04

view = session.start()
wavelet = simple.Wavelet(WholeExtent=[-10, 4, -10, 10, -10, 10])
compressed = simple.ZFPCompress(Input=wavelet, Rate=16)
contour = simple.Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[ISOVALUE])


def picture(source, name, kind, **properties):
    """Return the picture of a source in a representation."""
    display = simple.Show(source, view)
    display.SetRepresentationType(kind)
    for key, value in {**LOOK, **properties}.items():
        setattr(display, key, value)
    camera = view.GetActiveCamera()
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetPosition(35.0, 25.0, 55.0)
    camera.SetViewUp(0.0, 1.0, 0.0)
    simple.Render(view)  # ParaView finds the bounds of what is mirrored only now
    pixels = session.screenshot(view, f"mirrored_{name}.png")
    simple.Hide(source, view)
    return pixels


def shape(pixels):
    """Return where a picture shows anything."""
    return abs(pixels - pixels[0, 0]).max(axis=2) > 8


def check_like(expected, source, name, **properties):
    """Check that an isosurface has the outline that is expected, without a message; return its
    picture."""
    with session.messages() as listener:
        pixels = picture(
            source, name, session.PROGRESSIVE_ISOSURFACE, Isovalues=[ISOVALUE], **properties
        )
    assert not listener.GetOutput(), f"{name}: {listener.GetOutput()}"
    share = session.covered(expected)
    differing = float((shape(pixels) != shape(expected)).mean())
    assert share > 0.05 and differing <= SHARE * share, f"{name}: {differing} of {share} differ"
    return pixels


def offered(source):
    """Is the representation offered for a source?"""
    kinds = simple.Show(source, view).GetProperty("Representation").Available
    simple.Hide(source, view)
    return session.PROGRESSIVE_ISOSURFACE in kinds


found = {}
straight = picture(contour, "contour", "Surface")
light = straight[shape(straight)].mean()
for axes in ([-1.0, 1.0, 1.0], [1.0, -1.0, 2.0]):
    expected = picture(contour, "contour_scaled", "Surface", Scale=axes, **FLAT)
    assert (shape(expected) != shape(straight)).mean() > 0.02  # it is no symmetry
    for name, source in (("plain", wavelet), ("compressed", compressed)):
        check_like(expected, source, name, Scale=axes, **FLAT)
        look = {"Isovalues": [ISOVALUE], "Ambient": 0.0, "Diffuse": 1.0, "Scale": axes}
        pixels = picture(source, f"{name}_lit", session.PROGRESSIVE_ISOSURFACE, **look)
        found[f"{name} {axes}"] = float(pixels[shape(pixels)].mean() / light)
        assert 0.7 < found[f"{name} {axes}"] < 1.3, found  # lit from the same side

for plane in ("X Max", "Z Min"):
    reflected = simple.Reflect(Input=wavelet, Plane=plane)
    surface = simple.Contour(
        Input=reflected, ContourBy=["POINTS", "RTData"], Isosurfaces=[ISOVALUE]
    )
    found[f"reflect {plane}"] = "not offered"
    if offered(reflected):
        expected = picture(surface, "contour_reflected", "Surface", **FLAT)
        pixels = check_like(expected, reflected, "reflected", **FLAT)
        found[f"reflect {plane}"] = float(abs(pixels - expected).mean())

# what a filter makes of a compressed volume that is no image any more does not claim to be one
twisted = simple.Reflect(Input=compressed, Plane="X Max")
if not offered(twisted):
    display = simple.Show(twisted, view)
    assert display.Representation[0] != session.PROGRESSIVE_ISOSURFACE, display.Representation
    found["compressed"] = display.Representation[0]
else:
    with session.messages() as listener:
        session.show_isosurface(twisted, view, Isovalues=[ISOVALUE])
        pixels = session.screenshot(view, "mirrored_twisted.png")
    found["compressed"] = listener.GetOutput()
session.finish(**found)
