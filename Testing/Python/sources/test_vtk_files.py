"""VTK's own files as sources: by extent, and never a crash."""

import itertools
import pickle
import re

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOLegacy import vtkDataSetWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

import progiso
from helpers.images import blobs, check_same, make_image
from progiso.compression import find_array
from progiso.io import open_source

STYLES = list(
    itertools.product(
        ("Ascii", "Binary", "Appended"), (0, 1), ("None", "ZLib", "LZ4"), ("UInt32", "UInt64")
    )
)


def write(image, path, mode="Binary", encoded=0, packed="None", header="UInt64", big=False):
    """Write a .vti in one of VTK's styles."""
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetEncodeAppendedData(encoded)
    getattr(writer, f"SetCompressorTypeTo{packed}")()
    getattr(writer, f"SetHeaderTypeTo{header}")()
    if big:
        writer.SetByteOrderToBigEndian()
    writer.SetFileName(str(path))
    assert writer.Write()


@pytest.mark.parametrize("style", STYLES, ids=str)
@pytest.mark.parametrize("strings", [2, 300])
def test_strings_that_are_not_as_many_as_told(style, strings, tmp_path):
    """VTK would write behind the end of its array; what nothing here unpacks is left to VTK."""
    image, names = make_image(blobs((5, 6, 7))), vtkStringArray()
    names.SetName("names")
    for number in range(strings):
        names.InsertNextValue("x" * (number * 7 % 101))
    image.GetFieldData().AddArray(names)
    path = tmp_path / "volume.vti"
    write(image, path, *style, big=style[1] == 0)
    assert open_source(path).about.dimensions == (7, 6, 5)
    told = b'NumberOfTuples="%d"'
    path.write_bytes(path.read_bytes().replace(told % strings, told % (strings - 1)))
    if style[2] == "LZ4" and style[0] != "Ascii":
        return
    with pytest.raises(ValueError, match=f"'names' are {strings}, not {strings - 1}"):
        open_source(path)


def test_packed_data_that_announce_too_much(tmp_path):
    """VTK would ask for as much memory, and end the process."""
    path = tmp_path / "volume.vti"
    write(make_image(blobs((5, 6, 7))), path, "Appended", 0, "ZLib")
    data = path.read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    blocks, size = (int.from_bytes(data[start + i : start + i + 8], "little") for i in (0, 8))
    assert blocks == 1 and size >= 5 * 6 * 7
    for place in (0, 8, 24):
        hostile = bytearray(data)
        hostile[start + place + 5] = 0xB0
        path.write_bytes(hostile)
        with pytest.raises(ValueError, match="announces more than it can hold"):
            open_source(path)


def test_packed_data_of_another_kind_of_numbers(tmp_path):
    """Half a number is a block of no size, by which VTK would divide."""
    path = tmp_path / "volume.vti"
    write(make_image(blobs((5, 6, 7))), path, "Appended", 0, "ZLib")
    path.write_bytes(path.read_bytes().replace(b'header_type="UInt64"', b""))
    with pytest.raises(ValueError, match="announces more than it can hold"):
        open_source(path)


def test_packed_data_of_no_blocks(tmp_path):
    """An array of samples has some; an empty one has none."""
    path, nothing = tmp_path / "volume.vti", vtkFloatArray()
    image = make_image(blobs((5, 6, 7)))
    nothing.SetName("nothing")
    image.GetFieldData().AddArray(nothing)
    write(image, path, "Appended", 0, "ZLib")
    assert open_source(path).read().shape == (5, 6, 7)
    data = path.read_bytes()
    before, offset, after = re.split(rb'offset="([1-9]\d*)"', data)  # of the samples
    path.write_bytes(before + b'offset="%d"' % (int(offset) + 1) + after)
    with pytest.raises(ValueError, match="announces more than it can hold"):
        open_source(path)


@pytest.mark.parametrize(
    "told, hostile",
    [
        (b'WholeExtent="0 6 0 5 0 4"', b'WholeExtent="0 6 0 5 0 2147483647"'),
        (b'WholeExtent="0 6 0 5 0 4"', b'WholeExtent="255 6 0 5 0 4"'),
        (b'ScalarType" NumberOfTuples="1"', b'x" NumberOfTuples="-2147483648"'),
        (b'ScalarType" NumberOfTuples="1"', b'x" NumberOfTuples="2147483648"'),
        (b'encoding="raw">\n   _', b'encoding="raw">\n  \xff_'),
        (b'WholeExtent="0 6 0 5 0 4"', b'WholeExtent="0 99999 0 99999 0 99999"'),
        (b'ScalarType" NumberOfTuples="1"', b'x" NumberOfTuples="99999999999"'),
    ],
)
def test_headers_that_announce_too_much(told, hostile, tmp_path):
    path = tmp_path / "volume.vti"
    write(progiso.compress(make_image(blobs((5, 6, 7))), rate=8), path, "Appended")
    data = path.read_bytes()
    assert told in data
    path.write_bytes(data.replace(told, hostile))
    with pytest.raises(
        ValueError, match="its extent is|announces more than it can hold|do not begin with"
    ):
        open_source(path)


def test_by_extent(tmp_path):
    """A region is that of the whole, and the volume that of the whole image."""
    values = blobs((13, 7, 9)) * 100
    image = make_image(values, origin=(1, 2, 3), extent_start=(5, -6, 7))
    path = tmp_path / "volume.vti"
    write(image, path, "Appended")
    with open_source(path) as source:
        assert not source.more_than_samples
        for region in (np.s_[2:5, 1:7, 3:4], np.s_[12:13, 0:1, 0:9], np.s_[:, :, :]):
            assert np.array_equal(source.read(region), values[region])
        assert np.array_equal(pickle.loads(pickle.dumps(source)).read(), values)
    compressed = progiso.compress_file(path, rate=7)
    check_same(compressed, progiso.compress(image, rate=7))
    assert compressed.GetExtent() == image.GetExtent()


@pytest.mark.parametrize("wanted", ["a", "b", "c"])
@pytest.mark.parametrize("suffix", [".vti", ".vtk"])
def test_the_array_that_is_asked_for_is_active(wanted, suffix, tmp_path):
    image = vtkImageData()
    image.SetDimensions(5, 6, 7)
    for name, data in (("a", "Point"), ("b", "Point"), ("c", "Cell")):
        array = vtkFloatArray()
        array.SetName(name)
        array.SetNumberOfTuples(getattr(image, f"GetNumberOf{data}s")())
        array.Fill(ord(name))
        attributes = getattr(image, f"Get{data}Data")()
        attributes.AddArray(array)
        attributes.SetActiveScalars(name)
    path = tmp_path / f"volume{suffix}"
    if suffix == ".vti":
        write(image, path)
    else:
        writer = vtkDataSetWriter()
        writer.SetInputData(image)
        writer.SetFileName(str(path))
        assert writer.Write()
    read = progiso.read(path, array=wanted)
    assert find_array(read)[0].GetName() == wanted
    assert read.GetPointData().GetNumberOfArrays() + read.GetCellData().GetNumberOfArrays() == 3
    volume = progiso.compress(read, rate=8)
    assert progiso.describe(volume)["array"] == wanted
