"""The isosurface among other geometry: it hides and is hidden by depth, and translucent geometry blends over it."""

from common import *

load_plugin(globals())
view = make_view()
wavelet = make_wavelet()
display = show_isosurface(wavelet, view, Isovalue=150.0, DiffuseColor=[1.0, 1.0, 1.0])
look(view, azimuth=0, elevation=0)
alone = screenshot(view, "opaque_alone.png")
center = (SIZE[1] // 2, SIZE[0] // 2)


def sphere(z, radius, color, opacity):
    source = simple.Sphere(Center=[0, 0, z], Radius=radius, ThetaResolution=48, PhiResolution=48)
    shown = simple.Show(source, view)
    shown.SetRepresentationType("Surface")
    shown.DiffuseColor = color
    shown.Opacity = opacity
    return source


# behind the image: hidden wherever the isosurface is
behind = sphere(-40.0, 12.0, [1.0, 0.0, 0.0], 1.0)
pixels = screenshot(view, "opaque_behind.png")
surface = abs(alone - alone[0, 0]).max(axis=2) > 8
check_same(alone[surface], pixels[surface])
simple.Hide(behind, view)

# in front, opaque: hides
front = sphere(34.0, 8.0, [0.0, 0.0, 1.0], 1.0)
pixels = screenshot(view, "opaque_front.png")[center]
assert pixels[2] > 100 and pixels[0] < 50, pixels

# in front, translucent: blends over the isosurface
simple.GetDisplayProperties(front, view).Opacity = 0.5
pixels = screenshot(view, "opaque_translucent.png")[center]
assert pixels[2] > pixels[0] > 0.3 * alone[center][0], (pixels, alone[center])

# a transform moves it
simple.Hide(front, view)
display.Position = [100.0, 0.0, 0.0]
assert covered(screenshot(view, "opaque_moved_away.png")) == 0.0
simple.ResetCamera(view)
assert covered(screenshot(view, "opaque_moved.png")) > 0.1

finish(covered=covered(alone))
