"""Save a state with an isosurface of a plain image and of a compressed volume, and what it looks like."""

from common import (
    OUTPUT,
    covered,
    finish,
    load_plugin,
    look,
    make_view,
    make_wavelet,
    screenshot,
    show_isosurface,
)
from paraview import simple

load_plugin()
view = make_view()
wavelet = make_wavelet()
show_isosurface(
    wavelet, view, Isovalues=[130.0], DiffuseColor=[0.3, 0.6, 0.9], CompressionRate=16.0
)
compressed = simple.ZFPCompress(Input=wavelet, Rate=6)
show_isosurface(
    compressed,
    view,
    Isovalues=[220.0, 240.0],
    DiffuseColor=[0.9, 0.4, 0.2],
    Speculation=0,
    Position=[10.0, 0.0, 0.0],
)
look(view)
shown = screenshot(view, "state_saved.png")
simple.SaveState(str(OUTPUT / "state.pvsm"))

finish(covered=covered(shown))
