"""GIPL against SimpleITK, which writes it."""

import gzip

import numpy as np
import pytest

from progiso.io.formats import open_source

itk = pytest.importorskip("SimpleITK")


@pytest.mark.parametrize("suffix", [".gipl", ".gipl.gz"])
@pytest.mark.parametrize("kind", ["u1", "i1", "u2", "i2", "f4", "f8"])
def test_gipl(kind, suffix, tmp_path):
    values = np.random.default_rng(0).integers(0, 100, (4, 5, 6)).astype(kind)
    image = itk.GetImageFromArray(values)
    image.SetSpacing((1.5, 2.5, 3.5))
    image.SetOrigin((10, 20, 30))
    path = tmp_path / f"x{suffix}"
    itk.WriteImage(image, str(path))
    source = open_source(path)
    assert source.dtype == values.dtype and np.array_equal(source.read(), values)
    region = (slice(1, 3), slice(2, 4), slice(0, 5))
    assert np.array_equal(source.read(region), values[region])
    geometry = source.about.geometry
    assert np.array_equal(geometry.axes, np.diag([1.5, 2.5, 3.5]))
    assert np.array_equal(geometry.origin, [10, 20, 30]) and geometry.space == "LPS"


def test_bad_gipl(tmp_path):
    path = tmp_path / "x.gipl"
    itk.WriteImage(itk.GetImageFromArray(np.ones((4, 5, 6), "i2")), str(path))
    whole = bytearray(path.read_bytes())
    for content, words in (
        (whole[:-1], "truncated"),
        (whole[:100], "not a GIPL"),
        (gzip.compress(whole)[:-20], "truncated|damaged|ended"),
        (whole[:8] + b"\0\1" + whole[10:], "type 1"),
        (whole[:10] + b"\x7f\xc0\0\0" + whole[14:], "unusable"),
    ):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=f"x.gipl'.*({words})"):
            open_source(path).read()
