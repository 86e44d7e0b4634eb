"""DICOM: series are put in order by their positions; what is missing or mixed is an error."""

import pathlib
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pydicom
import pytest
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.sequence import Sequence
from pydicom.uid import (
    CTImageStorage,
    EnhancedMRImageStorage,
    ExplicitVRLittleEndian,
    ImplicitVRLittleEndian,
    MediaStorageDirectoryStorage,
    RLELossless,
    generate_uid,
)

import progiso
from progiso.cli import main
from progiso.io.formats import open_source
from progiso.io.source import Selection

SHAPE = (5, 7, 6)  # slices, rows, columns
X = np.random.default_rng(3).integers(0, 4000, SHAPE).astype("<i2")
AXIAL = (1, 0, 0, 0, 1, 0)
SERIES = generate_uid()


def dataset(**fields):
    """Make a CT slice without pixels."""
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = CTImageStorage
    meta.MediaStorageSOPInstanceUID = generate_uid()
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    found = FileDataset("", {}, file_meta=meta, preamble=bytes(128))
    found.SOPClassUID, found.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
    values = {
        "SeriesInstanceUID": SERIES,
        "Modality": "CT",
        "SeriesDescription": "head",
        "ImageOrientationPatient": AXIAL,
        "PixelSpacing": (0.5, 0.25),
        "SliceThickness": 2,
        "SamplesPerPixel": 1,
        "PhotometricInterpretation": "MONOCHROME2",
        "PixelRepresentation": 1,
        "BitsStored": 16,
    } | fields
    for key, value in values.items():
        if value is not None:
            setattr(found, key, [*value] if isinstance(value, tuple) else value)
    return found


def put_pixels(data, pixels, syntax=ExplicitVRLittleEndian):
    """Add pixels of a slice, or of several frames."""
    compressed = syntax == RLELossless
    data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian if compressed else syntax
    data.Rows, data.Columns = (
        pixels.shape[-2:] if data.SamplesPerPixel == 1 else pixels.shape[-3:-1]
    )
    data.BitsAllocated, data.HighBit = 8 * pixels.itemsize, data.BitsStored - 1
    data.PixelData = pixels.tobytes()
    data["PixelData"].VR = "OW" if pixels.itemsize > 1 else "OB"
    if compressed:
        data.compress(RLELossless)
    return data


def write_series(
    folder, values=X, prefix="", shuffled=True, syntax=ExplicitVRLittleEndian, **fields
):
    """Write a slice a file, in names that tell nothing about the order."""
    folder.mkdir(exist_ok=True)
    step = fields.pop("step", (0, 0, 2.5))
    start = np.array(fields.pop("start", (10, 20, 30)))
    for z, pixels in enumerate(values):
        data = dataset(
            ImagePositionPatient=tuple((start + z * np.array(step)).tolist()),
            InstanceNumber=z + 1,
            **fields,
        )
        put_pixels(data, pixels, syntax)
        name = f"{prefix}{(z * 3) % len(values) if shuffled else z}.dcm"
        data.save_as(folder / name, enforce_file_format=True)
    return folder


def check(path, expected, selection=None):
    source = open_source(path, selection)
    assert np.array_equal(source.read(), expected)
    assert source.dtype == expected.dtype.newbyteorder("=")
    region = (slice(1, 4), slice(2, 6), slice(1, 3))
    with ThreadPoolExecutor(3) as pool:
        for found in pool.map(source.read, [region] * 6):
            assert np.array_equal(found, expected[region])
    assert np.array_equal(pickle.loads(pickle.dumps(source)).read(region), expected[region])
    return source


SYNTAXES = [ExplicitVRLittleEndian, ImplicitVRLittleEndian]


@pytest.mark.parametrize("syntax", SYNTAXES, ids=lambda uid: uid.name)
def test_a_series_is_that_of_itk(syntax, tmp_path):
    """Sample by sample and corner by corner."""
    itk = pytest.importorskip("SimpleITK")
    folder = write_series(tmp_path / "ct", syntax=syntax)
    source = check(folder, X)
    reader = itk.ImageSeriesReader()
    reader.SetFileNames(reader.GetGDCMSeriesFileNames(str(folder)))
    image = reader.Execute()
    assert np.array_equal(itk.GetArrayFromImage(image), X)
    geometry = source.about.geometry
    for corner in np.ndindex(2, 2, 2):
        index = np.array(corner) * (5, 6, 4)
        place = image.TransformIndexToPhysicalPoint(index.tolist())
        assert np.allclose(geometry.origin + geometry.axes @ index, place)
    assert geometry.space == "LPS" and geometry.units == "mm"
    assert source.about.chunks == (1, 7, 6)


def test_compressed_slices(tmp_path):
    check(write_series(tmp_path / "ct", syntax=RLELossless), X)


def test_slopes_and_intercepts(tmp_path):
    """Whole intercepts keep integers, slopes make float32; they may differ from slice to slice."""
    folder = write_series(
        tmp_path / "a", RescaleSlope=1, RescaleIntercept=-1024, BitsStored=12, PixelRepresentation=0
    )
    check(folder, X - 1024)
    folder = write_series(
        tmp_path / "b",
        X.astype("<u2"),
        RescaleSlope=1,
        RescaleIntercept=-1024,
        PixelRepresentation=0,
    )
    check(folder, X.astype("i4") - 1024)
    folder = write_series(tmp_path / "c", RescaleSlope=0.5, RescaleIntercept=3)
    check(folder, (X * 0.5 + 3).astype("f4"))
    folder = write_series(tmp_path / "d", X[:4])
    last = dataset(ImagePositionPatient=(10, 20, 40), RescaleSlope=2, RescaleIntercept=0)
    put_pixels(last, X[4]).save_as(folder / "last.dcm", enforce_file_format=True)
    check(folder, np.concatenate([X[:4], 2 * X[4:]]).astype("f4"))


def test_order_and_directions(tmp_path):
    """Positions decide, not numbers or names; rows and columns may point anywhere."""
    folder = write_series(tmp_path / "down", step=(0, 0, -2.5))
    check(folder, X[::-1])
    folder = write_series(
        tmp_path / "coronal", ImageOrientationPatient=(1, 0, 0, 0, 0, -1), step=(0, 3, 0)
    )
    axes = check(folder, X).about.geometry.axes
    assert np.allclose(axes, [[0.25, 0, 0], [0, 0, 3], [0, -0.5, 0]])
    tilted = write_series(tmp_path / "tilted", step=(0, 0.5, 2.5))
    assert np.allclose(check(tilted, X).about.geometry.axes[:, 2], [0, 0.5, 2.5])


def test_several_series(tmp_path, capsys):
    """They are listed, and chosen by number or UID."""
    folder = write_series(tmp_path / "ct")
    other = generate_uid()
    write_series(folder, X + 1, prefix="o", SeriesInstanceUID=other, SeriesDescription="other")
    with pytest.raises(ValueError, match="ct' holds 2 series.*--series") as error:
        open_source(folder)
    assert SERIES in str(error.value) and other in str(error.value) and "6x7" in str(error.value)
    number = sorted([SERIES, other]).index(other)
    for series in (other, number, str(number), "other"):
        source = check(folder, X + 1, Selection(series=series))
        assert len(source.about.series) == 2
    for series in ("1.2.3", 2, -1):
        with pytest.raises(ValueError, match="no series"):
            open_source(folder, Selection(series=series))
    assert main(["info", str(folder)]) == 1
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_a_localizer_is_a_series_of_its_own(tmp_path):
    """Even if it carries the series' UID."""
    folder = write_series(tmp_path / "ct")
    scout = dataset(
        ImagePositionPatient=(0, 0, 0), ImageOrientationPatient=(0, 1, 0, 0, 0, -1), Modality="CT"
    )
    put_pixels(scout, X[0]).save_as(folder / "scout.dcm", enforce_file_format=True)
    with pytest.raises(ValueError, match="2 series"):
        open_source(folder)
    check(folder, X, Selection(series=0))


def test_gaps_are_listed(tmp_path):
    folder = write_series(tmp_path / "gap", shuffled=False)
    (folder / "2.dcm").unlink()
    with pytest.raises(ValueError, match="gap'.*missing.*2.5 mm apart: 32.5 to 37.5"):
        open_source(folder)
    folder = write_series(tmp_path / "uneven", X[:3], shuffled=False)
    late = dataset(ImagePositionPatient=(10, 20, 38.4))
    put_pixels(late, X[3]).save_as(folder / "3.dcm", enforce_file_format=True)
    with pytest.raises(ValueError, match="uneven'.*unevenly"):
        open_source(folder)
    folder = write_series(tmp_path / "twice", shuffled=False)
    again = dataset(ImagePositionPatient=(10, 20, 30))
    put_pixels(again, X[0]).save_as(folder / "again.dcm", enforce_file_format=True)
    with pytest.raises(ValueError, match="twice'.*fewer at 32.5"):
        open_source(folder)


def test_time_points(tmp_path):
    folder = write_series(tmp_path / "t", TemporalPositionIdentifier=2)
    write_series(folder, X + 1, prefix="b", TemporalPositionIdentifier=1)
    source = check(folder, X + 1)
    assert source.about.times == 2 and "choose by --time" in source.about.notes[-1]
    check(folder, X, Selection(time=1))


def test_what_else_lies_in_folders(tmp_path):
    """Lists of files, reports and other files are left out with a note; copies count once."""
    folder = write_series(tmp_path / "ct")
    report = dataset(Modality="SR")
    report.save_as(folder / "report.dcm", enforce_file_format=True)
    listing = dataset()
    listing.SOPClassUID = MediaStorageDirectoryStorage
    listing.save_as(folder / "DICOMDIR", enforce_file_format=True)
    (folder / "read me.txt").write_text("hello")
    (folder / "deeper").mkdir()
    (folder / "1.dcm").rename(folder / "deeper" / "no suffix")
    (folder / "copy.dcm").write_bytes((folder / "0.dcm").read_bytes())
    notes = " ".join(check(folder, X).about.notes)
    assert "3 files" in notes and "report.dcm" in notes and "twice" in notes
    with pytest.raises(ValueError, match="name its folder"):
        open_source(folder / "DICOMDIR")
    (tmp_path / "none").mkdir()
    report.save_as(tmp_path / "none" / "report.dcm", enforce_file_format=True)
    with pytest.raises(ValueError, match="none'.*no DICOM images"):
        open_source(tmp_path / "none")


def test_single_files(tmp_path):
    """A file of the series is one slice; its name needs no suffix."""
    folder = write_series(tmp_path / "ct", shuffled=False)
    (folder / "0.dcm").rename(folder / "IM0")
    source = open_source(folder / "IM0")
    assert np.array_equal(source.read(), X[:1]) and "name its folder" in source.about.notes[0]


def test_frames_of_one_file(tmp_path):
    """Enhanced files tell a place and a slope for each frame, here from the last to the first."""
    data = dataset(NumberOfFrames=5, ImageOrientationPatient=None, PixelSpacing=None)
    data.SOPClassUID = EnhancedMRImageStorage

    def item(**fields):
        found = pydicom.Dataset()
        for key, value in fields.items():
            setattr(found, key, value)
        return found

    data.SharedFunctionalGroupsSequence = Sequence([
        item(
            PlaneOrientationSequence=Sequence([item(ImageOrientationPatient=[*AXIAL])]),
            PixelMeasuresSequence=Sequence([item(PixelSpacing=[0.5, 0.25], SliceThickness=1)]),
        )
    ])  # fmt: skip
    data.PerFrameFunctionalGroupsSequence = Sequence([
        item(
            PlanePositionSequence=Sequence([item(ImagePositionPatient=[1, 2, 3 - 2.0 * z])]),
            PixelValueTransformationSequence=Sequence(
                [item(RescaleSlope=1, RescaleIntercept=z, RescaleType="US")]
            ),
        )
        for z in range(5)
    ])  # fmt: skip
    put_pixels(data, X).save_as(tmp_path / "e.dcm", enforce_file_format=True)
    expected = (X + np.arange(5)[:, None, None])[::-1]
    source = check(tmp_path / "e.dcm", expected.astype("i4"))
    assert np.allclose(source.about.geometry.origin, [1, 2, -5])
    assert np.allclose(source.about.geometry.axes, np.diag([0.25, 0.5, 2]))


def test_colours_and_labels(tmp_path):
    colours = np.random.default_rng(0).integers(0, 256, (5, 7, 6, 3)).astype("u1")
    kind = dict(
        SamplesPerPixel=3,
        PhotometricInterpretation="RGB",
        PlanarConfiguration=0,
        BitsStored=8,
        PixelRepresentation=0,
    )
    folder = write_series(tmp_path / "c", colours, **kind)
    assert check(folder, colours).about.components == 3
    check(folder, colours[..., 1], Selection(component=1))
    folder = write_series(tmp_path / "s", X, Modality="SEG")
    assert check(folder, X).about.labels is True


def test_without_positions(tmp_path):
    """Slices are taken by their numbers, and their space is not known."""
    folder = tmp_path / "n"
    folder.mkdir()
    for z in range(5):
        data = dataset(ImageOrientationPatient=None, InstanceNumber=10 - z)
        put_pixels(data, X[z]).save_as(folder / f"{z}.dcm", enforce_file_format=True)
    source = check(folder, X[::-1])
    assert source.about.geometry.space is None and "no positions" in source.about.notes[0]
    assert np.allclose(source.about.geometry.axes, np.diag([0.25, 0.5, 2]))


def test_compression_of_a_folder(tmp_path):
    """By the command line, too: a folder is a volume."""
    folder = write_series(tmp_path / "ct")
    assert main(["compress", str(folder), str(tmp_path / "x.vti"), "--rate", "24"]) == 0
    volume = progiso.read(tmp_path / "x.vti")
    assert volume.GetDimensions() == (6, 7, 5)
    assert volume.GetOrigin() == (10, 20, 30) and volume.GetSpacing() == (0.25, 0.5, 2.5)


def test_damaged_files(tmp_path):
    """Files cut short and headers of nonsense name the folder and the file."""
    folder = write_series(tmp_path / "ct", np.tile(X, (1, 4, 4)), shuffled=False)
    whole = (folder / "1.dcm").read_bytes()
    (folder / "1.dcm").write_bytes(whole[:-500])
    with pytest.raises(ValueError, match="ct'.*'1.dcm'"):
        open_source(folder).read()
    (folder / "1.dcm").write_bytes(whole[:400])  # cut in its header
    with pytest.raises(ValueError, match="ct': slices are missing.*1.dcm"):
        open_source(folder)
    for field, value in (
        ("Rows", 0),
        ("PixelSpacing", [0, 1]),
        ("ImageOrientationPatient", [1, 0, 0, 1, 0, 0]),
        ("ImagePositionPatient", [1, 2]),
    ):
        data = dataset(ImagePositionPatient=(0, 0, 0))
        put_pixels(data, X[0])
        setattr(data, field, value)
        path = tmp_path / "bad.dcm"
        data.save_as(path, enforce_file_format=True)
        with pytest.raises(ValueError, match="bad.dcm'"):
            open_source(path).read()
    (tmp_path / "text.dcm").write_text("hello " * 100)
    with pytest.raises(ValueError, match="text.dcm' is not a DICOM file"):
        open_source(tmp_path / "text.dcm")


def pydicoms_own(name):
    return pathlib.Path(pydicom.__file__).parent / "data" / "test_files" / name


@pytest.mark.parametrize(
    "name",
    [
        "CT_small.dcm",
        "MR_small_bigendian.dcm",
        "MR_small_RLE.dcm",
        "MR_small_jp2klossless.dcm",
        "MR_small_jpeg_ls_lossless.dcm",
        "J2K_pixelrep_mismatch.dcm",
        "SC_rgb_jpeg_gdcm.dcm",
        "SC_rgb_rle_2frame.dcm",
        "SC_rgb_jpeg_lossy_gdcm.dcm",
        "examples_ybr_color.dcm",
    ],
)
def test_examples_of_pydicom(name):
    """Compressed and other syntaxes, against SimpleITK."""
    itk = pytest.importorskip("SimpleITK")
    path = pydicoms_own(name)
    if not path.exists():
        pytest.skip("this version of pydicom does not come with it")
    found = open_source(path).read()
    assert np.array_equal(found, itk.GetArrayFromImage(itk.ReadImage(str(path))))


def test_a_decoder_that_ends_is_told(monkeypatch):
    """GDCM aborts on some damaged files: it does so in a process of its own."""
    monkeypatch.setattr(sys, "executable", "/bin/false")
    path = pydicoms_own("MR_small_jpeg_ls_lossless.dcm")
    with pytest.raises(ValueError, match=f"{path.name}'.*the decoder"):
        open_source(path).read()
