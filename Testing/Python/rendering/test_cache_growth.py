"""The cache grows in place: what it holds stays, and no image waits for much memory at a time."""

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkRenderWindow

import progiso
from helpers.gl_hooks import SparseBuffers
from helpers.images import make_image, noise, reference_volume
from helpers.scenes import CACHED, Scene, orbit

SIZE = (240, 180)


def decoded(scene):
    return sum(p["decoded_blocks"] for p in scene.statistics()["passes"])


def slots(scene):
    return scene.statistics()["memory"]["buffers"]["cache_free_slots"] // 8


@pytest.fixture(scope="module")
def volume():
    """Return a volume larger than a first cache, a camera, and a value that has no surface."""
    values = noise((180, 180, 180), 3)
    image = progiso.compress(make_image(values), rate=4)
    return image, orbit(reference_volume(image), 1, 4), float(values.max()) - 0.01


@pytest.mark.parametrize("colors", [False, True])
def test_what_the_cache_holds_stays(volume, colors):
    """The cache grows when the first image is complete, to twice of what it needed.

    Back at the first view, nothing is decoded again, and the image is the same bit by bit.
    """
    image, camera, nothing = volume
    scene = Scene(image, 3.65, camera, SIZE, **CACHED)
    if colors:
        scene.mapper.SetColorInputData(image)
    first, picture = scene.depth(), scene.picture()
    needed = decoded(scene)
    assert needed < 16384 < 2 * needed <= slots(scene)
    scene.isovalue = nothing
    scene.render()
    scene.isovalue = 3.65
    assert scene.depth().tobytes() == first.tobytes()
    assert scene.picture().tobytes() == picture.tobytes()
    assert decoded(scene) == 0


def test_movements_make_no_memory(volume):
    """After the first image an orbit and a dolly change nothing, as long as the slots suffice."""
    image, camera, _ = volume
    scene = Scene(image, 3.5, camera, SIZE, **CACHED)
    scene.render()
    first = slots(scene)
    assert first >= 2 * decoded(scene)
    for i in range(12):
        scene.renderer.GetActiveCamera().Azimuth(2)
        scene.renderer.GetActiveCamera().Dolly(1.05 if i < 6 else 0.9)
        scene.render()
        assert sum(p["decoded_blocks"] for p in scene.statistics()["passes"]) < first
        assert slots(scene) == first


def test_rays_under_way_go_on(volume):
    """A cache that grows amid the passes of an image keeps the blocks of the passes before."""
    image, camera, _ = volume
    expected = Scene(image, 3.0, camera, SIZE).depth()
    scene = Scene(image, 3.0, camera, SIZE, MaximumPassesPerRender=1, **CACHED)
    scene.renderer.ResetCameraClippingRange()
    sizes = []
    while not scene.mapper.GetConverged():
        scene.window.Render()
        sizes.append(slots(scene))
    held = [p["cached_blocks"] for p in scene.statistics()["passes"]]
    grown = np.flatnonzero(np.diff(sizes[:-1])) + 1  # the last is growth for the next image
    assert len(grown) > 0 and len(held) == len(sizes)
    assert all(held[i] > sizes[i - 1] / 2 and held[i + 1] >= held[i] for i in grown)
    assert scene.depth().tobytes() == expected.tobytes()


def test_within_the_budget_at_every_size(volume):
    """Where the budget has no room for two copies of the cache, the image is right all the same."""
    image, camera, _ = volume
    expected = Scene(image, 3.0, camera, SIZE).depth()
    for budget in (10_000_000, 14_000_000, 20_000_000, 30_000_000):
        scene = Scene(image, 3.0, camera, SIZE, MemoryBudget=budget, **CACHED)
        assert scene.depth().tobytes() == expected.tobytes()
        memory = scene.statistics()["memory"]
        assert memory["total"] - memory["compressed"] <= budget


@pytest.mark.skipif(
    vtkRenderWindow().GetClassName() != "vtkOSOpenGLRenderWindow",
    reason="a GPU has sparse buffers, or not",
)
def test_memory_is_committed_bit_by_bit(volume, monkeypatch):
    """Of all that the cache has addresses for, only what it needs has memory.

    Neither stages nor copies touch what has none, and the statistics tell what has.
    """
    monkeypatch.setenv("PROGISO_GL_DEBUG", "0")  # the context says that it has no sparse buffers
    image, camera, nothing = volume
    settings = {"ColorInputData": image, **CACHED}
    plain = Scene(image, 3.3, camera, SIZE, **settings)
    expected, picture = plain.depth(), plain.picture()
    scene = Scene(image, nothing, camera, SIZE, **settings)
    scene.window.Initialize()  # it looks up OpenGL's functions
    with SparseBuffers().offered() as sparse:
        scene.depth()
        before = slots(scene)
        sparse.largest_commit = 0
        scene.isovalue = 3.3
        assert scene.depth().tobytes() == expected.tobytes()
        assert scene.picture().tobytes() == picture.tobytes()
        assert slots(scene) > before
        assert sparse.largest_commit == 8192 * 256
        buffers = scene.statistics()["memory"]["buffers"]
        cache = [buffers[f"cache_{of}"] for of in ("values", "map", "free_slots", "requests")]
        assert sum(cache) == sparse.bytes()
        assert sum(cache) < 566 * slots(scene) + 5 * sparse.PAGE
        assert len(sparse.committed) == 4
        sparse.check()
        scene.volume.ReleaseGraphicsResources(scene.window)
