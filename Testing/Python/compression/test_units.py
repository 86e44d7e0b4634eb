"""Streams in units of their own, where float32 cannot hold the samples.

Whoever reads them reads the samples. See also test_filters.py and the rows of test_verify.py.
"""

import ast
import re
import warnings

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

import progiso
from helpers.images import (
    blobs,
    check_same,
    make_image,
    metadata,
    reference_volume,
    samples_of,
    stream_of,
)
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, orbit
from progiso import vtkCompressedVolume, vtkCompressedVolumeBuilder
from progiso.io.slabs import units_of
from progiso.measure import tolerances

OFFSET, SCALE = 1e6, 2.0**-10
SHAPE = (20, 24, 28)
FIELD = np.round(blobs(SHAPE, 3).astype(float) * 2**20) / 2**20  # exact also beside the offset
SIZE = (120, 90)


@pytest.fixture(scope="module")
def plain():
    return progiso.compress(make_image(FIELD.astype(np.float32)), rate=32)


@pytest.fixture(scope="module")
def shifted():
    """Add a value so large that float32 would leave nothing of the field."""
    image = progiso.compress(make_image(OFFSET + SCALE * FIELD), rate=32)
    assert progiso.describe(image)["offset"] != 0
    return image


def isovalue_of(isovalue):
    return OFFSET + SCALE * isovalue


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_hits(plain, shifted, settings):
    """A hit is where the plain field's is, and has the isovalue in the samples' units."""
    camera = orbit(reference_volume(plain), 1, 4)
    scenes = [
        Scene(image, at, camera, SIZE, **settings)
        for image, at in ((plain, 0.1), (shifted, isovalue_of(0.1)))
    ]
    depths = [scene.depth() for scene in scenes]
    hit = np.isfinite(depths[0])
    assert hit.sum() > 1000 and np.mean(hit != np.isfinite(depths[1])) < 1e-3
    both = hit & np.isfinite(depths[1])
    assert np.abs(depths[0][both] - depths[1][both]).max() < tolerances.UNITS_DEPTH
    row, column = np.argwhere(both)[len(np.argwhere(both)) // 2]
    position, isovalue = [0.0] * 3, reference(0.0)
    assert scenes[1].mapper.GetHit(int(column), int(SIZE[1] - 1 - row), position, isovalue)
    assert float(isovalue) == pytest.approx(isovalue_of(0.1), abs=1e-9 * SCALE)


def test_colours(plain, shifted):
    """Also the volume that gives the colours may have units."""
    pictures = []
    for image, low, high in ((plain, -1, 1), (shifted, isovalue_of(-1), isovalue_of(1))):
        colors = vtkColorTransferFunction()
        colors.AddRGBPoint(low, 0, 0, 1)
        colors.AddRGBPoint(high, 1, 0, 0)
        scene = Scene(
            plain,
            0.1,
            orbit(reference_volume(plain), 1, 4),
            SIZE,
            ColorInputData=image,
            ColorLookupTable=colors,
        )
        scene.render()
        pictures.append(scene.picture().astype(int))
    assert len(np.unique(pictures[0].reshape(-1, 3), axis=0)) > 1
    assert np.abs(pictures[0] - pictures[1]).max() <= 2


def test_contour(plain, shifted):
    """The mesh is the same; its scalars are the isovalue, its gradients those of the samples."""
    meshes = [
        progiso.contour(image, at, gradients=True)
        for image, at in ((plain, 0.1), (shifted, isovalue_of(0.1)))
    ]
    points = [vtk_to_numpy(mesh.GetPoints().GetData()) for mesh in meshes]
    assert len(points[0]) == len(points[1]) > 100
    assert np.abs(points[0] - points[1]).max() < tolerances.UNITS_DEPTH
    assert (
        vtk_to_numpy(meshes[1].GetPointData().GetScalars()) == np.float32(isovalue_of(0.1))
    ).all()
    gradients = [vtk_to_numpy(mesh.GetPointData().GetArray("Gradients")) for mesh in meshes]
    assert np.abs(gradients[0] - gradients[1] / SCALE).max() < tolerances.UNITS_DEPTH


def test_builder(shifted):
    """Given the units that the filter finds, it makes the filter's stream."""
    about = progiso.describe(shifted)
    builder = vtkCompressedVolumeBuilder()
    builder.SetOffset(about["offset"])
    builder.SetScale(about["scale"])
    assert builder.Start(SHAPE[::-1], 32)
    for z in range(0, SHAPE[0], 4):
        assert builder.AddSlab(numpy_to_vtk((OFFSET + SCALE * FIELD)[z : z + 4].ravel(), deep=True))
    image = vtkImageData()
    assert builder.Finish(image)
    assert (
        stream_of(image) == stream_of(shifted)
        and progiso.describe(image)["range"] == about["range"]
    )


def test_slabs(shifted):
    """Given the units, slabs and slices make the filter's stream."""
    about = progiso.describe(shifted)
    values, units = OFFSET + SCALE * FIELD, (about["offset"], about["scale"])
    for slabs in (iter(values), lambda z: values[z]):
        image = progiso.compress_slabs(slabs, SHAPE[::-1], rate=32, units=units)
        assert stream_of(image) == stream_of(shifted)
    with pytest.raises(RuntimeError, match="scale"):
        progiso.compress_slabs(iter(values), SHAPE[::-1], units=(0, -1))


R = np.sqrt(((np.mgrid[0:21, 0:18, 0:16] - 8.5) ** 2).sum(0))  # [z, y, x]
BEYOND_FLOAT = {
    "pressure": 101325 + 1e-4 * R,
    "1e8": 1e8 + 1e-3 * R,
    "1e300": 1e300 * R,
    "denormal": 1e-42 * R,
    "denormal doubles": 1e-310 * R,
    "small float32": (1e-33 * R**4).astype(np.float32),
    "ids of 2^27": (2**27 + R).astype(np.int32),
    "ids of 2^24": (2**24 + R).astype(np.uint32),
    "ids of 2^60": (2**60 + (R * 1000).astype(np.int64)),
    "long double": (1e8 + 1e-3 * R).astype(np.longdouble),
    "constant": np.full(R.shape, 0.1),
    "big-endian": (101325 + 1e-4 * R).astype(">f8"),
}


@pytest.mark.parametrize("case", BEYOND_FLOAT)
def test_slabs_choose_the_units_of_compress(case):
    """Also from slices, slabs of any depth, a function, and a whole array."""
    values = BEYOND_FLOAT[case]
    expected = progiso.compress(values.T, rate=16)
    about = progiso.describe(expected)
    assert (about["offset"], about["scale"]) != (0, 1)
    for slabs in (values, [values[:3], values[3:]], lambda z: values[z]):
        check_same(progiso.compress_slabs(slabs, R.shape[::-1], rate=16, name="values"), expected)
        assert units_of(values[z] for z in range(len(R))) == (about["offset"], about["scale"])


@pytest.mark.parametrize("case", sorted(set(BEYOND_FLOAT) - {"constant"}))
def test_slabs_that_come_once_say_what_they_lack(case):
    """The units of the warning, or of the error, are those that hold the values."""
    values = BEYOND_FLOAT[case]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            progiso.compress_slabs(iter(values), R.shape[::-1], rate=16)
            (message,) = [str(warning.message) for warning in caught]
        except RuntimeError as error:
            message = str(error)
    units = ast.literal_eval(re.search(r"units=(\(.*?\))", message).group(1))
    if case == "1e300":  # told as soon as one value is infinite, when others are still to come
        assert units[1] > 1e298
        return
    again = progiso.compress_slabs(iter(values), R.shape[::-1], rate=16, units=units)
    assert stream_of(again) == stream_of(progiso.compress(values.T, rate=16))


HELD = {
    "float32": (R.astype(np.float32), 1),
    "uint16": (R.astype(np.uint16), 1),
    "truth values": (R < 8, 1),
    "ids from 0": (R.astype(np.int64) * 2**30, 1),
    "doubles": (R, 21),
}


@pytest.mark.parametrize("case", HELD)
def test_as_few_slabs_are_asked_for_as_settle_the_units(case):
    values, needed = HELD[case]
    asked = []
    assert units_of(asked.append(z) or values[z] for z in range(len(values))) == (0, 1)
    assert len(asked) == needed
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        progiso.compress_slabs(iter(values), R.shape[::-1], rate=4)


def test_units_do_not_depend_on_what_is_hidden():
    values = np.ma.masked_less(101325 + 1e-4 * R, 101325.0005)
    values.data[values.mask] = -9999
    offset, scale = units_of(values)
    assert (offset, scale) == units_of(values.filled(np.nan)) and offset > 101325 and scale == 1
    assert units_of([np.full((4, 4), np.nan)]) == (0, 1)
    with pytest.raises(RuntimeError, match="Component is 2"):
        units_of(values, component=2)


@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan"), float("inf")])
def test_builder_refuses_no_units(scale):
    builder = vtkCompressedVolumeBuilder()
    builder.SetScale(scale)
    assert not builder.Start((4, 4, 4), 8) and "scale" in builder.GetErrorMessage()


def test_files(shifted, tmp_path):
    """A .vti keeps the units; a .zfp file cannot, and says so."""
    progiso.save(shifted, tmp_path / "shifted.vti")
    again = progiso.read(tmp_path / "shifted.vti")
    assert np.array_equal(
        samples_of(progiso.decompress(again)), samples_of(progiso.decompress(shifted))
    )
    with pytest.raises(RuntimeError, match="units"):
        progiso.save(shifted, tmp_path / "shifted.zfp")


BAD_UNITS = {
    "Scale": (0.0, -1.0, float("nan"), float("inf")),
    "Offset": (float("nan"), float("-inf")),
}


@pytest.mark.parametrize(
    "name, value", [(name, value) for name, values in BAD_UNITS.items() for value in values]
)
def test_bad_units_are_refused(shifted, name, value):
    image = vtkImageData()
    image.DeepCopy(shifted)
    metadata(image, name)[:] = value
    volume = vtkCompressedVolume()
    assert not volume.Read(image) and f"ProgIso.ZFP.{name} is not" in volume.GetErrorMessage()
    scene = Scene(image, 0.1, orbit(reference_volume(shifted), 1, 4), (32, 32))
    with vtk_messages() as messages:
        scene.window.Render()
    assert sum("vtkProgressiveIsosurfaceMapper" in message for message in messages) == 1
