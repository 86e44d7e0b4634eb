"""How the work is divided must not show: depth images agree in every byte."""

import numpy as np
import progiso
import pytest
from oracle.caster import Camera
from scenes import Scene, orbit
from support import blobs, make_image, marschner_lobb, noise, reference_volume

FIELDS = {
    "noise": (lambda: noise((30, 26, 34), 1), 1.2),
    "marschner-lobb": (lambda: marschner_lobb(48), 0.5),
    "blobs": (lambda: blobs((37, 41, 45), 2), 0.1),
}


@pytest.fixture(scope="module", params=FIELDS)
def case(request):
    """A field, an isovalue, a camera, and the depth image that one plain run gives."""
    field, isovalue = FIELDS[request.param]
    image = progiso.compress(make_image(field()), 8)
    camera = orbit(reference_volume(image), 2, 5)
    depth = Scene(image, isovalue, camera).depth()
    assert np.isfinite(depth).mean() > 0.05
    return image, isovalue, camera, depth


def same(case, **settings):
    image, isovalue, camera, expected = case
    scene = Scene(image, isovalue, camera, **settings)
    depth = scene.depth()
    different = np.argwhere(depth.view(np.uint32) != expected.view(np.uint32))
    assert (
        len(different) == 0
    ), f"{len(different)} pixels, first {different[0]}: {depth[tuple(different[0])]}, not {expected[tuple(different[0])]}"
    return scene.statistics()


@pytest.mark.parametrize("limit", [1, 2, 7, 64])
def test_speculation(case, limit):
    passes = len(same(case, SpeculationLimit=limit)["passes"])
    if limit == 1:
        assert passes > len(same(case, SpeculationLimit=64)["passes"])


@pytest.mark.parametrize("limit", [1, 1 << 14, 1 << 16, 1 << 18, 1 << 22, 1 << 30])
def test_cache_limit(case, limit):
    """However small the cache, the image is complete and the same; and the limit holds, but for the smallest cache that can work."""
    statistics = same(case, CacheLimit=limit)
    cache = sum(size for name, size in statistics["memory"]["buffers"].items() if name.lower().startswith("cache"))
    smallest = sum(
        size for name, size in same(case, CacheLimit=1)["memory"]["buffers"].items() if name.lower().startswith("cache")
    )
    assert 0 < cache <= max(limit, smallest)


@pytest.mark.parametrize("threshold", [0, 8, 40, 1 << 30])
def test_grouping_threshold(case, threshold):
    """Rays that go through a block together find what each would find alone."""
    stages = same(case, GroupingThreshold=threshold)["stages"]
    assert ("IntersectPairs" in stages) == (threshold > 0)


@pytest.mark.parametrize("speculation", [1, 64])
@pytest.mark.parametrize("passes", [1, 2, 5])
def test_passes_per_render(case, passes, speculation):
    same(case, MaximumPassesPerRender=passes, SpeculationLimit=speculation)


@pytest.mark.parametrize("cache", [1 << 14, 1 << 17])
def test_everything_at_once(case, cache):
    same(case, CacheLimit=cache, SpeculationLimit=7, MaximumPassesPerRender=1)


def test_history_does_not_show(case):
    """A mapper that has seen other views, isovalues and sizes shows what a fresh one shows."""
    image, isovalue, camera, expected = case
    scene = Scene(image, isovalue, camera, CacheLimit=1 << 17)
    for i in range(3):
        scene.camera = orbit(reference_volume(image), i, 3)
        scene.isovalue = isovalue + 0.05 * (i - 1)
        scene.window.SetSize(100 + 30 * i, 90)
        scene.render()
    scene.window.SetSize(160, 120)
    scene.camera, scene.isovalue = camera, isovalue
    assert scene.depth().tobytes() == expected.tobytes()


def test_a_change_amid_the_passes_restarts(case):
    image, isovalue, camera, expected = case
    scene = Scene(image, isovalue + 0.1, camera, MaximumPassesPerRender=1, SpeculationLimit=1)
    scene.renderer.ResetCameraClippingRange()
    scene.window.Render()
    assert not scene.mapper.GetConverged()
    scene.isovalue = isovalue
    scene.window.Render()
    assert scene.depth().tobytes() == expected.tobytes()


def test_cached_blocks_are_not_decoded_again(case):
    """A turn by a little decodes only what newly appears; the same view, nothing."""
    image, isovalue, camera, _ = case
    scene = Scene(image, isovalue, camera)
    scene.render()

    def decoded():
        return sum(p["decoded_blocks"] for p in scene.statistics()["passes"])

    first = decoded()
    scene.renderer.GetActiveCamera().Azimuth(0.5)
    scene.render()
    assert decoded() < 0.25 * first


def test_other_input_replaces_the_cache():
    """What was decoded of one volume is never shown for another."""
    camera = Camera((60, 50, 70), (12, 12, 12))
    first, second = (progiso.compress(make_image(blobs((25, 25, 25), seed))) for seed in (3, 4))
    expected = Scene(second, 0.1, camera).depth()
    scene = Scene(first, 0.1, camera)
    assert scene.depth().tobytes() != expected.tobytes()
    scene.mapper.SetInputData(second)
    assert scene.depth().tobytes() == expected.tobytes()
