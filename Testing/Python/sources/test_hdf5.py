"""HDF5 files as h5py reads them: arrays by path, NeXus, NetCDF-4, Imaris."""

import json

import h5py
import hdf5plugin
import numpy as np
import pytest

import progiso
from helpers.sources import SHAPE, check, opened, ramp


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.h5"


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"chunks": (2, 4, 5)},
        {"compression": "gzip", "shuffle": True, "fletcher32": True},
        dict(hdf5plugin.Blosc(cname="zstd")),
        dict(hdf5plugin.Bitshuffle()),
        dict(hdf5plugin.Zstd()),
    ],
    ids=str,
)
@pytest.mark.parametrize("dtype", ["u1", ">i2", "<f4", ">f8", "?", "f2"])
def test_the_only_volume(path, options, dtype):
    expected = ramp().astype(dtype)
    with h5py.File(path, "w") as file:
        file.create_dataset("group/volume", data=expected, **options)
        file["group/other"] = np.arange(5)
    source = opened(path)
    wanted = expected.astype({"?": "u1", "f2": "f4"}.get(dtype, dtype.lstrip("<>")))
    check(source, wanted, (1, 1, 1))
    assert source.about.name == "volume"
    if "chunks" in options:
        assert source.about.chunks == (2, 4, 5)


def test_several_volumes_are_listed(path):
    with h5py.File(path, "w") as file:
        file["a"], file["b/c"] = ramp(), ramp((3, 4, 5))
    with pytest.raises(ValueError, match=r"a.h5.*several.*'a.h5:/a'.*/a 7x9x11.*/b/c 3x4x5"):
        opened(path)
    check(opened(f"{path}:/b/c"), ramp((3, 4, 5)))
    with pytest.raises(ValueError, match="no array 'd'.*/b/c"):
        opened(f"{path}:/d")


def test_no_volume(path):
    with h5py.File(path, "w") as file:
        file["line"], file["text"] = np.arange(3), "words"
    with pytest.raises(ValueError, match="no volume.*/line 3"):
        opened(path)
    with pytest.raises(ValueError, match="not real numbers"):
        opened(f"{path}:/text")


def test_missing_filter_is_named(path, monkeypatch):
    with h5py.File(path, "w") as file:
        file.create_dataset("a", data=ramp(), **hdf5plugin.Blosc())
    monkeypatch.setattr(h5py.h5z, "filter_avail", lambda code: False)
    with pytest.raises(ImportError, match="32001.*hdf5plugin.*progiso.hdf5"):
        opened(path)


def test_virtual_arrays_miss_no_file(path):
    """HDF5 fills in what is in files that are not there."""
    layout = h5py.VirtualLayout(SHAPE, "u2")
    for number in range(SHAPE[0]):
        with h5py.File(path.parent / f"{number}.h5", "w") as file:
            file["slice"] = ramp()[number]
        layout[number] = h5py.VirtualSource(f"{number}.h5", "slice", SHAPE[1:])
    with h5py.File(path, "w") as file:
        file.create_virtual_dataset("a", layout)
    check(opened(path), ramp())
    (path.parent / "3.h5").unlink()
    with pytest.raises(ValueError, match="a.h5.*'3.h5', which is missing"):
        opened(path)


def test_spacing_in_attributes(path):
    with h5py.File(path, "w") as file:
        file["a"] = ramp()
        file["a"].attrs["element_size_um"] = [2, 0.5, 0.25]
    check(opened(path), ramp(), (0.25, 0.5, 2), units="um")


def test_axistags(path):
    expected = ramp((2, *SHAPE, 3))
    tags = {"axes": [{"key": key, "resolution": 0} for key in "tzyxc"]}
    with h5py.File(path, "w") as file:
        file["a"] = expected
        file["a"].attrs["axistags"] = json.dumps(tags)
    source = opened(path, time=1, channel=2)
    check(source, expected[1, ..., 2])
    assert source.about.times == 2
    assert source.about.channels == ("0", "1", "2")


def test_axes_in_another_order(path):
    expected = ramp((11, 9, 7))
    with h5py.File(path, "w") as file:
        file["a"] = expected
        file["a"].attrs["axes"] = "xyz"
    check(opened(path), expected.T)


def test_axes_without_names(path):
    expected = ramp((2, *SHAPE))
    with h5py.File(path, "w") as file:
        file["a"] = expected
    with pytest.raises(ValueError, match="without names.*--channel or --time"):
        opened(path)
    check(opened(path, channel=1), expected[1])
    with h5py.File(path, "w") as file:
        file["a"] = expected = ramp((*SHAPE, 3))
    check(opened(path), expected)
    check(opened(path, component=1), expected[..., 1])


def test_nexus(path):
    with h5py.File(path, "w") as file:
        data = file.create_group("entry/data")
        file.attrs["default"], file["entry"].attrs["default"] = "entry", "data"
        data.attrs["signal"], data.attrs["axes"] = "counts", ["z", "y", "x"]
        data["counts"], data["error"] = ramp(), ramp(seed=1)
        for name, first, step in (("z", 5, 2), ("y", 0, -0.5), ("x", -1, 0.1)):
            n = SHAPE["zyx".index(name)]
            data[name] = (first + step * np.arange(n)).astype("f4")
            data[name].attrs["units"] = "millimeter"
    check(opened(path), ramp(), (0.1, -0.5, 2), origin=(-1, 0, 5), units="mm")


def netcdf(path, *, uneven=False, fill=-7):
    with h5py.File(path, "w") as file:
        coordinates = {
            "time": np.arange(3.0),
            "level": np.arange(7) * 100.0,
            "lat": 50 - np.arange(9) * 0.25,
            "lon": np.arange(11) * 0.5 - 5,
        }
        if uneven:
            coordinates["level"] = coordinates["level"] ** 2
        stored = ramp((3, *SHAPE)).astype("i2")
        stored[:, 0, 0, :3] = fill
        data = file.create_dataset("temperature", data=stored, chunks=(1, 2, 4, 4))
        for i, (name, values) in enumerate(coordinates.items()):
            file[name] = values
            file[name].make_scale(name)
            file[name].attrs["units"] = np.bytes_(
                "hours since 2000-01-01" if name == "time" else "degrees"
            )
            data.dims[i].attach_scale(file[name])
        data.attrs["_FillValue"] = np.array([fill], "i2")
        data.attrs["scale_factor"], data.attrs["add_offset"] = np.float32(0.5), np.float32(10)
    return stored


def test_netcdf(tmp_path):
    path = tmp_path / "a.nc"
    stored = netcdf(path)
    source = opened(path, time=2)
    check(
        source,
        (stored[2] * np.float32(0.5) + np.float32(10)).astype("f4"),
        (0.5, -0.25, 100),
        origin=(-5, 50, 0),
        units="degrees",
    )
    assert source.about.times == 3
    hidden = np.ma.getmaskarray(source.read())
    np.testing.assert_array_equal(hidden, stored[2] == -7)
    assert hidden.sum() == 3
    region = (slice(0, 2), slice(0, 3), slice(2, 5))
    np.testing.assert_array_equal(source.read(region).mask, (stored[2] == -7)[region])


def test_uneven_coordinates_are_told(tmp_path):
    path = tmp_path / "a.nc"
    netcdf(path, uneven=True)
    notes = " ".join(opened(path).about.notes)
    assert "'level' are not evenly spaced" in notes and "spacing along z is not told" in notes


def test_nan_as_fill_value(tmp_path):
    path = tmp_path / "a.nc"
    expected = ramp().astype("f4")
    expected[0, 0] = np.nan
    with h5py.File(path, "w") as file:
        file["a"] = expected
        file["a"].attrs["_FillValue"] = np.float32(np.nan)
    np.testing.assert_array_equal(opened(path).read().mask, np.isnan(expected))


def test_classic_netcdf_is_told(tmp_path):
    path = tmp_path / "a.nc"
    path.write_bytes(b"CDF\x01" + bytes(100))
    with pytest.raises(ValueError, match="a.nc.*classic NetCDF"):
        opened(path)


def characters(text):
    return np.frombuffer(str(text).encode(), "S1")


def imaris(path):
    volume = ramp((2, 2, *SHAPE))
    with h5py.File(path, "w") as file:
        image = file.create_group("DataSetInfo/Image")
        for axis, (low, high) in enumerate([(1, 6.5), (0, 18), (-3, 4)]):
            image.attrs[f"ExtMin{axis}"] = characters(low)
            image.attrs[f"ExtMax{axis}"] = characters(high)
        image.attrs["Unit"] = characters("um")
        for channel, name in enumerate(["nuclei", "actin"]):
            info = file.create_group(f"DataSetInfo/Channel {channel}")
            info.attrs["Name"] = characters(name)
            for time in range(2):
                for level in range(2):
                    group = file.create_group(
                        f"DataSet/ResolutionLevel {level}/TimePoint {time}/Channel {channel}"
                    )
                    samples = volume[time, channel]
                    samples = samples[:, ::2, ::2] if level else samples
                    padded = np.zeros((8, 16, 16), "u2")
                    padded[tuple(map(slice, samples.shape))] = samples
                    group.create_dataset("Data", data=padded, chunks=(8, 8, 8), compression="gzip")
                    for axis, size in zip("ZYX", samples.shape):
                        group.attrs[f"ImageSize{axis}"] = characters(size)
    return volume


def test_imaris(tmp_path):
    path = tmp_path / "a.ims"
    volume = imaris(path)
    source = opened(path, time=1, channel="actin")
    check(source, volume[1, 1], (0.5, 2, 1), origin=(1.25, 1, -2.5), units="um")
    assert source.about.channels == ("nuclei", "actin") and source.about.times == 2
    coarse = opened(path, level=1)
    check(
        coarse,
        volume[0, 0, :, ::2, ::2],
        (5.5 / 6, 18 / 5, 1),
        origin=(1 + 5.5 / 12, 18 / 10, -2.5),
        units="um",
    )
    assert "channel 0 ('nuclei') of 2" in " ".join(coarse.about.notes)
    with pytest.raises(ValueError, match="no level 2"):
        opened(path, level=2)


def test_a_file_that_is_open_already(path):
    with h5py.File(path, "w") as file:
        file["a"] = ramp()
    with h5py.File(path, "r"):
        check(opened(path), ramp())


def test_truncated_and_flipped_files_are_errors(path):
    with h5py.File(path, "w") as file:
        file.create_dataset("a", data=ramp((16, 33, 35)), compression="gzip", fletcher32=True)
    whole = path.read_bytes()
    for part in (0.9, 0.5, 0.1, 0.001):
        path.write_bytes(whole[: int(len(whole) * part)])
        with pytest.raises((ValueError, RuntimeError), match="a.h5"):
            opened(path).read()
    damaged = bytearray(whole)
    damaged[-3000] ^= 255
    path.write_bytes(damaged)
    with pytest.raises((ValueError, RuntimeError), match="a.h5"):
        opened(path).read()


def test_compressed_by_slabs(path):
    with h5py.File(path, "w") as file:
        file.create_dataset("a", data=ramp((9, 33, 35)).astype("f4"), chunks=(4, 16, 16))
    with pytest.warns(UserWarning, match="spacing"):
        assert progiso.is_compressed(progiso.compress_file(path, rate=8))
