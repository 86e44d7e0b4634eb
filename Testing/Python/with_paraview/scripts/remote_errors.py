"""What one process of a server cannot draw is told once, at the client; nothing hangs or shows."""

import server
import session
from paraview import simple

session.load_plugin()


def count(listener):
    return listener.GetOutput().count("Progressive Isosurface:")


with server.connected(2):
    view = session.make_view([160, 120])
    # samples of one process's piece are no numbers
    holes = simple.Calculator(
        Input=session.make_wavelet(30),
        ResultArrayName="holes",
        Function="if(coordsZ > 5, ln(-1 - coordsZ^2), RTData)",
        ReplaceInvalidResults=0,
    )
    with session.messages() as listener:
        display = session.show_isosurface(
            holes, view, IsosurfaceArray=["POINTS", "holes"], Isovalues=[157.0], MaskNaN=0
        )
        session.look(view)
        for name in ("refused", "again"):
            pixels = session.screenshot(view, f"remote_errors_{name}.png")
            assert session.covered(pixels) == 0.0, session.covered(pixels)
    assert count(listener) == 1 and "NaN" in listener.GetOutput(), listener.GetOutput()
    display.MaskNaN = 1
    assert session.covered(session.screenshot(view, "remote_errors_masked.png")) > 0.05

    # too little memory: more is taken, which is told once
    with session.messages() as listener:
        display.MemoryBudget = 1
        for _ in range(2):
            session.screenshot(view, "remote_errors_memory.png")
    assert count(listener) == 1 and "budget" in listener.GetOutput(), listener.GetOutput()
    assert session.check_converged(display)["processes"] == 2
    simple.Hide(holes, view)

    # an array that is not there
    with session.messages() as listener:
        display = session.show_isosurface(
            session.make_wavelet(10), view, IsosurfaceArray=["POINTS", "absent"], Isovalues=[157.0]
        )
        assert session.covered(session.screenshot(view, "remote_errors_absent.png")) == 0.0
    assert count(listener) == 1 and '"absent"' in listener.GetOutput(), listener.GetOutput()
    display.IsosurfaceArray = ["POINTS", "RTData"]
    assert session.covered(session.screenshot(view, "remote_errors_there.png")) > 0.01
session.finish(errors="told")
