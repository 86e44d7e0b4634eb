"""The compressed volume: filters, files and metadata, against libzfp."""

import subprocess

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkPointDataToCellData
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

import progiso
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
from helpers.messages import vtk_messages
from progiso import (
    vtkCompressedVolume,
    vtkImageZFPCompress,
    vtkImageZFPDecompress,
    vtkZFPReader,
    vtkZFPWriter,
)
from progiso.measure import tolerances
from progiso.oracle import zfp_reference

RATES = [9 / 64, 0.5, 1, 1.5, 2, 3, 4, 5.25, 8, 12, 16, 31, 32]
TYPES = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"]


def run(algorithm):
    """Update an algorithm; return its output and what VTK had to say."""
    with vtk_messages() as messages:
        algorithm.Update()
    return algorithm.GetOutputDataObject(0), messages


def compressor(image, rate=8, **settings):
    algorithm = vtkImageZFPCompress()
    algorithm.SetInputData(image)
    algorithm.SetRate(rate)
    for name, value in settings.items():
        getattr(algorithm, "Set" + name)(value)
    return algorithm


# --- round trips -------------------------------------------------------------------------------------------------------------


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
    image = make_image(values, "name", cells)
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


@pytest.mark.parametrize("scale", [1e37, 1e30, 1e-28, 0.0])
def test_extreme_values(scale):
    """Large, tiny and zero values keep zfp's own bits."""
    values = (noise((6, 7, 5), 5) * scale).astype(np.float32)
    compressed = progiso.compress(make_image(values), rate=11)
    assert stream_of(compressed).startswith(zfp_reference.encode(values, 11))
    assert same_bits(samples_of(progiso.decompress(compressed)), reference_values(compressed))


def test_blocks_that_overflow_in_zfp_are_zero():
    """zfp's scale factor overflows for blocks below 3e-30: where the rest is larger they become what they are beside it."""
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
    """The stream's units make up for it: what is lost is float32's and zfp's rounding of the differences."""
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
    assert (
        metadata(compressed, "Version")[0] == 2
        and metadata(compressed, "Scale")[0] == about["scale"]
    )
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
    assert metadata(compressed, "Version")[0] == 1 and progiso.describe(compressed)["scale"] == 1
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


# --- errors ------------------------------------------------------------------------------------------------------------------


def plane():
    return make_image(noise((1, 8, 8)))


def with_value(value):
    values = noise((8, 8, 8))
    values[1, 2, 3] = values[7, 7, 7] = value
    return make_image(values)


BAD_INPUTS = {
    "flat": (plane, {}, "2"),
    "nan": (lambda: with_value(np.nan), {}, "2 "),
    "infinite": (lambda: with_value(np.inf), {}, "2 "),
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
    output, messages = run(compressor(image(), **settings))
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
    "newer version": replace("Version", [3]),
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
    output, messages = run(algorithm)
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


# --- files -------------------------------------------------------------------------------------------------------------------


def test_vti_carries_the_stream_through_pyvista(tmp_path):
    """pyvista saves and reads a compressed volume untouched."""
    pyvista = pytest.importorskip("pyvista")
    compressed = progiso.compress(
        make_image(noise((7, 8, 9)), origin=(1, 2, 3), extent_start=(5, 6, 7)), rate=3
    )
    pyvista.wrap(compressed).save(tmp_path / "volume.vti")
    read = pyvista.read(tmp_path / "volume.vti")
    assert stream_of(read) == stream_of(compressed)
    assert read.GetExtent() == compressed.GetExtent()
    assert same_bits(samples_of(progiso.decompress(read)), reference_values(compressed))


@pytest.mark.parametrize("header", [False, True])
@pytest.mark.parametrize("rate", [0.25, 3, 8, 19.5])
def test_writer_against_the_tool(tmp_path, header, rate, lacking):
    if not zfp_reference.has_tool():
        lacking("the zfp command line tool is not installed (Debian: zfp)")
    values = noise((6, 9, 7), 6)
    compressed = progiso.compress(make_image(values), rate=rate)
    path = tmp_path / "volume.zfp"
    writer = vtkZFPWriter()
    writer.SetInputData(compressed)
    writer.SetFileName(str(path))
    writer.SetWriteHeader(header)
    assert writer.Write() == 1
    options = ["-h"] if header else ["-f", "-3", "7", "9", "6", "-r", str(rate)]
    subprocess.run(["zfp", "-q", *options, "-z", path, "-o", tmp_path / "raw"], check=True)
    assert same_bits(
        np.fromfile(tmp_path / "raw", np.float32).reshape(6, 9, 7), reference_values(compressed)
    )


@pytest.mark.parametrize("header", [False, True])
@pytest.mark.parametrize("rate", [0.25, 3, 8, 19.5])
def test_reader_against_the_tool(tmp_path, header, rate, lacking):
    if not zfp_reference.has_tool():
        lacking("the zfp command line tool is not installed (Debian: zfp)")
    values = noise((6, 9, 7), 7)
    values.tofile(tmp_path / "raw")
    options = ["-h"] if header else []
    path = tmp_path / "volume.zfp"
    subprocess.run(
        [
            "zfp",
            "-q",
            *options,
            "-f",
            "-3",
            "7",
            "9",
            "6",
            "-r",
            str(rate),
            "-i",
            tmp_path / "raw",
            "-z",
            path,
        ],
        check=True,
    )
    reader = vtkZFPReader()
    reader.SetFileName(str(path))
    if not header:
        reader.SetDataDimensions(7, 9, 6)
        reader.SetRate(rate)
    reader.SetDataSpacing(1, 2, 3)
    output, messages = run(reader)
    assert not messages
    expected = zfp_reference.encode(values, rate)
    assert stream_of(output).startswith(expected[: metadata(output, "BlockBits")[0] * 12 // 8])
    decoded = reference_values(output)
    assert same_bits(samples_of(progiso.decompress(output)), decoded)
    assert output.GetSpacing() == (1, 2, 3)
    assert list(metadata(output, "Range")) == [decoded.min(), decoded.max()]


@pytest.mark.parametrize("header", [False, True])
@pytest.mark.parametrize("rate", [9 / 64, 7.3, 32])
def test_reader_puts_parts_together(tmp_path, header, rate):
    """Files are read in parts of a quarter of a MiB, by several threads."""
    compressed = progiso.compress(make_image(noise((61, 62, 65), 8)), rate=rate)
    writer = vtkZFPWriter()
    writer.SetInputData(compressed)
    writer.SetFileName(str(tmp_path / "volume.zfp"))
    writer.SetWriteHeader(header)
    assert writer.Write() == 1
    dimensions = None if header else (65, 62, 61)
    assert stream_of(
        progiso.read(tmp_path / "volume.zfp", dimensions=dimensions, rate=rate)
    ) == stream_of(compressed)


@pytest.mark.parametrize("cells", [False, True])
@pytest.mark.parametrize("pieces", [2, 3, 8])
def test_pieces_hold_the_blocks_of_the_whole(pieces, cells):
    """A piece's stream decodes to the samples that the whole's does, its own and those around it."""
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(-13, 14, -9, 16, 2, 31)
    cell_values = vtkPointDataToCellData()
    cell_values.SetInputConnection(source.GetOutputPort())
    algorithm = vtkImageZFPCompress()
    algorithm.SetInputConnection((cell_values if cells else source).GetOutputPort())
    algorithm.SetRate(5)
    algorithm.Update()
    expected = samples_of(progiso.decompress(algorithm.GetOutput()))
    origin, covered = np.array([-13, -9, 2]), np.zeros(expected.shape, int)
    for piece in range(pieces):
        algorithm.UpdatePiece(piece, pieces, 0)
        output, volume = algorithm.GetOutput(), vtkCompressedVolume()
        assert volume.Read(output), volume.GetErrorMessage()
        own = np.reshape(output.GetExtent(), (3, 2)) - origin[:, None]
        held = np.reshape(volume.GetExtent(), (3, 2)) - origin[:, None]
        assert (held[:, 0] % 4 == 0).all() and (held != [[0, 27], [0, 25], [0, 29]]).any()
        assert (held[:, 0] <= np.maximum(own[:, 0] - 1, 0)).all()
        assert (held[:, 1] >= np.minimum(own[:, 1] + 1, [27, 25, 29])).all()
        found = progiso.decompress(output)
        assert found.GetExtent() == volume.GetExtent()
        box = tuple(slice(low, high + (0 if cells else 1)) for low, high in held[::-1])
        assert same_bits(samples_of(found), np.ascontiguousarray(expected[box]))
        covered[tuple(slice(low, high) for low, high in own[::-1])] += 1
    cell_box = tuple(slice(0, n) for n in (29, 25, 27))
    assert (covered[cell_box] == 1).all(), "every cell belongs to one piece"


@pytest.mark.parametrize("bits", [9, 64, 333, 2048])
def test_cropping_keeps_blocks_as_they_are(bits):
    """Rows of blocks that begin at any bit of a word."""
    compressed = progiso.compress(
        make_image(noise((21, 18, 30), 5), extent_start=(3, -4, 5)), rate=bits / 64
    )
    part, volume = vtkImageData(), vtkCompressedVolume()
    part.DeepCopy(compressed)
    part.SetExtent(17, 25, 5, 9, 12, 15)
    assert volume.Read(part) and not volume.Covers(part)
    volume.Crop(part.GetExtent())
    assert volume.GetExtent() == (15, 26, 4, 11, 9, 16)
    volume.Write(part)
    expected = samples_of(progiso.decompress(compressed))[4:12, 8:16, 12:24]
    assert same_bits(samples_of(progiso.decompress(part)), np.ascontiguousarray(expected))
    with vtk_messages() as messages:
        writer = vtkZFPWriter()
        writer.SetInputData(part)
        writer.SetFileName("/dev/null")
        assert writer.Write() == 0
    assert len(messages) == 1 and "piece" in messages[0]


def test_a_stream_of_another_piece_is_refused():
    compressed = progiso.compress(make_image(noise((9, 9, 9))), rate=8)
    compressed.SetExtent(4, 12, 0, 8, 0, 4)
    reader = vtkCompressedVolume()
    assert not reader.Read(compressed) and "another piece" in reader.GetErrorMessage()


def test_vti_with_appended_data(tmp_path):
    """Raw bytes behind the XML hold the same, in less."""
    compressed = progiso.compress(
        make_image(noise((30, 31, 32)), origin=(1, 2, 3), extent_start=(5, 6, 7)), rate=8
    )
    progiso.save(compressed, tmp_path / "in_line.vti")
    progiso.save(compressed, tmp_path / "appended.vti", appended=True)
    read = progiso.read(tmp_path / "appended.vti")
    assert stream_of(read) == stream_of(compressed)
    assert read.GetExtent() == compressed.GetExtent() and read.GetOrigin() == (1, 2, 3)
    assert (tmp_path / "appended.vti").stat().st_size < 0.8 * (
        tmp_path / "in_line.vti"
    ).stat().st_size
    with pytest.raises(ValueError, match="appended"):
        progiso.save(compressed, tmp_path / "volume.zfp", appended=True)


def test_reader_refuses_what_is_no_zfp_file(tmp_path):
    path = tmp_path / "bad.zfp"
    for content, settings in (
        (b"not a zfp file", {}),
        (b"\0" * 10, {"DataDimensions": (8, 8, 8)}),
        (None, {}),
    ):
        path.unlink(missing_ok=True)
        if content is not None:
            path.write_bytes(content)
        reader = vtkZFPReader()
        reader.SetFileName(str(path))
        for name, value in settings.items():
            getattr(reader, "Set" + name)(value)
        output, messages = run(reader)
        assert sum("vtkZFPReader" in m and "returned failure" not in m for m in messages) == 1, (
            messages
        )
        assert not vtkCompressedVolume.IsCompressed(output)


def test_writer_refuses_plain_images(tmp_path):
    writer = vtkZFPWriter()
    writer.SetInputData(make_image(noise((4, 4, 4))))
    writer.SetFileName(str(tmp_path / "none.zfp"))
    with vtk_messages() as messages:
        assert writer.Write() == 0
    assert len(messages) == 1
    assert not (tmp_path / "none.zfp").exists()
