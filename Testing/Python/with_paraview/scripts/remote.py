"""A server of two processes renders; the client shows the picture, and the figures of both."""

import numpy
import server
import session
from paraview import servermanager, simple

assert session.BUILD.is_dir()
PROCESSES = 2
LOOK = {"Isovalues": [150.0], "DiffuseColor": [0.9, 0.85, 0.7]}


def show_wavelet(name):
    """Show the same scene wherever it is rendered; return its picture, its figures, and what shows
    it."""
    view = session.make_view()
    wavelet = session.make_wavelet(60)
    display = session.show_isosurface(wavelet, view, **LOOK)
    session.look(view)
    return session.screenshot(view, name), session.check_converged(display), view, wavelet, display


def picks_of(view):
    """Return the places that ParaView finds at some pixels, on mesh points and not."""
    places = [(x, y) for x in range(90, 240, 50) for y in range(60, 190, 40)]
    found = [session.pick(view, *place, snap=snap) for place in places for snap in (True, False)]
    return [place for place in found if place is not None]


session.load_plugin()
here, info_here, view, *_ = show_wavelet("remote_here.png")
picks_here = picks_of(view)
assert len(picks_here) > 4
assert info_here["processes"] == 1, info_here
assert session.covered(here) > 0.1

with server.connected(PROCESSES):
    there, info, view, wavelet, display = show_wavelet("remote_there.png")
    session.check_same(here, there, tolerance=2)
    assert numpy.allclose(picks_of(view), picks_here, atol=1e-4), "of the right process's piece"

    # both processes draw, and each has its part of the volume
    assert info["processes"] == PROCESSES, info
    assert info["budget"] > 1.5 * info_here["budget"], (info, info_here)

    # the figures follow the image without being asked for
    display.MemoryBudget = 3
    display.Isovalues = [120.0]
    simple.Render(view)
    figures = {
        name: servermanager.vtkSMPropertyHelper(display.SMProxy, name).GetAsDouble()
        for name in ("NumberOfPasses", "CompletedFraction", "BudgetBytes")
    }
    assert figures["NumberOfPasses"] > 1 and figures["CompletedFraction"] == 1.0, figures
    session.check_close(figures["BudgetBytes"], PROCESSES * 3 * 2**20, "budget of two processes")

    # a compressed volume of the server's
    compressed = simple.ZFPCompress(Input=wavelet, Rate=display.CompressionRate)
    simple.Hide(wavelet, view)
    packed = session.show_isosurface(compressed, view, **LOOK)
    session.check_same(there, session.screenshot(view, "remote_compressed.png"))
    assert session.check_converged(packed)["processes"] == PROCESSES

    # with levels of detail: the server's windows, too, know whether the camera moves
    leveled = simple.ZFPCompress(Input=wavelet, Rate=display.CompressionRate, Levels=11)
    simple.Hide(compressed, view)
    packed = session.show_isosurface(leveled, view, **LOOK, LevelOfDetail="Interactive")
    packed.PixelTolerance = 64.0
    session.check_same(there, session.screenshot(view, "remote_levels.png"))
    (still,) = session.figures(packed, "LevelPixels")
    assert session.figures(packed, "UncertainFraction") == [0.0]
    view.SMProxy.InteractiveRender()
    while session.information(packed)["completed"] < 1.0:
        view.SMProxy.InteractiveRender()
    exact, *coarser = session.figures(packed, "LevelPixels")
    assert exact == 0.0 < sum(coarser) and still > 0.0, (still, exact, coarser)
    (uncertain,) = session.figures(packed, "UncertainFraction")
    assert 0.0 < uncertain < 1.0, uncertain

session.finish(here=info_here, there=info)
