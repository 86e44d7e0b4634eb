"""How the work is divided does not show: depth images agree in every byte."""

import collections
import time

import numpy as np
import pytest

import progiso
from helpers.images import blobs, make_image, marschner_lobb, noise, reference_volume, stream_of
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, least_budget, orbit
from progiso.oracle.caster import Camera

# large enough that the smallest cache does not hold them
FIELDS = {
    "noise": (lambda: noise((60, 56, 64), 1), 1.2),
    "marschner-lobb": (lambda: marschner_lobb(64), 0.5),
    "blobs": (lambda: blobs((73, 81, 89), 2, waves=6), 0.1),
}


Case = collections.namedtuple("Case", "image isovalue camera depth picture")


@pytest.fixture(scope="module", params=FIELDS)
def case(request):
    """Return field, isovalue and camera, depth and picture of one pass over decoded samples."""
    field, isovalue = FIELDS[request.param]
    image = progiso.compress(make_image(field()), rate=8)
    camera = orbit(reference_volume(image), 2, 5)
    scene = Scene(image, isovalue, camera, lit=True)
    depth = scene.depth()
    assert np.isfinite(depth).mean() > 0.05
    assert len(scene.statistics()["passes"]) == 1
    return Case(image, isovalue, camera, depth, scene.picture())


def same(case, **settings):
    """Render with other settings; check that depth and picture are the same. Return statistics."""
    image, isovalue, camera, expected, picture = case
    scene = Scene(image, isovalue, camera, lit=True, **settings)
    depth = scene.depth()
    different = np.argwhere(depth.view(np.uint32) != expected.view(np.uint32))
    assert len(different) == 0, (
        f"{len(different)} pixels, first {different[0]}:"
        f" {depth[tuple(different[0])]}, not {expected[tuple(different[0])]}"
    )
    assert scene.picture().tobytes() == picture.tobytes()
    return scene.statistics()


def beside_the_stream(statistics):
    return statistics["memory"]["total"] - statistics["memory"]["compressed"]


@pytest.mark.parametrize("limit", [1, 2, 7, 64])
def test_speculation(case, limit):
    passes = len(same(case, SpeculationLimit=limit, **CACHED)["passes"])
    if limit == 1:
        assert passes > len(same(case, SpeculationLimit=64, **CACHED)["passes"])


@pytest.mark.parametrize("speculation", [2, 64])
@pytest.mark.parametrize("pixels", [1, 4, 32])
def test_stragglers(case, pixels, speculation):
    """A work group of its own casts a ray like a lane of one does; software renderers use it only
    when they are told to."""
    settings = {"SpeculationLimit": speculation, **CACHED}
    assert "CastStragglers" in same(case, PixelsPerStraggler=pixels, **settings)["stages"]
    assert "CastStragglers" not in same(case, PixelsPerStraggler=0, **settings)["stages"]


@pytest.mark.parametrize("speculation", [1, 64])
@pytest.mark.parametrize("share", [0, 0.01, 0.03, 0.1, 0.3, 0.7, 1, 2])
def test_memory_budget(case, share, speculation):
    """From the least budget that can work to one that holds the whole decoded volume the image is
    the same, and never over budget."""
    image, isovalue, camera, _, _ = case
    whole = same(case)
    least = least_budget(image, isovalue, camera)
    needed = beside_the_stream(whole) + 400_000  # with room for traffic with the CPU
    budget = int(least + share * (needed - least))
    statistics = same(case, MemoryBudget=budget, SpeculationLimit=speculation)
    assert statistics["memory"]["budget"] == budget
    assert beside_the_stream(statistics) <= budget
    if share <= 0.3 or share >= 1:
        assert ("cache_map" in statistics["memory"]["buffers"]) == (share < 1)
    if share == 0:
        assert "CacheEvict" in statistics["stages"]


def test_never_over_budget(case):
    """The mapper is not over budget after any pass, even while view, isovalue and size change."""
    image, isovalue, camera, _, _ = case
    budget = 3 * least_budget(image, isovalue, camera)
    scene = Scene(
        image, isovalue, camera, lit=True, MemoryBudget=budget, MaximumPassesPerRender=1, **CACHED
    )
    for size, change in (((160, 120), 0), ((200, 150), 0.1), ((40, 30), -0.1), ((170, 130), 0)):
        scene.window.SetSize(*size)
        scene.isovalue = isovalue + change
        scene.renderer.GetActiveCamera().Azimuth(50)
        scene.renderer.ResetCameraClippingRange()
        for _ in range(2000):
            scene.window.Render()
            assert beside_the_stream(scene.statistics()) <= budget
            if scene.mapper.GetConverged():
                break
        assert scene.mapper.GetConverged()


def test_of_too_small_a_budget_the_least_is_taken(case):
    """One warning says so, in MiB, until budget or input change."""
    image, isovalue, camera, expected, _ = case
    least = least_budget(image, isovalue, camera)
    scene = Scene(image, isovalue, camera, lit=True, MemoryBudget=1 << 20)
    with vtk_messages() as messages:
        assert scene.depth().tobytes() == expected.tobytes()
        scene.window.Render()
    assert len(messages) == 1, messages
    assert "1.0 MiB" in messages[0] and f"{least / 2**20:.1f} MiB ({least} bytes)" in messages[0]
    assert scene.statistics()["memory"]["budget"] == least
    assert scene.statistics()["memory"]["least_budget"] == least
    with vtk_messages() as messages:
        scene.mapper.SetMemoryBudget(1 << 19)
        scene.window.Render()
        scene.mapper.SetMemoryBudget(least)
        assert scene.depth().tobytes() == expected.tobytes()
        scene.mapper.SetMemoryBudget(1 << 19)
        for _ in range(3):  # a turned camera is no reason to tell it again
            scene.renderer.GetActiveCamera().Azimuth(5)
            scene.window.Render()
    assert len(messages) == 1 and "0.5 MiB" in messages[0], messages


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("bits", [9, 64, 100.25, 512])
def test_stream_in_several_buffers(case, bits, whole):
    """A stream longer than a buffer may be lies in several, wherever its blocks begin and end."""
    image, isovalue, camera, _, _ = case
    image = progiso.compress(progiso.decompress(image), rate=bits / 64)
    expected = Scene(image, isovalue, camera).depth()
    stream = len(stream_of(image))
    scene = Scene(
        image, isovalue, camera, LargestBuffer=max(stream // 3, 2_500_000 if whole else 600_000)
    )
    scene.mapper.SetDecodeWholeVolume(whole)
    assert scene.depth().tobytes() == expected.tobytes()
    if not whole and stream > 900_000:
        # blocks that two buffers need are in both
        assert scene.statistics()["memory"]["compressed"] > stream


@pytest.mark.parametrize("speculation", [1, 64])
@pytest.mark.parametrize("passes", [1, 2, 5])
def test_passes_per_render(case, passes, speculation):
    same(case, MaximumPassesPerRender=passes, SpeculationLimit=speculation, **CACHED)


@pytest.mark.parametrize("share", [1.05, 1.5])
def test_everything_at_once(case, share):
    image, isovalue, camera, _, _ = case
    budget = int(share * least_budget(image, isovalue, camera))
    same(
        case,
        MemoryBudget=budget,
        SpeculationLimit=7,
        MaximumPassesPerRender=1,
        DetailedStatistics=True,
    )


def test_history_does_not_show(case):
    """A mapper that has seen other views, isovalues and sizes shows what a fresh one shows."""
    image, isovalue, camera, expected, _ = case
    scene = Scene(image, isovalue, camera, MemoryBudget=2 * least_budget(image, isovalue, camera))
    for i in range(3):
        scene.camera = orbit(reference_volume(image), i, 3)
        scene.isovalue = isovalue + 0.05 * (i - 1)
        scene.window.SetSize(100 + 30 * i, 90)
        scene.mapper.SetMemoryBudget(0 if i == 1 else 3_000_000)
        scene.render()
    scene.window.SetSize(160, 120)
    scene.camera, scene.isovalue = camera, isovalue
    assert scene.depth().tobytes() == expected.tobytes()


def test_a_change_amid_the_passes_restarts(case):
    image, isovalue, camera, expected, _ = case
    scene = Scene(
        image, isovalue + 0.1, camera, MaximumPassesPerRender=1, SpeculationLimit=1, **CACHED
    )
    scene.renderer.ResetCameraClippingRange()
    scene.window.Render()
    assert not scene.mapper.GetConverged()
    scene.isovalue = isovalue
    scene.window.Render()
    assert scene.depth().tobytes() == expected.tobytes()


def test_a_change_of_memory_amid_the_passes_restarts(case):
    image, isovalue, camera, expected, _ = case
    scene = Scene(image, isovalue, camera, MaximumPassesPerRender=1, SpeculationLimit=1, **CACHED)
    scene.renderer.ResetCameraClippingRange()
    scene.window.Render()
    assert not scene.mapper.GetConverged()
    scene.mapper.SetMemoryBudget(least_budget(image, isovalue, camera))
    assert scene.depth().tobytes() == expected.tobytes()
    scene.mapper.SetMemoryBudget(0)
    scene.mapper.DecodeWholeVolumeOn()
    assert scene.depth().tobytes() == expected.tobytes()


def test_cached_blocks_are_not_decoded_again(case):
    """A small turn decodes only what newly appears; the same view decodes nothing."""
    image, isovalue, camera, _, _ = case
    scene = Scene(image, isovalue, camera, **CACHED)
    scene.render()

    def decoded():
        return sum(p["decoded_blocks"] for p in scene.statistics()["passes"])

    first = decoded()
    scene.renderer.GetActiveCamera().Azimuth(0.5)
    scene.render()
    assert decoded() < 0.25 * first


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_an_emptied_cache_decodes_again(case, settings):
    """Measurements start with nothing decoded, and get the same image."""
    image, isovalue, camera, expected, _ = case
    scene = Scene(image, isovalue, camera, **settings)
    scene.render()
    first = sum(p["decoded_blocks"] for p in scene.statistics()["passes"])
    scene.mapper.EmptyCache()
    assert scene.depth().tobytes() == expected.tobytes()
    again = scene.statistics()
    assert sum(p["decoded_blocks"] for p in again["passes"]) == first
    assert {"DecodeBlocks"} <= set(again["stages"])


def test_cache_grows_and_shrinks_with_the_scene():
    """A complex view makes the cache grow; after views that need little, and a pause, it is small.

    The images stay right.
    """
    values = noise((180, 180, 180), 3)
    image = progiso.compress(make_image(values), rate=4)
    camera = orbit(reference_volume(image), 1, 4)
    scene = Scene(image, values.max() - 0.01, camera, (400, 300), **CACHED)

    def cache():
        return scene.statistics()["memory"]["buffers"]["cache_values"]

    scene.render()
    small = cache()
    scene.isovalue = 2.7
    scene.render()
    large = cache()
    assert large > 1.5 * small
    scene.isovalue = values.max() - 0.01
    for _ in range(12):
        scene.renderer.GetActiveCamera().Azimuth(1)
        scene.render()
        assert cache() >= large  # not in the midst of a movement
    time.sleep(2.1)
    scene.renderer.GetActiveCamera().Azimuth(1)
    scene.render()
    assert cache() < large / 2
    scene.camera, scene.isovalue = camera, 2.7
    assert scene.depth().tobytes() == Scene(image, 2.7, camera, (400, 300)).depth().tobytes()


def test_other_input_replaces_the_cache():
    """Blocks decoded of one volume are never shown for another."""
    camera = Camera((60, 50, 70), (12, 12, 12))
    first, second = (progiso.compress(make_image(blobs((25, 25, 25), seed))) for seed in (3, 4))
    expected = Scene(second, 0.1, camera).depth()
    for settings in ({}, CACHED):
        scene = Scene(first, 0.1, camera, **settings)
        assert scene.depth().tobytes() != expected.tobytes()
        scene.mapper.SetInputData(second)
        assert scene.depth().tobytes() == expected.tobytes()
