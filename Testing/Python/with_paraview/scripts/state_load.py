"""Load the state of state_save.py in a new process and compare."""

from common import (
    OUTPUT,
    PROGRESSIVE_ISOSURFACE,
    check_converged,
    check_same,
    covered,
    finish,
    load_plugin,
    read_png,
    screenshot,
)
from paraview import simple

load_plugin()
simple.LoadState(str(OUTPUT / "state.pvsm"))
view = simple.GetActiveViewOrCreate("RenderView")
view.UseFXAA = 0  # a setting of the application, not of the state
loaded = screenshot(view, "state_loaded.png")
check_same(read_png(OUTPUT / "state_saved.png"), loaded)

compressed = simple.FindSource("ZFPCompress1")
display = simple.GetDisplayProperties(compressed, view)
assert display.Representation == PROGRESSIVE_ISOSURFACE, display.Representation
assert list(display.Isovalues) == [220.0, 240.0] and display.Speculation == 0
assert compressed.Rate == 6.0, compressed.Rate
check_converged(display)

finish(covered=covered(loaded))
