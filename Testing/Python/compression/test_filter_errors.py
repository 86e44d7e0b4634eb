"""Inputs that cannot be compressed, and compressed volumes that are damaged: one clear error."""

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkImageData

import progiso
from helpers.filters import compressor, update
from helpers.images import make_image, noise
from progiso import vtkCompressedVolume, vtkImageZFPDecompress


def plane():
    return make_image(noise((1, 8, 8)))


def with_value(value):
    values = noise((8, 8, 8))
    values[1, 2, 3] = values[7, 7, 7] = value
    return make_image(values)


BAD_INPUTS = {
    "flat": (plane, {}, "2"),
    "nan": (lambda: with_value(np.nan), {"MaskNonFinite": False}, "2 "),
    "infinite": (lambda: with_value(np.inf), {"MaskNonFinite": False}, "2 "),
    "no array": (lambda: make_empty(), {}, "array"),
    "component": (lambda: make_image(noise((4, 4, 4))), {"Component": 1}, "omponent"),
    "rate 0": (lambda: make_image(noise((4, 4, 4))), {"Rate": 0}, "ate"),
    "rate 33": (lambda: make_image(noise((4, 4, 4))), {"Rate": 33}, "ate"),
    "rate nan": (lambda: make_image(noise((4, 4, 4))), {"Rate": float("nan")}, "ate"),
}


def make_empty():
    image = vtkImageData()
    image.SetDimensions(4, 4, 4)
    return image


@pytest.mark.parametrize("case", BAD_INPUTS)
def test_bad_input_is_one_clear_error(case):
    image, settings, word = BAD_INPUTS[case]
    output, messages = update(compressor(image(), **settings))
    ours = [m for m in messages if "vtkImageZFPCompress" in m]
    assert len(ours) == 1, messages
    assert word in ours[0].split("):")[-1]
    assert not vtkCompressedVolume.IsCompressed(output)


def damaged(change):
    compressed = vtkImageData()
    compressed.DeepCopy(progiso.compress(make_image(noise((8, 8, 8)))))
    change(compressed)
    return compressed


def replace(name, values, kind=vtkIntArray):
    def change(image):
        array = kind()
        array.SetName("ProgIso.ZFP." + name)
        for value in values:
            array.InsertNextValue(value)
        image.GetFieldData().RemoveArray(array.GetName())
        image.GetFieldData().AddArray(array)

    return change


def cover(image, extent):
    replace("Extent", extent)(image)


def truncate(image):
    stream = image.GetFieldData().GetAbstractArray("ProgIso.ZFP.Stream")
    stream.SetNumberOfValues(stream.GetNumberOfValues() - 1)


DAMAGES = {
    "truncated": truncate,
    "no stream": lambda image: image.GetFieldData().RemoveArray("ProgIso.ZFP.Stream"),
    "no rate": lambda image: image.GetFieldData().RemoveArray("ProgIso.ZFP.BlockBits"),
    "newer version": replace("Version", [4]),
    "negative bits": replace("BlockBits", [-8]),
    "too few bits": replace("BlockBits", [8]),
    "too many bits": replace("BlockBits", [1 << 30]),
    "no bits": replace("BlockBits", []),
    "other geometry": lambda image: image.SetDimensions(9, 8, 8),
    "range": replace("Range", [0, float("nan")], vtkDoubleArray),
    "association": replace("Association", [7]),
    "an extent elsewhere": lambda image: image.SetExtent(1, 6, 0, 7, 3, 8),
    "an extent of another size": lambda image: (
        image.SetExtent(0, 6, 0, 7, 0, 7),
        cover(image, (0, 7, 0, 7, 0, 6)),
    ),
    "an extent beyond 32 bits": lambda image: (
        image.SetExtent(0, 6, 0, 7, 0, 7),
        cover(image, (-(2**31), 7) * 3),
    ),
}


@pytest.mark.parametrize("case", DAMAGES)
def test_damaged_volumes_are_refused(case):
    compressed = damaged(DAMAGES[case])
    reader = vtkCompressedVolume()
    assert not reader.Read(compressed)
    assert reader.GetErrorMessage()
    algorithm = vtkImageZFPDecompress()
    algorithm.SetInputData(compressed)
    output, messages = update(algorithm)
    assert sum("vtkImageZFPDecompress" in m for m in messages) == 1, messages
    assert output.GetPointData().GetNumberOfArrays() == 0
    with pytest.raises(RuntimeError):
        progiso.decompress(compressed)


def test_python_errors_name_the_argument():
    image = make_image(noise((4, 4, 4)))
    with pytest.raises(ValueError, match="'nothing'.*'field'"):
        progiso.compress(image, array="nothing")
    with pytest.raises(TypeError, match="vtkImageData"):
        progiso.compress([1, 2, 3])
    with pytest.raises(RuntimeError, match="already"):
        progiso.compress(progiso.compress(image))
