"""The filters of the compressed volume: stream and metadata against libzfp."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk

import progiso
from helpers.filters import compressor
from helpers.images import (
    blobs,
    make_image,
    marschner_lobb,
    metadata,
    noise,
    reference_values,
    same_bits,
    samples_of,
    stream_of,
)
from progiso.measure import tolerances
from progiso.oracle import zfp_reference

RATES = [9 / 64, 0.5, 1, 1.5, 2, 3, 4, 5.25, 8, 12, 16, 31, 32]
TYPES = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"]


@pytest.mark.parametrize("rate", RATES)
def test_stream_is_zfps_own(rate):
    values = noise((9, 6, 11))
    compressed = progiso.compress(make_image(values), rate=rate)
    expected = zfp_reference.encode(values, rate)
    assert stream_of(compressed)[: len(expected)] == expected
    assert len(stream_of(compressed)) % 8 == 0
    assert not any(stream_of(compressed)[len(expected) :])
    assert same_bits(samples_of(progiso.decompress(compressed)), reference_values(compressed))


@pytest.mark.parametrize(
    "shape", [(a, b, c) for a in (2, 4, 7) for b in (3, 5, 8) for c in (2, 6, 9)]
)
def test_partial_blocks(shape):
    """Every remainder of four meets every other at the border."""
    values = noise(shape, 1)
    compressed = progiso.compress(make_image(values), rate=6)
    assert stream_of(compressed).startswith(zfp_reference.encode(values, 6))
    assert same_bits(samples_of(progiso.decompress(compressed)), reference_values(compressed))
    assert tuple(metadata(compressed, "Dimensions")) == shape[::-1]


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_threads_do_not_show(threads):
    image = make_image(noise((33, 20, 18), 2))
    assert stream_of(progiso.compress(image, rate=5, threads=threads)) == stream_of(
        progiso.compress(image, rate=5, threads=1)
    )


@pytest.mark.parametrize("cells", [False, True])
@pytest.mark.parametrize("kind", TYPES)
def test_scalar_types(kind, cells):
    values = (marschner_lobb(9) * 100).astype(kind)
    image = make_image(values, "name", cells=cells)
    compressed = progiso.compress(image, rate=16)
    assert (
        metadata(compressed, "ScalarType")[0]
        == (image.GetCellData() if cells else image.GetPointData()).GetScalars().GetDataType()
    )
    assert stream_of(compressed).startswith(zfp_reference.encode(values, 16))
    assert list(metadata(compressed, "Range")) == [values.min(), values.max()]
    assert metadata(compressed, "Association")[0] == int(cells)
    restored = progiso.decompress(compressed)
    data = restored.GetCellData() if cells else restored.GetPointData()
    assert data.GetScalars().GetName() == "name"
    assert data.GetScalars().GetDataTypeAsString() == "float"
    assert np.abs(samples_of(restored) - values.astype(float)).max() < 0.02


def test_geometry_is_kept():
    rotation = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    image = make_image(
        noise((5, 6, 7)),
        origin=(1, -2, 3),
        spacing=(0.5, 2, 1),
        direction=rotation,
        extent_start=(4, -3, 10),
    )
    for result in (progiso.compress(image), progiso.decompress(progiso.compress(image))):
        assert result.GetExtent() == image.GetExtent() == (4, 10, -3, 2, 10, 14)
        assert result.GetOrigin() == image.GetOrigin()
        assert result.GetSpacing() == image.GetSpacing()
        for row in range(3):
            for column in range(3):
                assert result.GetDirectionMatrix().GetElement(row, column) == rotation[row, column]
    assert progiso.compress(image).GetPointData().GetNumberOfArrays() == 0


def test_array_and_component_are_chosen():
    first, second = noise((4, 5, 6), 3), noise((4, 5, 6, 3), 4)
    image = make_image(first, "first")
    other = numpy_to_vtk(second.reshape(-1, 3), deep=True)
    other.SetName("second")
    image.GetPointData().AddArray(other)
    compressed = progiso.compress(image, rate=32, array="second", component=2)
    assert stream_of(compressed).startswith(zfp_reference.encode(second[..., 2], 32))
    assert (
        compressed.GetFieldData().GetAbstractArray("ProgIso.ZFP.ArrayName").GetValue(0) == "second"
    )
    assert metadata(compressed, "Component")[0] == 2
    assert stream_of(progiso.compress(image, rate=32)).startswith(zfp_reference.encode(first, 32))


@pytest.mark.parametrize("scale", [1e37, 1e30, 1e-20, 0.0])
def test_extreme_values(scale):
    """Large, small and zero values keep zfp's own bits."""
    values = (noise((6, 7, 5), 5) * scale).astype(np.float32)
    compressed = progiso.compress(make_image(values), rate=11)
    assert stream_of(compressed).startswith(zfp_reference.encode(values, 11))
    assert same_bits(samples_of(progiso.decompress(compressed)), reference_values(compressed))


def test_blocks_that_overflow_in_zfp_are_zero():
    """zfp's scale factor overflows for blocks below 3e-30; beside larger values they become 0."""
    values = noise((8, 8, 8), 5)
    values[:4, :4, :4] *= np.float32(1e-35)
    restored = samples_of(progiso.decompress(progiso.compress(make_image(values), rate=16)))
    assert not restored[:4, :4, :4].any()
    assert np.abs(restored - values).max() < 0.01


UNITS = {
    "offset": (1e8, 1e-3, np.float64),
    "negative offset": (-1e12, 1.0, np.float64),
    "whole numbers": (2e9, 1000.0, np.uint32),
    "large": (0.0, 1e300, np.float64),
    "tiny": (0.0, 1e-31, np.float32),
    "tiny doubles": (0.0, 1e-300, np.float64),
    "denormal": (0.0, 1e-41, np.float32),
    "offset and tiny": (1e-30, 1e-38, np.float64),
}


@pytest.mark.parametrize("case", UNITS)
def test_values_that_float32_cannot_hold(case):
    """The stream's units make up for it: what is lost is float32's and zfp's rounding of the
    differences."""
    offset, scale, kind = UNITS[case]
    values = (offset + scale * blobs((9, 10, 7), 5).astype(float)).astype(kind)
    compressed = progiso.compress(make_image(values), rate=32)
    restored = samples_of(progiso.decompress(compressed))
    assert restored.dtype == np.float64
    original = values.astype(float)
    allowed = tolerances.UNITS_RELATIVE * np.ptp(original)
    assert np.abs(restored - original).max() <= allowed
    about = progiso.describe(compressed)
    assert np.abs(np.subtract(about["range"], [original.min(), original.max()])).max() <= allowed
    assert metadata(compressed, "Scale")[0] == about["scale"]
    assert (about["offset"] != 0) == (offset != 0)


@pytest.mark.parametrize(
    "values",
    [
        noise((6, 7, 5)).astype(float) + 12,
        np.full((4, 4, 4), 3.0),
        1000 + np.arange(64).reshape(4, 4, 4),
    ],
)
def test_values_that_float32_holds_keep_their_units(values):
    compressed = progiso.compress(make_image(values), rate=11)
    assert stream_of(compressed).startswith(zfp_reference.encode(values, 11))
    assert progiso.describe(compressed)["scale"] == 1
    assert samples_of(progiso.decompress(compressed)).dtype == np.float32


@pytest.mark.parametrize("rate", [1 / 64, 9 / 64, 0.99, 1.004, 2.51, 32])
def test_actual_rate_is_zfps(rate):
    algorithm = compressor(make_image(noise((4, 4, 4))), rate)
    algorithm.Update()
    bits = int(metadata(algorithm.GetOutput(), "BlockBits")[0])
    assert algorithm.GetActualRate() * 64 == bits == max(9, int(64 * rate + 0.5))


def test_modified_times():
    """A filter runs again when something changed, and only then."""
    algorithm = compressor(make_image(noise((4, 4, 4))))
    algorithm.Update()
    time = algorithm.GetOutput().GetMTime()
    algorithm.SetRate(algorithm.GetRate())
    algorithm.Update()
    assert algorithm.GetOutput().GetMTime() == time
    algorithm.SetRate(4)
    algorithm.Update()
    assert metadata(algorithm.GetOutput(), "BlockBits")[0] == 256


def test_progress_rises():
    seen = []
    progiso.compress(make_image(noise((40, 8, 8))), progress=seen.append)
    assert len(seen) > 2 and seen == sorted(seen) and seen[-1] == 1
