"""Hidden samples and cells through compression, files and pieces."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

import progiso
from helpers.holes import (
    HIDDEN_CELL,
    HIDDEN_POINT,
    SHAPE,
    all_together,
    ball,
    blank,
    fewer,
    speckles,
)
from helpers.images import (
    blobs,
    check_same,
    make_image,
    metadata,
    noise,
    reference_values,
    same_bits,
    samples_of,
    stream_of,
)
from progiso import vtkCompressedVolume, vtkCompressedVolumeBuilder
from progiso.geometry import hide_points


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    shape=st.tuples(*[st.integers(2, 19)] * 3),
    start=st.tuples(*[st.integers(-5, 5)] * 3),
    share=st.sampled_from([0, 0.02, 0.5, 0.98, 1]),
    rate=st.sampled_from([2, 9, 32]),
    cells=st.booleans(),
    seed=st.integers(0, 99),
)
def test_round_trip(shape, start, share, rate, cells, seed):
    """What was hidden is NaN and marked, hidden cells are marked, the rest is as close as ever."""
    samples = speckles(shape, share, seed)
    image = make_image(
        np.where(samples, np.nan, noise(shape, seed)), cells=cells, extent_start=start
    )
    others = None if cells else speckles(fewer(shape), share, seed + 1)
    volume = progiso.compress(blank(image, cells=others), rate=rate, mask_nan=True)
    back = progiso.decompress(volume)
    values = samples_of(back)
    assert np.array_equal(np.isnan(values), samples)
    seen = ~samples
    assert same_bits(values[seen], reference_values(volume)[seen])
    check_flags(
        back.GetCellData() if cells else back.GetPointData(),
        samples,
        HIDDEN_CELL if cells else HIDDEN_POINT,
    )
    if not cells:
        check_flags(back.GetCellData(), others, HIDDEN_CELL)
    again = progiso.compress(back, rate=rate)
    for name in ("HiddenSamples", "HiddenCells"):
        runs = [v.GetFieldData().GetArray("ProgIso.ZFP." + name) for v in (volume, again)]
        assert (runs[0] is None) == (runs[1] is None)
        assert runs[0] is None or np.array_equal(vtk_to_numpy(runs[0]), vtk_to_numpy(runs[1]))


def check_flags(data, hidden, flag):
    flags = data.GetArray(vtkDataSetAttributes.GhostArrayName())
    assert (flags is not None) == hidden.any()
    if flags:
        assert np.array_equal(vtk_to_numpy(flags).reshape(hidden.shape), np.where(hidden, flag, 0))


def test_hidden_values_cost_nothing():
    """Whether NaN, huge values or zeros are hidden, the rest is kept alike, and about as well as
    without a hole."""
    values, hidden = blobs(SHAPE, 3), ball(SHAPE, 9)
    errors = []
    for filling in (np.nan, 1e30, 0):
        image = blank(make_image(np.where(hidden, np.float32(filling), values)), hidden)
        volume = progiso.compress(image, rate=6)
        errors.append(np.abs(samples_of(progiso.decompress(volume)) - values)[~hidden].max())
        assert progiso.describe(volume)["range"] == [values[~hidden].min(), values[~hidden].max()]
    whole = samples_of(progiso.decompress(progiso.compress(make_image(values), rate=6)))
    assert errors[0] == errors[1] == errors[2] <= 3 * np.abs(whole - values).max()


def test_slabs_and_files_hide_alike(tmp_path):
    hidden = ball(SHAPE, 9)
    values = np.where(hidden, np.float32(np.inf), blobs(SHAPE, 3))
    whole = progiso.compress(make_image(values), rate=5, mask_nan=True)
    values.tofile(tmp_path / f"hole_{SHAPE[2]}x{SHAPE[1]}x{SHAPE[0]}_float32.raw")
    slabs = progiso.compress_slabs(iter(values), SHAPE[::-1], rate=5, mask_nan=True)
    file = progiso.compress_file(next(tmp_path.iterdir()), rate=5, mask_nan=True)
    for volume in (slabs, file):
        assert stream_of(volume) == stream_of(whole)
        assert np.array_equal(metadata(volume, "HiddenSamples"), metadata(whole, "HiddenSamples"))
    with pytest.raises(RuntimeError, match="infinite"):
        progiso.compress_slabs(iter(values), SHAPE[::-1], rate=5, mask_nan=False)


KINDS = ("?", "u1", ">i2", "i4", "u8", "f2", "f4", ">f8", "g")


@pytest.mark.parametrize("kind", KINDS)
def test_masked_samples_are_hidden(kind):
    """Of every type, whatever lies under the mask, in one array or in slabs cut anyhow."""
    hidden = ball(SHAPE, 9)
    values = (10 + 9 * blobs(SHAPE, 3)).astype(kind)
    values[hidden] = np.nan if values.dtype.kind == "f" else 99
    array = np.ma.MaskedArray(values, hidden)
    volume = progiso.compress(array.T, rate=32)
    assert np.array_equal(np.isnan(samples_of(progiso.decompress(volume))), hidden)
    low, high = array.min(), array.max()
    assert progiso.describe(volume)["range"] == [float(low), float(high)]
    cut = [array[:3], array[3:4], array[4:9].filled(0) if not hidden[4:9].any() else array[4:9]]
    for slabs in (array, iter([*cut, array[9:]]), lambda z: array[z]):
        again = progiso.compress_slabs(slabs, SHAPE[::-1], rate=32, name="values")
        check_same(again, volume)
        assert np.array_equal(metadata(again, "HiddenSamples"), metadata(volume, "HiddenSamples"))


def test_masks_survive_files(tmp_path):
    """Whatever their bits are: VTK takes lengths of pairs, which it may find to be no numbers."""
    values = blobs((41, 34, 70), 4)
    values[3:9, 5:20, 30:66] = np.nan
    volume = progiso.compress(make_image(values), rate=5, levels=1)
    for _ in range(2):
        progiso.save(volume, tmp_path / "a.vti")
        text = (tmp_path / "a.vti").read_bytes()
        assert b"nan" not in text[: text.index(b"ProgIso.ZFP.Stream")]
        again = progiso.read(tmp_path / "a.vti")
        runs = [metadata(v, "HiddenSamples").tolist() for v in (volume, again)]
        assert runs[0] == runs[1]
        volume = again


def test_masks_without_effect():
    """Arrays with an empty mask, and other classes of arrays, are arrays."""
    values = blobs(SHAPE, 3)
    expected = progiso.compress(values.T, rate=8)
    for array in (np.ma.array(values), np.ma.MaskedArray(values, False), values.view(Subclass)):
        check_same(progiso.compress(array.T, rate=8), expected)
        volume = progiso.compress(array.T, rate=8)
        assert not volume.GetFieldData().HasArray("ProgIso.ZFP.HiddenSamples")
    with pytest.raises(TypeError, match="3 dimensions, this one has 2"):
        progiso.compress(np.asmatrix(values[0]))
    everything = np.ma.MaskedArray(values, True)
    assert np.isnan(samples_of(progiso.decompress(progiso.compress(everything)))).all()


class Subclass(np.ndarray):
    pass


def test_hide_points_adds_to_what_is_hidden():
    image = make_image(noise((3, 4, 5)))
    first, second = np.zeros((3, 4, 5), bool), np.zeros(60, bool)
    first[1, 2, 3] = second[7] = True
    hide_points(image, first)
    hide_points(image, second)
    flags = vtk_to_numpy(image.GetPointData().GetArray("vtkGhostType"))
    assert np.array_equal(flags == HIDDEN_POINT, first.ravel() | second)
    with pytest.raises(ValueError, match="59 truth values for 60 points"):
        hide_points(image, second[:59])


def test_a_mask_of_another_size_is_refused():
    builder = vtkCompressedVolumeBuilder()
    assert builder.Start((4, 4, 4), 8)
    samples, hidden = (numpy_to_vtk(np.zeros(n, np.uint8), deep=True) for n in (64, 63))
    assert not builder.AddSlab(samples, 0, hidden)
    assert "63 values that hide 64 samples" in builder.GetErrorMessage()


def test_a_piece_takes_its_part_of_the_mask():
    volume, _ = all_together()
    read = vtkCompressedVolume()
    assert read.Read(volume)
    own = (9, 20, 5, 13, 11, 25)
    read.Crop(own)
    piece, extent = vtkImageData(), read.GetExtent()
    piece.SetExtent(extent)
    read.Write(piece)
    inside = tuple(slice(extent[2 * axis], extent[2 * axis + 1] + 1) for axis in (2, 1, 0))
    part, whole = progiso.decompress(piece), progiso.decompress(volume)
    assert np.array_equal(samples_of(part), samples_of(whole)[inside], equal_nan=True)
    flags = [
        vtk_to_numpy(i.GetCellData().GetArray("vtkGhostType")).reshape(
            np.array(i.GetDimensions()[::-1]) - 1
        )
        for i in (part, whole)
    ]
    assert np.array_equal(flags[0], flags[1][tuple(slice(s.start, s.stop - 1) for s in inside)])


def test_files(tmp_path):
    """A .vti carries the mask; a .zfp cannot, and says so."""
    volume, _ = all_together()
    writer, reader = vtkXMLImageDataWriter(), vtkXMLImageDataReader()
    writer.SetFileName(str(tmp_path / "hole.vti"))
    writer.SetInputData(volume)
    writer.Write()
    reader.SetFileName(str(tmp_path / "hole.vti"))
    reader.Update()
    assert np.array_equal(
        samples_of(progiso.decompress(reader.GetOutput())),
        samples_of(progiso.decompress(volume)),
        equal_nan=True,
    )
    with pytest.raises((RuntimeError, OSError), match="hidden"):
        progiso.save(volume, tmp_path / "hole.zfp")
    assert not (tmp_path / "hole.zfp").exists()


def spoiled(runs, kind=np.uint64, components=2):
    array = numpy_to_vtk(np.array(runs, kind).reshape(-1, components), deep=True)
    array.SetName("ProgIso.ZFP.HiddenSamples")
    return array


@pytest.mark.parametrize(
    "array",
    [
        spoiled([4, 1]),
        spoiled([0, 1, 5, 0, 5, 1]),
        spoiled([0, 1, 5, 0, 3, 1]),
        spoiled([0, 1, 512, 7]),
        spoiled([0, 1, 2**63, 7]),
        spoiled([0, 1, 0, 1], components=1),
        spoiled([0, 1], np.int64),
        spoiled([0, 1], np.uint32),
        spoiled([0, 1], np.float64),
    ],
)
def test_a_mask_that_is_none(array):
    volume = progiso.compress(make_image(noise((32, 32, 32))))
    volume.GetFieldData().AddArray(array)
    with pytest.raises(RuntimeError, match="HiddenSamples"):
        progiso.decompress(volume)


def test_cells_of_cell_data_are_samples():
    volume = progiso.compress(make_image(noise((9, 9, 9)), cells=True))
    array = spoiled([0, 1])
    array.SetName("ProgIso.ZFP.HiddenCells")
    volume.GetFieldData().AddArray(array)
    with pytest.raises(RuntimeError, match="HiddenCells"):
        progiso.decompress(volume)
