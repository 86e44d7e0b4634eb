"""The GPU's memory runs out: one clear error, nothing drawn, nothing left behind.

The picture is right again as soon as that is possible.
"""

import re

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkRenderWindow

from helpers import gl_hooks
from helpers.comparison import NESTED, OPAQUE
from helpers.faults import compiled_scene, is_empty, messages_of, run_program
from helpers.gl_hooks import gl_errors, intercepted

TARGETS = {
    "storage": {gl_hooks.STORAGE_BUFFER},
    "other": {gl_hooks.UNIFORM_BUFFER, gl_hooks.COPY_READ_BUFFER, gl_hooks.COPY_WRITE_BUFFER},
}


@pytest.mark.parametrize("targets", TARGETS)
def test_no_room(uncounted, image, settings, targets):
    """The driver refuses each allocation in turn: an error says what to do, then the picture is
    right."""
    scene = compiled_scene(image, settings, NESTED if settings else OPAQUE)
    first, failures = scene.picture(), 0
    while True:
        scene.volumes[0].ReleaseGraphicsResources(scene.window)
        fault = gl_hooks.NoRoom(failures + 1, TARGETS[targets])
        with intercepted("glBufferData", fault):
            messages, picture = messages_of(scene)
        if fault.count <= failures:
            break
        failures += 1
        assert len(messages) == 1 and re.search(
            "no room for .* bytes of|out of memory", messages[0]
        ), messages
        assert "lower the memory budget, the rate or the image size" in messages[0]
        assert is_empty(picture) and not gl_errors()
        assert not scene.mapper.GetConverged()
        assert np.array_equal(scene.picture(), first)
    assert np.array_equal(picture, first) and not messages
    assert failures >= (7 if targets == "storage" else 2)


def test_no_room_where_it_is_used(uncounted, image, settings):
    """Some drivers allocate memory when a shader first touches it."""
    scene = compiled_scene(image, settings)
    first = scene.picture()
    scene.volumes[0].ReleaseGraphicsResources(scene.window)

    pending = []

    def dispatch(original, *groups):
        pending.append(gl_hooks.OUT_OF_MEMORY)
        original(*groups)

    with (
        intercepted("glDispatchCompute", dispatch),
        intercepted("glGetError", lambda of: pending.pop() if pending else of()),
    ):
        messages, picture = messages_of(scene)
    (message,) = messages
    assert (
        "the GPU has run out of memory: lower" in message and is_empty(picture) and not gl_errors()
    )
    assert np.array_equal(scene.picture(), first)


def test_of_a_budget_too_small_the_least_is_taken(image, settings):
    """While the camera moves, and afterwards."""
    scene = compiled_scene(image, settings)
    first = scene.picture()
    scene.mapper.SetMemoryBudget(1000)
    scene.look_at(image, 2)
    scene.renderer.ResetCameraClippingRange()
    (message,), picture = messages_of(scene)
    least = int(re.search(r"\((\d+) bytes\)", message)[1])
    scene.mapper.SetMemoryBudget(0)
    second = scene.picture()
    assert np.array_equal(picture, second) and not np.array_equal(second, first)
    scene.look_at(image, 1)
    assert np.array_equal(scene.picture(), first)
    scene.mapper.SetMemoryBudget(least)
    assert np.array_equal(scene.picture(), first)


# What the operating system lets a process have; room for all but the decoded blocks of a larger
# volume.
REAL = """
import resource, sys
sys.path[:0] = {path!r}
import numpy as np
import progiso
from helpers.comparison import ComparisonScene, picture_of
from helpers.images import make_image
from helpers.messages import vtk_messages
from helpers.comparison import OPAQUE, show

def slopes(n):
    return progiso.compress(make_image(np.indices((n,) * 3, np.float32).sum(0) / n - 1.5), rate=1)

small, large = slopes(32), slopes(256)
scene = ComparisonScene(ours=True)
show(scene, small, OPAQUE)
first = scene.picture()
size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
before = resource.getrlimit(resource.RLIMIT_AS)
resource.setrlimit(resource.RLIMIT_AS, (size + 2**25, before[1]))
scene.mapper.SetInputData(large)
with vtk_messages() as messages:
    scene.window.Render()
assert np.ptp(picture_of(scene.window).reshape(-1, 3), axis=0).max() == 0
resource.setrlimit(resource.RLIMIT_AS, before)
scene.mapper.SetInputData(small)
assert np.array_equal(scene.picture(), first)
scene.mapper.SetInputData(large)
scene.look_at(large)
assert np.ptp(scene.picture().reshape(-1, 3), axis=0).max() > 50
print(*messages)
"""


def test_memory_that_is_really_not_there():
    """64 MiB of decoded blocks do not fit until the process may have more memory."""
    if "vtkOSOpenGLRenderWindow" != vtkRenderWindow().GetClassName():
        pytest.skip("the memory of a GPU is not this process's; see Testing/gpu_faults.py")
    printed = run_program(REAL, PROGISO_GL_DEBUG="0")
    assert re.fullmatch(
        r"ERR.*the GPU has no room for \d+ bytes of cache_values: lower.*",
        printed.strip(),
        re.DOTALL,
    ), printed
