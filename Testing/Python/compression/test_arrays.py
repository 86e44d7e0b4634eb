"""NumPy arrays wherever an image is wanted, indexed [x, y, z] as pyvista takes them."""

import numpy as np
import pytest

import progiso
from helpers.images import blobs, make_image, reference_values, same_bits, samples_of

FIELD = blobs((9, 12, 14), 5)  # [z, y, x]


@pytest.fixture(scope="module")
def image():
    return make_image(FIELD, "values")


def test_compress(image):
    volume = progiso.compress(FIELD.T, rate=12)
    assert (
        volume.GetDimensions() == (14, 12, 9)
        and volume.GetSpacing() == (1, 1, 1)
        and volume.GetOrigin() == (0, 0, 0)
    )
    assert same_bits(reference_values(volume), reference_values(progiso.compress(image, rate=12)))
    assert progiso.describe(volume)["array"] == "values"


def test_as_pyvista_wraps_them():
    pyvista = pytest.importorskip("pyvista")
    array = np.ascontiguousarray(FIELD.T)
    wrapped = progiso.compress(pyvista.wrap(array), rate=12)
    assert same_bits(reference_values(progiso.compress(array, rate=12)), reference_values(wrapped))


@pytest.mark.parametrize("kind", ["?", "u1", "i2", ">i4", "f2", "<f4", ">f4", "f8", "g"])
def test_types(kind):
    """Take VTK's own types in either byte order, and those that VTK lacks: truth values, half and
    long double precision."""
    array = (10 * FIELD.T).astype(kind)
    expected = progiso.compress(make_image(array.T.astype(np.float32)), rate=32)
    assert same_bits(reference_values(progiso.compress(array, rate=32)), reference_values(expected))


def test_contour_render_and_save(image, tmp_path):
    array = FIELD.T
    of_array, of_image = (progiso.contour(volume, 0.1, rate=12) for volume in (array, image))
    assert of_array.GetNumberOfPolys() == of_image.GetNumberOfPolys() > 100
    assert progiso.contour(array, 0.1).GetNumberOfPolys() > 100
    of_array, of_image = (
        progiso.render(volume, 0.1, size=(64, 48)).image for volume in (array, image)
    )
    assert np.array_equal(of_array, of_image) and np.ptp(of_array) > 100
    assert (
        progiso.make_isosurface(array, 0.1).GetBounds()
        == progiso.make_isosurface(image, 0.1).GetBounds()
    )
    progiso.save(array, tmp_path / "array.vti")
    assert np.array_equal(samples_of(progiso.read(tmp_path / "array.vti")), FIELD)


@pytest.mark.parametrize(
    "wrong, message",
    [
        (FIELD[0], "3 dimensions, this one has 2"),
        (FIELD.astype(complex), "real numbers, this one has complex128"),
        (FIELD.tolist(), "got list"),
        ("volume.vti", "progiso.read makes an image of a file"),
    ],
)
def test_what_is_no_volume(wrong, message):
    for use in (
        progiso.compress,
        lambda volume: progiso.contour(volume, 0),
        lambda volume: progiso.render(volume, 0),
    ):
        with pytest.raises(TypeError, match=message):
            use(wrong)
