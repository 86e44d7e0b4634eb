"""Properties of ParaView's Volume in a state: its isovalues become ours when they are set, and a
saved state keeps ours."""

import session
from paraview import simple, smstate

view = session.start([200, 150])
display = session.show_isosurface(session.make_wavelet(10), view, Isovalues=[120.0])
session.look(view)
before = session.screenshot(view, "volume_state.png")
display.IsosurfaceValues = [100.0, 200.0]
assert list(display.Isovalues) == [100.0, 200.0], display.Isovalues
assert abs(session.screenshot(view, "volume_state_two.png") - before).max() > 50
display.Isovalues = [120.0]
display.UseCropping = 1
display.CroppingScale = [0.5, 1.0, 1.0]
cropped = session.screenshot(view, "volume_state_cropped.png")
assert session.covered(cropped) < 0.9 * session.covered(before)

python = smstate.get_state()
simple.SaveState(str(session.OUTPUT / "volume.pvsm"))
for load in (
    lambda: simple.LoadState(str(session.OUTPUT / "volume.pvsm")),
    lambda: exec(python, {}),
):
    simple.ResetSession()
    load()
    view = simple.GetActiveViewOrCreate("RenderView")
    (source,) = simple.GetSources().values()
    display = simple.GetDisplayProperties(source, view)
    assert list(display.Isovalues) == [120.0], display.Isovalues
    session.undecorate(view, [200, 150])
    display.SetScalarBarVisibility(view, False)
    again = session.screenshot(view, "volume_state_again.png")
    assert (abs(again - cropped).max(axis=2) > 8).mean() < 0.01
session.finish(isovalues=list(display.Isovalues))
