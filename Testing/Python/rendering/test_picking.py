"""Hits under the mouse: the mapper's, the picker's, and those of VTK's pickers and selector."""

import math

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPlane, vtkSelectionNode
from vtkmodules.vtkRenderingCore import (
    vtkCellPicker,
    vtkHardwareSelector,
    vtkPointPicker,
    vtkPropPicker,
    vtkRenderer,
    vtkWorldPointPicker,
)
from vtkmodules.vtkRenderingVolume import vtkVolumePicker

import progiso
from helpers.comparison import GREEN, NESTED, OPAQUE, RED, SIZE, ComparisonScene, show
from helpers.geometry import SHAPE, TURNED, ball, wall
from helpers.images import blobs, make_image, reference_volume
from helpers.layers import crossings_of, to_index
from progiso.oracle.caster import Camera

PIXELS = [(x, y) for x in range(3, SIZE[0], 13) for y in range(2, SIZE[1], 11)]


@pytest.fixture(scope="module")
def image():
    return progiso.compress(
        make_image(blobs(SHAPE, 12, waves=2), origin=(3, -4, 5), extent_start=(2, -7, 4)), rate=16
    )


def first_crossings(scene, image, surfaces, matrix=None):
    """Return the place and isovalue of the caster's first crossing, for each pixel from the bottom
    left."""
    camera, volume = Camera.from_vtk(scene.camera), reference_volume(image, matrix)
    crossings = crossings_of(
        volume, sorted(surfaces), camera, SIZE, scene.camera.GetClippingRange()
    )
    origins, directions = camera.rays(SIZE)
    found = {}
    for ray, depth, surface in zip(
        crossings.ray[::-1], crossings.depth[::-1], crossings.surface[::-1]
    ):
        pixel = ray % SIZE[0], SIZE[1] - 1 - ray // SIZE[0]
        found[pixel] = origins[ray] + depth * directions[ray], sorted(surfaces)[surface]
    return found


@pytest.mark.parametrize("surfaces", [OPAQUE, {v: (*look[:3], 1.0) for v, look in NESTED.items()}])
@pytest.mark.parametrize("matrix", [None, TURNED])
def test_hits_are_the_casters(image, surfaces, matrix):
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces, matrix=matrix)
    scene.render()
    expected = first_crossings(scene, image, surfaces, matrix)
    picker, places = progiso.vtkIsosurfacePicker(), 0
    for pixel in PIXELS:
        picked = picker.Pick(*pixel, 0, scene.renderer)
        assert picked == (pixel in expected) == (picker.GetVolume() is scene.volumes[0])
        if picked:
            place, isovalue = expected[pixel]
            assert np.abs(np.subtract(picker.GetPickPosition(), place)).max() < 1e-3
            assert picker.GetIsovalue() == pytest.approx(isovalue, abs=1e-12)
            places += 1
        else:
            assert math.isnan(picker.GetIsovalue()) and picker.GetViewProp() is None
    assert 20 < places < len(PIXELS) - 20


def test_the_first_layer_is_picked(image):
    """A translucent surface is picked where it is hit first."""
    scene = ComparisonScene(ours=True)
    show(scene, image, NESTED)
    scene.render()
    expected = first_crossings(scene, image, NESTED)
    picker = progiso.vtkIsosurfacePicker()
    for pixel in PIXELS:
        assert picker.Pick(*pixel, 0, scene.renderer) == (pixel in expected)
        if pixel in expected:
            assert np.abs(np.subtract(picker.GetPickPosition(), expected[pixel][0])).max() < 1e-3
            assert picker.GetIsovalue() == pytest.approx(expected[pixel][1], abs=1e-12)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_opaque_geometry_hides_from_the_picker(image, surfaces):
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces)
    free = scene.picture()
    scene.renderer.AddActor(wall(scene.camera, 0.3))
    hidden = scene.picture()
    picker, counts = progiso.vtkIsosurfacePicker(), [0, 0]
    for x, y in PIXELS:
        row = SIZE[1] - 1 - y
        behind_wall = not np.array_equal(hidden[row, x], free[row, x])
        picked = picker.Pick(x, y, 0, scene.renderer)
        assert not (picked and behind_wall)
        counts[behind_wall] += picked or behind_wall
    assert min(counts) > 20


def two_volumes(image):
    scene = ComparisonScene(ours=True)
    show(scene, image)
    shift = np.eye(4)
    shift[:3, 3] = 6, 4, 2
    scene.add(image, {0.1: (*RED, 1.0)}, matrix=shift)
    scene.render()
    return scene


def test_the_nearest_volume_is_picked(image):
    """Of two that overlap the nearer is picked, if it is pickable, visible and in the list."""
    scene = two_volumes(image)
    depths = [
        np.nan_to_num(progiso.depth(volume.GetMapper()), posinf=1e9)[::-1]
        for volume in scene.volumes
    ]
    picker, seen = progiso.vtkIsosurfacePicker(), set()
    for x, y in PIXELS:
        pair = [depth[y, x] for depth in depths]
        if abs(pair[0] - pair[1]) > 1e-2:
            assert (
                picker.Pick(x, y, 0, scene.renderer)
                and picker.GetVolume() is scene.volumes[int(np.argmin(pair))]
            )
            seen.add(int(np.argmin(pair)))
    assert seen == {0, 1}
    x, y = next((x, y) for x, y in PIXELS if depths[0][y, x] + 1e-2 < depths[1][y, x] < 1e9)
    front, back = scene.volumes
    front.PickableOff()
    assert not picker.Pick(x, y, 0, scene.renderer)  # it still hides what is behind
    back.PickableOff()
    front.PickableOn()
    assert picker.Pick(x, y, 0, scene.renderer) and picker.GetVolume() is front
    picker.PickFromListOn()
    assert not picker.Pick(x, y, 0, scene.renderer)
    picker.AddPickList(front)
    assert picker.Pick(x, y, 0, scene.renderer)
    front.VisibilityOff()
    scene.render()
    assert not picker.Pick(x, y, 0, scene.renderer)


def test_the_picker_keeps_to_its_renderer(image):
    """It picks in a viewport's own pixels, none outside, and nothing for a renderer that shows
    none."""
    scene = ComparisonScene(ours=True)
    show(scene, image)
    scene.renderer.SetViewport(0.5, 0, 1, 1)
    other = vtkRenderer()
    other.SetViewport(0, 0, 0.5, 1)
    scene.window.AddRenderer(other)
    scene.render()
    hits = np.isfinite(progiso.depth(scene.mapper))[::-1]
    picker = progiso.vtkIsosurfacePicker()
    for x, y in PIXELS:
        inside = x >= SIZE[0] // 2 and hits[y, x - SIZE[0] // 2]
        assert picker.Pick(x, y, 0, scene.renderer) == inside
        assert not picker.Pick(x, y, 0, other)
    assert hits[:, :].sum() > 1000


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_what_is_cut_away_is_not_picked(image, surfaces):
    """What shows behind a crop or a clip is picked."""
    scene = ComparisonScene(ours=True)
    mapper = show(scene, image, surfaces).GetMapper()
    whole = scene.picture() is not None and first_crossings(scene, image, surfaces)
    mapper.CroppingOn()
    bounds = image.GetBounds()
    mapper.SetCroppingRegionPlanes(
        bounds[0] + 9, bounds[1] + 1, bounds[2] - 1, bounds[3] + 1, bounds[4] - 1, bounds[5] + 1
    )
    mapper.SetCroppingRegionFlagsToSubVolume()
    plane = vtkPlane()
    plane.SetOrigin(image.GetCenter())
    plane.SetNormal(0, 0, -1)
    mapper.AddClippingPlane(plane)
    scene.render()
    picker, picked, others = progiso.vtkIsosurfacePicker(), 0, 0
    for pixel in PIXELS:
        if picker.Pick(*pixel, 0, scene.renderer):
            place = picker.GetPickPosition()
            assert place[0] > bounds[0] + 9 - 1e-3 and place[2] < image.GetCenter()[2] + 1e-3
            picked += 1
            others += np.abs(np.subtract(place, whole[pixel][0])).max() > 0.1
    assert picked > 10 and others > 3


def test_picking_is_told_of(image):
    scene = ComparisonScene(ours=True)
    show(scene, image)
    scene.render()
    picker, events = progiso.vtkIsosurfacePicker(), []
    for name in ("StartPickEvent", "PickEvent", "EndPickEvent"):
        picker.AddObserver(name, lambda _, event: events.append(event))
    rows, columns = np.nonzero(np.isfinite(progiso.depth(scene.mapper))[::-1])
    assert picker.Pick(int(columns[0]), int(rows[0]), 0, scene.renderer)
    assert events == ["StartPickEvent", "PickEvent", "EndPickEvent"]
    assert "Isovalue: 0.1" in str(picker)
    events.clear()
    assert not picker.Pick(0, 0, 0, scene.renderer)
    assert events == ["StartPickEvent", "EndPickEvent"]


# --- VTK's own ------------------------------------------------------------------------------------


def selector_of(scene, association, area=(0, 0, SIZE[0] - 1, SIZE[1] - 1)):
    selector = vtkHardwareSelector()
    selector.SetRenderer(scene.renderer)
    selector.SetArea(*area)
    selector.SetFieldAssociation(association)
    return selector


def select(scene, association, area):
    return selected_by(selector_of(scene, association, area).Select())


def selected_by(selection):
    found = {}
    for i in range(selection.GetNumberOfNodes()):
        node = selection.GetNode(i)
        ids = node.GetSelectionList()
        found[node.GetProperties().Get(vtkSelectionNode.PROP())] = {
            int(ids.GetValue(j)) for j in range(ids.GetNumberOfTuples())
        }
    return found


CELLS, POINTS = vtkDataObject.FIELD_ASSOCIATION_CELLS, vtkDataObject.FIELD_ASSOCIATION_POINTS


def check_selected(scene, image, expected, association, extent=None, matrix=None):
    """Each pixel has the cell of the image that holds the first hit, or the corner next to it."""
    volume = reference_volume(image, matrix)
    samples = np.array(vtk_extent(image)).reshape(3, 2)
    ids = np.array(extent or image.GetExtent()).reshape(3, 2)
    counts = np.ptp(ids, axis=1) + (association == POINTS)
    centred = progiso.describe(image)["association"] == "cell"
    selector = selector_of(scene, association)
    selector.CaptureBuffers()
    hits = 0
    for x, y in PIXELS:
        found = selected_by(selector.GenerateSelection(x, y, x, y))
        assert set(found) == ({scene.volumes[0]} if (x, y) in expected else set())
        if found:
            place = to_index(volume, expected[x, y][0][None])[0] + 0.5 * centred
            place += 0.5 * (association == POINTS)
            if np.abs(place - np.round(place)).min() > 1e-3:  # else it may as well be the next
                at = np.clip(place.astype(int) + samples[:, 0] - ids[:, 0], 0, counts - 1)
                assert found[scene.volumes[0]] == {
                    int(at[0] + counts[0] * (at[1] + counts[1] * at[2]))
                }
                hits += 1
    assert hits > 30


def vtk_extent(image):
    volume = progiso.vtkCompressedVolume()
    assert volume.Read(image)
    return volume.GetExtent()


@pytest.mark.parametrize("association", [CELLS, POINTS])
@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("matrix", [None, TURNED])
def test_the_selector_finds_cells_and_points(image, surfaces, matrix, association):
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces, matrix=matrix)
    scene.render()
    expected = first_crossings(scene, image, surfaces, matrix)
    check_selected(scene, image, expected, association, matrix=matrix)


@pytest.mark.parametrize("association", [CELLS, POINTS])
def test_the_selector_finds_what_cell_data_belong_to(association):
    image = progiso.compress(make_image(blobs(SHAPE, 12, waves=2), cells=True), rate=16)
    scene = ComparisonScene(ours=True)
    show(scene, image)
    scene.render()
    check_selected(scene, image, first_crossings(scene, image, OPAQUE), association)


@pytest.mark.parametrize("association", [CELLS, POINTS])
def test_the_selector_names_another_image(image, association):
    """Of a piece with other ghost cells, for a block of a composite data set, on a process."""
    scene = ComparisonScene(ours=True)
    show(scene, image)
    scene.render()
    low = image.GetExtent()[::2]
    extent = [low[0] - 2, 40, low[1] - 1, 50, low[2], 60]
    scene.mapper.SetSelectionExtent(extent)
    scene.mapper.SetCompositeIndex(7)
    expected = first_crossings(scene, image, OPAQUE)
    check_selected(scene, image, expected, association, extent)
    selector = selector_of(scene, association)
    selector.SetProcessID(3)
    properties = selector.Select().GetNode(0).GetProperties()
    assert properties.Get(vtkSelectionNode.COMPOSITE_INDEX()) == 7
    assert properties.Get(vtkSelectionNode.PROCESS_ID()) == 3


def test_the_selector_tells_props_apart(image):
    """Of two volumes and a sphere it finds the one in front."""
    scene = two_volumes(image)
    sphere = ball(9, centre=(10, 0, 15))
    scene.renderer.AddActor(sphere)
    picture = scene.picture()[::-1]
    owners = {}
    for x, y in PIXELS:
        found = set(select(scene, vtkDataObject.FIELD_ASSOCIATION_CELLS, (x, y, x, y)))
        color = picture[y, x]
        wanted = {0: {scene.volumes[0]}, 1: {scene.volumes[1]}, 2: {sphere}, 3: set()}
        colors = [255 * np.array(c) for c in (GREEN, RED, (1, 0.9, 0.3), (0.2, 0.3, 0.4))]
        owner = int(np.argmin([np.abs(color - c).max() for c in colors]))
        assert found == wanted[owner]
        owners[owner] = owners.get(owner, 0) + 1
    assert len(owners) == 4


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_the_picture_after_a_selection_is_the_same(image, surfaces):
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces)
    first = scene.picture()
    select(scene, vtkDataObject.FIELD_ASSOCIATION_CELLS, (10, 10, 100, 100))
    assert np.array_equal(scene.picture(), first)


def test_vtk_pickers(image):
    """vtkPropPicker finds the volume where it shows; vtkWorldPointPicker finds the place by the
    depth buffer."""
    scene = ComparisonScene(ours=True)
    show(scene, image)
    scene.render()
    expected = first_crossings(scene, image, OPAQUE)
    prop, world = vtkPropPicker(), vtkWorldPointPicker()
    for x, y in PIXELS[::2]:
        assert bool(prop.Pick(x, y, 0, scene.renderer)) == ((x, y) in expected)
        if (x, y) in expected:
            assert prop.GetVolume() is scene.volumes[0]
            world.Pick(x, y, 0, scene.renderer)
            assert np.abs(np.subtract(world.GetPickPosition(), expected[x, y][0])).max() < 0.3


@pytest.mark.parametrize("kind", [vtkCellPicker, vtkPointPicker, vtkVolumePicker])
def test_pickers_that_read_samples(image, kind):
    """They find no compressed volume, as it has no samples to read.

    Of a plain one VTK picks by opacities, not isovalues.
    """
    scene = ComparisonScene(ours=True)
    show(scene, image)
    assert scene.mapper.GetDataSetInput() is None and scene.mapper.GetInput() is image
    assert scene.mapper.GetBounds() == image.GetBounds() == scene.volumes[0].GetBounds()
    scene.render()
    picker = kind()
    rows, columns = np.nonzero(np.isfinite(progiso.depth(scene.mapper))[::-1])
    x, y = int(columns[len(columns) // 2]), int(rows[len(rows) // 2])
    picker.Pick(x, y, 0, scene.renderer)
    assert not (kind is not vtkPointPicker and picker.GetCellId() >= 0)
    plain = progiso.decompress(image)
    scene.mapper.SetInputData(plain)
    scene.render()
    assert scene.mapper.GetDataSetInput() is plain
    if kind is not vtkPointPicker:
        assert picker.Pick(x, y, 0, scene.renderer) and picker.GetVolume() is scene.volumes[0]
