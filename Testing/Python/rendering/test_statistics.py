"""Statistics say what happened, and memory stays within its formula."""

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction, vtkPlane

import progiso
from helpers.gl_hooks import intercepted, without_extension
from helpers.images import make_image, marschner_lobb, noise, reference_volume, stream_of
from helpers.scenes import CACHED, Scene, check_memory, orbit
from progiso.oracle.caster import Camera
from progiso.statistics import PASS_KEYS


@pytest.fixture(scope="module")
def scene():
    image = progiso.compress(make_image(marschner_lobb(64)), rate=4)
    camera = orbit(reference_volume(image), 1, 4)
    scene = Scene(
        image, 0.5, camera, (200, 150), SpeculationLimit=4, DetailedStatistics=True, **CACHED
    )
    scene.image = image
    scene.rays = scene.depth()
    return scene


def test_keys(scene):
    statistics = scene.statistics()
    assert set(statistics) == {
        *(
            "passes",
            "total_ms",
            "loading",
            "memory",
            "stages",
            "left_out",
            "stage_ms",
            "levels",
            "uncertain",
            "converged",
            "camera",
            "size",
            "gl",
        )
    }
    memory = {"buffers", "total", "compressed", "budget", "least_budget", "host"}
    assert set(statistics["memory"]) == memory
    assert set(statistics["camera"]) >= {
        "position",
        "focal_point",
        "view_up",
        "view_angle",
        "parallel",
    }
    assert all(set(PASS_KEYS) <= set(p) for p in statistics["passes"])
    assert statistics["size"] == [200, 150]
    assert statistics["stages"] and not set(statistics["stages"]) & set(statistics["left_out"])
    assert "Mesa" in statistics["gl"] or "NVIDIA" in statistics["gl"]


def test_passes_add_up(scene):
    statistics = scene.statistics()
    passes = statistics["passes"]
    assert [p["pass"] for p in passes] in (
        list(range(len(passes))),
        list(range(1, len(passes) + 1)),
    )
    active = [p["active_rays"] for p in passes]
    assert active == sorted(active, reverse=True) and 0 < active[0] <= 200 * 150
    completed = [p["completed"] for p in passes]
    assert completed == sorted(completed) and completed[-1] == 1
    assert statistics["converged"]
    assert active[0] >= np.isfinite(scene.rays).sum()
    for p in passes:
        assert 1 <= p["speculation"] <= 4
        assert p["visible_blocks"] <= p["pairs"]
        assert p["visible_blocks"] <= p["active_blocks"] <= p["cached_blocks"] <= 16**3
    assert sum(p["pairs"] for p in passes) >= np.isfinite(scene.rays).sum()
    # nothing was evicted, so what is cached in the end was decoded, each block once
    assert sum(p["decoded_blocks"] for p in passes) == passes[-1]["cached_blocks"]
    assert passes[0]["pairs"] == 0 and passes[0]["decoded_blocks"] > 0
    elapsed = [p["elapsed_ms"] for p in passes]
    assert elapsed == sorted(elapsed) and 0 < elapsed[0] and elapsed[-1] <= statistics["total_ms"]


def test_table_says_the_same(scene):
    table = scene.mapper.GetStatistics().GetPassTable()
    passes = scene.statistics()["passes"]
    assert table.GetNumberOfRows() == len(passes)
    for key in PASS_KEYS:
        column = table.GetColumnByName(key)
        assert [column.GetTuple1(i) for i in range(len(passes))] == pytest.approx(
            [p[key] for p in passes]
        )


def test_details_are_there_when_asked_for(scene):
    """Every stage that ran has its time; without details nobody counts blocks or asks the clock."""
    statistics = scene.statistics()
    assert set(statistics["stage_ms"]) == set(statistics["stages"])
    assert all(ms > 0 for stage, ms in statistics["stage_ms"].items() if stage != "CacheReset")
    plain = Scene(scene.image, 0.5, scene.camera, (200, 150), SpeculationLimit=4, **CACHED)
    assert plain.depth().tobytes() == scene.rays.tobytes()
    about = plain.statistics()
    assert about["stage_ms"] == {}
    assert all(p["visible_blocks"] is None and p["active_blocks"] is None for p in about["passes"])
    assert [p["pairs"] for p in about["passes"]] == [p["pairs"] for p in statistics["passes"]]
    assert set(statistics["memory"]["buffers"]) - set(about["memory"]["buffers"]) == {"cache_seen"}


def test_loading_splits(scene):
    """Each stage that ran has a program, which somebody waited for: there are no threads."""
    loading = scene.statistics()["loading"]
    keys = {"input_ms", "upload_ms", "preparation_ms", "decoded_blocks", "programs"}
    assert set(loading) == keys and loading["decoded_blocks"] == 0
    assert all(loading[key] > 0 for key in ("input_ms", "upload_ms", "preparation_ms"))
    assert set(loading["programs"]) >= set(scene.statistics()["stages"])
    for times in loading["programs"].values():
        assert 0 < times["waited_ms"] and 0 < times["ms"] <= times["waited_ms"]


def test_nobody_waits_until_a_figure_is_asked_for(volume):
    """A render of one pass gives the GPU its work and does not wait for it."""
    image, camera = volume
    scene = Scene(image, 0.5, camera, SIZE)
    scene.render()
    before = scene.mapper.GetStatistics()
    assert before.GetNumberOfPasses() == 1
    waits = []

    def wait(original, *arguments):
        waits.append(arguments)
        return original(*arguments)

    with intercepted("glClientWaitSync", wait):
        scene.renderer.GetActiveCamera().Azimuth(5)
        scene.window.Render()
        assert scene.mapper.GetConverged() and not waits
        assert before.GetPassValue(0, "active_rays") > 0 and waits
        count = len(waits)
        before.GetPassValue(0, "pairs")
        assert len(waits) == count


def test_figures_outlive_image_and_mapper(volume):
    """Whoever has asked for none before the window's resources go still gets those of the image."""
    image, camera = volume
    scene = Scene(image, 0.5, camera, SIZE, **CACHED)
    scene.render()
    passes = scene.statistics()["passes"]
    other = Scene(image, 0.5, camera, SIZE, **CACHED)
    other.renderer.ResetCameraClippingRange()
    other.window.Render()
    statistics = other.mapper.GetStatistics()
    other.volume.ReleaseGraphicsResources(other.window)
    other.renderer.RemoveVolume(other.volume)
    del other
    assert statistics.GetNumberOfPasses() == len(passes)
    pairs = [statistics.GetPassValue(i, "pairs") for i in range(len(passes))]
    assert pairs == [p["pairs"] for p in passes]


def test_snapshots_without_a_mapped_buffer(volume, monkeypatch):
    """OpenGL 4.3 cannot map a buffer for good: the passes' records are the same."""
    monkeypatch.setenv("PROGISO_GL_DEBUG", "0")
    image, camera = volume
    records = []
    for extension in (b"GL_none", b"GL_ARB_buffer_storage"):
        scene = Scene(image, 0.5, camera, SIZE, SpeculationLimit=1, **CACHED)
        scene.window.Initialize()  # it looks up OpenGL's functions
        mapped = []

        def map_buffer(original, *arguments, mapped=mapped):
            mapped.append(arguments)
            return original(*arguments)

        with without_extension(extension), intercepted("glMapBufferRange", map_buffer):
            scene.render()
        assert bool(mapped) == (extension == b"GL_none")
        records.append([{**p, "elapsed_ms": 0} for p in scene.statistics()["passes"]])
    assert records[0] == records[1]


def test_memory_adds_up(scene):
    memory = scene.statistics()["memory"]
    assert sum(memory["buffers"].values()) == memory["total"]
    stream = len(stream_of(scene.image))
    assert stream <= memory["compressed"] <= stream + 64
    assert memory["compressed"] in memory["buffers"].values()


@pytest.mark.parametrize("settings", [{}, CACHED, {"SpeculationLimit": 1, **CACHED}])
@pytest.mark.parametrize("size", [(64, 48), (640, 360)])
@pytest.mark.parametrize("shape", [(17, 18, 19), (100, 90, 110)])
def test_memory_formula(shape, size, settings):
    """Beside stream and cache there are three bytes a block and forty a pixel."""
    image = progiso.compress(make_image(noise(shape)), rate=1)
    scene = Scene(image, 0.5, orbit(reference_volume(image), 1, 4), size, **settings)
    scene.render()
    check_memory(image, scene.statistics())


# --- what a scene does not need is not there ------------------------------------------------------

SHAPE, SIZE = (100, 90, 110), (160, 120)
BLOCKS, MACROCELLS, PIXELS = 25 * 23 * 28, 7 * 6 * 7, 160 * 120
ALWAYS = {
    *("control", "pass_statistics", "macrocells", "block_marks"),
    *("hits", "cache_values", "scene", "staging"),
}


@pytest.fixture(scope="module")
def volume():
    image = progiso.compress(make_image(noise(SHAPE)), rate=1)
    return image, orbit(reference_volume(image), 1, 4, view_angle=20)  # it covers the window


def needs(volume, lit=True, **settings):
    """Render; return the buffers with their sizes, and the stages."""
    image, camera = volume
    scene = Scene(image, 0.5, camera, SIZE, **settings)
    scene.volume.GetProperty().SetShade(lit)
    scene.render()
    statistics = scene.statistics()
    return statistics["memory"]["buffers"], set(statistics["stages"])


def test_a_small_volume_needs_no_cache(volume):
    """Decoded as a whole it needs no stream, no block map, no waiting rays, and one pass."""
    buffers, stages = needs(volume)
    assert set(buffers) == ALWAYS | {"normals", "cache_cell_marks"}
    assert buffers["cache_values"] == 256 * BLOCKS
    assert buffers["cache_cell_marks"] == 8 * BLOCKS
    assert buffers["macrocells"] == 136 * MACROCELLS
    assert buffers["block_marks"] == 8 * MACROCELLS
    assert stages == {
        "DecodeBlocks",
        "MarkBlocks",
        "MarkCells",
        "PlanPass",
        "CastRays",
        "FinishHits",
        "Composite",
    }


def test_what_the_cache_adds(volume):
    buffers, stages = needs(volume, **CACHED)
    assert set(buffers) == ALWAYS | {
        *("normals", "compressed", "rays", "cache_map", "cache_free_slots", "cache_requests")
    }
    assert buffers["rays"] == 12 * PIXELS
    assert buffers["macrocells"] == 148 * MACROCELLS
    assert {"RequestBlocks", "DecodeBlocks"} <= stages
    # a cache with a slot for every block never evicts
    assert ("CacheEvict" in stages) == (buffers["cache_values"] < 256 * BLOCKS)


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_an_unlit_surface_needs_no_normals(volume, settings):
    lit, stages = needs(volume, **settings)
    plain, other_stages = needs(volume, lit=False, **settings)
    assert lit["normals"] == 4 * PIXELS and "normals" not in plain
    assert sum(lit.values()) - sum(plain.values()) >= 4 * PIXELS
    assert stages - other_stages == {"FinishHits"} and other_stages < stages


def test_speculation_takes_no_memory(volume):
    """It has no buffer and no stage of its own, as rays look ahead."""
    with_it, stages = needs(volume, **CACHED)
    without, same_stages = needs(volume, SpeculationLimit=1, **CACHED)
    assert with_it == without and stages == same_stages


def feature(volume, change, isovalues=((0.5, 1.0),), **settings):
    """Return buffers and stages of a lit scene with isovalues of these opacities, after `change` of
    the mapper."""
    image, camera = volume
    scene = Scene(image, 0.5, camera, SIZE, lit=True, **settings)
    opacities = vtkPiecewiseFunction()
    for number, (isovalue, opacity) in enumerate(isovalues):
        scene.volume.GetProperty().GetIsoSurfaceValues().SetValue(number, isovalue)
        opacities.AddPoint(isovalue, opacity)
    scene.volume.GetProperty().SetScalarOpacity(opacities)
    change(scene.mapper)
    scene.render()
    statistics = scene.statistics()
    return statistics["memory"]["buffers"], set(statistics["stages"])


def add_clipping_plane(mapper):
    plane = vtkPlane()
    plane.SetOrigin(50, 45, 55)
    mapper.AddClippingPlane(plane)


def crop(mapper):
    mapper.SetCroppingRegionPlanes(20, 60, 20, 60, 20, 60)
    mapper.CroppingOn()


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_what_features_take(volume, settings):
    """Clipping and cropping take nothing, a second isovalue 4 bytes a pixel, translucency 20
    without a cache."""
    plain, stages = feature(volume, lambda mapper: None, **settings)
    assert feature(volume, add_clipping_plane, **settings) == (plain, stages)
    assert feature(volume, crop, **settings)[0] == plain
    two, _ = feature(volume, lambda mapper: None, ((0.5, 1.0), (1.0, 1.0)), **settings)
    assert two == {**plain, "hits": 12 * PIXELS}
    seen_through, _ = feature(volume, lambda mapper: None, ((0.5, 0.5),), **settings)
    assert "normals" not in seen_through
    assert seen_through["layers"] == 8 * PIXELS and seen_through["rays"] == 12 * PIXELS


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_what_colours_take(volume, settings):
    """Colours take as much again for decoded samples, 4 bytes a pixel, and the palette."""
    image, _ = volume
    plain, stages = feature(volume, lambda mapper: None, **settings)
    coloured, more = feature(volume, lambda mapper: mapper.SetColorInputData(image), **settings)
    assert coloured["hits"] == 12 * PIXELS and coloured["palette"] == 64 + 20 * 768
    assert coloured["cache_values"] == 2 * plain["cache_values"]
    assert more - stages == {"DecodeColors"}
    assert ("compressed_colors" in coloured) == bool(settings)


def test_host_memory():
    """A plain image is compressed there; of a compressed one the stream is shared."""
    plain = make_image(marschner_lobb(24))
    for image, least in ((plain, 24**3), (progiso.compress(plain, rate=8), 0)):
        scene = Scene(image, 0.5, Camera((60, 60, 60), (12, 12, 12)), Rate=8)
        scene.render()
        assert least <= scene.statistics()["memory"]["host"] <= 3 * least
    scene.mapper.SetColorInputData(plain)
    scene.mapper.SetColorLookupTable(scene.volume.GetProperty().GetRGBTransferFunction())
    scene.render()
    assert 24**3 <= scene.statistics()["memory"]["host"] <= 3 * 24**3


def test_nothing_to_see():
    """A volume out of sight or an isovalue out of range costs no decode."""
    image = progiso.compress(make_image(marschner_lobb(24)))
    away = Scene(image, 0.5, Camera((100, 100, 100), (200, 200, 200)), **CACHED)
    out = Scene(image, 7.0, Camera((60, 60, 60), (12, 12, 12)), **CACHED)
    # VTK would not even ask the mapper for what it finds out of sight.
    away.renderer.GetCullers().RemoveAllItems()
    for scene in (away, out):
        assert not np.isfinite(scene.depth()).any()
        statistics = scene.statistics()
        assert statistics["converged"]
        assert sum(p["decoded_blocks"] for p in statistics["passes"]) == 0
