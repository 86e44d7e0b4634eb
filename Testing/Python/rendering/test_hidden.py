"""What is hidden, blanked points and cells and NaN, leaves clean holes; all else stays."""

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes
from vtkmodules.vtkRenderingCore import vtkLight

import progiso
from helpers.holes import (
    ISOVALUE,
    KINDS,
    SHAPE,
    SIZE,
    all_together,
    ball,
    blank,
    cells_of,
    hidden_points,
    nan_image,
    speckles,
)
from helpers.images import blobs, make_image, noise, reference_volume, samples_of
from helpers.layers import crossings_of, places
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, least_budget, orbit
from progiso.measure import tolerances
from progiso.oracle.caster import Camera


def check_depth(scene, image, hidden, isovalues=(ISOVALUE,)):
    """Hold depths against the caster's first crossing in a cell that is not hidden."""
    got = scene.depth()
    volume = reference_volume(image)
    crossings = crossings_of(volume, isovalues, scene.camera, SIZE, scene.clipping_range)
    cells = np.floor(places(crossings, volume, scene.camera, SIZE)).astype(int)
    x, y, z = np.clip(cells, 0, np.array(hidden.shape[::-1]) - 1).T
    seen = crossings.only(~hidden[z, y, x])
    expected = np.full(SIZE[0] * SIZE[1], np.inf)
    np.minimum.at(expected, seen.ray, seen.depth)
    expected = expected.reshape(got.shape)
    assert np.isfinite(expected).mean() > 0.05
    without = np.full(expected.size, np.inf)
    np.minimum.at(without, crossings.ray, crossings.depth)
    assert (expected != without.reshape(got.shape)).mean() > 0.02, "nothing that is seen is hidden"
    same = got == expected
    near = (
        np.abs(np.subtract(got, expected, out=np.zeros(got.shape), where=~same))
        <= tolerances.DEPTH_VOXELS
    )
    assert (~(same | near)).mean() <= tolerances.LAYERS_PIXELS
    return got


@pytest.mark.parametrize("make", KINDS)
def test_depths_are_the_casters(make):
    image, hidden = make()
    camera = orbit(reference_volume(image), 1, 4, distance=0.9)
    whole = check_depth(Scene(image, ISOVALUE, camera, SIZE), image, hidden)
    budget = least_budget(image, ISOVALUE, camera, SIZE, **CACHED)
    scene = Scene(image, ISOVALUE, camera, SIZE, lit=True, MemoryBudget=budget, **CACHED)
    assert np.array_equal(scene.depth(), whole)
    assert np.array_equal(scene.picture(), Scene(image, ISOVALUE, camera, SIZE, lit=True).picture())


def test_several_isovalues():
    image, hidden = all_together()
    scene = Scene(image, -0.2, orbit(reference_volume(image), 2, 4), SIZE)
    scene.volume.GetProperty().GetIsoSurfaceValues().SetValue(1, 0.3)
    check_depth(scene, image, hidden, (-0.2, 0.3))


def test_the_mapper_hides_what_its_plain_input_does():
    """It follows what changes there, too."""
    values = blobs(SHAPE, 3)
    image = blank(make_image(values), ball(SHAPE, 9))
    scene = Scene(
        image, ISOVALUE, orbit(reference_volume(progiso.compress(image)), 1, 4), SIZE, Rate=12
    )
    before = scene.depth()
    assert np.array_equal(
        before, Scene(progiso.compress(image, rate=12), ISOVALUE, scene.camera, SIZE).depth()
    )
    image.GetPointData().GetArray(vtkDataSetAttributes.GhostArrayName()).Fill(0)
    image.GetPointData().GetArray(vtkDataSetAttributes.GhostArrayName()).Modified()
    after = scene.depth()
    assert (after != before).any()
    assert np.array_equal(
        after,
        Scene(progiso.compress(make_image(values), rate=12), ISOVALUE, scene.camera, SIZE).depth(),
    )


def test_nan_is_hidden_or_an_error():
    hidden = ball(SHAPE, 9)
    image = nan_image(hidden, blobs(SHAPE, 3))
    scene = Scene(image, ISOVALUE, Camera((14, 14, 90), (14, 14, 12)), SIZE, Rate=12)
    compressed = progiso.compress(image, rate=12)
    check_depth(scene, compressed, cells_of(hidden))
    scene.mapper.MaskNonFiniteOff()
    with vtk_messages() as messages:
        scene.window.Render()
    assert (
        len(messages) == 1
        and f"{hidden.sum()} NaN" in messages[0]
        and "MaskNonFinite" in messages[0]
    )
    scene.mapper.MaskNonFiniteOn()
    check_depth(scene, compressed, cells_of(hidden))


@pytest.mark.parametrize("cached", [False, True])
@pytest.mark.parametrize("make", [speckles, lambda shape: ball(shape, 8)])
def test_light_at_the_border_of_a_hole(make, cached):
    """Differences of samples do not reach into what is hidden.

    A plane's light is that of the plane up to the border.
    """
    z, y, x = np.meshgrid(*[np.arange(n, dtype=np.float32) for n in SHAPE], indexing="ij")
    values = z + 0.4 * y + 0.3 * x
    hidden = make(SHAPE)
    images = (
        progiso.compress(make_image(values), rate=32),
        progiso.compress(blank(make_image(values), hidden), rate=32),
    )
    pictures = []
    for image in images:
        scene = Scene(
            image,
            20.3,
            Camera((14, 15, 80), (14, 15, 12), view_angle=25),
            SIZE,
            lit=True,
            DecodeWholeVolume=not cached,
        )
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(50, 90, 70)
        scene.renderer.AddLight(light)
        scene.volume.GetProperty().SetSpecular(0)
        scene.render()
        pictures.append(scene.picture().astype(int))
        depth = progiso.depth(scene.mapper)
    seen = np.isfinite(depth)
    plane = np.median(pictures[0][seen], axis=0)
    assert (
        0.1
        < seen.mean()
        < 0.9 * np.isfinite(Scene(images[0], 20.3, scene.camera, SIZE).depth()).mean() + 0.1
    )
    # at the volume's own border differences are one-sided, as in VTK's mapper, and of half the
    # slope
    inside = seen & (np.abs(pictures[0] - plane).max(axis=2) <= 1)
    assert inside.mean() > 0.1
    assert np.abs(pictures[1][inside] - plane).max() <= 1


def test_what_hiding_takes():
    """Hiding takes no memory where nothing is hidden; else the mask, and 16 bytes a slot."""
    image, _ = hidden_points()
    plain = progiso.compress(make_image(blobs(SHAPE, 3)), rate=12)
    camera = orbit(reference_volume(plain), 1, 4)
    memory = []
    for each in (plain, image):
        scene = Scene(each, ISOVALUE, camera, SIZE, **CACHED)
        scene.render()
        memory.append(scene.statistics()["memory"]["buffers"])
    assert "hidden_cells" not in memory[0]
    assert 0 < memory[1]["hidden_cells"] < 16 * np.prod([-(-n // 4) for n in SHAPE])
    assert memory[1]["cache_values"] * 256 == memory[0]["cache_values"] * 272


def test_all_of_it_hidden():
    """A volume that is hidden as a whole shows nothing, and is no error."""
    image = progiso.compress(make_image(np.full(SHAPE, np.nan, np.float32)), rate=8, mask_nan=True)
    assert progiso.describe(image)["range"] == [0, 0]
    assert not np.isfinite(Scene(image, 0, Camera((14, 14, 90), (14, 14, 12)), SIZE).depth()).any()
    assert np.isnan(samples_of(progiso.decompress(image))).all()


@pytest.mark.parametrize("cells", [False, True])
def test_the_default_array_is_no_ghost_array(cells):
    """Where no scalars are active the first array counts, in the filter and in the mapper."""
    image = make_image(noise((9, 9, 9)), cells=cells)
    data = image.GetCellData() if cells else image.GetPointData()
    values = data.GetScalars()
    data.RemoveArray("field")
    blank(image, cells=speckles((9, 9, 9))) if cells else blank(image, points=speckles((9, 9, 9)))
    data.AddArray(values)
    assert data.GetArrayName(0) == "vtkGhostType" and data.GetScalars() is None
    assert progiso.describe(progiso.compress(image))["array"] == "field"
    depth = Scene(image, 0.0, Camera((4, 4, 30), (4, 4, 4)), SIZE).depth()
    assert np.array_equal(
        depth, Scene(progiso.compress(image), 0.0, Camera((4, 4, 30), (4, 4, 4)), SIZE).depth()
    )
    assert np.isfinite(depth).any()
