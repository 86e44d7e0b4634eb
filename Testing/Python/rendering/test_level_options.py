"""`level_of_detail` and `pixel_tolerance` of `make_isosurface` and `render`, and `levels` of the
statistics."""

import json
import warnings

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

import progiso
from helpers.images import make_image, marschner_lobb

ISOVALUE = 0.5
SIZE = (160, 120)
SAMPLES = 150  # two levels, of 76 and 39 samples a side
NONE_THERE = "no levels of detail"


@pytest.fixture(scope="module")
def plain():
    return make_image(marschner_lobb(SAMPLES))


@pytest.fixture(scope="module")
def volume(plain):
    return progiso.compress(plain, levels=11)


@pytest.fixture(scope="module")
def without(plain):
    return progiso.compress(plain)


@pytest.fixture(scope="module")
def camera(plain):
    """Return a camera so far off that samples are nearer to each other than pixels."""
    return progiso.view_camera(plain, zoom=0.4)


def rendered(image, camera, **options):
    """Render an image, and return its result."""
    return progiso.render(image, ISOVALUE, size=SIZE, camera=camera, **options)


def same(a, b):
    """Tell whether two images have the same depths and colours, bit for bit."""
    return a.depth.tobytes() == b.depth.tobytes() and a.image.tobytes() == b.image.tobytes()


@pytest.fixture(scope="module")
def exact(without, camera):
    return rendered(without, camera)


def test_options_reach_the_mapper(volume):
    mapper = progiso.make_isosurface(volume, ISOVALUE).GetMapper()
    assert mapper.GetLevelOfDetail() == mapper.LevelOfDetailOff and mapper.GetPixelTolerance() == 1
    for name, expected in (("on", mapper.LevelOfDetailOn), ("off", mapper.LevelOfDetailOff),
                           ("interactive", mapper.LevelOfDetailInteractive),
                           ("conservative", mapper.LevelOfDetailConservative)):  # fmt: skip
        prop = progiso.make_isosurface(volume, ISOVALUE, level_of_detail=name, pixel_tolerance=2.5)
        assert prop.GetMapper().GetLevelOfDetail() == expected
        assert prop.GetMapper().GetPixelTolerance() == 2.5


@pytest.mark.parametrize("tolerance", [1 / 16, 64])
def test_tolerances_within_the_mappers(volume, tolerance):
    """The mapper clamps in silence: what it does not take is refused before."""
    prop = progiso.make_isosurface(volume, ISOVALUE, pixel_tolerance=tolerance)
    assert prop.GetMapper().GetPixelTolerance() == tolerance
    beyond = tolerance / 2 if tolerance < 1 else 2 * tolerance
    with pytest.raises(ValueError, match=r"pixel_tolerance must be in \[0.0625, 64\]"):
        progiso.make_isosurface(volume, ISOVALUE, pixel_tolerance=beyond)


def test_a_wrong_level_is_told_before_anything_is_compressed(plain, camera):
    told = []
    with pytest.raises(ValueError, match="'on', 'interactive' or 'conservative', got"):
        rendered(plain, camera, level_of_detail="fine", progress=told.append)
    assert not told


@pytest.mark.parametrize("mode", ["off", "interactive"])
def test_a_still_view_is_exact(volume, exact, camera, mode):
    """Levels that are there but not drawn change no bit."""
    result = rendered(volume, camera, level_of_detail=mode)
    assert same(result, exact)
    hits = int(np.isfinite(exact.depth).sum())
    assert hits > 300 and result.statistics["levels"] == exact.statistics["levels"] == {0: hits}


def test_levels_in_json(exact):
    """Keys of JSON are strings."""
    written = json.loads(json.dumps(exact.statistics))["levels"]
    assert written == {"0": exact.statistics["levels"][0]}


@pytest.mark.parametrize("mode, levels", [("off", {0: 0}), ("on", {0: 0, 1: 0, 2: 0})])
def test_where_nothing_is_hit_no_pixel_counts(volume, camera, mode, levels):
    nothing = progiso.render(volume, 7.0, size=SIZE, camera=camera, level_of_detail=mode)
    assert nothing.statistics["levels"] == levels


def test_a_volume_without_levels_is_drawn_exactly_with_one_warning(without, exact, camera):
    with pytest.warns(UserWarning, match=NONE_THERE) as told:
        result = rendered(without, camera, level_of_detail="on")
    assert len(told) == 1 and same(result, exact)
    assert list(result.statistics["levels"]) == [0]


def test_levels_that_were_not_wanted(plain, exact, camera):
    """Who says how many levels a plain image gets is obeyed."""
    with pytest.warns(UserWarning, match=NONE_THERE):
        result = rendered(plain, camera, level_of_detail="on", levels=0)
    assert same(result, exact)


def test_a_small_volume_needs_no_levels(camera):
    """It has none, which is nothing to warn of."""
    small = make_image(marschner_lobb(40))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = progiso.render(small, ISOVALUE, size=SIZE, level_of_detail="on")
    assert same(result, progiso.render(small, ISOVALUE, size=SIZE))


def test_a_far_view_is_drawn_from_coarse_levels(volume, exact, camera):
    """More pixels between samples make it coarser; surfaces stay within about a pixel."""
    results = [
        rendered(volume, camera, level_of_detail="on", pixel_tolerance=tolerance)
        for tolerance in (1 / 16, 1, 64)
    ]
    fine, middle, coarse = (result.statistics["levels"] for result in results)
    assert fine[0] > 0 == fine[1] == fine[2] and coarse[0] == coarse[1] == 0 < coarse[2]
    assert middle[1] + middle[2] > 0
    for result in results:
        hits = int(np.isfinite(result.depth).sum())
        assert sum(result.statistics["levels"].values()) == hits
    assert same(results[0], exact)


def test_plain_images_get_levels(plain, volume, camera):
    """Who asks for a level of detail need not know of `levels`."""
    result = rendered(plain, camera, level_of_detail="on")
    assert same(result, rendered(volume, camera, level_of_detail="on"))
    assert list(result.statistics["levels"]) == [0, 1, 2]


def test_interactive_is_coarse_while_the_window_moves(plain, camera):
    """Also of a plain image, which the mapper compresses."""
    prop = progiso.make_isosurface(plain, ISOVALUE, level_of_detail="interactive")
    renderer, window = vtkRenderer(), vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    renderer.AddVolume(prop)
    camera.apply(renderer.GetActiveCamera())
    levels, depths = [], []
    for rate in (0.001, 15.0, 0.001):
        window.SetDesiredUpdateRate(rate)
        window.Render()
        levels.append(progiso.statistics(prop.GetMapper())["levels"])
        depths.append(progiso.depth(prop.GetMapper()).tobytes())
    assert levels[0] == levels[2] == {0: levels[0][0]} and depths[0] == depths[2] != depths[1]
    assert sum(count for level, count in levels[1].items() if level > 0) > 0
