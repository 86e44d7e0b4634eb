"""A still render in a Python program's window is complete at once, as nobody asks for another."""

import session
from paraview import simple

view = session.start(size=[480, 360])
display = session.show_isosurface(
    session.make_wavelet(40), view, Isovalues=[150.0], MemoryBudget=10, Opacity=0.5
)
session.look(view)
for azimuth in (0, 25, 50):
    view.GetActiveCamera().Azimuth(azimuth)
    simple.Render(view)
    info = session.information(display)
    assert info["completed"] == 1.0, info
    assert info["passes"] > 1, info
session.finish(info=info)
