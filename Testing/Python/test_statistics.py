"""The statistics say what happened, and the memory stays within its formula."""

import numpy as np
import progiso
import pytest
import tolerances
from oracle.caster import Camera
from progiso.statistics import PASS_KEYS
from scenes import Scene, orbit
from support import make_image, marschner_lobb, metadata, noise, reference_volume, stream_of


@pytest.fixture(scope="module")
def scene():
    image = progiso.compress(make_image(marschner_lobb(64)), 4)
    scene = Scene(image, 0.5, orbit(reference_volume(image), 1, 4), (200, 150), SpeculationLimit=4)
    scene.image = image
    scene.rays = scene.depth()
    return scene


def test_keys(scene):
    statistics = scene.statistics()
    assert {"passes", "total_ms", "memory", "stages", "left_out", "converged", "camera", "size", "gl"} <= set(
        statistics
    )
    assert set(statistics["memory"]) == {"buffers", "total", "compressed"}
    assert set(statistics["camera"]) >= {"position", "focal_point", "view_up", "view_angle", "parallel"}
    assert all(set(PASS_KEYS) <= set(p) for p in statistics["passes"])
    assert statistics["size"] == [200, 150]
    assert statistics["stages"] and not set(statistics["stages"]) & set(statistics["left_out"])
    assert "Mesa" in statistics["gl"] or "NVIDIA" in statistics["gl"]


def test_passes_add_up(scene):
    statistics = scene.statistics()
    passes = statistics["passes"]
    assert [p["pass"] for p in passes] in (list(range(len(passes))), list(range(1, len(passes) + 1)))
    active = [p["active_rays"] for p in passes]
    assert active == sorted(active, reverse=True) and 0 < active[0] <= 200 * 150
    completed = [p["completed"] for p in passes]
    assert completed == sorted(completed) and completed[-1] == 1
    assert statistics["converged"]
    assert active[0] >= np.isfinite(scene.rays).sum()
    for p in passes:
        assert 1 <= p["speculation"] <= 4
        assert p["pairs"] <= p["active_rays"] * 4
        assert p["visible_blocks"] <= p["pairs"] or p["pairs"] == 0
        assert p["visible_blocks"] <= p["active_blocks"] <= 16**3
        assert p["decoded_blocks"] <= p["active_blocks"]
    assert sum(p["pairs"] for p in passes) >= np.isfinite(scene.rays).sum()
    assert sum(p["decoded_blocks"] for p in passes) >= max(p["active_blocks"] for p in passes)
    elapsed = [p["elapsed_ms"] for p in passes]
    assert elapsed == sorted(elapsed) and 0 < elapsed[0] and elapsed[-1] <= statistics["total_ms"]


def test_table_says_the_same(scene):
    table = scene.mapper.GetStatistics().GetPassTable()
    passes = scene.statistics()["passes"]
    assert table.GetNumberOfRows() == len(passes)
    for key in PASS_KEYS:
        column = table.GetColumnByName(key)
        assert [column.GetTuple1(i) for i in range(len(passes))] == pytest.approx([p[key] for p in passes])


def test_memory_adds_up(scene):
    memory = scene.statistics()["memory"]
    assert sum(memory["buffers"].values()) == memory["total"]
    stream = len(stream_of(scene.image))
    assert stream <= memory["compressed"] <= stream + 64
    assert memory["compressed"] in memory["buffers"].values()


@pytest.mark.parametrize("speculation", [1, 64])
@pytest.mark.parametrize("size", [(64, 48), (640, 360)])
@pytest.mark.parametrize("shape", [(17, 18, 19), (100, 90, 110)])
def test_memory_formula(shape, size, speculation):
    """Beside payload and cache: three bytes for a block, forty for a pixel."""
    image = progiso.compress(make_image(noise(shape)), 1)
    scene = Scene(image, 0.5, orbit(reference_volume(image), 1, 4), size, SpeculationLimit=speculation)
    scene.render()
    check_memory(image, scene.statistics())


def check_memory(image, statistics):
    memory = statistics["memory"]
    cache = sum(bytes_ for name, bytes_ in memory["buffers"].items() if name.lower().startswith("cache"))
    assert cache > 0
    blocks = np.prod([-(-int(n) // 4) for n in metadata(image, "Dimensions")])
    bound = tolerances.BYTES_PER_BLOCK * blocks + tolerances.BYTES_PER_PIXEL * np.prod(statistics["size"])
    rest = memory["total"] - memory["compressed"] - cache
    assert (
        rest <= bound
    ), f"{rest} bytes for {blocks} blocks and {np.prod(statistics['size'])} pixels: {memory['buffers']}"


def test_nothing_to_see():
    """A volume out of sight or an isovalue out of range costs no decode."""
    image = progiso.compress(make_image(marschner_lobb(24)))
    away = Scene(image, 0.5, Camera((100, 100, 100), (200, 200, 200)))
    out = Scene(image, 7.0, Camera((60, 60, 60), (12, 12, 12)))
    # VTK would not even ask the mapper for what it finds out of sight.
    away.renderer.GetCullers().RemoveAllItems()
    for scene in (away, out):
        assert not np.isfinite(scene.depth()).any()
        statistics = scene.statistics()
        assert statistics["converged"]
        assert sum(p["decoded_blocks"] for p in statistics["passes"]) == 0
