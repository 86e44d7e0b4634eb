"""TIFF stacks and hyperstacks as tifffile reads them, by region, with their places."""

import numpy as np
import pytest
import tifffile

import progiso
from helpers.sources import SHAPE, check, opened, ramp
from progiso.io import open_source


def written(tmp_path, samples, name="a.tif", **options):
    path = tmp_path / name
    tifffile.imwrite(path, samples, **options)
    return path


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"bigtiff": True},
        {"byteorder": ">"},
        {"compression": "zlib", "predictor": True},
        {"compression": "lzw", "rowsperstrip": 2},
        {"tile": (16, 16)},
        {"tile": (16, 16), "compression": "zstd"},
        {"rowsperstrip": 4, "contiguous": False, "metadata": None},
        {"volumetric": True, "tile": (16, 16, 16)},
    ],
    ids=str,
)
@pytest.mark.parametrize("dtype", ["u1", "i2", "f4", "f8"])
def test_stacks(tmp_path, options, dtype):
    expected = ramp((20, 33, 35)).astype(dtype)
    options = {"photometric": "minisblack"} | options
    path = written(tmp_path, expected, **options)
    check(opened(path), tifffile.imread(path), (1, 1, 1))


def test_pages_of_different_places_in_the_file(tmp_path):
    path = tmp_path / "pages.tif"
    expected = ramp()
    with tifffile.TiffWriter(path) as file:
        for page in expected:
            file.write(page, contiguous=False, compression="zlib", rowsperstrip=2, metadata=None)
    source = opened(path)
    check(source, expected, (1, 1, 1))
    assert source.about.chunks == (1, 2, 11)
    assert any("spacing" in note for note in source.about.notes)


def test_imagej_hyperstack_is_channels_of_volumes(tmp_path):
    """F22: channels were slices, and the spacing 1."""
    volume = ramp((32, 32, 32)).astype("f4")
    path = written(
        tmp_path,
        np.stack([volume, -volume], 1),
        imagej=True,
        metadata={"axes": "ZCYX", "spacing": 3, "unit": "um"},
        resolution=(2, 2),
    )
    source = opened(path)
    check(source, volume, (0.5, 0.5, 3), units="um")
    assert source.about.channels == ("0", "1")
    assert any("channel 0 of 2" in note for note in source.about.notes)
    check(opened(path, channel=1), -volume, (0.5, 0.5, 3), units="um")
    with pytest.raises(ValueError, match="no channel 2"):
        opened(path, channel=2)


def test_f22_through_read(tmp_path):
    volume = ramp((8, 8, 8)).astype("f4")
    path = written(
        tmp_path,
        np.stack([volume, 20 - volume], 1),
        imagej=True,
        metadata={"axes": "ZCYX", "spacing": 3, "unit": "um"},
        resolution=(2, 2),
    )
    image = opened(path).image()
    assert image.GetDimensions() == (8, 8, 8)
    assert image.GetSpacing() == (0.5, 0.5, 3)


@pytest.mark.parametrize("compression", [None, "zlib"])
def test_time_points_and_slices(tmp_path, compression):
    expected = ramp((3, 5, 2, 9, 11))
    path = written(
        tmp_path, expected, imagej=True, compression=compression, metadata={"axes": "TZCYX"}
    )
    source = opened(path, time=2, channel=1)
    check(source, expected[2, :, 1])
    assert source.about.times == 3
    with pytest.raises(ValueError, match="no time 3"):
        opened(path, time=3)


def test_time_series_without_slices_is_one_slice(tmp_path):
    expected = ramp((4, 9, 11))
    path = written(tmp_path, expected, imagej=True, metadata={"axes": "TYX"})
    source = opened(path, time=1)
    check(source, expected[1:2])
    assert source.about.times == 4


def test_colours_are_components(tmp_path):
    expected = ramp((*SHAPE, 3)).astype("u1")
    path = written(tmp_path, expected, photometric="rgb")
    source = opened(path)
    assert source.about.components == 3
    check(source, expected)
    check(opened(path, component=2), expected[..., 2])


def test_colours_in_planes(tmp_path):
    expected = ramp((5, 3, 32, 48)).astype("u1")
    path = written(tmp_path, expected, photometric="rgb", planarconfig="separate", tile=(16, 16))
    check(opened(path), np.moveaxis(expected, 1, -1))


def test_ome(tmp_path):
    expected = ramp((2, 3, 7, 9, 11))
    path = written(
        tmp_path,
        expected,
        "a.ome.tif",
        metadata={
            "axes": "TCZYX",
            "PhysicalSizeX": 0.25,
            "PhysicalSizeXUnit": "\u00b5m",
            "PhysicalSizeY": 250,
            "PhysicalSizeYUnit": "nm",
            "PhysicalSizeZ": 2,
            "Channel": {"Name": ["nuclei", "membrane", "actin"]},
        },
        compression="zlib",
    )
    source = opened(path, channel="actin", time=1)
    check(source, expected[1, 2], (0.25, 0.25, 2), units="um")
    assert source.about.channels == ("nuclei", "membrane", "actin")
    assert "channel 0 ('nuclei') of 3" in " ".join(opened(path).about.notes)


def test_pyramid_and_series(tmp_path):
    path = tmp_path / "p.ome.tif"
    fine, other = ramp((4, 64, 64)), ramp((2, 32, 48), seed=1)
    with tifffile.TiffWriter(path, ome=True) as file:
        meta = {"axes": "ZYX", "PhysicalSizeX": 2, "PhysicalSizeY": 2, "PhysicalSizeZ": 5}
        file.write(fine, subifds=1, tile=(16, 16), metadata=meta | {"Name": "fine"})
        file.write(fine[:, ::2, ::2], subfiletype=1, tile=(16, 16))
        file.write(other, metadata={"axes": "ZYX", "Name": "other"})
    check(opened(path), fine, (2, 2, 5), units="um")
    check(opened(path, level=1), fine[:, ::2, ::2], (4, 4, 5), origin=(1, 1, 0), units="um")
    check(opened(path, series="other"), other, (1, 1, 1))
    assert opened(path).about.series == ("fine", "other")
    with pytest.raises(ValueError, match="no level 2"):
        opened(path, level=2)
    with pytest.raises(ValueError, match="no series 'nothing'.*'fine'.*'other'"):
        opened(path, series="nothing")


def test_data_set_of_several_files(tmp_path):
    """The first file's OME-XML names the others."""
    expected = ramp((2, 9, 11))
    first, second = tmp_path / "m0.ome.tif", tmp_path / "m1.ome.tif"
    tifffile.imwrite(second, expected[1], metadata=None)
    xml = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" UUID="urn:uuid:a">'
        '<Image ID="Image:0"><Pixels ID="Pixels:0" DimensionOrder="XYZCT" Type="uint16" '
        'SizeX="11" SizeY="9" SizeZ="2" SizeC="1" SizeT="1"><Channel ID="C:0" '
        'SamplesPerPixel="1"/><TiffData IFD="0" PlaneCount="1" FirstZ="0">'
        '<UUID FileName="m0.ome.tif">urn:uuid:a</UUID></TiffData><TiffData IFD="0" PlaneCount="1" '
        'FirstZ="1"><UUID FileName="m1.ome.tif">urn:uuid:b</UUID></TiffData></Pixels></Image></OME>'
    )
    tifffile.imwrite(first, expected[0], description=xml, metadata=None)
    check(opened(first), expected)
    second.unlink()
    with pytest.raises(ValueError, match="m0.ome.tif"):
        opened(first).read()


def test_resolution_in_tags(tmp_path):
    expected = ramp()
    path = written(
        tmp_path, expected, resolution=(20, 40), resolutionunit="CENTIMETER", metadata=None
    )
    source = opened(path)
    check(source, expected, (0.5, 0.25, 0.25), units="mm")
    assert any("spacing along z is not told" in note for note in source.about.notes)
    path = written(tmp_path, expected, resolution=(72, 72), resolutionunit="INCH", metadata=None)
    source = opened(path)
    check(source, expected, (1, 1, 1))
    assert any("spacing along x, y, z is not told" in note for note in source.about.notes)


def test_nodata_is_hidden(tmp_path):
    expected = ramp().astype("f4")
    path = written(
        tmp_path, expected, metadata=None, extratags=[(42113, "s", 0, "17", True)], rowsperstrip=9
    )
    source = opened(path)
    hidden = np.ma.getmaskarray(source.read())
    np.testing.assert_array_equal(hidden, expected == 17)
    assert hidden.sum() == 1


def test_four_axes_without_names_are_no_volume(tmp_path):
    path = written(tmp_path, ramp((2, 3, 9, 11)), photometric="minisblack")
    with pytest.raises(ValueError, match="not clear which of the axes"):
        opened(path)


@pytest.mark.parametrize("kind", ["contiguous", "pages", "imagej", "ome"])
def test_truncated_files_are_errors(tmp_path, kind):
    options = {
        "contiguous": {},
        "pages": {"compression": "zlib", "rowsperstrip": 3, "metadata": None},
        "imagej": {"imagej": True, "metadata": {"axes": "ZYX"}},
        "ome": {"ome": True, "metadata": {"axes": "ZYX"}, "compression": "zlib"},
    }[kind]
    path = written(tmp_path, ramp((16, 33, 35)), **options)
    whole = path.read_bytes()
    for part in (0.9, 0.5, 0.1, 0.01):
        path.write_bytes(whole[: int(len(whole) * part)])
        with pytest.raises((ValueError, RuntimeError), match="a.tif"):
            opened(path).read()


def test_garbage_is_an_error_of_one_kind(tmp_path):
    path = written(tmp_path, ramp(), compression="zlib", rowsperstrip=3)
    whole = bytearray(path.read_bytes())
    random = np.random.default_rng(1)
    for _ in range(40):
        damaged = bytearray(whole)
        for place in random.integers(0, len(whole), 12):
            damaged[place] = random.integers(256)
        path.write_bytes(damaged)
        try:
            opened(path).read()
        except (ValueError, RuntimeError) as error:
            assert "a.tif" in str(error)


def test_compressed_by_slabs_as_whole(tmp_path):
    path = written(tmp_path, ramp((9, 33, 35)).astype("f4"), compression="zlib")
    with pytest.warns(UserWarning, match="spacing"):
        assert progiso.is_compressed(progiso.compress_file(path, rate=8))


def test_pages_in_a_circle(tmp_path):
    """The last page names itself as the next one: tifffile would go around for ever."""
    path = tmp_path / "circle.tif"
    with tifffile.TiffWriter(path) as writer:
        for height in (5, 6):
            writer.write(np.zeros((height, 6), "u1"), metadata=None)
    with tifffile.TiffFile(path) as file:
        last, tags = file.pages[1].offset, len(file.pages[1].tags)
    data = bytearray(path.read_bytes())
    assert not any(data[last + 2 + 12 * tags : last + 6 + 12 * tags])
    data[last + 2 + 12 * tags : last + 6 + 12 * tags] = last.to_bytes(4, "little")
    path.write_bytes(data)
    with pytest.raises(ValueError, match="circular reference"):
        open_source(path)
