"""What the window's trace recorder writes down of a session makes the same picture when it is played back, as a saved state in Python does."""

from common import (
    OUTPUT,
    PROGRESSIVE_ISOSURFACE,
    check_same,
    covered,
    finish,
    load_plugin,
    look,
    make_view,
    screenshot,
    undecorate,
)
from paraview import simple, smstate, smtrace

load_plugin()


class Recorded:
    """Property changes of a proxy as the panel's Apply records them."""

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
    load_plugin()
    exec(compile(script, "script", "exec"), {"__name__": "__main__"})
    return screenshot(undecorate(simple.GetActiveViewOrCreate("RenderView")), "trace_played.png")


smtrace.start_trace()
view = make_view()
wavelet = simple.Wavelet()
with Recorded(wavelet):
    wavelet.WholeExtent = [-24, 24] * 3
compressed = simple.ZFPCompress(Input=wavelet)
with Recorded(compressed):
    compressed.Rate = 6.0
display = simple.Show(compressed, view)
with Recorded(display):
    display.SetRepresentationType(PROGRESSIVE_ISOSURFACE)
    display.Isovalues = [150.0]
    display.DiffuseColor = [0.3, 0.6, 0.9]
    display.MemoryBudget = 100
    display.Speculation = 0
look(view)
recorded = smtrace.stop_trace()
shown = screenshot(view, "trace_shown.png")
assert covered(shown) > 0.1

for fact in (
    "Isovalues = [150.0]",
    "MemoryBudget = 100",
    "Speculation = 0",
    "Rate = 6.0",
    PROGRESSIVE_ISOSURFACE,
):
    assert fact in recorded, (fact, recorded)
state = smstate.get_state()
(OUTPUT / "trace_state.py").write_text(state)
(OUTPUT / "trace_recorded.py").write_text(recorded)

check_same(shown, play(recorded))
check_same(shown, play(state))

finish(covered=covered(shown))
