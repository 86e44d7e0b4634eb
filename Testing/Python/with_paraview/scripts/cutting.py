"""Clip planes cut the isosurface open, as Clip cuts Contour's; unused ones leave it alone."""

import session
from paraview import simple

view = session.start()
wavelet = session.make_wavelet()
display = session.show_isosurface(wavelet, view, Isovalues=[150.0], DiffuseColor=[1.0, 1.0, 1.0])
session.look(view)
whole = session.screenshot(view, "cutting_whole.png")
assert list(display.ClipPlaneOrigin) == [0.0, 0.0, 0.0]  # in the middle of the data

display.ClipPlaneOrigin, display.ClipPlaneNormal = [3.0, 0.0, 0.0], [-1.0, 0.5, 0.0]
display.ClipPlaneOrigin2, display.ClipPlaneNormal2 = [0.0, 0.0, 2.0], [0.0, 0.0, -1.0]
session.check_same(whole, session.screenshot(view, "cutting_unused.png"))
display.UseClipPlane = 1
half = session.screenshot(view, "cutting_half.png")
display.UseClipPlane2 = 1
quarter = session.screenshot(view, "cutting_quarter.png")
session.check_converged(display)


def meshes(planes):
    """Return the picture of Contour, cut by planes in the same way."""
    surface = simple.Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[150.0])
    for origin, normal in planes:
        surface = simple.Clip(Input=surface, ClipType="Plane", Invert=0)
        surface.ClipType.Origin, surface.ClipType.Normal = origin, normal
    shown = simple.Show(surface, view)
    shown.SetRepresentationType("Surface")
    simple.ColorBy(shown, None)
    shown.DiffuseColor = [1.0, 1.0, 1.0]
    shown.Specular, shown.Ambient = display.Specular, display.Ambient
    pixels = session.screenshot(view, f"cutting_mesh_{len(planes)}.png")
    simple.Hide(surface, view)
    return pixels


simple.Hide(wavelet, view)
planes = [
    (list(display.ClipPlaneOrigin), list(display.ClipPlaneNormal)),
    (list(display.ClipPlaneOrigin2), list(display.ClipPlaneNormal2)),
]
differing = []
for ours, cut in ((whole, []), (half, planes[:1]), (quarter, planes)):
    differing.append(float((abs(ours - meshes(cut)).max(axis=2) > 40).mean()))
assert max(differing) < 0.01, differing
assert session.covered(quarter) < session.covered(half) < session.covered(whole)

simple.Show(wavelet, view)
display.UseClipPlane = display.UseClipPlane2 = 0
session.check_same(whole, session.screenshot(view, "cutting_again.png"))

session.finish(differing=differing, covered=[session.covered(p) for p in (whole, half, quarter)])
