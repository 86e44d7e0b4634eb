"""While the camera moves, ParaView's image reduction says how many rays the image has.

Where an image takes longer than FrameTime, it has larger pixels meanwhile: squares of
ImageReductionFactor, of up to twice that where those take too long, too; still, it
has all. LODThreshold does not matter, as it does not for ParaView's Volume.
"""

import numpy
import session
from paraview import simple

view = session.start([400, 304])  # all reductions divide it
wavelet = session.make_wavelet(32)
display = session.show_isosurface(wavelet, view, Isovalues=[150.0])
session.look(view)
still = session.screenshot(view, "turning_still.png")


def moved():
    return session.moving_picture(view, display)


def pixels_per_side(picture):
    """Return the side of the squares that an image is made of."""
    for side in range(8, 1, -1):
        rows, columns = picture.shape[0] // side * side, picture.shape[1] // side * side
        squares = picture[:rows, :columns].reshape(rows // side, side, columns // side, side, 3)
        if (squares == squares[:, :1, :, :1]).all():
            return side
    return 1


assert pixels_per_side(still) == 1
display.FrameTime = 1e6
full = moved()
assert pixels_per_side(full) == 1, "the image takes less than FrameTime"
display.FrameTime = 0.0  # every image takes longer
for threshold in (view.LODThreshold, 0.0):
    view.LODThreshold = threshold
    assert pixels_per_side(moved()) == 2 * view.ImageReductionFactor == 4
session.check_same(still, session.screenshot(view, "turning_again.png"))
view.ImageReductionFactor = 4
coarse = moved()
assert pixels_per_side(coarse) == 8
assert abs(session.covered(coarse) - session.covered(still)) < 0.02
view.ImageReductionFactor = 1
session.check_same(full, moved())
view.ImageReductionFactor = 4

# a translucent surface among opaque geometry ends at it in the coarse image, too
display.Opacity = 0.4
sphere = simple.Show(simple.Sphere(Radius=14.0, ThetaResolution=48, PhiResolution=48), view)
sphere.DiffuseColor = [1.0, 0.0, 0.0]
exact = session.screenshot(view, "turning_sphere.png")
coarse = moved()
assert abs(exact - coarse).mean() < 6.0, abs(exact - coarse).mean()
simple.Render(view)
session.check_same(exact, session.screenshot(view, "turning_sphere_again.png"))

session.finish(difference=float(abs(exact - coarse).mean()), size=numpy.shape(still))
