"""Checksums of compressed volumes: what is damaged is refused, and the place is named."""

import zlib

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOLegacy import vtkDataSetReader, vtkDataSetWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

import progiso
from helpers.holes import nan_samples
from helpers.images import (
    PREFIX,
    blobs,
    copy_of,
    make_image,
    message_of,
    metadata,
    noise,
    same_bits,
    samples_of,
    stream_of,
    without_checksums,
)
from progiso import vtkCompressedVolume

PAGE = vtkCompressedVolume.PageBytes


@pytest.fixture(scope="module")
def volume():
    """Return a volume whose stream has 3 pages, the last a part of one."""
    return progiso.compress(make_image(noise((40, 44, 48))), rate=15)


def test_a_page_has_zlibs_checksum(volume):
    stream = stream_of(volume)
    pages = [zlib.crc32(stream[i : i + PAGE]) for i in range(0, len(stream), PAGE)]
    assert metadata(volume, "PageChecksums").tolist() == pages and len(pages) == 3
    reader = vtkCompressedVolume()
    assert reader.Read(volume) and reader.GetHasChecksums()


@pytest.mark.parametrize("place", [0, PAGE - 1, PAGE, 2 * PAGE + 5, -1])
@pytest.mark.parametrize("bit", [0, 7])
def test_a_flipped_bit_is_refused(volume, place, bit):
    damaged = copy_of(volume)
    stream = metadata(damaged, "Stream")
    stream[place] ^= 1 << bit
    first = (place % len(stream)) // PAGE * PAGE
    last = min(first + PAGE, len(stream)) - 1
    blocks = 8 * np.array([first, last]) // metadata(damaged, "BlockBits")[0]
    low, high = 4 * (blocks // (11 * 12)) + [0, 3]
    message = message_of(damaged)
    assert f"1 of its 3 pages of {PAGE} bytes" in message
    assert f"from byte {first} to {last} (in slices {low} to {high} of the samples)" in message
    for use in (progiso.decompress, lambda image: progiso.contour(image, 0)):
        with pytest.raises((RuntimeError, ValueError), match="is damaged"):
            use(damaged)


def flipped(array, value):
    """Return an array's values with one bit of one value flipped."""
    numbers = vtk_to_numpy(array)
    flat = numbers.reshape(-1).view(np.uint8)
    flat[value * numbers.itemsize] ^= 1


NAMES = ("Range", "ScalarType", "Component", "Extent", "HiddenSamples", "PageChecksums")


@pytest.mark.parametrize("name", [*NAMES, "MetadataChecksum", "Offset", "Scale"])
def test_flipped_metadata_are_refused(name):
    if name in ("Offset", "Scale"):
        volume = progiso.compress(make_image(101325 + 1e-4 * blobs((8, 8, 8)).astype(float)))
    else:
        volume = copy_of(nan_samples()[0])
    array = volume.GetFieldData().GetAbstractArray(PREFIX + name)
    flipped(array, 1 if name in ("Extent", "HiddenSamples") else 0)
    assert message_of(volume)


def test_other_names_are_refused():
    volume = copy_of(progiso.compress(make_image(noise((8, 8, 8)))))
    volume.GetFieldData().GetAbstractArray(PREFIX + "ArrayName").SetValue(0, "other")
    assert "do not match their checksum" in message_of(volume)


@pytest.mark.parametrize("name", ["PageChecksums", "MetadataChecksum"])
def test_checksums_cannot_be_left_out(name):
    volume = copy_of(progiso.compress(make_image(noise((8, 8, 8)))))
    volume.GetFieldData().RemoveArray(PREFIX + name)
    assert message_of(volume)
    assert "checksum" in message_of(volume).lower()


def test_volumes_of_older_versions_are_read(volume):
    old = without_checksums(copy_of(volume))
    reader = vtkCompressedVolume()
    assert reader.Read(old) and not reader.GetHasChecksums()
    assert same_bits(samples_of(progiso.decompress(old)), samples_of(progiso.decompress(volume)))


def test_what_is_modified_is_checked_again(volume):
    """A stream is checked once, and again when it says that it has been modified."""
    changed = copy_of(volume)
    assert not message_of(changed)
    array = changed.GetFieldData().GetAbstractArray(PREFIX + "Stream")
    vtk_to_numpy(array)[5] ^= 1
    assert not message_of(changed)
    array.Modified()
    assert "is damaged" in message_of(changed)
    vtk_to_numpy(array)[5] ^= 1
    array.Modified()
    assert not message_of(changed)


def xml(image, path, **settings):
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    for name, value in settings.items():
        getattr(writer, "Set" + name)(value)
    assert writer.Write()
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def legacy(image, path):
    writer = vtkDataSetWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.SetFileTypeToBinary()
    assert writer.Write()
    reader = vtkDataSetReader()
    reader.SetFileName(str(path))
    reader.ReadAllFieldsOn()
    reader.Update()
    return reader.GetOutput()


@pytest.mark.parametrize("make", ["masked", "with units"])
def test_vtks_writers_keep_checksums(tmp_path, make):
    """Whatever the encoding, the widths of integers and the order of bytes in VTK's files."""
    if make == "masked":
        volume = nan_samples()[0]
    else:
        volume = progiso.compress(make_image(101325 + 1e-4 * blobs((8, 8, 8)).astype(float)))
    for number, settings in enumerate(
        ({"DataMode": 0}, {"DataMode": 1}, {"DataMode": 2}, {"ByteOrder": 0}, {"HeaderType": 32})
    ):
        read = xml(volume, tmp_path / f"{number}.vti", **settings)
        reader = vtkCompressedVolume()
        assert reader.Read(read), (settings, reader.GetErrorMessage())
        assert reader.GetHasChecksums()
        assert "IntactStream" not in (tmp_path / f"{number}.vti").read_bytes().decode("latin-1")
    assert not message_of(legacy(volume, tmp_path / "legacy.vtk"))


def test_every_producer_stores_checksums(tmp_path):
    image = make_image(noise((9, 9, 9)))
    progiso.save(progiso.compress(image), tmp_path / "a.zfp")
    noise((9, 9, 9)).tofile(tmp_path / "a_9x9x9_float32.raw")
    whole = progiso.compress(image)
    for volume in (
        progiso.read(tmp_path / "a.zfp"),
        progiso.compress_file(tmp_path / "a_9x9x9_float32.raw"),
        progiso.compress_slabs(iter([noise((9, 9, 9))]), (9, 9, 9)),
    ):
        assert np.array_equal(metadata(volume, "PageChecksums"), metadata(whole, "PageChecksums"))
        assert metadata(volume, "Version")[0] == 3
