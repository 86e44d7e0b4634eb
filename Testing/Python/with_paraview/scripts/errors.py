"""Inputs that cannot be drawn: one error that says why, an empty image, and no crash."""

import session
from paraview import simple

view = session.start()


def show_and_listen(source, name):
    """Return the pixels of `source` as an isosurface, and what was said on the way."""
    with session.messages() as listener:
        display = simple.Show(source, view)
        display.SetRepresentationType(session.PROGRESSIVE_ISOSURFACE)
        simple.ResetCamera(view)
        return session.screenshot(view, name), listener.GetOutput()


def check_refused(source, expected, name):
    pixels, messages = show_and_listen(source, name)
    assert session.covered(pixels) == 0.0, name
    assert expected in messages, f"{name}: {expected!r} not in {messages!r}"
    simple.Delete(source)


empty = simple.PassArrays(Input=session.make_wavelet())
empty.PointDataArrays = []
check_refused(empty, "no compressed volume", "errors_no_array.png")

damaged = simple.ProgrammableFilter(
    Input=simple.ZFPCompress(Input=session.make_wavelet()), CopyArrays=1
)
damaged.Script = """
image = self.GetImageDataOutput()
image.ShallowCopy(self.GetInput())
bits = image.GetFieldData().GetArray("ProgIso.ZFP.BlockBits").NewInstance()
bits.SetName("ProgIso.ZFP.BlockBits")
bits.InsertNextValue(5)
image.GetFieldData().AddArray(bits)
"""
check_refused(damaged, "Progressive Isosurface: ", "errors_damaged.png")

# isovalues that no sample has: a warning, not an error, once until one is in the range again
warnings = []
with session.messages() as listener:
    display = session.show_isosurface(session.make_wavelet(), view, Isovalues=[150.0])
    for isovalues in ([150.0], [1000.0], [2000.0, -5.0], [2000.0, 150.0], [-5.0]):
        display.Isovalues = isovalues
        simple.Render(view)
        simple.Render(view)
        warnings.append(listener.GetOutput().count("outside the values of the array, 33.9"))
assert warnings == [0, 1, 1, 1, 2], (warnings, listener.GetOutput())
assert "ERROR" not in listener.GetOutput()

session.finish(messages="seen")
