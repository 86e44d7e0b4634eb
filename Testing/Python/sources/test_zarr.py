"""Zarr stores as zarr-python reads them: plain arrays, xarray's, OME-Zarr's pyramids."""

import shutil

import numpy as np
import pytest
import zarr
from zarr.codecs import BloscCodec

import progiso
from helpers.sources import SHAPE, check, opened, ramp
from progiso.io import zarr_files


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.zarr"


def array_in(path, expected, chunks=(4, 4, 4), **options):
    options = {"zarr_format": 3} | options
    array = zarr.create_array(
        path, shape=expected.shape, dtype=expected.dtype, chunks=chunks, **options
    )
    array[:] = expected
    return array


@pytest.mark.parametrize(
    "options",
    [
        {"zarr_format": 2},
        {"zarr_format": 2, "compressors": None, "order": "F"},
        {},
        {"shards": (4, 8, 12)},
        {"compressors": BloscCodec(cname="zstd")},
    ],
    ids=str,
)
@pytest.mark.parametrize("dtype", ["u1", ">i2", "<f4", "f8", "?", "f2"])
def test_plain_arrays(path, options, dtype):
    expected = ramp().astype(dtype)
    array_in(path, expected, **options)
    source = opened(path)
    check(
        source, expected.astype({"?": "u1", "f2": "f4"}.get(dtype, dtype.lstrip("<>"))), (1, 1, 1)
    )
    assert source.about.chunks == (4, 4, 4)


@pytest.mark.parametrize("piece_bytes", [1, 100, 1000])
def test_regions_in_pieces(path, monkeypatch, piece_bytes):
    monkeypatch.setattr(zarr_files, "_PIECE_BYTES", piece_bytes)
    expected = ramp((2, *SHAPE))
    array_in(path, expected, chunks=(1, 3, 4, 5))
    check(opened(path, channel=1), expected[1])


def test_zip(tmp_path):
    path = tmp_path / "a.zarr"
    array_in(path, ramp())
    shutil.make_archive(str(path), "zip", path)
    check(opened(tmp_path / "a.zarr.zip"), ramp())


def test_several_arrays_are_listed(path):
    array_in(path / "b", ramp())
    array_in(path / "c/d", ramp((3, 4, 5)))
    zarr.open_group(path, mode="a")
    zarr.open_group(path / "c", mode="a")
    with pytest.raises(ValueError, match="several.*'a.zarr:/b'.*b 7x9x11.*c/d 3x4x5"):
        opened(path)
    check(opened(f"{path}:/c/d"), ramp((3, 4, 5)))
    with pytest.raises(ValueError, match="a.zarr.*holds no Zarr array or group at 'e'"):
        opened(f"{path}:/e")


def test_missing_chunks_are_the_fill_value(path):
    expected = ramp()
    array_in(path, expected, fill_value=7)
    (path / "c/1/0/1").unlink()
    expected[4:8, 0:4, 4:8] = 7
    check(opened(path), expected)


@pytest.mark.parametrize("options", [{"zarr_format": 2}, {}, {"shards": (8, 8, 8)}], ids=str)
def test_damaged_chunks_are_named(path, options):
    array_in(path, ramp(), **options)
    chunk = {2: "1.0.1"}.get(
        options.get("zarr_format"), "c/0/1/1" if "shards" in options else "c/1/0/1"
    )
    file = path / chunk
    whole = file.read_bytes()
    for damage in (whole[: len(whole) // 2], bytes(4) + whole[4:], b""):
        file.write_bytes(damage)
        with pytest.raises(ValueError, match=f"{chunk}.*a.zarr"):
            opened(path).read()
    assert opened(path).read((slice(0, 1), slice(0, 1), slice(0, 1))).size == 1


def ome(path, *, version="0.5", axes="tczyx", shape=(2, 3, *SHAPE)):
    """Write an image of two levels, as ome-zarr-py does."""
    expected = ramp(shape)
    group = zarr.open_group(path, mode="w", zarr_format=3 if version == "0.5" else 2)
    levels = [expected, expected[..., ::2, ::2]]
    for number, samples in enumerate(levels):
        array = group.create_array(
            str(number),
            shape=samples.shape,
            dtype=samples.dtype,
            chunks=(1,) * (len(axes) - 3) + (4, 4, 4),
        )
        array[:] = samples
    types = {"t": "time", "c": "channel"}
    units = {"z": "micrometer", "y": "nanometer", "x": "micrometer"}
    scales = {"t": 1, "c": 1, "z": 2.0, "y": 500.0, "x": 0.25}
    multiscales = {
        "axes": [
            {"name": a, "type": types.get(a, "space")} | ({"unit": units[a]} if a in units else {})
            for a in axes
        ],
        "datasets": [
            {
                "path": str(number),
                "coordinateTransformations": [
                    {
                        "type": "scale",
                        "scale": [scales[a] * (2**number if a in "yx" else 1) for a in axes],
                    },
                    {
                        "type": "translation",
                        "translation": [
                            10.0 if a == "z" else number / 8 if a == "x" else 0.0 for a in axes
                        ],
                    },
                ],
            }
            for number in range(2)
        ],
        "name": "image",
    }
    attributes = {
        "multiscales": [multiscales],
        "omero": {"channels": [{"label": "nuclei"}, {"label": "actin"}, {"label": "er"}]},
    }
    group.attrs.update(
        {"ome": attributes | {"version": version}} if version == "0.5" else attributes
    )
    return expected


@pytest.mark.parametrize("version", ["0.4", "0.5"])
def test_ome_zarr(tmp_path, version):
    path = tmp_path / "a.ome.zarr"
    expected = ome(path, version=version)
    source = opened(path, channel="actin", time=1)
    check(source, expected[1, 1], (0.25, 0.5, 2), origin=(0, 0, 10), units="um")
    assert source.about.channels == ("nuclei", "actin", "er") and source.about.times == 2
    assert source.about.name == "a"
    coarse = opened(path, level=1)
    place = {"spacing": (0.5, 1, 2), "origin": (0.125, 0, 10), "units": "um"}
    check(coarse, expected[0, 0, :, ::2, ::2], **place)
    assert "channel 0 ('nuclei') of 3" in " ".join(coarse.about.notes)
    check(opened(f"{path}:/1", channel=2), expected[0, 2, :, ::2, ::2], **place)
    with pytest.raises(ValueError, match="no level 2"):
        opened(path, level=2)


def test_systems_of_coordinates(path):
    """Version 0.6 has axes in systems, and sequences of transformations."""
    ome(path)
    group = zarr.open_group(path, mode="a")
    image = group.attrs["ome"]
    scales = image["multiscales"][0]
    scales["coordinateSystems"] = [{"name": "physical", "axes": scales.pop("axes")}]
    level = scales["datasets"][0]
    changes = level["coordinateTransformations"]
    level["coordinateTransformations"] = [{"type": "sequence", "transformations": changes}]
    group.attrs["ome"] = image
    check(opened(path), ramp((2, 3, *SHAPE))[0, 0], (0.25, 0.5, 2), origin=(0, 0, 10), units="um")
    level["coordinateTransformations"] = [{"type": "affine", "affine": []}]
    group.attrs["ome"] = image
    with pytest.raises(ValueError, match="'affine'"):
        opened(path)


def test_labels(tmp_path):
    path = tmp_path / "a.ome.zarr"
    ome(path, version="0.4")
    zarr.open_group(path / "labels", mode="w", zarr_format=2).attrs["labels"] = ["cells"]
    expected = ome(path / "labels/cells", version="0.4", axes="zyx", shape=SHAPE)
    zarr.open_group(path / "labels/cells", mode="a").attrs["image-label"] = {"version": "0.4"}
    source = opened(f"{path}:/labels/cells")
    assert source.about.labels is True
    check(source, expected, (0.25, 0.5, 2), origin=(0, 0, 10), units="um")
    assert opened(path).about.labels is None


def test_images_in_a_collection(path):
    group = zarr.open_group(path, mode="w", zarr_format=2)
    group.attrs["bioformats2raw.layout"] = 3
    volumes = [ome(path / name, version="0.4", axes="zyx", shape=SHAPE) for name in ("0", "10")]
    source = opened(path)
    assert source.about.series == ("0", "10")
    assert "series 0 ('0') of 2" in " ".join(source.about.notes)
    check(opened(path, series="10"), volumes[1], units="um")


@pytest.mark.parametrize("version", [2, 3])
def test_xarray(path, version):
    expected = ramp((2, *SHAPE)).astype("f4")
    expected[:, 0, 0, 0] = np.nan
    group = zarr.open_group(path, mode="w", zarr_format=version)
    coordinates = {
        "time": (np.arange(2), "days since 2000-01-01"),
        "level": (np.arange(7) * 5.0, "m"),
        "lat": (40 - np.arange(9) * 0.5, "m"),
        "lon": (np.arange(11) * 0.25 + 3, "m"),
    }
    names = list(coordinates)
    for name, (values, unit) in coordinates.items():
        named = {"dimension_names": [name]} if version == 3 else {}
        array = group.create_array(name, shape=values.shape, dtype=values.dtype, **named)
        array[:] = values
        array.attrs["units"] = unit
        if version == 2:
            array.attrs["_ARRAY_DIMENSIONS"] = [name]
    named = {"dimension_names": names} if version == 3 else {}
    array = group.create_array("v", shape=expected.shape, dtype="f4", fill_value=np.nan, **named)
    array[:] = expected
    if version == 2:
        array.attrs["_ARRAY_DIMENSIONS"] = names
    else:
        array.attrs["_FillValue"] = "AAAAAAAA+H8="
    source = opened(path, time=1)
    check(source, expected[1], (0.25, -0.5, 5), origin=(3, 40, 0), units="m")
    hidden = np.ma.getmaskarray(source.read())
    np.testing.assert_array_equal(hidden, np.isnan(expected[1]))
    assert hidden.sum() == 1


def test_damaged_headers_are_errors(path):
    array_in(path, ramp())
    header = path / "zarr.json"
    whole = header.read_bytes()
    random = np.random.default_rng(0)
    for _ in range(40):
        damaged = bytearray(whole)
        for place in random.integers(0, len(whole), 3):
            damaged[place] = random.integers(32, 127)
        header.write_bytes(damaged)
        try:
            opened(path).read()
        except (ValueError, RuntimeError) as error:
            assert "a.zarr" in str(error)
    for damage in (b"", b"{}", whole[:50]):
        header.write_bytes(damage)
        with pytest.raises((ValueError, RuntimeError), match="a.zarr"):
            opened(path)


def test_compressed_by_slabs(path):
    array_in(path, ramp((9, 33, 35)).astype("f4"), (4, 16, 16))
    with pytest.warns(UserWarning, match="spacing"):
        assert progiso.is_compressed(progiso.compress_file(path, rate=8))
