"""A recorded trace of a session makes the same picture when it is played; so does a state in
Python."""

import session
from paraview import simple, smstate, smtrace

session.load_plugin()


class Recorded:
    """Record changes of a proxy's properties as the panel's Apply does."""

    def __init__(self, proxy):
        self.proxy = proxy

    def __enter__(self):
        self.item = smtrace._create_trace_item_internal(
            "PropertiesModified", kwargs={"proxy": self.proxy.SMProxy}
        )

    def __exit__(self, *_):
        self.item.finalize()


def play(script):
    """Run a script on an empty session; return its picture."""
    simple.ResetSession()
    session.load_plugin()
    exec(compile(script, "script", "exec"), {"__name__": "__main__"})
    return session.screenshot(
        session.undecorate(simple.GetActiveViewOrCreate("RenderView")), "trace_played.png"
    )


smtrace.start_trace()
view = session.make_view()
wavelet = simple.Wavelet()
with Recorded(wavelet):
    wavelet.WholeExtent = [-24, 24] * 3
compressed = simple.ZFPCompress(Input=wavelet)
with Recorded(compressed):
    compressed.Rate = 6.0
display = simple.Show(compressed, view)
with Recorded(display):
    display.SetRepresentationType(session.PROGRESSIVE_ISOSURFACE)
    display.Isovalues = [150.0]
    display.DiffuseColor = [0.3, 0.6, 0.9]
    display.MemoryBudget = 100
    display.Speculation = 0
session.look(view)
recorded = smtrace.stop_trace()
shown = session.screenshot(view, "trace_shown.png")
assert session.covered(shown) > 0.1

for fact in (
    "Isovalues = [150.0]",
    "MemoryBudget = 100",
    "Speculation = 0",
    "Rate = 6.0",
    session.PROGRESSIVE_ISOSURFACE,
):
    assert fact in recorded, (fact, recorded)
state = smstate.get_state()
(session.OUTPUT / "trace_state.py").write_text(state)
(session.OUTPUT / "trace_recorded.py").write_text(recorded)

session.check_same(shown, play(recorded))
session.check_same(shown, play(state))

session.finish(covered=session.covered(shown))
