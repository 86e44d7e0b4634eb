"""The extractor ZFP writes compressed volumes, and a script for Catalyst that does so."""

import session
from paraview import catalyst, servermanager, simple
from paraview.detail.catalyst_export import save_catalyst_state

session.load_plugin()
OUT = session.OUTPUT


def values(source):
    """Return a compressed volume's bounds and decompressed values."""
    image = servermanager.Fetch(simple.ZFPDecompress(Input=source))
    array = image.GetPointData().GetArray("RTData")
    return image.GetBounds(), [array.GetValue(i) for i in range(array.GetNumberOfTuples())]


wavelet = simple.Wavelet(WholeExtent=[-10, 9, -10, 10, -10, 8])
simple.RenameSource("input", wavelet)
simple.GetAnimationScene().NumberOfFrames = 2
extractor = simple.CreateExtractor("ZFP", wavelet, registrationName="ZFP1")
extractor.Writer.FileName = "volume_{timestep:04d}.vti"
extractor.Writer.Rate = 6
simple.SaveExtracts(ExtractsOutputDirectory=str(OUT / "saved"))
saved = sorted((OUT / "saved").glob("*.vti"))
assert len(saved) == 2, saved
expected = values(simple.ZFPCompress(Input=wavelet, Rate=6))
assert values(simple.OpenDataFile(str(saved[0]))) == expected

# to a file of zfp's own, of a compressed volume as it is, and with a tolerance in place of a rate
compressed = simple.ZFPCompress(Input=wavelet, Rate=9)
other = simple.CreateExtractor("ZFP", compressed, registrationName="ZFP2")
other.Writer.FileName = "whole_{timestep:04d}.zfp"
simple.SaveExtracts(ExtractsOutputDirectory=str(OUT / "others"))
again = simple.OpenDataFile(str(OUT / "others" / "whole_0000.zfp"))
again.ArrayName = "RTData"
assert values(again)[1] == values(compressed)[1]
simple.Delete(other)
extractor.Writer.Tolerance = 0.5
simple.SaveExtracts(ExtractsOutputDirectory=str(OUT / "tolerance"))
within = values(simple.OpenDataFile(str(OUT / "tolerance" / "volume_0000.vti")))[1]
exact = servermanager.Fetch(wavelet).GetPointData().GetArray("RTData")
assert max(abs(exact.GetValue(i) - value) for i, value in enumerate(within)) <= 0.5
extractor.Writer.Tolerance = 0

# with levels of detail, where a volume is large enough for any
long = simple.Wavelet(WholeExtent=[-40, 40, -4, 4, -4, 4])
other = simple.CreateExtractor("ZFP", long, registrationName="ZFP3")
other.Writer.Levels = 2
other.Writer.FileName = "levels_{timestep:04d}.vti"
simple.SaveExtracts(ExtractsOutputDirectory=str(OUT / "levels"))
packed = simple.OpenDataFile(str(OUT / "levels" / "levels_0000.vti"))
level = servermanager.Fetch(simple.ZFPDecompress(Input=packed, Level=1))
assert level.GetDimensions() == (41, 5, 5), level.GetDimensions()
simple.Delete(other)

# what cannot be written is told once a file, by what the panel calls it
extractor.Writer.FileName = "volume_{timestep:04d}.vtk"
with session.messages() as listener:
    simple.SaveExtracts(ExtractsOutputDirectory=str(OUT / "wrong"))
assert "ends with .vti, or with .zfp" in listener.GetOutput(), listener.GetOutput()
extractor.Writer.FileName = "volume_{timestep:04d}.vti"
extractor.Writer.Rate = 40
with session.messages() as listener:
    simple.SaveExtracts(ExtractsOutputDirectory=str(OUT / "wrong"))
assert "Rate is 40" in listener.GetOutput(), listener.GetOutput()
extractor.Writer.Rate = 6

# the window's File > Save Catalyst State
simple.SetActiveSource(wavelet)
options = catalyst.Options()
options.ExtractsOutputDirectory = "extracts"
save_catalyst_state(str(OUT / "pipeline.py"), options)
written = (OUT / "pipeline.py").read_text()
assert "CreateExtractor('ZFP'" in written and "Rate = 6" in written, written

session.finish(files=len(saved))
