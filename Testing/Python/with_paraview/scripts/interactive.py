"""Interactive renders refine the image, never lose any of it, and end at that of a still render."""

import session

view = session.start(size=[640, 480])
view.ImageReductionFactor = 1  # interactive images have all rays
wavelet = session.make_wavelet(48)
display = session.show_isosurface(wavelet, view, Isovalues=[150.0])
session.look(view)
still = session.screenshot(view, "interactive_still.png")
passes = session.information(display)["passes"]

# turn the camera away and back, so that the image is to be made anew, with interactive renders only
view.GetActiveCamera().Azimuth(40)
view.SMProxy.InteractiveRender()
view.GetActiveCamera().Azimuth(-40)
completed = []
while not completed or completed[-1] < 1.0:
    view.SMProxy.InteractiveRender()
    completed.append(session.information(display)["completed"])
    assert len(completed) < 1000, completed[-10:]
assert completed == sorted(completed), completed
session.check_same(still, session.screenshot(view, "interactive_refined.png"))

session.finish(renders=len(completed), passes=passes, completed=completed)
