"""The isosurface among other geometry: both hide by depth, translucent geometry blends over it."""

import session
from paraview import simple

view = session.start()
wavelet = session.make_wavelet()
display = session.show_isosurface(wavelet, view, Isovalues=[150.0], DiffuseColor=[1.0, 1.0, 1.0])
session.look(view, azimuth=0, elevation=0)
alone = session.screenshot(view, "opaque_alone.png")
surface = abs(alone - alone[0, 0]).max(axis=2) > 8


def sphere(z, radius, color, opacity):
    """Show a sphere; return its source."""
    source = simple.Sphere(Center=[0, 0, z], Radius=radius, ThetaResolution=48, PhiResolution=48)
    shown = simple.Show(source, view)
    shown.SetRepresentationType("Surface")
    shown.DiffuseColor = color
    shown.Opacity = opacity
    return source


def shows(pixels, channel):
    """Mark where one colour channel is far above the others."""
    others = [other for other in range(3) if other != channel]
    return pixels[:, :, channel] > 60 + pixels[:, :, others].max(axis=2)


# behind the image: hidden wherever the isosurface is
behind = sphere(-40.0, 12.0, [1.0, 0.0, 0.0], 1.0)
pixels = session.screenshot(view, "opaque_behind.png")
# but for the light's direction, which is rounded anew
session.check_same(alone[surface], pixels[surface], tolerance=1)
assert not (shows(pixels, 0) & surface).any()
assert shows(pixels, 0).any(), "the sphere behind is seen through the holes"
simple.Hide(behind, view)

# in front, opaque: hides
front = sphere(34.0, 8.0, [0.0, 0.0, 1.0], 1.0)
pixels = session.screenshot(view, "opaque_front.png")
hidden = shows(pixels, 2)
assert (hidden & surface).sum() > 500, (hidden & surface).sum()

# in front, translucent: a quarter of the isosurface is seen through its two sides
simple.GetDisplayProperties(front, view).Opacity = 0.5
pixels = session.screenshot(view, "opaque_translucent.png")
blended = pixels[hidden & surface]
assert (blended[:, 0] < alone[hidden & surface][:, 0]).mean() > 0.95
assert blended[:, 0].mean() > 0.15 * alone[hidden & surface][:, 0].mean(), blended.mean(axis=0)
assert (blended[:, 2] > blended[:, 0]).mean() > 0.95

# a transform moves it
simple.Hide(front, view)
session.move(display, [100.0, 0.0, 0.0])
assert session.covered(session.screenshot(view, "opaque_moved_away.png")) == 0.0
simple.ResetCamera(view)
assert session.covered(session.screenshot(view, "opaque_moved.png")) > 0.1

session.finish(covered=session.covered(alone))
