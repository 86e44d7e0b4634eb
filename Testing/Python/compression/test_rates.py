"""The least rate for a tolerance keeps it, and a bit less a block does not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from vtkmodules.util.numpy_support import vtk_to_numpy

import progiso
from helpers.images import blobs, make_image, marschner_lobb, noise, reference_values
from helpers.programs import call_progiso


def error_at(values, rate, **choice):
    """Return the largest error of a visible sample at a rate, by libzfp."""
    image = progiso.compress(make_image(values), rate=rate, **choice)
    about = progiso.describe(image)
    decoded = about["offset"] + about["scale"] * reference_values(image).astype(float)
    with np.errstate(invalid="ignore"):
        return float(
            np.nanmax(np.where(np.isfinite(values), np.abs(decoded - np.asarray(values, float)), 0))
        )


def check_least(values, tolerance, **options):
    """Find the rate, check that no neighbouring lower one would do, and return it."""
    rate = progiso.least_rate(make_image(values), tolerance, **options)
    assert rate * 64 == int(rate * 64) and 9 / 64 <= rate <= 32
    choice = {"mask_nan": options.get("mask_nan", True)}
    if options.get("relative"):
        tolerance *= float(np.ptp(values.astype(float)))
    assert error_at(values, rate, **choice) <= tolerance
    assert rate == 9 / 64 or error_at(values, rate - 1 / 64, **choice) > tolerance
    return rate


@given(
    shape=st.tuples(*[st.integers(2, 20)] * 3),
    kind=st.sampled_from(["u1", "i2", "u4", "f4", "f8"]),
    smooth=st.booleans(),
    seed=st.integers(0, 10**6),
    part=st.sampled_from([0.5, 0.1, 0.01, 1e-3, 1e-5]),
    relative=st.booleans(),
)
def test_random_fields(shape, kind, smooth, seed, part, relative):
    values = (blobs if smooth else noise)(shape, seed)
    values = (100 + 30 * values).clip(0, 255).astype(kind)
    spread = float(np.ptp(values.astype(float)))
    if relative and spread == 0:
        return
    check_least(values, part if relative else part * max(spread, 1.0), relative=relative)


def test_finer_takes_more():
    found = [
        check_least(marschner_lobb(41), tolerance) for tolerance in (0.5, 0.1, 0.01, 1e-3, 1e-5)
    ]
    assert found == sorted(found) and found[0] < 3 and found[-1] > 9


@pytest.mark.parametrize("depth", [4, 13, 32, 33, 47])
def test_partial_blocks(depth):
    """Also of a volume whose last slices are no whole blocks, and grow; progress rises."""
    values = (
        noise((depth, 11, 14), depth) * np.linspace(0.1, 3, depth, dtype=np.float32)[:, None, None]
    )
    fractions = []
    check_least(values, 0.01, progress=fractions.append)
    assert fractions == sorted(fractions) and fractions[-1] == 1


def test_array_and_component():
    values = np.stack([noise((9, 10, 11), 1), 100 * noise((9, 10, 11), 2)], axis=-1)
    for cells in (False, True):
        image = make_image(values, "pair", cells=cells)
        for component in (0, 1):
            expected = check_least(np.ascontiguousarray(values[..., component]), 0.5)
            assert progiso.least_rate(image, 0.5, array="pair", component=component) == expected


def test_the_lowest_rate_will_do():
    assert progiso.least_rate(make_image(np.zeros((5, 6, 7))), 1e-30) == 9 / 64


def test_small_differences_on_a_large_offset():
    """The volume's own units count, not those that a part of it would have."""
    values = 1e8 + noise((32, 12, 12)).astype(float) * np.linspace(1e-3, 1, 32)[:, None, None]
    assert progiso.describe(progiso.compress(make_image(values)))["offset"] != 0
    check_least(values, 1e-4)


def test_large_and_tiny_values():
    values = noise((32, 12, 12)).astype(float)
    for scale in (1e300, 1e-200):
        check_least(scale * values, 0.01 * scale)


@pytest.mark.parametrize("ghosts", [False, True])
def test_hidden_samples_do_not_count(ghosts):
    values = noise((12, 13, 14), 5)
    values[5, 6, 7], values[0, 0, 0], values[3, 3:9, 4] = np.nan, np.inf, -np.inf
    rate = check_least(values, 0.01)
    if ghosts:
        image = make_image(np.where(np.isfinite(values), values, 1e6).astype(np.float32))
        image.AllocatePointGhostArray()
        flags = vtk_to_numpy(image.GetPointGhostArray())
        flags[~np.isfinite(values).ravel()] = 2  # vtkDataSetAttributes::HIDDENPOINT
        assert progiso.least_rate(image, 0.01) == rate
    else:
        with pytest.raises(RuntimeError, match="NaN"):
            progiso.least_rate(make_image(values), 0.01, mask_nan=False)


# --- errors ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("tolerance", [0, -1, float("nan"), float("inf"), "much", None])
def test_tolerance_must_be_positive(tolerance):
    with pytest.raises(ValueError, match="tolerance must be a number above 0"):
        progiso.least_rate(make_image(noise((5, 5, 5))), tolerance)


def test_what_no_rate_keeps():
    """Differences that float32 does not have cannot be kept; the message says what can, and that
    works."""
    values = np.append(1e8 + noise((8, 8, 7)).astype(float), np.zeros((8, 8, 1)), axis=2)
    with pytest.raises(
        ValueError, match="no rate keeps the samples within 0.001: at 32 bits some are off by"
    ) as error:
        progiso.least_rate(make_image(values), 1e-3)
    check_least(values, float(str(error.value).split()[-1]) * 1.01)


@pytest.mark.parametrize(
    "image, options, error, message",
    [
        (make_image(np.full((5, 5, 5), 3.0)), {"relative": True}, ValueError, "all samples are 3"),
        (make_image(noise((5, 5, 5))), {"component": 1}, RuntimeError, "Component is 1"),
        (make_image(noise((5, 5, 5))), {"array": "none"}, ValueError, "no array 'none'"),
        (make_image(noise((1, 5, 5))), {}, RuntimeError, "5 x 5 x 1|5x5x1"),
        (
            progiso.compress(make_image(noise((5, 5, 5)))),
            {},
            RuntimeError,
            "is a compressed volume already",
        ),
        (None, {}, TypeError, "expected a vtkImageData"),
    ],
)
def test_errors_name_what_is_wrong(image, options, error, message):
    with pytest.raises(error, match=message):
        progiso.least_rate(image, 0.1, **options)


# --- the command line -----------------------------------------------------------------------------


def test_command_line(tmp_path):
    """`compress` takes what the command prints."""
    values = blobs((20, 22, 24), 3)
    values.tofile(tmp_path / "blobs_24x22x20_float32.raw")
    rate = call_progiso(
        tmp_path, "rate", "blobs_24x22x20_float32.raw", "--tolerance", 0.001
    ).strip()
    assert float(rate) == check_least(values, 0.001)
    call_progiso(tmp_path, "compress", "blobs_24x22x20_float32.raw", "blobs.vti", "--rate", rate)
    volume = progiso.read(tmp_path / "blobs.vti")
    assert progiso.describe(volume)["rate"] == float(rate)
    relative = call_progiso(
        tmp_path, "rate", "blobs_24x22x20_float32.raw", "--tolerance", 0.001, "--relative"
    ).strip()
    assert float(relative) == check_least(values, 0.001, relative=True)
    for options, message in (
        (("--tolerance", 0), "tolerance must be a number above 0"),
        (("--tolerance", 1e-12), "no rate keeps the samples"),
    ):
        assert message in call_progiso(
            tmp_path, "rate", "blobs_24x22x20_float32.raw", *options, succeeds=False
        )
    assert "--tolerance" in call_progiso(
        tmp_path, "rate", "blobs_24x22x20_float32.raw", succeeds=False
    )
