"""What takes time is told: in ParaView's progress bar what only a first image takes (compression,
upload, preparation, programs), in its Timer Log all work.

And what a compressed volume comes up as, from our sources and from ParaView's reader.
"""

import session
from paraview import servermanager, simple
from vtkmodules.vtkCommonSystem import vtkTimerLog

view = session.start()
handler = servermanager.ActiveConnection.Session.GetProgressHandler()
handler.SetProgressInterval(0.0)  # small volumes are compressed in less than the usual interval
told = []
handler.AddObserver("ProgressEvent", lambda *_: told.append(handler.GetLastProgressText()))
parts = []  # of a first image's work, as the representation tells it: the handler leaves some out


def note(representation, _event):
    parts.append((representation.GetProgressText(), representation.GetProgress()))


vtkTimerLog.SetMaxEntries(10000)
vtkTimerLog.ResetLog()
wavelet = session.make_wavelet()
display = session.show_isosurface(wavelet, view, Isovalues=[150.0])
ours = display.SMProxy.GetClientSideObject().GetActiveRepresentation()
ours.AddObserver("ProgressEvent", note)
simple.Render(view)
assert any("Compressing" in text for text in told), told
assert any("Loading" in text for text in told), told
loading = [fraction for text, fraction in parts if "Loading" in text]
assert len(loading) >= 5 and loading == sorted(loading) and loading[-1] == 1.0, parts
log = {vtkTimerLog.GetEventString(event) for event in range(vtkTimerLog.GetNumberOfEvents())}
assert {f"Progressive Isosurface: {work}" for work in ("compress", "upload", "render")} <= log, log
parts.clear()
display.Isovalues = [160.0]
view.GetActiveCamera().Azimuth(10)
simple.Render(view)
assert not parts, parts
display.Opacity = 0.5  # translucent surfaces have programs of their own
simple.Render(view)
assert len(parts) >= 2 and parts[-1][1] == 1.0, parts
simple.Hide(wavelet, view)

# compressed volumes come up as what they are good for, all else as before
defaults = {"plain": simple.Show(session.make_wavelet(8), view).Representation[0]}
compressed = simple.ZFPCompress(Input=wavelet, Rate=4)
defaults["filter"] = simple.Show(compressed, view).Representation[0]
for suffix in ("zfp", "vti"):
    path = str(session.OUTPUT / f"waiting.{suffix}")
    simple.SaveData(path, compressed)
    defaults[suffix] = simple.Show(simple.OpenDataFile(path), view).Representation[0]
chosen = simple.CreateRenderView()
defaults["chosen"] = simple.Show(compressed, chosen, Representation="Outline").Representation[0]
expected = dict.fromkeys(defaults, session.PROGRESSIVE_ISOSURFACE)
assert defaults == {**expected, "plain": "Outline", "chosen": "Outline"}, defaults

session.finish(told=len(told), loading=loading, **defaults)
