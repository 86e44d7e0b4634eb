"""Numbered slices in folders and by patterns."""

import sys
import types

import numpy as np
import pytest
import tifffile
from PIL import Image

import progiso
from helpers.sources import SHAPE, check, opened, ramp


def slices(folder, samples, name="slice_{:03}.tif", first=0, **options):
    """Write slices into a folder."""
    folder.mkdir(exist_ok=True)
    for number, picture in enumerate(samples, first):
        path = folder / name.format(number)
        if path.suffix in (".tif", ".tiff"):
            tifffile.imwrite(path, picture, **options)
        else:
            Image.fromarray(picture).save(path, **options)
    return folder


@pytest.mark.parametrize("suffix", ["tif", "tiff", "png", "bmp", "jp2"])
@pytest.mark.parametrize("kind", ["u1", "u2", "colours"])
def test_slices_are_sorted_by_number(tmp_path, suffix, kind):
    expected = ramp((12, 9, 11, *((3,) if kind == "colours" else ())))
    expected = expected.astype("u2" if kind == "u2" else "u1")
    if (suffix, kind) == ("bmp", "u2"):
        return
    options = {"jp2": {"irreversible": False}}.get(suffix, {})
    source = opened(slices(tmp_path / "a", expected, "s{}." + suffix, 5, **options))
    check(source, expected, (1, 1, 1))
    assert source.about.name == "s"
    assert any("spacing along x, y, z is not told" in note for note in source.about.notes)
    check(opened(tmp_path / "a" / f"s*.{suffix}"), expected)


def test_colours(tmp_path):
    expected = ramp((*SHAPE, 3)).astype("u1")
    folder = slices(tmp_path / "a", expected, "s{}.png")
    assert opened(folder).about.components == 3
    check(opened(folder, component=1), expected[..., 1])
    with pytest.raises(ValueError, match="no component 3"):
        opened(folder, component=3)


def test_no_data_in_slices(tmp_path):
    expected = ramp().astype("f4")
    folder = slices(tmp_path / "a", expected, extratags=[(42113, "s", 0, "17", True)])
    hidden = np.ma.getmaskarray(opened(folder).read())
    np.testing.assert_array_equal(hidden, expected == 17)
    assert hidden.sum() == 1


def test_jpeg_as_pillow_reads_it(tmp_path):
    folder = slices(tmp_path / "a", ramp((3, 16, 16)).astype("u1"), "s{}.jpg")
    check(opened(folder), np.stack([Image.open(folder / f"s{i}.jpg") for i in range(3)]))


def test_places_of_tiff_slices(tmp_path):
    folder = slices(
        tmp_path / "a",
        ramp(),
        imagej=True,
        resolution=(4, 2),
        metadata={"spacing": 3, "unit": "um", "axes": "YX"},
    )
    check(opened(folder), ramp(), (0.25, 0.5, 3), units="um")
    folder = slices(tmp_path / "b", ramp(), resolution=(20, 20), resolutionunit="CENTIMETER")
    source = opened(folder)
    check(source, ramp(), (0.5, 0.5, 0.5), units="mm")
    assert any("spacing along z is not told" in note for note in source.about.notes)


def test_gaps_are_listed(tmp_path):
    folder = slices(tmp_path / "a", ramp((9, 5, 5)))
    for number in (2, 5, 6):
        (folder / f"slice_{number:03}.tif").unlink()
    with pytest.raises(ValueError, match=r"'.*a' lacks slices of 'slice_#.tif': 2, 5 to 6"):
        opened(folder)
    slices(tmp_path / "b", ramp((3, 5, 5)))
    slices(tmp_path / "b", ramp((1, 5, 5)), "slice_{}.tif")
    with pytest.raises(ValueError, match="two slices of one number: slice_0.*.tif, slice_0"):
        opened(tmp_path / "b")


def test_several_series_are_listed(tmp_path):
    folder = slices(tmp_path / "a", ramp(), "s1_z{:02}.png")
    slices(folder, ramp(seed=1), "s2_z{:02}.png")
    slices(folder, ramp((1, 3, 3), "u1"), "preview.bmp")
    (folder / "notes.txt").write_text("not a picture")
    with pytest.raises(
        ValueError, match=r"several.*'preview.bmp' \(1\), 's1_z#.png' \(7\), 's2_z#.png' \(7\)"
    ):
        opened(folder)
    check(opened(folder, series="s2_z#.png"), ramp(seed=1))
    check(opened(folder / "s2*"), ramp(seed=1))
    check(opened(folder, series=1), ramp())
    with pytest.raises(FileNotFoundError, match="no files.*t2*"):
        opened(folder / "t2*")


@pytest.mark.parametrize("suffix", ["tif", "png"])
def test_other_sizes_and_types_are_named(tmp_path, suffix):
    folder = slices(tmp_path / "a", ramp(), "s{}." + suffix)
    slices(folder, ramp((1, 9, 10)), "s{}." + suffix, 7)
    with pytest.raises(ValueError, match=f"s7.{suffix}' is 10x9 of uint16, .*s0.{suffix}' is 11x9"):
        opened(folder)
    slices(folder, ramp((1, 9, 11), "u1"), "s{}." + suffix, 7)
    with pytest.raises(ValueError, match=f"s7.{suffix}' is 11x9 of uint8"):
        opened(folder)


@pytest.mark.parametrize("suffix", ["tif", "png", "jpg", "bmp", "jp2"])
def test_files_that_are_no_pictures_are_named(tmp_path, suffix):
    path = tmp_path / f"s0.{suffix}"
    path.write_bytes(b"no picture at all")
    for place in (tmp_path, path):
        with pytest.raises(ValueError, match=path.name):
            opened(place)


@pytest.mark.parametrize("suffix", ["tif", "png", "jpg", "bmp"])
def test_damaged_slices_are_named(tmp_path, suffix):
    options = {"compression": "zlib", "rowsperstrip": 4} if suffix == "tif" else {}
    folder = slices(tmp_path / "a", ramp((3, 30, 30), "u1"), "s{}." + suffix, **options)
    file = folder / f"s1.{suffix}"
    whole = file.read_bytes()
    for part in (0.8, 0.3, 0.01):
        file.write_bytes(whole[: int(len(whole) * part)])
        with pytest.raises((ValueError, RuntimeError), match=f"s1.{suffix}"):
            opened(folder).read()


def test_stacks_are_no_slices(tmp_path):
    folder = slices(tmp_path / "a", ramp((2, *SHAPE)), photometric="minisblack")
    with pytest.raises(ValueError, match="slice_000.tif' has 7 pages, and is no slice"):
        opened(folder)


def test_colours_of_16_bits_are_refused(tmp_path):
    imagecodecs = pytest.importorskip("imagecodecs")
    imagecodecs.imwrite(tmp_path / "s0.png", ramp((5, 5, 3)))
    with pytest.raises(ValueError, match="s0.png.*16 bits"):
        opened(tmp_path)


def test_no_pictures(tmp_path):
    (tmp_path / "notes.txt").write_text("nothing")
    with pytest.raises(ValueError, match="folder without DICOM files and pictures"):
        opened(tmp_path)


def test_dicom_goes_to_its_reader(tmp_path, monkeypatch):
    asked = []
    module = types.ModuleType("progiso.io.dicom")
    module.open_dicom = lambda path, selection: asked.append(path) or opened_slices
    monkeypatch.setitem(sys.modules, "progiso.io.dicom", module)
    opened_slices = opened(slices(tmp_path / "b", ramp()))
    folder = slices(tmp_path / "a", ramp((1, 5, 5)))
    (folder / "IM0001").write_bytes(bytes(128) + b"DICM" + bytes(10))
    opened(folder)
    assert asked == [folder]


def test_zarr_in_a_folder_of_another_name(tmp_path):
    zarr = pytest.importorskip("zarr")
    zarr.create_array(tmp_path / "scan", shape=SHAPE, dtype="u2", chunks=(4, 4, 4))[:] = ramp()
    check(opened(tmp_path / "scan"), ramp())


def test_one_picture_is_one_slice(tmp_path):
    slices(tmp_path, ramp((1, 9, 11)), "x{}.png")
    check(opened(tmp_path / "x0.png"), ramp((1, 9, 11)))


def test_compressed_by_slabs(tmp_path):
    folder = slices(tmp_path / "a", ramp((9, 33, 35)).astype("f4"))
    with pytest.warns(UserWarning, match="spacing"):
        assert progiso.is_compressed(progiso.compress_file(folder, rate=8))
    with pytest.warns(UserWarning, match="spacing"):
        assert progiso.read(folder / "*.tif").GetDimensions() == (35, 33, 9)
