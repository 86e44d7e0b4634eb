"""What nibabel reads, by region: against nibabel's own whole reading, sample by sample."""

import gzip
import pickle
from concurrent.futures import ThreadPoolExecutor

import nibabel
import numpy as np
import pytest

import progiso
from progiso.cli import main
from progiso.io.formats import open_source
from progiso.io.source import Selection

SHAPE = (6, 5, 4)  # x, y, z, as nibabel has them
AFFINE = np.array([[0, -2, 0, 4], [1, 0, 0, 5], [0, 0, 3, 6], [0, 0, 0, 1.0]])


def values_as(kind="<i2", shape=SHAPE):
    return np.random.default_rng(7).integers(0, 100, shape).astype(kind)


def nifti(path, values=None, affine=AFFINE, second=False, **header):
    """Write an image; `header` holds fields of NIfTI."""
    values = values_as() if values is None else values
    image = (nibabel.Nifti2Image if second else nibabel.Nifti1Image)(
        values, affine, dtype=values.dtype
    )
    slope = header.pop("slope", None)
    for key, value in header.items():
        image.header[key] = value
    image.header.set_data_dtype(values.dtype)
    if slope is not None:
        image.header.set_slope_inter(slope, 1.5)
    nibabel.save(image, path)
    return path


def check(path, expected, *, selection=None, affine=None):
    """Compare the whole, regions in any order, threads, a pickled copy, and the place.

    `expected` has nibabel's axes: x, y, z and, where there are several, components.
    """
    expected = np.swapaxes(expected, 0, 2)
    source = open_source(path, selection)
    assert np.array_equal(source.read(), expected.astype(source.dtype))
    assert source.dtype.isnative
    regions = [
        (slice(2, 4), slice(1, 3), slice(2, 6)),
        (slice(0, 1), slice(0, 5), slice(0, 6)),
        (slice(3, 4), slice(4, 5), slice(5, 6)),
    ]
    with ThreadPoolExecutor(3) as pool:
        for region, found in zip(regions * 3, pool.map(source.read, regions * 3)):
            assert np.array_equal(found, expected[region].astype(source.dtype))
    copy = pickle.loads(pickle.dumps(source))
    assert np.array_equal(copy.read(regions[0]), expected[regions[0]].astype(source.dtype))
    if affine is not None:
        geometry = source.about.geometry
        assert np.allclose(geometry.axes, affine[:3, :3])
        assert np.allclose(geometry.origin, affine[:3, 3])
        assert geometry.space == "RAS"
    return source


KINDS = ["i1", "u1", "<i2", ">u2", ">i4", "<u4", "<i8", ">u8", "<f4", ">f8"]


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz", ".img"])
@pytest.mark.parametrize("kind", KINDS)
def test_nifti(kind, suffix, tmp_path):
    values = values_as(kind)
    path = tmp_path / f"x{suffix}"
    if suffix == ".img":
        nibabel.save(nibabel.Nifti1Pair(values, AFFINE, dtype=np.dtype(kind)), path)
    else:
        nifti(path, values, second=kind in ("<i8", "<f4"))
    source = check(path, values, affine=AFFINE)
    assert source.dtype == np.dtype(kind).newbyteorder("=")
    assert source.about.geometry.units in (None, "mm")
    if suffix == ".img":
        check(path.with_suffix(".hdr"), values, affine=AFFINE)


@pytest.mark.parametrize("kind", ["u1", "<i2", ">f4", "<i4", "<f8"])
def test_slope_and_intercept(kind, tmp_path):
    """Samples of 16 bits become float32, wider ones float64."""
    values = values_as(kind)
    path = nifti(tmp_path / "x.nii.gz", values, slope=0.25)
    source = check(path, values * 0.25 + 1.5)
    assert source.dtype == (np.float64 if kind in ("<i4", "<f8") else np.float32)


def test_names_do_not_matter(tmp_path):
    """Gzipped files called .nii, and plain ones called .nii.gz, are common."""
    values = values_as()
    plain = nifti(tmp_path / "x.nii", values).read_bytes()
    (tmp_path / "plain.nii.gz").write_bytes(plain)
    (tmp_path / "packed.nii").write_bytes(gzip.compress(plain))
    assert not check(tmp_path / "plain.nii.gz", values).about.sequential
    assert check(tmp_path / "packed.nii", values).about.sequential


def test_times_vectors_colours(tmp_path):
    series = values_as(shape=(*SHAPE, 3))
    for path in (
        nifti(tmp_path / "t.nii.gz", series),
        nifti(tmp_path / "u.nii", series[..., np.newaxis]),
    ):
        source = check(path, series[..., 0])
        assert source.about.times == 3
        assert source.about.notes == ("time point 0 of 3: choose by --time",)
        assert not check(path, series[..., 2], selection=Selection(time=2)).about.notes
        with pytest.raises(ValueError, match=f"{path.name}'.*time point 3"):
            open_source(path, Selection(time=3))
    vectors = nifti(tmp_path / "v.nii", series[:, :, :, np.newaxis], intent_code=1007)
    assert check(vectors, series).about.components == 3
    check(vectors, series[..., 1], selection=Selection(component=1))
    colours = np.zeros(SHAPE, [("R", "u1"), ("G", "u1"), ("B", "u1")])
    for index, name in enumerate("RGB"):
        colours[name] = series[..., index]
    path = nifti(tmp_path / "c.nii.gz", colours)
    assert check(path, series).about.components == 3
    check(path, series[..., 2], selection=Selection(component=2))
    complex_path = nifti(tmp_path / "z.nii", series[..., 0].astype("c8"))
    with pytest.raises(ValueError, match="z.nii'.*complex64"):
        open_source(complex_path)


def test_few_dimensions(tmp_path):
    """A slice is a volume of one slice; what is longer in a sixth dimension is none."""
    path = nifti(tmp_path / "x.nii", values_as()[:, :, 0])
    assert open_source(path).shape == (1, 5, 6)
    path = nifti(tmp_path / "y.nii", values_as(shape=(6, 5, 4, 1, 1, 2)))
    with pytest.raises(ValueError, match="y.nii'.*no volume"):
        open_source(path)


def test_what_the_header_tells(tmp_path):
    path = tmp_path / "x.nii"
    image = nibabel.Nifti1Image(values_as(), AFFINE)
    image.header.set_intent("label")
    image.header.set_xyzt_units("micron")
    nibabel.save(image, path)
    about = open_source(path).about
    assert about.labels is True and about.geometry.units == "um"
    assert open_source(nifti(tmp_path / "y.nii")).about.labels is None


def test_which_form_places_a_volume(tmp_path):
    """The sform, else the qform, else spacings alone, of which no space is known."""
    other = np.diag([2, 3, 4, 1.0])
    for sform, qform, expected in ((1, 1, AFFINE), (0, 1, other), (1, 0, AFFINE)):
        image = nibabel.Nifti1Image(values_as(), None)
        image.set_sform(AFFINE, sform)
        image.set_qform(other, qform)
        nibabel.save(image, tmp_path / "x.nii")
        assert not check(tmp_path / "x.nii", values_as(), affine=expected).about.notes
    image = nibabel.Nifti1Image(values_as(), None)
    image.header.set_zooms((2, 3, 4))
    image.set_sform(AFFINE, 0)
    image.set_qform(None, 0)
    image.header.set_zooms((2, 3, 4))
    nibabel.save(image, tmp_path / "x.nii")
    source = check(tmp_path / "x.nii", values_as())
    assert source.about.geometry.space is None and "neither" in source.about.notes[0]
    assert np.array_equal(source.about.geometry.axes, np.diag([2, 3, 4]))
    nifti(tmp_path / "y.nii", affine=other, srow_x=(0, 0, 0, 0))  # an sform of no volume
    image = nibabel.load(tmp_path / "y.nii")
    raw = bytearray((tmp_path / "y.nii").read_bytes())
    raw[280:328] = bytes(48)
    raw[252:256] = np.array([1, 2], "<i2").tobytes()  # qform and sform both are there
    (tmp_path / "y.nii").write_bytes(raw)
    source = check(tmp_path / "y.nii", np.asarray(image.dataobj))
    assert "sform" in source.about.notes[0] and source.about.geometry.space == "RAS"


def test_mirrored_forms_are_no_warning(tmp_path, recwarn):
    """R02: an sform that is mirrored to the qform is read without a word."""
    image = nibabel.Nifti1Image(values_as(), None)
    image.set_sform(np.diag([-2, 3, 4, 1.0]), 1)
    image.set_qform(np.diag([2, 3, 4, 1.0]), 1)
    nibabel.save(image, tmp_path / "x.nii")
    progiso.read(tmp_path / "x.nii")
    assert not recwarn.list


@pytest.mark.parametrize("suffix", [".mgh", ".mgz"])
def test_freesurfer(suffix, tmp_path):
    for kind in ("u1", ">i2", ">i4", ">f4"):
        values = values_as(kind, (*SHAPE, 2))
        image = nibabel.MGHImage(values, AFFINE)
        nibabel.save(image, tmp_path / f"x{suffix}")
        check(tmp_path / f"x{suffix}", values[..., 0], affine=AFFINE)
        check(tmp_path / f"x{suffix}", values[..., 1], selection=Selection(time=1))


def nibabels_own(pattern):
    """Return the example files that nibabel comes with, and that are whole."""
    folder = (nibabel.pkg_info.__file__.rpartition("/")[0]) + "/tests/data"
    import pathlib

    return sorted(p for p in pathlib.Path(folder).glob(pattern) if p.stat().st_size)


@pytest.mark.parametrize(
    "name",
    [
        "minc1_1_scale.mnc",
        "minc1_4d.mnc",
        "minc2_1_scale.mnc",
        "minc2_4d.mnc",
        "minc2-4d-d.mnc",
        "small.mnc",
        "example4d+orig.HEAD",
        "example4d+orig.BRIK.gz",
        "scaled+tlrc.HEAD",
        "phantom_EPI_asc_CLEAR_2_1.PAR",
        "phantom_varscale.PAR",
    ],
)
def test_examples_of_nibabel(name):
    """MINC, AFNI and PAR/REC: the last time point, corner by corner."""
    (path,) = nibabels_own(name)
    image = nibabel.load(path)
    values, minc = np.asarray(image.dataobj), name.endswith(".mnc")
    times = open_source(path).about.times
    source = open_source(path, Selection(time=times - 1))
    if minc:
        values = values[-1] if values.ndim == 4 else values
    else:
        values = values[..., -1].T if values.ndim == 4 else values.T
    assert np.array_equal(source.read(), values.astype(source.dtype))
    part = (slice(1, 3), slice(2, 9), slice(3, 4))
    assert np.array_equal(source.read(part), values[part].astype(source.dtype))
    for corner in np.ndindex(2, 2, 2):
        index = np.array(corner) * (np.array(source.shape[::-1]) - 1)
        place = nibabel.affines.apply_affine(image.affine, index[::-1] if minc else index)
        geometry = source.about.geometry
        assert np.allclose(geometry.origin + geometry.axes @ index, place)
    assert source.about.geometry.space == "RAS"


# --- what is wrong --------------------------------------------------------------------------------


def truncated(path, keep=0.5):
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * keep)])
    return path


def test_truncated_files(tmp_path, capsys):
    """Every one is an error of one line that names the file, in Python and at the command line."""
    values = np.random.default_rng(0).random((20, 20, 20)).astype("f4")
    paths = []
    for name in ("a.nii", "a.nii.gz", "a.mgz", "a.mgh"):
        kind = nibabel.MGHImage if ".mg" in name else nibabel.Nifti1Image
        nibabel.save(kind(values, np.eye(4)), tmp_path / name)
        paths.append(tmp_path / name)
    for path in paths:
        for keep in (0.9, 0.5, 0.01):
            truncated(path, keep)
            with pytest.raises(ValueError, match=f"{path.name}'"):
                open_source(path).read()
        assert main(["info", str(path)]) == 1
        error = capsys.readouterr().err
        assert path.name in error and len(error.splitlines()) == 1


def test_a_checksum_at_the_end_is_read(tmp_path):
    path = nifti(tmp_path / "x.nii.gz")
    data = bytearray(path.read_bytes())
    data[-8] ^= 1
    path.write_bytes(data)
    with pytest.raises(ValueError, match="x.nii.gz' is damaged.*CRC"):
        open_source(path).read()


def test_no_volumes_are_told_with_the_reason(tmp_path):
    gifti = nibabel.GiftiImage()
    nibabel.save(gifti, tmp_path / "s.gii")
    axes = (
        nibabel.cifti2.ScalarAxis(["a"]),
        nibabel.cifti2.BrainModelAxis.from_mask(np.ones(5), "CortexLeft"),
    )
    nibabel.save(nibabel.Cifti2Image(np.ones((1, 5)), axes), tmp_path / "c.dscalar.nii")
    bad = bytearray(nifti(tmp_path / "m.nii").read_bytes())
    bad[344:348] = b"xxxx"
    (tmp_path / "m.nii").write_bytes(bad)
    mgh = nibabel.MGHImage(np.ones((9, 9, 9), "f4"), np.eye(4))
    nibabel.save(mgh, tmp_path / "y.mgh")
    flat = bytearray((tmp_path / "y.mgh").read_bytes())
    flat[30:42] = bytes(12)
    (tmp_path / "y.mgh").write_bytes(flat)
    (tmp_path / "n.img").write_bytes(bytes(1000))
    for name, words in {
        "s.gii": "GiftiImage.*no volume",
        "c.dscalar.nii": "CIFTI.*no volume",
        "m.nii": "not a NIfTI",
        "y.mgh": "unusable",
        "n.img": "file type",
    }.items():
        with pytest.raises(ValueError, match=f"{name}.*{words}"):
            open_source(tmp_path / name)


@pytest.mark.parametrize("name", ["bad_attribute+orig.HEAD", "bad_datatype+orig.HEAD"])
def test_reasons_of_nibabel_are_told(name):
    (path,) = nibabels_own(name)
    with pytest.raises(ValueError, match="BYTEORDER|multiple data types"):
        open_source(path)


def test_huge_sizes_are_no_memory(tmp_path):
    """A header that announces more than the file holds is refused before memory is asked for."""
    for name in ("x.nii", "x.nii.gz"):
        path = nifti(tmp_path / "x.nii")
        data = bytearray(path.read_bytes())
        data[42:48] = np.array([32767] * 3, "<i2").tobytes()
        (tmp_path / name).write_bytes(gzip.compress(data) if name.endswith("gz") else data)
        with pytest.raises(ValueError, match=f"{name}' is truncated"):
            open_source(tmp_path / name)


def test_unusual_headers_are_noted_not_printed(tmp_path, capfd):
    path = nifti(tmp_path / "x.nii")
    data = bytearray(path.read_bytes())
    data[76:80] = np.array([0], "<f4").tobytes()  # qfac
    data[254:256] = np.array([0], "<i2").tobytes()
    path.write_bytes(data)
    open_source(path).read()
    assert not capfd.readouterr().err


# --- one head in two formats ----------------------------------------------------------------------


def test_one_place_for_all_formats(tmp_path):
    """The same head as .nii.gz (RAS), .nrrd and .mha (LPS) lies in one place, if asked for."""
    itk = pytest.importorskip("SimpleITK")
    head = nifti(tmp_path / "head.nii.gz", values_as("<f4"))
    image = itk.ReadImage(str(head))
    for name in ("head.nrrd", "head.mha"):
        itk.WriteImage(image, str(tmp_path / name))
        own = open_source(tmp_path / name)
        assert own.about.geometry.space == "LPS"
        for space in ("LPS", "RAS"):
            first, second = (
                open_source(path, Selection(space=space)) for path in (head, tmp_path / name)
            )
            assert np.array_equal(first.read(), second.read())
            assert np.allclose(first.about.geometry.axes, second.about.geometry.axes)
            assert np.allclose(first.about.geometry.origin, second.about.geometry.origin)
            assert first.about.geometry.space == space
