"""What loading a volume costs: no dispatch for long, and what is too large is an error."""

import ctypes

import numpy as np
import pytest

import progiso
from helpers.gl_hooks import gl, intercepted, program_label
from helpers.images import make_image, noise, reference_volume
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, least_budget, orbit

CURRENT_PROGRAM = 0x8B8D
SIZE = (120, 90)


@pytest.fixture(scope="module")
def volume():
    image = progiso.compress(make_image(noise((140, 132, 136), 4)), rate=2)
    return image, orbit(reference_volume(image), 1, 4)


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
