"""Save a state with isosurfaces of a plain image and a compressed volume, and their picture."""

import session
from paraview import simple

view = session.start()
wavelet = session.make_wavelet()
session.show_isosurface(
    wavelet, view, Isovalues=[130.0], DiffuseColor=[0.3, 0.6, 0.9], CompressionRate=16.0
)
compressed = simple.ZFPCompress(Input=wavelet, Rate=6)
moved = session.show_isosurface(
    compressed, view, Isovalues=[220.0, 240.0], DiffuseColor=[0.9, 0.4, 0.2], Speculation=0
)
session.move(moved, [10.0, 0.0, 0.0])
session.look(view)
shown = session.screenshot(view, "state_saved.png")
simple.SaveState(str(session.OUTPUT / "state.pvsm"))

session.finish(covered=session.covered(shown))
