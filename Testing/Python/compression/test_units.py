"""Streams in units of their own, where float32 cannot hold the samples.

Whoever reads them reads the samples. See also test_filters.py and the rows of test_verify.py.
"""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

import progiso
from helpers.images import blobs, make_image, metadata, reference_volume, samples_of, stream_of
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, orbit
from progiso import vtkCompressedVolume, vtkCompressedVolumeBuilder
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
