"""What loading a volume costs: nothing is decoded whose ranges of values come with it, no dispatch
takes long, and what is too large is an error."""

import ctypes

import numpy as np
import pytest

import progiso
from helpers.gl_hooks import gl, intercepted, program_label
from helpers.holes import KINDS
from helpers.images import (
    blobs,
    copy_of,
    make_image,
    noise,
    reference_volume,
    without_ranges,
)
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, least_budget, orbit
from progiso.geometry import hide_points

CURRENT_PROGRAM = 0x8B8D
SIZE = (120, 90)


@pytest.fixture(scope="module")
def volume():
    image = progiso.compress(make_image(noise((140, 132, 136), 4)), rate=2)
    return without_ranges(image), orbit(reference_volume(image), 1, 4)


def current_stage():
    program = ctypes.c_int()
    gl("glGetIntegerv")(CURRENT_PROGRAM, ctypes.byref(program))
    return program_label(program.value)


@pytest.mark.parametrize("settings", [{}, CACHED], ids=["whole", "cached"])
def test_a_volume_is_prepared_by_slices(volume, settings):
    """The first dispatch is small; together they do all of the work, and each part once."""
    image, camera = volume
    scene = Scene(image, 0.5, camera, SIZE, **settings)
    scene.window.Initialize()  # it looks up OpenGL's functions
    groups = {}

    def dispatch(original, x, y, z):
        groups.setdefault(current_stage(), []).append(x * y)
        original(x, y, z)

    with intercepted("glDispatchCompute", dispatch):
        scene.render()
    ranges, blocks = groups["BlockRanges"], groups["DecodeBlocks"]
    assert 9 * 9 < ranges[0] <= 256 and len(ranges) > 1 and sum(ranges) == 9 * 9 * 9
    if settings:  # boxes of blocks, a layer of which belongs to two of them
        assert len(blocks) == len(ranges)
        assert 35 * 33 * 34 <= 32 * sum(blocks) <= 1.5 * 35 * 33 * 34
    else:
        assert blocks[0] == 256 * 64 / 32 and 32 * sum(blocks) >= 35 * 33 * 34


def test_ranges_are_the_same_however_small_the_cache(volume):
    """The boxes of blocks whose ranges are found are as small as the cache."""
    image, camera = volume
    expected = Scene(image, 0.5, camera, SIZE).depth()
    budget = least_budget(image, 0.5, camera, size=SIZE)
    scene = Scene(image, 0.5, camera, SIZE, MemoryBudget=budget, LargestBuffer=600_000, **CACHED)
    assert scene.depth().tobytes() == expected.tobytes()


def test_slices_of_a_stream_in_several_buffers(volume):
    image, camera = volume
    expected = Scene(image, 0.5, camera, SIZE).depth()
    for whole in (False, True):
        scene = Scene(image, 0.5, camera, SIZE, LargestBuffer=10_500_000 if whole else 600_000)
        scene.mapper.SetDecodeWholeVolume(whole)
        assert scene.depth().tobytes() == expected.tobytes()


def pictures_of(image, isovalue, camera, **settings):
    scene = Scene(image, isovalue, camera, SIZE, lit=True, **settings)
    return scene.depth().tobytes(), scene.picture().tobytes(), scene.statistics()


@pytest.mark.parametrize("settings", [{}, CACHED], ids=["whole", "cached"])
@pytest.mark.parametrize("make", [*KINDS, lambda: (make_image(blobs((41, 70, 37), 5)), None)])
def test_images_are_the_same_with_stored_ranges(make, settings):
    """Of volumes with holes, too; and nothing is compiled or decoded to find the ranges."""
    image = make()[0]
    image = image if progiso.is_compressed(image) else progiso.compress(image, rate=3)
    camera = orbit(reference_volume(image), 1, 4)
    depth, picture, about = pictures_of(image, 0.1, camera, **settings)
    found = pictures_of(without_ranges(copy_of(image)), 0.1, camera, **settings)
    assert (depth, picture) == found[:2]
    assert "BlockRanges" in found[2]["stages"] and "BlockRanges" in about["left_out"]
    assert "BlockRanges" not in about["loading"]["programs"]
    blocks = progiso.describe(image)["blocks"]
    assert found[2]["loading"]["decoded_blocks"] >= blocks
    assert about["loading"]["decoded_blocks"] == (0 if settings else blocks)
    assert about["passes"][0]["pairs"] == found[2]["passes"][0]["pairs"]


def test_nothing_is_decoded_before_the_first_rays():
    """The first stage that decodes is asked by rays that lack blocks."""
    image = progiso.compress(make_image(noise((40, 40, 40))), rate=4)
    scene = Scene(image, 0.5, orbit(reference_volume(image), 1, 4), SIZE, **CACHED)
    scene.window.Initialize()
    stages = []

    def dispatch(original, *groups):
        stages.append(current_stage())
        original(*groups)

    with (
        intercepted("glDispatchCompute", dispatch),
        intercepted("glDispatchComputeIndirect", dispatch),
    ):
        scene.render()
    assert stages.index("CastRays") < stages.index("DecodeBlocks")
    assert "BlockRanges" not in stages


def test_what_the_image_hides_since_has_no_stored_ranges():
    """A compressed image that is blanked has others; they are found, as without stored ones."""
    image = progiso.compress(make_image(blobs((24, 26, 28), 3)), rate=8)
    hide_points(image, np.random.default_rng(2).random((24, 26, 28)) < 0.01)
    scene = Scene(image, 0.1, orbit(reference_volume(image), 1, 4), SIZE)
    assert "BlockRanges" in (scene.render(), scene.statistics())[1]["stages"]


def test_a_buffer_too_small_for_the_cache_is_no_small_budget(volume):
    image, camera = volume
    scene = Scene(image, 0.5, camera, SIZE, LargestBuffer=2048 * 256 - 1, **CACHED)
    with vtk_messages() as messages:
        scene.window.Render()
    (message,) = (m for m in messages if "Isovalue" not in m)  # of noise at 2 bits it may warn
    assert "raise LargestBuffer" in message and "budget" not in message
    assert np.ptp(scene.picture().reshape(-1, 3), axis=0).max() == 0
    scene.mapper.SetLargestBuffer(2048 * 256)
    assert np.isfinite(scene.depth()).any()
