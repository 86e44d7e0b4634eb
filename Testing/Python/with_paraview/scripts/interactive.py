"""Interactive renders show what is there and never lose it: refinement ends at the image that a still render makes at once."""

from common import (
    check_same,
    finish,
    information,
    load_plugin,
    look,
    make_view,
    make_wavelet,
    screenshot,
    show_isosurface,
)

load_plugin()
view = make_view([640, 480])
wavelet = make_wavelet(48)
display = show_isosurface(wavelet, view, Isovalues=[150.0])
look(view)
still = screenshot(view, "interactive_still.png")
passes = information(display)["passes"]

# turn the camera away and back, so that the image is to be made anew, with interactive renders only
view.GetActiveCamera().Azimuth(40)
view.SMProxy.InteractiveRender()
view.GetActiveCamera().Azimuth(-40)
completed = []
while not completed or completed[-1] < 1.0:
    view.SMProxy.InteractiveRender()
    completed.append(information(display)["completed"])
    assert len(completed) < 1000, completed[-10:]
assert completed == sorted(completed), completed
check_same(still, screenshot(view, "interactive_refined.png"))

finish(renders=len(completed), passes=passes, completed=completed)
