"""Many mappers, volumes and windows: what they leave behind and share, and that none disturbs
another."""

import gc
import sys
import threading

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkRenderWindow

import progiso
from helpers.comparison import BLUE, GREEN, NESTED, OPAQUE, RED, ComparisonScene, show
from helpers.gl_objects import count_objects
from helpers.images import blobs, make_image
from helpers.programs import under_x
from helpers.scenes import CACHED
from progiso.bench.soak import growth
from progiso.measure import tolerances
from progiso.measure.machine import resident_bytes

MAPPERS, VOLUMES, FRAMES = 200, 50, 12


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)


def test_mappers_come_and_go(image):
    """Two hundred of all kinds leave as many objects of OpenGL's as before, and no more memory."""
    scene = ComparisonScene(ours=True, size=(64, 48))
    scene.look_at(image)
    scene.render()
    before = count_objects(scene.window)
    keeper = scene.add(image, OPAQUE)
    scene.render()
    scene.volumes.clear()
    keeper.VisibilityOff()
    kinds = [
        (OPAQUE, {}),
        (NESTED, CACHED),
        (OPAQUE, {**CACHED, "DetailedStatistics": True}),
        (NESTED, {}),
    ]
    samples = {"frame": [], "rss": []}
    for number in range(MAPPERS):
        surfaces, settings = kinds[number % len(kinds)]
        volume = scene.add(image, surfaces, **settings)
        scene.render()
        if number % 3:
            volume.ReleaseGraphicsResources(scene.window)
        scene.renderer.RemoveVolume(volume)
        scene.volumes.clear()
        del volume
        if number % len(kinds) == len(kinds) - 1:
            samples["frame"].append(number)
            samples["rss"].append(resident_bytes())
            if number < MAPPERS / 4:
                counted = count_objects(
                    scene.window
                )  # by then all shaders are compiled, which the keeper holds
    assert count_objects(scene.window) == counted
    assert growth(samples, "rss", MAPPERS // 4) <= tolerances.GROWTH_BYTES
    scene.renderer.RemoveVolume(keeper)
    del keeper
    gc.collect()
    after = count_objects(scene.window)
    assert after["Program"] < counted["Program"] <= before["Program"] + 60
    for kind in ("Buffer", "Texture", "Query", "Framebuffer", "Renderbuffer", "VertexArray"):
        assert after[kind] == before[kind], kind


def test_fifty_volumes(image):
    """In rows of one scene, each shows as it does alone, and they share their shaders."""
    size, small = (300, 160), progiso.compress(make_image(blobs((12, 14, 10), 5, waves=1)), rate=16)
    scene, alone = ComparisonScene(ours=True, size=size), ComparisonScene(ours=True, size=size)
    places = [np.array((12 * (i % 10), 16 * (i // 10), 0)) for i in range(VOLUMES)]
    matrices = [np.block([[np.eye(3), place[:, None]], [np.zeros(3), 1]]) for place in places]
    colors = [(0.1 * (i % 10), 0.2 * (i // 10), 1 - 0.1 * (i % 10)) for i in range(VOLUMES)]
    for each in (scene, alone):
        each.clipping_range = 20, 400
        each.camera.SetParallelProjection(True)
        each.camera.SetParallelScale(48)
        each.camera.SetPosition(60, 38, 150)
        each.camera.SetFocalPoint(60, 38, 0)
    counts = []
    for matrix, color in zip(matrices, colors):
        scene.add(small, {0.1: (*color, 1.0)}, matrix)
        if len(scene.volumes) in (1, VOLUMES):
            picture = scene.picture()
            counts.append(count_objects(scene.window))
    first, all_ = counts
    assert all_["Program"] == first["Program"], "each has its own shaders"
    assert all_["Buffer"] - first["Buffer"] <= (VOLUMES - 1) * first["Buffer"]
    background = picture[0, 0]
    together = np.broadcast_to(background, picture.shape).copy()
    for matrix, color in zip(
        matrices, colors
    ):  # they do not overlap: what one shows the others leave alone
        volume = alone.add(small, {0.1: (*color, 1.0)}, matrix)
        one = alone.picture()
        shown = (one != background).any(axis=2)
        assert shown.sum() > 100 and (together[shown] == background).all()
        together[shown] = one[shown]
        alone.renderer.RemoveVolume(volume)
        alone.volumes.clear()
    assert np.array_equal(picture, together)


SCENES = [
    (OPAQUE, {}),
    (NESTED, CACHED),
    ({0.2: (*RED, 1.0)}, CACHED),
    ({-0.2: (*BLUE, 0.5), 0.3: (*GREEN, 1.0)}, {}),
]


def frames(image, surfaces, settings):
    """Return pictures of a window of its own, as the camera goes round."""
    scene = ComparisonScene(ours=True, size=(96, 80))
    show(scene, image, surfaces, **settings).GetProperty().ShadeOn()
    pictures = []
    for frame in range(FRAMES):
        scene.look_at(image, frame % 4)
        pictures.append(scene.picture())
    scene.window.Finalize()
    return pictures


def test_each_thread_has_its_window(image):
    """Each of four threads makes, renders and closes a window: its pictures are those of one thread
    alone."""
    expected = [frames(image, *scene) for scene in SCENES]
    found = [None] * len(SCENES)

    def work(number):
        found[number] = frames(image, *SCENES[number])

    threads = [threading.Thread(target=work, args=(number,)) for number in range(len(SCENES))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for ours, theirs in zip(found, expected):
        assert ours is not None and all(np.array_equal(a, b) for a, b in zip(ours, theirs))


SHARED = """
import sys
sys.path[:0] = {path!r}
import numpy as np
import progiso
from helpers.scenes import CACHED
from helpers.comparison import ComparisonScene
from helpers.images import blobs, make_image
from helpers.comparison import NESTED, OPAQUE, show
from helpers.gl_objects import count_objects

image = progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)
scenes = [ComparisonScene(ours=True), ComparisonScene(ours=True)]
scenes[1].window.SetSharedRenderWindow(scenes[0].window)
for scene, surfaces in zip(scenes, (OPAQUE, NESTED)):
    show(scene, image, surfaces, **CACHED).GetProperty().ShadeOn()
pictures = [scene.picture() for scene in scenes]
names = [count_objects(scene.window)["Buffer"] for scene in scenes]
assert names[0] == names[1] > 20, "they share nothing"


def check():
    for scene, picture in zip(scenes, pictures):
        assert np.array_equal(scene.picture(), picture)


check()
for scene in scenes:
    scene.volumes[0].ReleaseGraphicsResources(scene.window)
    check()
    scene.window.Finalize()
    check()
print("good")
"""


def test_windows_share_their_contexts():
    """VTK's windows do so under X: names of one's buffers are known in the other, and neither
    deletes the other's."""
    if "OS" not in vtkRenderWindow().GetClassName():
        pytest.skip("this wants a display of Mesa's")
    program = SHARED.format(path=[path for path in sys.path if path])
    assert "good" in under_x(sys.executable, "-c", program)
