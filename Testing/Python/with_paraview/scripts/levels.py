"""Level Of Detail draws far parts coarsely always, never, or only while the camera moves, and
tells where this may lose something; Conservative loses nothing."""

import numpy
import session
from paraview import simple

view = session.start([400, 304])
view.ImageReductionFactor = 1  # moving images have all rays
wavelet = session.make_wavelet(75)  # 151 samples a side: levels of 76 and 39
compressed = simple.ZFPCompress(Input=wavelet, Levels=11)
display = session.show_isosurface(compressed, view, Isovalues=[150.0])
session.look(view)
view.GetActiveCamera().Dolly(0.4)  # samples are nearer to each other than pixels


def moved():
    return session.moving_picture(view, display)


def levels():
    """Return how many pixels each level of detail draws in the last image."""
    return session.figures(display, "LevelPixels")


def uncertain():
    """Return the fraction of pixels where a level of detail may hide something."""
    (fraction,) = session.figures(display, "UncertainFraction")
    return fraction


def drawn(pixels):
    """Return where the surface is, which has other colours than the corner."""
    return (pixels != pixels[0, 0]).any(axis=2)


def is_exact():
    """Tell whether the volume itself drew all of the last image."""
    pixels = levels()
    return pixels[0] > 1000 and sum(pixels[1:]) == 0 and uncertain() == 0


def is_coarse():
    """Tell whether a level of detail drew a part of the last image."""
    pixels = levels()
    return len(pixels) == 3 and sum(pixels[1:]) > 1000


assert display.LevelOfDetail == "Off" and display.PixelTolerance == 1.0
CHOICES = ["Off", "On", "Interactive", "Conservative"]
assert list(display.GetProperty("LevelOfDetail").Available) == CHOICES
exact = session.screenshot(view, "levels_off.png")
session.check_same(exact, moved())
assert levels() == [] and uncertain() == 0

# only while the camera moves: what is still, and what is saved, is exact
display.LevelOfDetail = "Interactive"
session.check_same(exact, session.screenshot(view, "levels_still.png"))
assert is_exact(), levels()
coarse = moved()
assert is_coarse(), levels()
assert 0 < abs(coarse - exact).mean() < 6.0, abs(coarse - exact).mean()
view.SMProxy.StillRender()
assert is_exact(), levels()
moved()
session.check_same(exact, session.screenshot(view, "levels_saved.png"))

# always: the picture is that of the moving camera
display.LevelOfDetail = "On"
session.check_same(coarse, session.screenshot(view, "levels_on.png"), tolerance=1)
assert is_coarse(), levels()
before = levels()
display.PixelTolerance = 8.0
coarser = session.screenshot(view, "levels_tolerance.png")
after = levels()
assert after[2] > before[2] and after[0] <= before[0], (before, after)
lost = drawn(exact) & ~drawn(coarser)
assert lost.any() and lost.sum() / lost.size < uncertain() < 1, (lost.sum(), uncertain())

# conservatively: nothing of what the volume shows is lost
display.LevelOfDetail = "Conservative"
whole = session.screenshot(view, "levels_conservative.png")
assert is_coarse() and uncertain() == 0, (levels(), uncertain())
assert not (drawn(exact) & ~drawn(whole)).any(), (drawn(exact) & ~drawn(whole)).sum()
display.LevelOfDetail = "On"
display.PixelTolerance = 0.0625  # finer than any sample here: the volume itself
session.check_same(exact, session.screenshot(view, "levels_fine.png"))
assert is_exact(), levels()
display.PixelTolerance, display.LevelOfDetail = 1.0, "Off"
session.check_same(exact, session.screenshot(view, "levels_again.png"))

# a plain image gets its levels when it is compressed
simple.Hide(compressed, view)
display = session.show_isosurface(wavelet, view, Isovalues=[150.0], LevelOfDetail="Interactive")
session.check_same(exact, session.screenshot(view, "levels_plain.png"), tolerance=1)
session.check_same(coarse, moved(), tolerance=1)
assert is_coarse(), levels()
simple.Hide(wavelet, view)

# blocks have the setting, too, and their pixels are summed
halves = [
    simple.ZFPCompress(
        Input=simple.ExtractSubset(Input=wavelet, VOI=[*half, -75, 75, -75, 75]), Levels=11
    )
    for half in ([-75, 0], [0, 75])
]
blocks = simple.GroupDatasets(Input=halves)
display = session.show_isosurface(blocks, view, Isovalues=[150.0], LevelOfDetail="On")
with session.messages() as listener:
    halved = session.screenshot(view, "levels_blocks.png")
assert listener.GetOutput() == "", listener.GetOutput()
assert is_coarse() and sum(levels()) >= sum(before) and 0 < uncertain() < 1, levels()
assert abs(halved - coarse).mean() < 0.5, abs(halved - coarse).mean()
simple.Hide(blocks, view)

# without levels it is drawn exactly, and that is said once
bare = simple.ZFPCompress(Input=wavelet)
display = session.show_isosurface(bare, view, Isovalues=[150.0], LevelOfDetail="On")
with session.messages() as listener:
    session.check_same(exact, session.screenshot(view, "levels_bare.png"))
    view.SMProxy.StillRender()
assert listener.GetOutput().count("no levels of detail") == 1, listener.GetOutput()
assert is_exact() and len(levels()) == 1, levels()

session.finish(levels=before, coarser=after, covered=session.covered(numpy.asarray(coarser)))
