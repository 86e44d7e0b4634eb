"""The box of ParaView's Volume, by its properties, cuts the isosurface as Clip cuts a contour; with
several processes too."""

import server
import session
from paraview import simple

ORIGIN, SCALE = [1.0, -2.0, 0.0], [0.5, 0.75, 1.0]
BOUNDS = [-10.0, 10.0]


def show(name):
    """Return the pictures of the whole and of the part, and the source."""
    view = session.make_view([200, 150])
    wavelet = session.make_wavelet(10)
    display = session.show_isosurface(wavelet, view, Isovalues=[157.0], CompressionRate=16)
    simple.ColorBy(display, None)
    session.look(view)
    whole = session.screenshot(view, f"cropping_{name}_whole.png")
    display.CroppingOrigin, display.CroppingScale = ORIGIN, SCALE
    session.check_same(whole, session.screenshot(view, f"cropping_{name}_off.png"))
    display.UseCropping = 1
    part = session.screenshot(view, f"cropping_{name}_part.png")
    display.UseCropping = 0
    session.check_same(whole, session.screenshot(view, f"cropping_{name}_again.png"))
    return whole, part, wavelet, view


session.load_plugin()
whole, part, wavelet, view = show("here")
simple.Hide(wavelet, view)
contour = simple.Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[157.0])
cut = contour
for axis in range(3):
    for end in BOUNDS:
        place, normal = [0.0] * 3, [0.0] * 3
        place[axis] = ORIGIN[axis] + SCALE[axis] * end
        normal[axis] = -1.0 if end < 0 else 1.0
        cut = simple.Clip(Input=cut, ClipType="Plane", Invert=1)
        cut.ClipType.Origin, cut.ClipType.Normal = place, normal
display = simple.Show(cut, view)
display.SetRepresentationType("Surface")
simple.ColorBy(display, None)
expected = session.screenshot(view, "cropping_clip.png")
assert 0.1 < session.covered(part) < 0.8 * session.covered(whole)
differing = (abs(part - expected).max(axis=2) > 24).mean()
assert differing < 0.06 * session.covered(expected), f"{differing} of the pixels differ"

with server.connected(2):
    there, part_there, *_ = show("there")
    assert (abs(part - part_there).max(axis=2) > 12).mean() < 2e-3
session.finish(differing=differing)
