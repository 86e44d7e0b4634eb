"""Clip planes cut the isosurface open, as Clip cuts Contour's; unused ones leave it alone. With
several processes, and for a moved display, too."""

import server
import session
from paraview import simple

PLANES = [([3.0, 0.0, 0.0], [-1.0, 0.5, 0.0]), ([0.0, 0.0, 2.0], [0.0, 0.0, -1.0])]


def show(name):
    """Return the pictures of the whole, of a half and of a quarter, and what shows them."""
    view = session.make_view()
    wavelet = session.make_wavelet()
    display = session.show_isosurface(
        wavelet, view, Isovalues=[150.0], DiffuseColor=[1.0, 1.0, 1.0]
    )
    session.look(view)
    whole = session.screenshot(view, f"cutting_{name}_whole.png")
    assert list(display.ClipPlaneOrigin) == [0.0, 0.0, 0.0]  # in the middle of the data
    (display.ClipPlaneOrigin, display.ClipPlaneNormal) = PLANES[0]
    (display.ClipPlaneOrigin2, display.ClipPlaneNormal2) = PLANES[1]
    session.check_same(whole, session.screenshot(view, f"cutting_{name}_unused.png"))
    display.UseClipPlane = 1
    half = session.screenshot(view, f"cutting_{name}_half.png")
    display.UseClipPlane2 = 1
    quarter = session.screenshot(view, f"cutting_{name}_quarter.png")
    session.check_converged(display)
    return (whole, half, quarter), display, wavelet, view


session.load_plugin()
(whole, half, quarter), display, wavelet, view = show("here")


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
differing = []
for ours, cut in ((whole, []), (half, PLANES[:1]), (quarter, PLANES)):
    differing.append(float((abs(ours - meshes(cut)).max(axis=2) > 40).mean()))
assert max(differing) < 0.01, differing
assert session.covered(quarter) < session.covered(half) < session.covered(whole)

simple.Show(wavelet, view)
display.UseClipPlane = display.UseClipPlane2 = 0
session.check_same(whole, session.screenshot(view, "cutting_again.png"))

# the planes stay where they are in the world, as those of the widgets do
display.UseClipPlane = 1
session.move(display, [10.0, 0.0, 0.0])
moved = session.screenshot(view, "cutting_moved.png")
session.move(display, [0.0, 0.0, 0.0])
display.ClipPlaneOrigin = [-7.0, 0.0, 0.0]
view.CameraPosition = [view.CameraPosition[0] - 10.0, *view.CameraPosition[1:]]
view.CameraFocalPoint = [view.CameraFocalPoint[0] - 10.0, *view.CameraFocalPoint[1:]]
same = session.screenshot(view, "cutting_moved_with_the_plane.png")
assert (abs(moved - same).max(axis=2) > 24).mean() < 0.002

with server.connected(2):
    there, *_ = show("there")
    for ours, theirs in zip((whole, half, quarter), there, strict=True):
        assert (abs(ours - theirs).max(axis=2) > 12).mean() < 2e-3

session.finish(differing=differing, covered=[session.covered(p) for p in (whole, half, quarter)])
