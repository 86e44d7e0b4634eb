"""Arrays of other libraries, and their images, are taken as they are."""

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid

import progiso
from helpers.images import check_same, samples_of
from progiso.io import open_source, source
from progiso.io.arrays import as_image, source_of
from progiso.io.axes import even_step

SHAPE = (9, 10, 11)


def values(kind="f4"):
    x, y, z = np.indices(SHAPE)
    return (x + 20 * np.sin(y) + 3 * z * z).astype(kind)


def dask_array(kind="f4"):
    return pytest.importorskip("dask.array").from_array(values(kind), chunks=(4, 5, 6))


def zarr_array(kind="f4"):
    zarr = pytest.importorskip("zarr")
    array = zarr.create_array(store={}, shape=SHAPE, chunks=(4, 5, 6), dtype=kind)
    array[...] = values(kind)
    return array


def h5py_dataset(kind="f4"):
    h5py = pytest.importorskip("h5py")
    file = h5py.File("in memory", "w", driver="core", backing_store=False)
    return file.create_dataset("values", data=values(kind), chunks=(4, 5, 6))


def memory_map(kind="f4"):
    import tempfile

    with tempfile.NamedTemporaryFile() as file:
        mapped = np.memmap(file.name, kind, "w+", shape=SHAPE)
        mapped[...] = values(kind)
        return mapped


LAZY = {"dask": dask_array, "zarr": zarr_array, "h5py": h5py_dataset, "memmap": memory_map}


@pytest.mark.parametrize("kind", ["f4", "f8", ">i2", "u1", "?", "f2"])
@pytest.mark.parametrize("library", LAZY)
def test_compressed_as_what_they_compute(library, kind, monkeypatch):
    """A lazy array gives the volume of the array that it computes, whatever a slab's depth."""
    if (library, kind) == ("zarr", ">i2"):
        kind = "i2"
    lazy = LAZY[library](kind)
    expected = progiso.compress(values(kind), rate=7)
    for slab_bytes in (1, 2**25):
        monkeypatch.setattr(source, "_SLAB_BYTES", slab_bytes)
        check_same(progiso.compress(lazy, rate=7), expected)


@pytest.mark.parametrize("library", LAZY)
def test_slices_first(library):
    """`axes` tells which dimension is which."""
    lazy = LAZY[library]()
    check_same(
        progiso.compress(lazy, rate=7, axes="zyx"),
        progiso.compress(np.ascontiguousarray(values().T), rate=7),
    )
    assert as_image(lazy, "zyx").GetDimensions() == SHAPE[::-1]
    assert as_image(values(), "yzx").GetDimensions() == (11, 9, 10)
    with pytest.raises(ValueError, match="axes must be"):
        as_image(lazy, "xyw")


@pytest.mark.parametrize("library", LAZY)
def test_as_slabs(library):
    """Slabs are slices, rows and columns; a lazy array is as many of them as it has."""
    expected = progiso.compress(values(), axes="zyx", rate=7)
    volume = progiso.compress_slabs(
        LAZY[library](), rate=7, name="values", spacing=(1, 2, 3), origin=(4, 5, 6)
    )
    check_same(volume, expected)
    assert volume.GetSpacing() == (1, 2, 3) and volume.GetOrigin() == (4, 5, 6)
    with pytest.raises(ValueError, match="has .11, 10, 9. samples, not .9, 10, 11."):
        progiso.compress_slabs(LAZY[library](), SHAPE)
    with pytest.raises(ValueError, match="give dimensions"):
        progiso.compress_slabs([values()])


def test_regions():
    """A region is that of the whole, also in threads and after a journey to another process."""
    whole = values().T
    for lazy in (dask_array(), values()):
        opened = source_of(lazy)
        assert opened.shape == whole.shape
        rng = np.random.default_rng(3)
        regions = []
        for _ in range(20):
            ends = [sorted(rng.choice(n + 1, 2, replace=False)) for n in whole.shape]
            regions.append(tuple(slice(int(a), int(b)) for a, b in ends))
        with ThreadPoolExecutor(4) as pool:
            for region, found in zip(regions, pool.map(opened.read, regions)):
                assert np.array_equal(found, whole[region])
        assert np.array_equal(pickle.loads(pickle.dumps(opened)).read(), whole)
        for bad in ((slice(3, 3),) * 3, (slice(0, 4, 2),) * 3, (slice(50, 60),) * 3):
            with pytest.raises(IndexError, match="is no region of"):
                opened.read(bad)


def test_masked_chunks():
    """What a lazy array's chunks mask is hidden, as of an array in memory."""
    dask = pytest.importorskip("dask.array")
    masked = np.ma.masked_less(values(), 10)
    masked.data[masked.mask] = -9999
    lazy = dask.ma.masked_less(dask.from_array(values(), chunks=4), 10)
    check_same(progiso.compress(lazy, rate=9), progiso.compress(masked, rate=9))
    volume = progiso.decompress(progiso.compress(lazy, rate=9))
    assert np.isnan(samples_of(volume)).sum() == masked.mask.sum() > 50


def test_coordinates_of_xarray():
    """Names of dimensions say which is which, even coordinates where samples lie."""
    xarray = pytest.importorskip("xarray")
    coords = {"lat": np.linspace(50, 41, 10), "lon": 5 + 0.5 * np.arange(11), "t": [0, 1, 3] * 3}
    array = xarray.DataArray(values(), coords=coords, dims=("t", "lat", "lon"), name="pressure")
    with pytest.warns(UserWarning, match="'t' is not evenly spaced"):
        volume = progiso.compress(array, rate=9)
    image = as_image(array)
    for placed in (volume, image):
        assert placed.GetDimensions() == (11, 10, 9)
        assert placed.GetSpacing() == (0.5, 1, 1) and placed.GetOrigin() == (5, 50, 0)
        assert placed.GetDirectionMatrix().GetElement(1, 1) == -1
    assert progiso.describe(volume)["array"] == "pressure"
    assert np.array_equal(samples_of(image), values())


@pytest.mark.parametrize("names", [("height", "lat", "lon"), ("lat", "lon", "level")])
def test_axes_of_xarray_and_of_its_file(names, tmp_path):
    """An array and the file that it is written to are read alike."""
    xarray, h5py = pytest.importorskip("xarray"), pytest.importorskip("h5py")
    coords = {name: 2.0 * np.arange(n) for name, n in zip(names, values().shape)}
    array = xarray.DataArray(values(), coords=coords, dims=names, name="pressure")
    with h5py.File(tmp_path / "a.nc", "w") as file:  # as NetCDF's library writes it
        file["pressure"] = values()
        for dimension, name in zip(file["pressure"].dims, names):
            file[name] = coords[name]
            file[name].make_scale(name)
            dimension.attach_scale(file[name])
    image, read = as_image(array), progiso.read(tmp_path / "a.nc")
    level = names.index("height" if "height" in names else "level")
    assert image.GetDimensions() == read.GetDimensions()
    assert image.GetDimensions()[2] == values().shape[level]
    assert np.array_equal(samples_of(image), samples_of(read))


def test_fill_values_of_xarray():
    xarray = pytest.importorskip("xarray")
    filled = np.where(values() < 10, -32768, values()).astype("i2")
    array = xarray.DataArray(filled, dims=("z", "y", "x"), attrs={"_FillValue": -32768})
    expected = progiso.compress(np.ma.masked_equal(filled, -32768), axes="zyx", rate=9)
    check_same(progiso.compress(array, rate=9), expected)


def test_images_of_others():
    """SimpleITK's lie in LPS, nibabel's in RAS, each as its own affine says."""
    sitk, nibabel = pytest.importorskip("SimpleITK"), pytest.importorskip("nibabel")
    other = sitk.GetImageFromArray(values())
    other.SetSpacing((1, 2, 3))
    other.SetOrigin((4, 5, 6))
    other.SetDirection((0, -1, 0, 1, 0, 0, 0, 0, 1))
    volume = progiso.compress(other, rate=32)
    assert volume.GetOrigin() == (4, 5, 6) and volume.GetSpacing() == (1, 2, 3)
    assert volume.GetDirectionMatrix().GetElement(0, 1) == -1
    assert np.array_equal(samples_of(as_image(other)), values())
    affine = np.array([[0, -2, 0, 4], [1, 0, 0, 5], [0, 0, 3, 6], [0, 0, 0, 1.0]])
    image = as_image(nibabel.Nifti1Image(values(), affine))
    assert image.GetOrigin() == (4, 5, 6) and image.GetSpacing() == (1, 2, 3)
    assert np.array_equal(samples_of(image), values().T)
    with pytest.raises(ValueError, match="knows its axes"):
        progiso.compress(other, axes="zyx")


@pytest.mark.parametrize("order", ["C", "F"])
def test_numpy_files(order, tmp_path):
    path = tmp_path / "values.npy"
    np.save(path, np.asarray(values(">i2"), order=order))
    assert np.array_equal(samples_of(progiso.read(path)), values("i2").T)
    assert np.array_equal(samples_of(progiso.read(path, axes="zyx")), values("i2"))
    check_same(progiso.compress_file(path, rate=5), progiso.compress(values("i2"), rate=5))
    opened = open_source(path)
    assert np.array_equal(pickle.loads(pickle.dumps(opened)).read(), values("i2").T)
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.raises(ValueError, match="cannot read '.*values.npy'"):
        progiso.read(path)
    np.save(path, np.array([{}]), allow_pickle=True)
    with pytest.raises(ValueError, match="cannot read '.*values.npy'"):
        progiso.read(path)


def test_what_is_no_volume():
    pytest.importorskip("dask")
    for wrong, message in (
        (dask_array()[0], "3 dimensions, this one has 2"),
        (np.zeros((3, 3, 3), complex), "real numbers"),
        (vtkRectilinearGrid(), "resample it to an image"),
        ("volume.vti", "progiso.read"),
        ([[[1.0]]], "got list"),
    ):
        with pytest.raises(TypeError, match=message):
            progiso.compress(wrong)


def test_even_step():
    assert even_step([3.0, 2.5, 2.0]) == (-0.5, 3, None)
    assert even_step([7]) == (None, 7, None)
    uneven = [[1, 1], [0, 1, 3], ["a", "b"], [0, 1, np.nan], np.array([0, 1], "M8[D]"), []]
    assert all(even_step(values) == (None, 0, None) for values in uneven)
