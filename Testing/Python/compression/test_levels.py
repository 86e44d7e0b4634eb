"""Levels of detail: what they hold, where they lie, and what of them is refused."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkImagingCore import vtkImageShiftScale

import progiso
from helpers.images import (
    PREFIX,
    blobs,
    copy_of,
    make_image,
    message_of,
    noise,
    samples_of,
    without_checksums,
)
from helpers.surfaces import check_same_surface
from progiso import vtkCompressedVolume, vtkImageZFPDecompress
from progiso.bench.levels import CHOSEN, coarsened, interpolated


def arrays_of(volume):
    """Return the bytes of all arrays of field data by their names."""
    fields = volume.GetFieldData()
    arrays = [fields.GetAbstractArray(i) for i in range(fields.GetNumberOfArrays())]
    return {
        array.GetName(): vtk_to_numpy(array).tobytes() if array.GetDataType() != 13 else
        array.GetValue(0)
        for array in arrays
    }  # fmt: skip


def numbers_of(volume, name):
    return vtk_to_numpy(volume.GetFieldData().GetAbstractArray(name))


@pytest.fixture(scope="module")
def plain():
    """Return samples of shape (depth, height, width), with even and odd numbers of them."""
    return (blobs((140, 67, 66)) + 0.05 * noise((140, 67, 66))).astype(np.float32)


@pytest.fixture(scope="module")
def volume(plain):
    return progiso.compress(make_image(plain), rate=6, levels=11)


def test_levels_are_those_of_a_reference(plain, volume):
    about = progiso.describe(volume)
    assert [level["samples"] for level in about["levels"]] == [[34, 34, 71], [18, 18, 36]]
    assert [level["steps"] for level in about["levels"]] == [[2, 2, 2], [4, 4, 4]]
    assert [level["rate"] for level in about["levels"]] == [9, 10]
    expected = plain
    for number, level in enumerate(about["levels"], 1):
        expected = coarsened(expected, CHOSEN)
        decoded = samples_of(progiso.decompress(volume, level=number))
        assert decoded.shape == expected.shape
        off = np.abs(decoded - expected)
        rounding = 1e-6 * float(np.abs(expected).max())
        assert off.max() == pytest.approx(level["largest_error"], abs=rounding)
        assert off.mean() == pytest.approx(level["mean_error"], rel=1e-3, abs=rounding)
        assert level["largest_error"] < about["largest_error"]
        assert level["range"] == pytest.approx([expected.min(), expected.max()], abs=rounding)
        assert plain.min() <= level["range"][0] and level["range"][1] <= plain.max()


def test_no_sample_is_farther_from_a_level_than_it_says(plain, volume):
    for number, level in enumerate(progiso.describe(volume)["levels"], 1):
        decoded = samples_of(progiso.decompress(volume, level=number))
        off = np.abs(interpolated(decoded, plain.shape, 0, 2**number) - plain).max()
        assert 0.4 * level["largest_distance"] < off <= level["largest_distance"] + 1e-6


def test_other_arrays_stay_as_they_are(plain, volume):
    """Who knows nothing of levels reads what is there without them, checksums included."""
    without = arrays_of(progiso.compress(make_image(plain), rate=6))
    assert all(name.startswith(PREFIX) for name in without)
    with_levels = arrays_of(volume)
    assert {name: with_levels[name] for name in without} == without
    more = with_levels.keys() - without.keys()
    assert more and not any(name.startswith(PREFIX) for name in more)
    older = without_checksums(progiso.compress(make_image(plain), rate=6))
    assert progiso.describe(older)["levels"] == []


def test_small_volumes_have_none():
    small = progiso.compress(make_image(noise((64, 20, 64))), levels=3)
    assert progiso.describe(small)["levels"] == []
    assert not any(name.startswith("ProgIso.Level") for name in arrays_of(small))
    wide = progiso.compress(make_image(noise((65, 20, 64))), levels=3)
    assert [level["samples"] for level in progiso.describe(wide)["levels"]] == [[33, 11, 33]]


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("depth", [3, 4, 37])
def test_slabs_make_the_same_bytes(plain, volume, depth, threads):
    slabs = (plain[z : z + depth] for z in range(0, len(plain), depth))
    image = progiso.compress_slabs(
        slabs, plain.shape[::-1], rate=6, levels=11, threads=threads, name="density"
    )
    expected = arrays_of(volume)
    found = arrays_of(image)
    assert {name: found[name] for name in expected if "Level" in name} == {
        name: expected[name] for name in expected if "Level" in name
    }


@pytest.mark.parametrize("suffix", [".nii.gz", ".mha", ".vti"])
def test_files_make_the_same_bytes(tmp_path, plain, suffix):
    """Also where samples are wider apart along one axis, as a file tells."""
    image = make_image(plain[:, :20], spacing=(0.5, 0.5, 2.0))
    path = tmp_path / f"plain{suffix}"
    progiso.save(image, path)
    expected = arrays_of(progiso.compress(progiso.read(path), rate=4, levels=2))
    found = progiso.compress_file(path, rate=4, levels=2)
    assert arrays_of(found) == expected
    steps = [level["steps"] for level in progiso.describe(found)["levels"]]
    assert steps == [[2, 2, 1], [4, 4, 1]]


@pytest.mark.parametrize("appended", [False, True])
def test_files_keep_levels(tmp_path, volume, appended):
    path = tmp_path / "packed.vti"
    progiso.save(volume, path, appended=appended)
    again = progiso.read(path)
    assert progiso.describe(again) == progiso.describe(volume)
    for level in (1, 2):
        expected = samples_of(progiso.decompress(volume, level=level))
        assert np.array_equal(samples_of(progiso.decompress(again, level=level)), expected)


def test_levels_lie_where_their_samples_do():
    image = make_image(
        noise((9, 140, 140)),
        spacing=(1.0, 2.0, 3.0),
        origin=(5.0, -6.0, 7.0),
        direction=np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
        extent_start=(10, -3, 4),
    )
    level = progiso.decompress(progiso.compress(image, levels=2), level=2)
    assert level.GetSpacing() == (4.0, 4.0, 3.0)  # halved along x, then along x and y
    for index in ((0, 0, 0), (3, 7, 5)):
        point, expected = [0.0] * 3, [0.0] * 3
        level.TransformIndexToPhysicalPoint(index, point)
        fine = np.array(index) * (4, 2, 1) + (10, -3, 4)
        image.TransformIndexToPhysicalPoint(fine.tolist(), expected)
        assert point == pytest.approx(expected)


def test_levels_of_cells():
    """Samples lie in the centres of cells, and a level's on those of every second one."""
    values = noise((70, 9, 9))
    image = make_image(values, spacing=(0.5, 1.0, 1.0), cells=True)
    packed = progiso.compress(image, rate=16, levels=1)
    level = progiso.decompress(packed, level=1)
    assert level.GetCellData().GetScalars() is not None
    cells = vtk_to_numpy(level.GetCellData().GetScalars())
    dims = progiso.describe(packed)["levels"][0]["samples"]
    assert len(cells) == np.prod(dims)
    assert cells[0] == pytest.approx(vtk_to_numpy(image.GetCellData().GetScalars())[0], abs=1e-2)
    first = np.array(level.GetCell(0).GetBounds()).reshape(3, 2).mean(axis=1)
    assert first == pytest.approx(np.array(image.GetCell(0).GetBounds()).reshape(3, 2).mean(axis=1))


def test_the_pipeline_knows_the_geometry(volume):
    decompressor = vtkImageZFPDecompress()
    decompressor.SetInputData(volume)
    decompressor.SetLevel(1)
    scaled = vtkImageShiftScale()
    scaled.SetInputConnection(decompressor.GetOutputPort())
    scaled.SetScale(2)
    scaled.Update()
    assert scaled.GetOutput().GetDimensions() == (34, 34, 71)
    assert np.array_equal(
        samples_of(scaled.GetOutput()), 2 * samples_of(progiso.decompress(volume, level=1))
    )


def test_hidden_samples_weigh_nothing(plain):
    holed = plain.copy()
    holed[30:50, 10:40, :33] = np.nan
    holed[100, 50, 50] = np.nan
    packed = progiso.compress(make_image(holed), rate=12, levels=2)
    inside = holed
    for number in (1, 2):
        decoded = samples_of(progiso.decompress(packed, level=number))
        step = 2**number
        hidden = np.isnan(decoded)
        assert hidden.any() and hidden[40 // step, 24 // step, 12 // step]
        assert not hidden[100 // step, 50 // step, 50 // step]
        error = progiso.describe(packed)["levels"][number - 1]["largest_error"]
        assert np.nanmin(inside) - error <= np.nanmin(decoded)
        assert np.nanmax(decoded) <= np.nanmax(inside) + error
        far = coarsened(plain, CHOSEN) if number == 1 else None
        if far is not None:
            close = np.zeros(far.shape, bool)
            close[13:28, 3:23, :19] = close[47:53, 22:28, 22:28] = True
            assert np.nanmax(np.abs(decoded - far)[~close]) <= error + 1e-6


def test_levels_have_the_streams_units():
    values = 1e6 + noise((70, 9, 8)).astype(np.float64)
    packed = progiso.compress(make_image(values), rate=10, levels=1)
    about = progiso.describe(packed)
    assert about["offset"] != 0
    level = about["levels"][0]
    decoded = samples_of(progiso.decompress(packed, level=1))
    expected = coarsened((values - 1e6).astype(np.float32), CHOSEN).astype(np.float64)
    off = np.abs(decoded - 1e6 - expected)
    assert decoded.dtype == np.float64 and off.max() <= 1.01 * level["largest_error"] + 1e-6


#: What may happen to a level's arrays, and what is said of it.
DAMAGE = {
    "Stream": "its field data array ProgIso.Level2.Stream is not an array",
    "Steps": "ProgIso.Level2.Steps is missing",
    "Dimensions": "ProgIso.Level2.Dimensions is missing",
    "BlockBits": "ProgIso.Level2.BlockBits is missing",
    "Range": "ProgIso.Level2.Range is missing",
    "Error": "ProgIso.Level2.Error is missing",
    "Distance": "ProgIso.Level2.Distance is missing",
    "Checksum": "ProgIso.Level2.Checksum is missing",
    "PageChecksums": "ProgIso.Level2.*) do not match their checksum",
}


@pytest.mark.parametrize("name", DAMAGE)
def test_a_lacking_array_is_named(volume, name):
    damaged = copy_of(volume)
    damaged.GetFieldData().RemoveArray(f"ProgIso.Level2.{name}")
    message = message_of(damaged)
    assert "level 2 of it: " in message and DAMAGE[name] in message
    with pytest.raises(RuntimeError, match="level 2 of it"):
        progiso.decompress(damaged)


@pytest.mark.parametrize("name", sorted(set(DAMAGE) - {"Stream"}))
def test_a_changed_value_is_found(volume, name):
    damaged = copy_of(volume)
    numbers_of(damaged, f"ProgIso.Level1.{name}").reshape(-1).view(np.uint8)[0] ^= 1
    assert "level 1 of it: " in message_of(damaged)


def test_a_flipped_bit_of_a_stream_is_found(volume):
    damaged = copy_of(volume)
    numbers_of(damaged, "ProgIso.Level2.Stream")[77] ^= 4
    message = message_of(damaged)
    assert "level 2 of it: ProgIso.Level2.Stream is damaged: 1 of its 1 pages" in message
    reader = vtkCompressedVolume()
    assert not reader.Read(damaged) and reader.GetNumberOfLevels() == 0


def test_a_truncated_stream_is_found(volume):
    damaged = copy_of(volume)
    damaged.GetFieldData().GetAbstractArray("ProgIso.Level1.Stream").SetNumberOfValues(800)
    assert "level 1 of it: ProgIso.Level1.Stream is truncated" in message_of(damaged)


def test_levels_of_another_stream_are_found(plain, volume):
    """Where an older version has compressed an image again, its levels stay."""
    other = progiso.compress(make_image(plain), rate=5)
    for name in arrays_of(volume):
        if name.startswith("ProgIso.Level"):
            other.GetFieldData().AddArray(volume.GetFieldData().GetAbstractArray(name))
    assert "its levels of detail (arrays of field data named ProgIso.Level*)" in message_of(other)
    lacking = copy_of(volume)
    lacking.GetFieldData().RemoveArray("ProgIso.Levels")
    assert "ProgIso.Levels is missing" in message_of(lacking)


def test_nothing_stays_of_levels(plain, volume):
    """Neither where samples are decoded, nor where they are compressed anew."""
    for level in (0, 1):
        assert not arrays_of(progiso.decompress(volume, level=level))
    assert progiso.is_compressed(volume)
    again = copy_of(volume)
    vtkCompressedVolume.Remove(again)
    assert not arrays_of(again)


def test_what_cannot_be():
    image = make_image(noise((70, 9, 8)))
    packed = progiso.compress(image, levels=1)
    with pytest.raises(RuntimeError, match="no level 2: the volume has 1 levels"):
        progiso.decompress(packed, level=2)
    for wrong, error in ((-1, ValueError), (12, ValueError), (1.5, TypeError), ("1", TypeError)):
        with pytest.raises(error, match="levels must be"):
            progiso.compress(image, levels=wrong)
        with pytest.raises(error, match="level must be"):
            progiso.decompress(packed, level=wrong)


def contour(image, isovalues, **options):
    return progiso.contour(image, isovalues, gradients=True, **options)


def test_contours_of_a_level_are_those_of_its_image(volume):
    """Also of data of cells, whose levels lie half a coarse cell further."""
    cells = blobs((70, 80, 90), 5).astype(np.float32)
    of_cells = progiso.compress(make_image(cells, cells=True), rate=8, levels=11)
    for compressed in (volume, of_cells):
        for level in (0, 1):
            surface = contour(compressed, [-0.2, 0.3], level=level)
            expected = contour(progiso.decompress(compressed, level=level), [-0.2, 0.3])
            assert surface.GetNumberOfPolys() > 1000
            check_same_surface(surface, expected)
    fine, coarse = (progiso.contour(volume, 0.3, level=level) for level in (0, 1))
    assert coarse.GetNumberOfPolys() < 0.4 * fine.GetNumberOfPolys()


def test_contours_of_levels_that_are_not_there(plain, volume):
    with pytest.raises(RuntimeError, match="no level 3: the volume has 2 levels"):
        progiso.contour(volume, 0.3, level=3)
    with pytest.raises(ValueError, match="level must be from 0 to 11, got 12"):
        progiso.contour(volume, 0.3, level=12)
    with pytest.raises(ValueError, match="a plain image has no level 1: compress it"):
        progiso.contour(make_image(plain), 0.3, level=1)
    made = contour(make_image(plain), 0.3, level=1, rate=6)
    check_same_surface(made, contour(volume, 0.3, level=1))
