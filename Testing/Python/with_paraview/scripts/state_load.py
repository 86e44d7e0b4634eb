"""Load the state of state_save.py in a new process and compare the pictures."""

import session
from paraview import simple

session.load_plugin()
simple.LoadState(str(session.OUTPUT / "state.pvsm"))
view = simple.GetActiveViewOrCreate("RenderView")
view.UseFXAA = 0  # a setting of the application, not of the state
loaded = session.screenshot(view, "state_loaded.png")
session.check_same(session.read_png(session.OUTPUT / "state_saved.png"), loaded)

compressed = simple.FindSource("ZFPCompress1")
display = simple.GetDisplayProperties(compressed, view)
assert display.Representation == session.PROGRESSIVE_ISOSURFACE, display.Representation
assert list(display.Isovalues) == [220.0, 240.0] and display.Speculation == 0
assert compressed.Rate == 6.0, compressed.Rate
session.check_converged(display)

session.finish(covered=session.covered(loaded))
