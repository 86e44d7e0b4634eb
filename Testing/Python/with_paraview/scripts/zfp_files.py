"""zfp's own files and VTI files of compressed volumes pass ParaView's readers and writers."""

import session
from paraview import simple

view = session.start()
compressed = simple.ZFPCompress(Input=session.make_wavelet(), Rate=8)
look_at = dict(Isovalues=[150.0], DiffuseColor=[0.9, 0.85, 0.7])
session.show_isosurface(compressed, view, **look_at)
session.look(view)
direct = session.screenshot(view, "files_direct.png")
simple.Hide(compressed, view)

# VTI keeps everything; in line, as Debian's ParaView can no longer read its own appended data
path = str(session.OUTPUT / "compressed.vti")
simple.SaveData(path, compressed, DataMode="Binary")
vti = simple.OpenDataFile(path)
session.show_isosurface(vti, view, **look_at)
session.check_same(direct, session.screenshot(view, "files_vti.png"))
simple.Hide(vti, view)

# zfp's file loses the geometry: spacing is 1 here anyway, the origin is given again
path = str(session.OUTPUT / "compressed.zfp")
simple.SaveData(path, compressed)
zfp = simple.OpenDataFile(path)
assert zfp.GetXMLName() == "ZFPReader", zfp.GetXMLName()
zfp.DataOrigin = [-24.0, -24.0, -24.0]
session.show_isosurface(zfp, view, **look_at)
session.check_same(direct, session.screenshot(view, "files_zfp.png"))
simple.Hide(zfp, view)

# without header the reader must be told
path = str(session.OUTPUT / "headerless.zfp")
simple.SaveData(path, compressed, WriteHeader=0)
bare = simple.ZFPReader(
    FileName=path, DataDimensions=[49, 49, 49], Rate=8, DataOrigin=[-24.0, -24.0, -24.0]
)
session.show_isosurface(bare, view, **look_at)
session.check_same(direct, session.screenshot(view, "files_headerless.png"))

simple.Hide(bare, view)

# and can be opened as any other file; before it is told nothing is wrong yet, and then once
with session.messages() as listener:
    opened = simple.OpenDataFile(path)
    opened.UpdatePipelineInformation()
    assert not listener.GetOutput(), listener.GetOutput()
    opened.UpdatePipeline()
assert listener.GetOutput().count("does not start with zfp's header") == 1, listener.GetOutput()
opened.DataDimensions = [49, 49, 49]
opened.DataOrigin = [-24.0, -24.0, -24.0]
session.show_isosurface(opened, view, **look_at)
session.check_same(direct, session.screenshot(view, "files_opened.png"))
simple.Hide(opened, view)

# a series is time steps
names = [str(session.OUTPUT / f"step_{step}.zfp") for step in range(3)]
for step, name in enumerate(names):
    scaled = simple.Calculator(Input=session.make_wavelet(), Function=f"RTData * {1 + step}")
    scaled.ResultArrayName = "scaled"
    packed = simple.ZFPCompress(Input=scaled, InputArray=["POINTS", "scaled"])
    simple.SaveData(name, packed)
series = simple.OpenDataFile(names)
assert list(series.TimestepValues) == [0.0, 1.0, 2.0], series.TimestepValues
isosurface = simple.ZFPContour(Input=series, Isosurfaces=[400.0])
counts = []
for time in range(3):
    isosurface.UpdatePipeline(time)
    counts.append(isosurface.GetDataInformation().GetNumberOfCells())
assert counts[0] == 0 < counts[1] and counts[1] != counts[2] > 0, counts

session.finish(covered=session.covered(direct))
