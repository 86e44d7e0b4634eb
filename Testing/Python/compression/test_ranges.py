"""Ranges of values that travel with compressed volumes: what they say, and that wrong ones are
refused or not used."""

import itertools
import struct
import zlib

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkImagingCore import vtkExtractVOI
from vtkmodules.vtkIOLegacy import vtkDataSetReader, vtkDataSetWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

import progiso
from helpers.holes import nan_samples
from helpers.images import (
    PREFIX,
    blobs,
    copy_of,
    make_image,
    metadata,
    noise,
    reference_values,
    without_checksums,
)
from progiso import vtkCompressedVolume
from progiso.cli import main

NAMES = ("Ranges", "RangesDirectory", "RangesOf")


def read(image):
    """Return what is read of an image, and the message if nothing is."""
    volume = vtkCompressedVolume()
    volume.Read(image)
    return volume, volume.GetErrorMessage()


def has_ranges(image):
    volume, message = read(image)
    assert not message
    return volume.HasRanges()


def same_ranges(a, b):
    return all(np.array_equal(metadata(a, name), metadata(b, name)) for name in NAMES[:2])


def replace(image, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(PREFIX + name)
    image.GetFieldData().AddArray(array)


def parts(length):
    return -(-length // 4)


def unpack(image):
    """Read stored ranges as the documentation of the format has them.

    Returns {block: (lowest, highest)}, without blocks that have no range.
    """
    samples = metadata(image, "Dimensions")
    blocks = [parts(n) for n in samples]
    cells = [parts(n) for n in blocks]
    pages = [parts(n) for n in cells]
    directory = metadata(image, "RangesDirectory").astype("<u4").reshape(-1, 4)
    words = metadata(image, "Ranges").astype("<u8")
    found, begin = {}, 0
    for entry, at in zip(directory, itertools.product(*(range(n) for n in pages[::-1]))):
        page = at[::-1]
        size = [min(4, n - 4 * i) for n, i in zip(cells, page)]
        record = words[begin : begin + entry[2] % 65536]
        begin += len(record)
        assert zlib.crc32(record.tobytes()) == entry[3]
        count = int(np.prod(size))
        low, high = entry[:2].view("<f4")
        assert entry[2] >> 16 == (1 if low > high else 2 if low == high else 0)
        steps_at = 1 + count
        for i in range(count):
            place = [4 * page[0] + i % size[0], 4 * page[1] + i // size[0] % size[1]]
            place.append(4 * page[2] + i // (size[0] * size[1]))
            of_cell, steps = (low, high), None
            if len(record):
                of_cell = struct.unpack("<2f", record[1 + i].tobytes())
                if int(record[0]) >> i & 1:
                    steps = record[steps_at : steps_at + 16].view("<u2")
                    steps_at += 16
            for n in range(64):
                block = tuple(4 * p + (n >> 2 * a & 3) for a, p in enumerate(place))
                has_cells = all(4 * b + 1 < length for b, length in zip(block, samples))
                two = int(steps[n]) if steps is not None else 255 << 8 if has_cells else 255
                lowest, highest = two & 255, two >> 8
                if lowest <= highest and of_cell[0] <= of_cell[1]:
                    found[block] = decode(*of_cell, lowest, highest)
        assert steps_at == len(record) or not len(record)
    assert begin == len(words)
    return found


def decode(low, high, lowest, highest):
    low, high = np.float32(low), np.float32(high)
    unit = high / np.float32(256) - low / np.float32(256)
    at = [low + np.float32(step) * unit for step in (lowest, highest)]
    return (low if lowest == 0 else at[0]), (high if highest == 255 else at[1])


def expected_ranges(image, hidden=None):
    """The ranges of the corners of each block's visible cells."""
    values = reference_values(image)
    cells = np.ones([n - 1 for n in values.shape], bool) if hidden is None else ~hidden
    found = {}
    for z, y, x in itertools.product(*(range(0, n - 1, 4) for n in values.shape)):
        box = tuple(slice(i, i + 4) for i in (z, y, x))
        corners = [
            values[tuple(slice(i, i + 4) for i in np.add((z, y, x), shift))][
                tuple(slice(0, n) for n in cells[box].shape)
            ][cells[box]]
            for shift in itertools.product((0, 1), repeat=3)
        ]
        if cells[box].any():
            found[x // 4, y // 4, z // 4] = np.min(corners), np.max(corners)
    return found


def check(image, hidden=None):
    stored, expected = unpack(image), expected_ranges(image, hidden)
    assert set(stored) == set(expected)
    spans = [high - low for low, high in expected.values()]
    for block, (low, high) in expected.items():
        lowest, highest = stored[block]
        assert lowest <= low and high <= highest
        assert high - low <= highest - lowest <= max(spans) * 2 + 1e-30


@pytest.mark.parametrize("rate", [1, 4, 11.3])
@pytest.mark.parametrize("shape", [(66, 35, 21), (16, 17, 65), (2, 3, 2)])
def test_ranges_hold_the_decoded_samples(shape, rate):
    check(progiso.compress(make_image(noise(shape)), rate=rate))


def test_hidden_samples_do_not_count():
    volume, hidden = nan_samples()
    check(volume, hidden)
    assert read(volume)[0].CheckRanges() == ""


def test_constant_pages_have_no_record():
    values = np.zeros((64, 64, 200), np.float32)
    values[5, 6, 134] = 1  # in no block whose samples another page reaches
    volume = progiso.compress(make_image(values), rate=8)
    directory = metadata(volume, "RangesDirectory").reshape(-1, 4)
    assert (directory[:, 2] % 65536).tolist() == [0, 0, 1 + 64 + 16, 0]
    check(volume)


@pytest.mark.parametrize("mask", [False, True])
def test_every_producer_stores_the_same(tmp_path, mask):
    values = blobs((41, 34, 70), 4)
    if mask:
        values[3:9, 5:20, 30:66] = np.nan
    expected = progiso.compress(make_image(values), rate=5)
    values.tofile(tmp_path / "a_70x34x41_float32.raw")
    slabs = (values[i : i + 8] for i in range(0, 41, 8))
    volumes = [
        progiso.compress(make_image(values), rate=5, threads=1),
        progiso.compress_slabs(slabs, (70, 34, 41), rate=5),
        progiso.compress_file(tmp_path / "a_70x34x41_float32.raw", rate=5),
    ]
    if not mask:
        progiso.save(expected, tmp_path / "a.zfp")
        volumes.append(progiso.read(tmp_path / "a.zfp"))
        progiso.save(expected, tmp_path / "a.vti")
        volumes.append(progiso.read(tmp_path / "a.vti"))
    for volume in volumes:
        assert same_ranges(volume, expected) and has_ranges(volume)
        assert read(volume)[0].CheckRanges() == ""


@pytest.mark.parametrize("settings", [
    {"DataMode": 0}, {"DataMode": 1}, {"DataMode": 2}, {"ByteOrder": 0}, {"HeaderType": 32}, None
])  # fmt: skip
def test_vtks_files_keep_ranges(tmp_path, settings):
    volume = nan_samples()[0]
    legacy = settings is None
    writer = vtkDataSetWriter() if legacy else vtkXMLImageDataWriter()
    reader = vtkDataSetReader() if legacy else vtkXMLImageDataReader()
    if legacy:
        writer.SetFileTypeToBinary()
        reader.ReadAllFieldsOn()
    for name, value in (settings or {}).items():
        getattr(writer, "Set" + name)(value)
    writer.SetInputData(volume)
    for either in (writer, reader):
        either.SetFileName(str(tmp_path / "a"))
    assert writer.Write()
    reader.Update()
    assert has_ranges(reader.GetOutput()) and same_ranges(reader.GetOutput(), volume)


@pytest.fixture(scope="module")
def volume():
    return progiso.compress(make_image(noise((70, 40, 36))), rate=3)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("place", [0, -1])
def test_flipped_bits_are_refused(volume, name, place):
    damaged = copy_of(volume)
    metadata(damaged, name)[place] ^= metadata(damaged, name).dtype.type(1)
    assert "damaged" in read(damaged)[1]
    with pytest.raises((RuntimeError, ValueError), match="ZFP"):
        progiso.render(damaged, 0.5, size=(20, 20))


@pytest.mark.parametrize("name", NAMES)
def test_a_lacking_array_is_an_error(volume, name):
    damaged = copy_of(volume)
    damaged.GetFieldData().RemoveArray(PREFIX + name)
    assert "damaged" in read(damaged)[1]


@pytest.mark.parametrize("name, values, error", [
    ("Ranges", np.zeros(7), "records are not 64-bit integers"),
    ("Ranges", np.zeros(7, np.uint64), "records have 7 words"),
    ("RangesDirectory", np.zeros(7, np.uint32), "directory is not 2 times four"),
    ("RangesDirectory", np.zeros(8, np.float32), "directory is not 2 times four"),
])  # fmt: skip
def test_arrays_of_another_form_are_named(volume, name, values, error):
    other = copy_of(volume)
    replace(other, name, values)
    assert error in read(other)[1]


def test_damage_of_a_page_is_named(volume):
    damaged = copy_of(volume)
    metadata(damaged, "Ranges")[-1] ^= np.uint64(1 << 40)
    assert (
        "those of 1 of 2 pages do not match their checksums, the first that of page 1"
        in (read(damaged)[1])
    )


def test_older_volumes_have_none(volume):
    assert not has_ranges(without_checksums(copy_of(volume)))
    bare = copy_of(volume)
    for name in NAMES:
        bare.GetFieldData().RemoveArray(PREFIX + name)
    assert vtkCompressedVolume.Place(bare) and not has_ranges(bare)


def test_ranges_of_another_stream_are_not_used(volume):
    """An older version, which does not know them, leaves those that it finds in the field data."""
    for other in (noise((70, 40, 36), 5), noise((36, 40, 70)).reshape(36, 40, 70)):
        written = progiso.compress(make_image(other), rate=3)
        for name in NAMES:
            array = volume.GetFieldData().GetAbstractArray(PREFIX + name)
            written.GetFieldData().AddArray(array)
        assert vtkCompressedVolume.Place(written)  # its checksum is right
        assert not has_ranges(written)
        expected = progiso.compress(make_image(other), rate=3)
        depths = [progiso.render(v, 0.5, size=(60, 50)).depth for v in (written, expected)]
        assert np.array_equal(*depths, equal_nan=True) and np.isfinite(depths[0]).any()


def test_what_changes_the_stream_or_what_is_hidden_takes_ranges_away(volume):
    reader = read(volume)[0]
    kept = vtkImageData()
    kept.CopyStructure(volume)
    reader.Write(kept)
    assert has_ranges(kept) and same_ranges(kept, volume)
    other = reader.GetStream().NewInstance()
    other.DeepCopy(reader.GetStream())
    reader.SetStream(other)
    assert not reader.HasRanges()
    reader.Write(kept)
    assert not has_ranges(kept) and not kept.GetFieldData().HasArray(PREFIX + "Ranges")
    part = read(volume)[0]
    part.Crop((8, 20, 4, 30, 0, 50))
    assert part.GetDimensions() != reader.GetDimensions() and not part.HasRanges()
    assert part.FindRanges() and part.HasRanges()


def test_filters_keep_the_ranges_of_the_stream_they_pass_on(volume):
    """A subset keeps the whole stream, and with it its ranges."""
    cut = vtkExtractVOI()
    cut.SetInputData(volume)
    cut.SetVOI(4, 30, 5, 33, 6, 60)
    cut.Update()
    assert has_ranges(cut.GetOutput())
    again = progiso.compress(progiso.decompress(volume), rate=6)
    assert has_ranges(again) and not same_ranges(again, volume)


def test_verify_finds_wrong_ranges(volume, tmp_path, capsys):
    """Those of other samples, with checksums that are right: only decoding tells."""
    progiso.save(volume, tmp_path / "right.vti")
    assert main(["info", "--verify", str(tmp_path / "right.vti")]) == 0
    assert "are right" in capsys.readouterr().out
    wrong = copy_of(volume)
    other = progiso.compress(make_image(0.5 * noise((70, 40, 36))), rate=3)
    for name in NAMES[:2]:
        wrong.GetFieldData().AddArray(other.GetFieldData().GetAbstractArray(PREFIX + name))
    assert vtkCompressedVolume.Place(wrong) and has_ranges(wrong)
    progiso.save(wrong, tmp_path / "wrong.vti")
    assert main(["info", "--verify", str(tmp_path / "wrong.vti")]) != 0
    assert "ranges of values that are wrong" in capsys.readouterr().err


def test_levels_have_their_own(tmp_path):
    """Whatever the slabs; what is damaged is named."""
    values = blobs((70, 90, 130), 4)
    values[3:20, 5:20, 30:66] = np.nan
    whole = progiso.compress(make_image(values), rate=4, levels=3)
    slabs = (values[i : i + 12] for i in range(0, 70, 12))
    again = progiso.compress_slabs(slabs, (130, 90, 70), rate=4, levels=3)
    ranges = []
    for volume in (whole, again):
        reader = read(volume)[0]
        levels = [reader.GetLevel(k + 1) for k in range(reader.GetNumberOfLevels())]
        assert levels and all(level.HasRanges() for level in levels)
        assert [level.CheckRanges() for level in levels] == [""] * len(levels)
        array = volume.GetFieldData().GetAbstractArray("ProgIso.Level1.Ranges")
        ranges.append(vtk_to_numpy(array).tolist())
    assert ranges[0] == ranges[1]
    vtk_to_numpy(array)[-1] ^= np.uint64(2)
    assert "level 1 of it: ProgIso.Level1.Ranges is damaged" in read(again)[1]
