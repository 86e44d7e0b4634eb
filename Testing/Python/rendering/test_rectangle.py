"""An image is the rectangle that the volume covers in the viewport, and costs what this costs."""

import time

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkHardwareSelector

import progiso
from helpers.comparison import NESTED, OPAQUE, ComparisonScene, picture_of
from helpers.geometry import ball
from helpers.gl_hooks import STORAGE_BUFFER, intercepted
from helpers.images import blobs, make_image, marschner_lobb, noise
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, check_scene, least_budget
from progiso.oracle.caster import Camera

CENTRE = np.array((12.0, 12.0, 12.0))
WIDTH, HEIGHT = SIZE = (160, 120)


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((25, 25, 25), 6)), rate=8)


def camera(*aside, distance=200.0, **settings):
    """Return a camera that looks along -z, `aside` voxels beside the volume's centre."""
    focus = CENTRE + (*aside, 0)
    return Camera(tuple(focus + (0, 0, distance)), tuple(focus), **settings)


def pixels(scene):
    """Return for how many pixels there is room."""
    return scene.statistics()["memory"]["buffers"].get("hits", 0) // 8


VIEWS = {
    "far": camera(0, 0, distance=400),
    "in a corner": camera(52, -36),
    "cut off to the left": camera(68, 0),
    "cut off at a corner": camera(-66, 48),
    "from the side": Camera((30.0, 12.0, 12.0), (29.0, 12.0, 13.0), view_angle=80),
    "within": Camera((12.0, 12.0, 9.0), (12.0, 12.0, 0.0), view_angle=80),
    "parallel": camera(70, 50, parallel_scale=80),
}


@pytest.mark.parametrize("settings", [{}, CACHED])
@pytest.mark.parametrize("name", VIEWS)
def test_depths(image, name, settings):
    """Wherever the volume is in the window, depths of all pixels are those of the caster."""
    # of few pixels many are at silhouettes
    scene = check_scene(image, 0.1, VIEWS[name], SIZE, grazing=0.3, **settings)
    found = np.isfinite(progiso.depth(scene.mapper)).sum()
    assert 30 < found <= pixels(scene) <= WIDTH * HEIGHT
    # an image of a quarter of the window, or more, has room for all of it
    assert (pixels(scene) == WIDTH * HEIGHT) == (name in ("within", "from the side"))
    assert scene.mapper.GetCompletedFraction() == 1


def test_the_rectangle_is_the_volumes(image):
    """Seen from ahead, a volume takes a pixel beside its own on each side."""
    scene = Scene(image, 0.1, camera(0, 0, distance=112.0, view_angle=60.0), SIZE)
    scene.render()
    # the nearest side is 24 wide and 100 away; a pixel is 2 * tan(30°) / 120 of the distance
    side = 24 / 100 * HEIGHT / (2 * np.tan(np.radians(30)))
    assert np.floor(side) ** 2 < pixels(scene) <= (side + 3) ** 2


def test_the_smallest_cache_serves_a_rectangle_beside_the_corner():
    """Where there is no room for all rays, those of a window of pixels are cast.

    They are in the order of the rectangle's tiles, wherever in the viewport it begins.
    """
    image = progiso.compress(make_image(noise((120, 120, 120))), rate=8)
    aside = np.array(image.GetCenter()) + (-90, -60, 0)
    eye = Camera(tuple(aside + (0, 0, 260)), tuple(aside))
    scene = Scene(image, 3.0, eye, SIZE)
    expected = scene.depth()
    rows, columns = np.nonzero(np.isfinite(expected))
    assert columns.min() > 80 and rows.max() < 80
    least = least_budget(image, 3.0, eye, SIZE)
    scene = Scene(image, 3.0, eye, SIZE, MemoryBudget=least, **CACHED)
    assert scene.depth().tobytes() == expected.tobytes()
    active = [p["active_rays"] for p in scene.statistics()["passes"]]
    assert 0 < active[3] < active[2] / 2  # two passes were refused blocks


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_pictures_and_picks(image, surfaces):
    """Pictures, picked places and selected cells are where depths are, with geometry before and
    behind; what is beside the volume stays."""
    scene, empty = ComparisonScene(ours=True), ComparisonScene(ours=True)
    for each in (scene, empty):
        each.clipping_range = 50, 500
        each.renderer.AddActor(ball(5, centre=(4, 12, 30)))
        each.renderer.AddActor(ball(40, centre=(60, 12, -60)))
        each.camera.SetPosition(60, 40, 200)
        each.camera.SetFocalPoint(60, 40, 12)
    scene.add(image, surfaces)
    picture, background = scene.picture(), empty.picture()
    hit = np.isfinite(progiso.depth(scene.mapper))
    assert 100 < hit.sum() < 0.2 * hit.size
    changed = (picture != background).any(axis=2)
    assert changed.sum() > 50 and not changed[~hit].any()
    rows, columns = np.indices(hit.shape).reshape(2, -1)[:, ::7]
    found = []
    for row, column in zip(rows, columns):
        position, isovalue = [0.0] * 3, reference(0.0)
        y = hit.shape[0] - 1 - int(row)
        found.append(scene.mapper.GetHit(int(column), y, position, isovalue))
        assert not found[-1] or isovalue.get() in [pytest.approx(value) for value in surfaces]
    assert np.array_equal(found, hit[rows, columns])
    selector = vtkHardwareSelector()
    selector.SetRenderer(scene.renderer)
    selector.SetArea(0, 0, hit.shape[1] - 1, hit.shape[0] - 1)
    selector.SetFieldAssociation(vtkDataObject.FIELD_ASSOCIATION_CELLS)
    selection = selector.Select()
    assert selection.GetNumberOfNodes() == 3
    assert np.array_equal(scene.picture(), picture)


class Calls:
    """Counts what is asked of the GPU."""

    def __init__(self):
        self.dispatches, self.buffers = 0, []

    def dispatch(self, original, *arguments):
        self.dispatches += 1
        original(*arguments)

    def make(self, original, target, size, data, usage):
        if target == STORAGE_BUFFER:
            self.buffers.append(size)
        original(target, size, data, usage)

    def counted(self, render):
        """Count what a render does."""
        with (
            intercepted("glDispatchCompute", self.dispatch),
            intercepted("glDispatchComputeIndirect", self.dispatch),
            intercepted("glBufferData", self.make),
        ):
            render()
        return self


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_out_of_sight(image, settings):
    """A volume out of sight costs nothing, before it was in sight and after.

    Its image is complete, without hits; back in sight it is what it was.
    """
    scene = Scene(image, 0.1, camera(300, 0), SIZE, **settings)
    scene.renderer.GetCullers().RemoveAllItems()  # VTK would not even ask the mapper
    scene.window.Initialize()
    calls = Calls().counted(scene.render)
    assert calls.dispatches == 0
    assert not {"hits", "macrocells", "compressed", "cache_values"} & {
        *scene.statistics()["memory"]["buffers"]
    }

    def check_nothing():
        assert scene.mapper.GetConverged() and scene.mapper.GetCompletedFraction() == 1
        assert scene.statistics()["passes"] == [] and scene.statistics()["converged"]
        depth = progiso.depth(scene.mapper)
        assert depth.shape == (HEIGHT, WIDTH) and np.isinf(depth).all()
        assert not scene.mapper.GetHit(80, 60, [0.0] * 3, reference(0.0))
        assert np.ptp(picture_of(scene.window).reshape(-1, 3), axis=0).max() == 0

    check_nothing()
    scene.camera = camera(0, 0)
    expected = Scene(image, 0.1, camera(0, 0), SIZE).depth()
    assert np.isfinite(expected).any()
    assert scene.depth().tobytes() == expected.tobytes()
    scene.camera = camera(0, 300)
    calls = Calls().counted(scene.render)
    assert calls.dispatches == 0 and not calls.buffers
    check_nothing()
    scene.mapper.SetDecodeWholeVolume(not scene.mapper.GetDecodeWholeVolume())
    assert Calls().counted(scene.render).dispatches == 0
    scene.camera = camera(0, 0)
    assert scene.depth().tobytes() == expected.tobytes()


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_a_movement_makes_few_buffers(image, settings):
    """In a dolly the rectangle changes with each frame.

    Buffers grow in steps, and shrink only after a pause; what they hold is in the statistics.
    """
    scene = Scene(image, 0.1, camera(0, 0, distance=1500), (320, 240), **settings)
    scene.render()
    first, held, calls = pixels(scene), [], Calls()

    def dolly(factor):
        scene.renderer.GetActiveCamera().Dolly(factor)
        scene.render()
        held.append(pixels(scene))

    for _ in range(40):
        calls.counted(lambda: dolly(1.1))
    assert held == sorted(held) and held[-1] > 100 * first
    assert held[-1] <= 320 * 240
    steps = len(set(held))
    assert 8 < steps <= 13 and len(calls.buffers) <= (2 if settings else 1) * steps
    for _ in range(40):
        dolly(1 / 1.1)
    assert set(held[40:]) == {held[39]}
    small = scene.depth()
    time.sleep(2.1)
    scene.renderer.GetActiveCamera().Azimuth(1)
    scene.render()
    assert pixels(scene) < 4 * first
    scene.renderer.GetActiveCamera().Azimuth(-1)
    again = scene.depth()
    assert np.isfinite(again).sum() == pytest.approx(np.isfinite(small).sum(), abs=3)


def test_the_budget_is_that_of_the_viewport(image):
    """A budget that suffices for a small rectangle suffices for a large one."""
    far, near = camera(0, 0, distance=1000), camera(0, 0, distance=30)
    least = least_budget(image, 0.1, near, SIZE, **CACHED)
    assert least == least_budget(image, 0.1, far, SIZE, **CACHED)
    expected = Scene(image, 0.1, near, SIZE).depth()
    scene = Scene(image, 0.1, far, SIZE, lit=True, MemoryBudget=least, **CACHED)
    slots = []
    for distance in np.geomspace(1000, 30, 20):
        scene.camera = camera(0, 0, distance=distance)
        with vtk_messages() as messages:
            depth = scene.depth()
        memory = scene.statistics()["memory"]
        assert not messages and memory["least_budget"] == least
        assert memory["total"] - memory["compressed"] <= least
        slots.append(memory["buffers"]["cache_values"])
    assert np.isfinite(expected).mean() > 0.3 and slots == sorted(slots)
    assert np.isfinite(depth).sum() == np.isfinite(expected).sum()


def test_many_small_volumes():
    """50 volumes have as much memory, and rays, as what they cover, not as 50 windows have."""
    small = progiso.compress(make_image(marschner_lobb(17)), rate=8)
    window, others = Scene(small, 0.5, Camera((130, 60, 400), (130, 60, 8)), (640, 360)), []
    for place in np.ndindex(5, 10):
        shift = np.eye(4)
        shift[:2, 3] = 28 * place[1], 28 * place[0]
        scene = Scene(small, 0.5, Camera((0, 0, 0), (0, 0, 1)), user_matrix=shift, **CACHED)
        window.renderer.AddVolume(scene.volume)
        others.append(scene)
    window.renderer.RemoveVolume(window.volume)
    window.renderer.ResetCameraClippingRange()
    window.window.Render()
    room = [pixels(scene) for scene in others]
    hits = sum(int(np.isfinite(progiso.depth(scene.mapper)).sum()) for scene in others)
    rays = [scene.statistics()["passes"][0]["active_rays"] for scene in others]
    assert len(room) == 50 and min(room) > 0
    assert sum(rays) <= sum(room) < 0.5 * 640 * 360
    assert hits > 0.2 * sum(room)


def test_rounding_of_the_camera_goes_on(image):
    """A camera that is the same but for rounding continues the image, wherever the edges of the
    rectangle fall."""
    # a pixel is a voxel, and the volume ends at pixels' centres
    scene = Scene(image, 0.1, camera(0.5, 0.5, parallel_scale=60.0), SIZE)
    expected, picture = scene.depth(), scene.picture()
    for step in range(-20, 20):
        scene.renderer.GetActiveCamera().SetParallelScale(60 * (1 + 1e-10 * step))
        assert Calls().counted(scene.window.Render).dispatches == 0
        assert progiso.depth(scene.mapper).tobytes() == expected.tobytes()
    assert np.array_equal(scene.picture(), picture)
