"""A lossy rate and the question asked: labels, masks, errors, and the numbers that users give."""

import decimal
import warnings

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray

import progiso
from helpers.images import (
    blobs,
    check_same,
    make_image,
    marschner_lobb,
    noise,
    reference_volume,
    samples_of,
)
from helpers.messages import vtk_messages
from helpers.scenes import Scene, orbit
from progiso.compression import doubts

N = 32
R = np.sqrt(((np.mgrid[0:N, 0:N, 0:N] - 15.5) ** 2).sum(0))
BALL = np.where(R < 12, 4000, 0).astype(np.int16)


def decoded(volume):
    return samples_of(progiso.decompress(volume)).T


def regions(count, ids, seed=0, shape=(N, N, N)):
    """Make a label map: random ids in the cells around random points, and none outside of a ball.

    Returns
    -------
    numpy.ndarray of int32, shape (n, n, n)
    """
    random = np.random.default_rng(seed)
    grid = np.stack(np.mgrid[tuple(slice(n) for n in shape)], -1).reshape(-1, 3)
    points = random.uniform(0, max(shape), (count, 3))
    nearest = ((grid[:, np.newaxis] - points) ** 2).sum(-1).argmin(1)
    labels = random.integers(1, ids, count)[nearest].reshape(shape)
    inside = np.linalg.norm(grid - np.array(shape) / 2, axis=-1).reshape(shape) < 0.45 * max(shape)
    return np.where(inside, labels, 0).astype(np.int32)


# --- labels and masks -----------------------------------------------------------------------------

LABELS = {
    "mask of 4000": BALL,
    "mask of doubles": BALL.astype(float),
    "truth values": R < 12,
    "mask of 255": np.where(R < 12, 255, 0).astype(np.uint8),
    "-1 and 1": np.where(R < 12, -1, 1).astype(np.int8),
    "tissues": np.digitize(R, [5, 9, 12]).astype(np.uint8),
    "FreeSurfer's ids": regions(30, 12175),
    "few ids": regions(30, 116).astype(np.uint8),
    "float32 ids": regions(30, 1605).astype(np.float32),
    "big-endian ids": regions(30, 30000).astype(">i2"),
    "ids of 2^22": regions(30, 2**22),
}


@pytest.mark.parametrize("case", LABELS)
def test_labels_stay_on_their_side_of_every_half_integer(case):
    """By default, however they come; no isovalue between two of them is warned of."""
    labels = LABELS[case]
    volume = progiso.compress(labels)
    about = progiso.describe(volume)
    assert about["rate"] >= 8 and about["largest_error"] < 0.5
    assert (np.floor(decoded(volume).astype(float) + 0.5) == labels).all()
    slabs = labels.T
    for given in (slabs, [slabs[:5], slabs[5:]], lambda z: slabs[z]):
        check_same(progiso.compress_slabs(given, labels.shape, name="values"), volume)
    values = np.unique(labels).astype(float)
    assert doubts(volume, (values[:-1] + 0.5)[:16]) is None
    least = progiso.describe(progiso.compress(labels, tolerance=0.49))["rate"]
    assert about["rate"] == max(8, least)


OTHERS = {
    "smooth": blobs((N, N, N), 1),
    "rounded": np.round(40 * R).astype(np.uint16),
    "rounded to bytes": np.round(5 * R).astype(np.uint8),
    "noise of whole numbers": np.round(300 * noise((N, N, N), 1)).astype(np.int16),
    "an edge with noise": (np.where(R < 12, 1000, -1000) + 20 * noise((N, N, N), 1)).astype("i2"),
    "constant": np.full((N, N, N), 7),
    "halves": np.where(R < 12, 4000.5, 0),
}


@pytest.mark.parametrize("case", OTHERS)
def test_all_else_has_8_bits(case):
    for volume in (
        progiso.compress(OTHERS[case]),
        progiso.compress_slabs(OTHERS[case].T, (N, N, N)),
    ):
        assert progiso.describe(volume)["rate"] == 8


def test_a_rate_that_is_given_is_taken():
    for rate in (8, 2.5, np.float32(4), np.array(6), decimal.Decimal("3.5")):
        assert progiso.describe(progiso.compress(BALL, rate=rate))["rate"] == float(rate)
        slabs = progiso.compress_slabs(BALL.T, BALL.shape, rate=rate)
        assert progiso.describe(slabs)["rate"] == float(rate)


def test_hidden_samples_are_no_labels():
    """What is hidden neither makes labels of measured values nor the other way round."""
    masked = np.ma.MaskedArray(BALL.astype(float), R < 4)
    masked.data[masked.mask] = 0.123
    volume = progiso.compress(masked)
    assert progiso.describe(volume)["largest_error"] < 0.5
    check_same(progiso.compress_slabs(masked.T, BALL.shape, name="values"), volume)
    holes = np.where(R < 4, np.nan, BALL)
    assert progiso.describe(progiso.compress(holes, mask_nan=True))["largest_error"] < 0.5


def test_slabs_that_come_once_take_a_number():
    with pytest.warns(UserWarning, match="the slabs are labels, and off by up to") as caught:
        progiso.compress_slabs(iter(BALL.T), BALL.shape)
    assert len(caught) == 1 and caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        progiso.compress_slabs(iter(BALL.T), BALL.shape, rate=8)
        progiso.compress_slabs(iter(OTHERS["smooth"]), BALL.shape)
    with pytest.raises(ValueError, match="take a rate"):
        progiso.compress_slabs(iter(BALL.T), BALL.shape, tolerance=1)


def test_sphere_of_a_mask():
    """The picture and the mesh of a mask are those of a ball, by default and with no warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = progiso.render(BALL, 0.5, size=(160, 160))
        mesh = progiso.contour(progiso.compress(BALL), 0.5)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    assert (abs(np.linalg.norm(points - 15.5, axis=1) - 12.5) < 1).all()
    exact = progiso.render(BALL, 0.5, rate=32, size=(160, 160)).depth
    assert progiso.describe(progiso.compress(BALL, rate=32))["largest_error"] == 0
    assert np.mean(np.isfinite(result.depth) != np.isfinite(exact)) < 1e-3
    both = np.isfinite(result.depth) & np.isfinite(exact)
    assert both.sum() > 5000 and np.percentile(abs(result.depth - exact)[both], 99) < 0.1


def test_the_mapper_keeps_labels_unless_it_is_given_a_rate():
    camera = orbit(reference_volume(progiso.compress(BALL)), 1, 4)
    scene = Scene(make_image(BALL), 0.5, camera, (64, 48))
    assert scene.mapper.GetKeepLabels() and scene.mapper.GetRate() == 8
    for rate, warned in ((None, 0), (8, 1)):
        if rate is not None:
            scene.mapper.SetRate(rate)
        assert scene.mapper.GetKeepLabels() == (rate is None)
        with vtk_messages() as messages:
            scene.render()
            scene.render()
        assert sum("Isovalue 0.5" in message for message in messages) == warned


# --- tolerance ------------------------------------------------------------------------------------


def test_tolerance_takes_the_least_rate():
    values = blobs((20, 22, 24), 3).T
    for tolerance in (0.1, 1e-3, decimal.Decimal("0.01")):
        for options in ({}, {"rate": "auto"}):
            volume = progiso.compress(values, tolerance=tolerance, **options)
            about = progiso.describe(volume)
            assert about["largest_error"] <= tolerance
            assert about["rate"] == progiso.least_rate(values, tolerance)
            slabs = progiso.compress_slabs(
                values.T, values.shape, tolerance=tolerance, name="values", **options
            )
            check_same(slabs, volume)
    assert progiso.contour(values, 0.1, tolerance=1e-3).GetNumberOfPolys() > 100


@pytest.mark.parametrize(
    "options, error, message",
    [
        ({"rate": "8"}, TypeError, "rate must be a number"),
        ({"rate": [8]}, TypeError, "rate must be a number"),
        ({"rate": 0}, ValueError, r"rate must be in \(0, 32\]"),
        ({"rate": float("nan")}, ValueError, r"rate must be in \(0, 32\]"),
        ({"rate": "auto"}, ValueError, "takes a tolerance"),
        ({"rate": 8, "tolerance": 0.1}, ValueError, "either a rate or a tolerance"),
        ({"tolerance": 0}, ValueError, "tolerance must be a number above 0"),
        ({"tolerance": "0.1"}, ValueError, "tolerance must be a number above 0"),
        ({"tolerance": 1e-30}, ValueError, "no rate keeps the samples within 1e-30"),
    ],
)
def test_rates_and_tolerances_are_checked(options, error, message):
    values = noise((6, 7, 8), 1)
    for compress in (
        lambda: progiso.compress(values, **options),
        lambda: progiso.compress_slabs(values, values.shape[::-1], **options),
        lambda: progiso.render(values, 0, **options),
    ):
        with pytest.raises(error, match=message):
            compress()


# --- errors, and what they mean for an isovalue ---------------------------------------------------


@pytest.mark.parametrize("rate", [2, 8, 20, 32])
@pytest.mark.parametrize("kind", ["u1", "i2", "f4", "f8"])
def test_errors_are_those_of_the_samples(kind, rate):
    values = (100 + 30 * noise((13, 18, 21), 1)).clip(0, 255).astype(kind)
    hidden = noise((13, 18, 21), 2) > 1
    for array in (values, np.ma.MaskedArray(values, hidden), 1e6 + values.astype(float) / 256):
        volume = progiso.compress(array.T, rate=rate)
        about = progiso.describe(volume)
        errors = np.abs(decoded(volume).astype(float) - np.ma.getdata(array).T.astype(float))
        assert about["largest_error"] == pytest.approx(np.nanmax(errors), rel=1e-6, abs=1e-12)
        assert about["mean_error"] == pytest.approx(np.nanmean(errors), rel=1e-3, abs=1e-12)
        slabs = progiso.describe(progiso.compress_slabs(array, array.shape[::-1], rate=rate))
        assert slabs["largest_error"] == about["largest_error"]
        assert slabs["mean_error"] == about["mean_error"]


DOUBTFUL = [0.5, 1, 4000, 3999.5, -0.5, 0, [2000, 0.5]]


@pytest.mark.parametrize("isovalue", DOUBTFUL)
@pytest.mark.parametrize("case", ["mask of 4000", "mask of doubles"])
def test_one_warning_where_the_error_is_larger_than_the_distance(case, isovalue):
    """The rate that it names keeps every sample on its side, and is not warned of."""
    labels = LABELS[case]
    volume = progiso.compress(labels, rate=8)
    with pytest.warns(UserWarning, match="Isovalue.* may show another surface") as caught:
        progiso.contour(volume, isovalue)
    assert len(caught) == 1 and caught[0].filename == __file__
    rate = float(str(caught[0].message).split("Compress at ")[1].split()[0])
    again = progiso.compress(labels, rate=rate)
    assert doubts(again, isovalue) is None
    value = np.min(isovalue)
    assert ((decoded(again) > value) == (labels > value)).all()


def test_everyone_warns_once():
    mesh = pytest.importorskip("pyvista")
    plotter = mesh.Plotter(off_screen=True)
    for use in (
        lambda: progiso.render(BALL, 0.5, rate=8, size=(64, 48)),
        lambda: progiso.contour(BALL, 0.5, rate=8),
        lambda: plotter.progiso.add_isosurface(BALL, 0.5, rate=8),
        lambda: progiso.make_isosurface(progiso.compress(BALL, rate=8), 0.5),
    ):
        with pytest.warns(UserWarning, match="Isovalue 0.5 may show") as caught:
            use()
        assert len(caught) == 1 and caught[0].filename == __file__


FINE = {
    "ball": (R, 12, 8),
    "marschner-lobb": (marschner_lobb(41), 0.5, 2),
    "blobs": (blobs((40, 44, 48), 1), 0.1, 4),
    "noise": (noise((40, 44, 48), 1), 0.1, 8),
    "middle of a mask": (BALL, 2000, 8),
    "edge with noise": (OTHERS["an edge with noise"], 0, 8),
    "ramp": (np.arange(16.0)[:, np.newaxis, np.newaxis] + np.zeros((16, 16, 16)), 7.5, 4),
    "outside": (BALL, 1e6, 8),
}


@pytest.mark.parametrize("case", FINE)
def test_nothing_is_said_of_smooth_fields(case):
    values, isovalue, rate = FINE[case]
    assert doubts(progiso.compress(values, rate=rate), isovalue) is None


def test_errors_pass_through_files_and_pieces(tmp_path):
    volume = progiso.compress(BALL, rate=8)
    progiso.save(volume, tmp_path / "ball.vti")
    again = progiso.read(tmp_path / "ball.vti")
    for key in ("largest_error", "mean_error"):
        assert progiso.describe(again)[key] == progiso.describe(volume)[key] > 0
    assert doubts(again, 0.5) == doubts(volume, 0.5)
    read = progiso.vtkCompressedVolume()
    assert read.Read(volume)
    read.Crop((5, 22, 5, 31, 0, 17))
    assert read.DescribeDoubts(numpy_to_vtk(np.array([0.5]), deep=True))
    progiso.save(volume, tmp_path / "ball.zfp")
    assert progiso.describe(progiso.read(tmp_path / "ball.zfp"))["largest_error"] is None


# --- numbers and arrays as users have them --------------------------------------------------------


@pytest.mark.parametrize(
    "isovalue",
    [6, np.array(6), np.float32(6), decimal.Decimal(6), np.array([6]), (np.array(6),), [6.0]],
)
def test_isovalues_of_any_kind_of_number(isovalue):
    prop = progiso.make_isosurface(R, isovalue)
    assert prop.GetProperty().GetIsoSurfaceValues().GetValue(0) == 6
    assert progiso.contour(R, isovalue).GetNumberOfPolys() > 100


def test_isovalues_of_xarray():
    xarray = pytest.importorskip("xarray")
    mean = xarray.DataArray(R).mean()
    assert progiso.contour(R, mean).GetNumberOfPolys() > 100


@pytest.mark.parametrize("isovalue", ["6", b"6", None, 1j, np.array(1j), np.array("6"), [[6]]])
def test_what_is_no_isovalue(isovalue):
    for use in (progiso.make_isosurface, progiso.contour):
        with pytest.raises((TypeError, ValueError), match="isovalue must be a finite number, got"):
            use(R, isovalue)


def test_arrays_are_asked_for_by_name_or_themselves():
    image = make_image(R, "radius")
    other = numpy_to_vtk((20 - R).ravel(), deep=True)
    other.SetName("other")
    image.GetPointData().AddArray(other)
    texts = vtkStringArray()
    texts.SetName("texts")
    texts.SetNumberOfValues(R.size)
    image.GetPointData().AddArray(texts)
    expected = progiso.compress(image, array="other", rate=8)
    assert progiso.describe(expected)["range"][1] == pytest.approx((20 - R).max())
    check_same(progiso.compress(image, array=other, rate=8), expected)
    check_same(progiso.compress(image, array=vtk_to_numpy(other), rate=8), expected)
    foreign = progiso.compress(image, array=(20 - R).ravel(), rate=8)
    assert samples_of(progiso.decompress(foreign)).tolist() == decoded(expected).T.tolist()
    for wanted, error, message in (
        ("none", ValueError, "no array 'none'; it has: 'radius', 'other'$"),
        ("texts", ValueError, "no numbers in array 'texts'; it has: 'radius', 'other'$"),
        (R.ravel()[:9], ValueError, "has 9 values, the image 32768 points and 29791 cells"),
        (6, TypeError, "an array's name or the array itself is wanted, got 6"),
    ):
        with pytest.raises(error, match=message):
            progiso.compress(image, array=wanted)


def test_scalars_as_pyvista_takes_them():
    pyvista = pytest.importorskip("pyvista")
    image = pyvista.wrap(np.asfortranarray(R))
    image["other"] = 20 - image["values"]
    expected = image.progiso.compress(scalars="other", rate=8)
    check_same(image.progiso.compress(scalars=image["other"], rate=8), expected)
    plotter = pyvista.Plotter(off_screen=True)
    prop = plotter.progiso.add_isosurface(image, np.array(8), scalars=image["other"])
    assert progiso.describe(prop.GetMapper().GetInput())["array"] == "other"
    for options, error, message in (
        ({"clim": [1]}, ValueError, "clim must be"),
        ({"clim": "ab"}, TypeError, "clim must be"),
        ({"clim": [2, 1]}, ValueError, "clim must be"),
        ({"rate": "8"}, TypeError, "rate must be"),
    ):
        with pytest.raises(error, match=message):
            plotter.progiso.add_isosurface(image, [8, 9], **options)
    for arguments, error in (
        ((None,), TypeError),
        (((0, 0, 0),), ValueError),
        (((1, 0),), ValueError),
        (("",), ValueError),
        (("x", (0, np.nan, 0)), ValueError),
    ):
        with pytest.raises(error, match="normal must|origin must"):
            plotter.progiso.clip(prop, *arguments)
    with pytest.raises(ValueError, match="rng must be"):
        plotter.progiso.add_isosurface_slider(image, rng=(3, 2))
