"""ParaView asks a stream for its range, which costs what it costs for the metadata (F12)."""

import time

import session
from paraview import simple

session.load_plugin()
HALF = 63  # 2 million samples, 8 MB of stream


def seconds(source):
    """Return the time of the processor that a source's information takes, once it is updated."""
    source.UpdatePipeline()
    began = time.process_time()
    source.GetDataInformation().GetNumberOfPoints()
    return time.process_time() - began


def check_range(source):
    """Check the range of the stream that ParaView shows."""
    stream = source.FieldData.GetArray("ProgIso.ZFP.Stream")
    assert stream.GetRange() == (0.0, 255.0), stream.GetRange()


wavelet = session.make_wavelet(HALF)
compressed = simple.ZFPCompress(Input=wavelet, Rate=32)
times = {"compressed": seconds(compressed)}
check_range(compressed)
for name, options in {"file.vti": {"DataMode": "Binary"}, "file.zfp": {}}.items():
    path = str(session.OUTPUT / name)
    simple.SaveData(path, compressed, **options)
    reader = simple.OpenDataFile(path)
    times[name] = seconds(reader)
    check_range(reader)
times["passed"] = seconds(simple.PassArrays(Input=reader))
times["subset"] = seconds(simple.ExtractSubset(Input=compressed, VOI=[-5, 5] * 3))

# as many bytes in a usual array, of which VTK looks at each
usual = simple.ProgrammableSource(OutputDataSetType="vtkImageData")
usual.Script = f"""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
array = numpy_to_vtk(numpy.arange({(2 * HALF + 1) ** 3 * 4}) % 256, deep=1, array_type=3)
array.SetName("bytes")
self.GetImageDataOutput().GetFieldData().AddArray(array)
"""
expected = seconds(usual)
for name, found in times.items():
    assert found < expected / 4, (name, times, expected)

session.finish(usual=expected, **times)
