"""What fails beside the mapper, or in what it calls: the GPU's memory, its compiler, its context, observers. One clear error,
nothing drawn, nothing left behind, and the right picture as soon as that is possible."""

import ctypes
import gc
import os
import re
import subprocess
import sys
import time

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkRenderingCore import vtkRenderWindow

import progiso
from helpers import REPOSITORY, gl_hooks
from helpers.comparison import NESTED, OPAQUE, Stage, paint, picture_of, show
from helpers.gl_hooks import gl, gl_errors, intercepted
from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.scenes import CACHED

MODES = {"whole": {}, "cached": CACHED}


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)


@pytest.fixture(params=MODES)
def settings(request):
    return MODES[request.param]


@pytest.fixture
def uncounted(monkeypatch):
    """Errors that are provoked are not to be counted as the mapper's."""
    monkeypatch.setenv("PROGISO_GL_DEBUG", "0")


def staged(image, settings, surfaces=OPAQUE):
    """A stage whose shaders stay compiled: another volume holds them."""
    stage = Stage(True, (64, 48))
    for _ in range(2):
        show(stage, image, surfaces, **settings).GetProperty().ShadeOn()
    stage.render()
    stage.volumes.pop().VisibilityOff()
    stage.render()
    return stage


def messages_of(stage):
    """Render; return what VTK reports, and the picture."""
    with vtk_messages() as messages:
        stage.window.Render()
    return messages, picture_of(stage.window)


def is_empty(picture):
    return np.ptp(picture.reshape(-1, 3), axis=0).max() == 0


# --- the GPU's memory --------------------------------------------------------------------------------------------------------

TARGETS = {
    "storage": {gl_hooks.STORAGE_BUFFER},
    "other": {gl_hooks.UNIFORM_BUFFER, gl_hooks.COPY_READ_BUFFER, gl_hooks.COPY_WRITE_BUFFER},
}


@pytest.mark.parametrize("targets", TARGETS)
def test_no_room(uncounted, image, settings, targets):
    """Each allocation in turn is refused by the driver: an error that says what to do, then the right picture."""
    stage = staged(image, settings, NESTED if settings else OPAQUE)
    first, failures = stage.picture(), 0
    while True:
        stage.volumes[0].ReleaseGraphicsResources(stage.window)
        fault = gl_hooks.NoRoom(failures + 1, TARGETS[targets])
        with intercepted("glBufferData", fault):
            messages, picture = messages_of(stage)
        if fault.count <= failures:
            break
        failures += 1
        assert len(messages) == 1 and re.search(
            "no room for .* bytes of|out of memory", messages[0]
        ), messages
        assert "lower the memory budget, the rate or the image size" in messages[0]
        assert is_empty(picture) and not gl_errors()
        assert not stage.mapper.GetConverged()
        assert np.array_equal(stage.picture(), first)
    assert np.array_equal(picture, first) and not messages
    assert failures >= (7 if targets == "storage" else 2)


def test_no_room_where_it_is_used(uncounted, image, settings):
    """Some drivers make memory when a stage first touches it."""
    stage = staged(image, settings)
    first = stage.picture()
    stage.volumes[0].ReleaseGraphicsResources(stage.window)

    pending = []

    def dispatch(original, *groups):
        pending.append(gl_hooks.OUT_OF_MEMORY)
        original(*groups)

    with (
        intercepted("glDispatchCompute", dispatch),
        intercepted("glGetError", lambda of: pending.pop() if pending else of()),
    ):
        messages, picture = messages_of(stage)
    (message,) = messages
    assert (
        "the GPU has run out of memory: lower" in message and is_empty(picture) and not gl_errors()
    )
    assert np.array_equal(stage.picture(), first)


def test_a_budget_too_small_leaves_no_old_picture(image, settings):
    """While it is too small the camera moves; then the picture is the new camera's."""
    stage = staged(image, settings)
    first = stage.picture()
    stage.mapper.SetMemoryBudget(1000)
    stage.look_at(image, 2)
    stage.renderer.ResetCameraClippingRange()
    (message,), picture = messages_of(stage)
    least = int(re.search(r"at least (\d+) bytes", message)[1])
    assert is_empty(picture)
    stage.mapper.SetMemoryBudget(0)
    second = stage.picture()
    assert not np.array_equal(second, first)
    stage.look_at(image, 1)
    assert np.array_equal(stage.picture(), first)
    stage.mapper.SetMemoryBudget(least)
    assert np.array_equal(stage.picture(), first)


# What the operating system lets a process have; room for all but the decoded blocks of a larger volume.
REAL = """
import resource, sys
sys.path[:0] = {path!r}
import numpy as np
import progiso
from helpers.comparison import Stage, picture_of
from helpers.images import make_image
from helpers.messages import vtk_messages
from helpers.comparison import OPAQUE, show

small, large = (progiso.compress(make_image(np.indices((n,) * 3, np.float32).sum(0) / n - 1.5), 1) for n in (32, 256))
stage = Stage(True)
show(stage, small, OPAQUE)
first = stage.picture()
size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
before = resource.getrlimit(resource.RLIMIT_AS)
resource.setrlimit(resource.RLIMIT_AS, (size + 2**25, before[1]))
stage.mapper.SetInputData(large)
with vtk_messages() as messages:
    stage.window.Render()
assert np.ptp(picture_of(stage.window).reshape(-1, 3), axis=0).max() == 0
resource.setrlimit(resource.RLIMIT_AS, before)
stage.mapper.SetInputData(small)
assert np.array_equal(stage.picture(), first)
stage.mapper.SetInputData(large)
stage.look_at(large)
assert np.ptp(stage.picture().reshape(-1, 3), axis=0).max() > 50
print(*messages)
"""


def run(program, file=None, **environment):
    """Run a program in a process of its own; return what it prints."""
    program = program.format(path=[path for path in sys.path if path], file=file)
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_memory_that_is_really_not_there():
    """64 MiB of decoded blocks do not fit into what the process may have; they do as soon as it may have more."""
    if "vtkOSOpenGLRenderWindow" != vtkRenderWindow().GetClassName():
        pytest.skip("the memory of a GPU is not this process's; see Testing/gpu_faults.py")
    printed = run(REAL, PROGISO_GL_DEBUG="0")
    assert re.fullmatch(
        r"ERR.*the GPU has no room for \d+ bytes of cache_values: lower.*",
        printed.strip(),
        re.DOTALL,
    ), printed


# --- the compiler ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "file", ["BlockRanges.comp", "CastRays.comp", "PlanPass.comp", "Composite.frag"]
)
def test_a_shader_does_not_compile(image, file):
    """For as long as that is so: one error a render, with the compiler's own words."""
    stage = Stage(True)
    stage.render()  # makes the context
    show(stage, image, OPAQUE, **CACHED).GetProperty().ShadeOn()
    mark = next((REPOSITORY / "Kernels").rglob(file)).read_bytes().splitlines()[0]

    def refuse(original, shader, count, strings, lengths):
        if mark in strings[0]:
            strings = (ctypes.c_char_p * 1)(b"#version 430\n#error no such luck\n")
        original(shader, count, strings, lengths)

    with intercepted("glShaderSource", refuse):
        for _ in range(2):
            (message,), picture = messages_of(stage)
            assert (
                f"shader {file.split('.')[0]} does not build on this driver" in message
                and "no such luck" in message
            )
            assert is_empty(picture) and not gl_errors() and not stage.mapper.GetConverged()
    assert np.ptp(stage.picture().reshape(-1, 3), axis=0).max() > 50


# --- the context -------------------------------------------------------------------------------------------------------------

PICTURES = """
import sys
sys.path[:0] = {path!r}
import numpy as np
from helpers.scenes import CACHED
from helpers.comparison import Stage
from helpers.images import blobs, make_image
from helpers.comparison import NESTED, OPAQUE, show
import progiso

image = progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)
pictures = []
for surfaces, settings in ((OPAQUE, {{}}), (NESTED, CACHED), (OPAQUE, CACHED)):
    stage = Stage(True)
    show(stage, image, surfaces, **settings).GetProperty().ShadeOn()
    pictures.append(stage.picture().astype(np.uint8))
about = stage.window.ReportCapabilities()
np.savez({file!r}, pictures=pictures, extensions=about.split("extensions:")[1].split())
print(about.split("OpenGL version string:")[1].split()[0])
"""

REFUSED = """
import sys
sys.path[:0] = {path!r}
import numpy as np
from helpers.comparison import Stage, picture_of
from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.comparison import OPAQUE, show
import progiso

stage = Stage(True)
show(stage, progiso.compress(make_image(blobs((16, 16, 16), 12)), rate=8), OPAQUE)
for _ in range(2):
    with vtk_messages() as messages:
        stage.window.Render()
    assert np.ptp(picture_of(stage.window).reshape(-1, 3), axis=0).max() == 0
    assert len(messages) == 1, messages
print(*messages)
"""


# What came after OpenGL 4.3, or never became a part of it. (Mesa cannot do without what did.)
LATER = """
ARB_bindless_texture ARB_buffer_storage ARB_clear_texture ARB_clip_control ARB_conditional_render_inverted ARB_cull_distance
ARB_derivative_control ARB_direct_state_access ARB_enhanced_layouts ARB_ES3_1_compatibility ARB_ES3_2_compatibility
ARB_get_texture_sub_image ARB_gl_spirv ARB_gpu_shader_int64 ARB_indirect_parameters ARB_multi_bind ARB_parallel_shader_compile
ARB_pipeline_statistics_query ARB_polygon_offset_clamp ARB_post_depth_coverage ARB_query_buffer_object
ARB_shader_atomic_counter_ops ARB_shader_ballot ARB_shader_clock ARB_shader_draw_parameters ARB_shader_group_vote
ARB_shader_texture_image_samples ARB_shader_viewport_layer_array ARB_sparse_buffer ARB_spirv_extensions ARB_texture_barrier
ARB_texture_filter_anisotropic ARB_texture_filter_minmax ARB_texture_mirror_clamp_to_edge ARB_texture_stencil8
ARB_transform_feedback_overflow_query AMD_gpu_shader_int64 AMD_pinned_memory AMD_shader_trinary_minmax ATI_meminfo
EXT_memory_object EXT_memory_object_fd EXT_shader_framebuffer_fetch EXT_shader_framebuffer_fetch_non_coherent
INTEL_shader_atomic_float_minmax KHR_blend_equation_advanced KHR_blend_equation_advanced_coherent MESA_framebuffer_flip_y
MESA_pack_invert MESA_shader_integer_functions NV_shader_atomic_float NV_texture_barrier NVX_gpu_memory_info
""".split()


@pytest.fixture
def mesa():
    if "OS" not in vtkRenderWindow().GetClassName():
        pytest.skip("only Mesa's contexts can be told to be older than they are")


def test_plain_opengl_4_3(mesa, tmp_path):
    """Without extensions beyond it, the pictures are the same, bit for bit."""
    full, floor = tmp_path / "full.npz", tmp_path / "floor.npz"
    run(PICTURES, file=str(full))
    version = run(
        PICTURES,
        file=str(floor),
        MESA_GL_VERSION_OVERRIDE="4.3",
        MESA_GLSL_VERSION_OVERRIDE="430",
        MESA_EXTENSION_OVERRIDE=" ".join(f"-GL_{name}" for name in LATER),
    )
    full, floor = np.load(full), np.load(floor)
    later = {f"GL_{name}" for name in LATER}
    assert (
        version.split()[-1] == "4.3"
        and later & {*full["extensions"]}
        and not later & {*floor["extensions"]}
    )
    assert np.array_equal(full["pictures"], floor["pictures"])


def test_opengl_below_4_3(mesa):
    """Without compute shaders: one error a render, which tells what is missing."""
    printed = run(
        REFUSED,
        MESA_GL_VERSION_OVERRIDE="4.2",
        MESA_GLSL_VERSION_OVERRIDE="420",
        MESA_EXTENSION_OVERRIDE="-GL_ARB_compute_shader",
    )
    assert (
        "needs OpenGL 4.3 (compute shaders), but this context offers 4.2 without GL_ARB_compute_shader"
        in printed
    )


@pytest.mark.parametrize("closed", ["finalized", "destroyed"])
@pytest.mark.parametrize("other", [False, True])
def test_a_context_goes_while_the_mapper_is_out_of_the_scene(image, settings, closed, other):
    """Nobody tells the mapper; then it is shown again, in that window or another, beside a mapper that was made meanwhile."""
    first, second = Stage(True), Stage(True)
    volume = show(first, image, NESTED, **settings)
    expected = first.picture()
    mapper = volume.GetMapper()
    volume.SetMapper(None)
    first.renderer.RemoveVolume(volume)
    first.volumes.clear()
    first.window.Finalize()
    if closed == "destroyed":
        size = first.window.GetSize()
        first.window.RemoveRenderer(first.renderer)
        first.window = None
        gc.collect()
        first = Stage(True, size=size)
    stage = second if other else first
    neighbour = show(stage, image, NESTED, **settings)
    assert np.array_equal(stage.picture(), expected)
    stage.renderer.RemoveVolume(neighbour)
    stage.volumes.clear()
    volume.SetMapper(mapper)
    stage.renderer.AddVolume(volume)
    stage.volumes.append(volume)
    assert np.array_equal(stage.picture(), expected) and not gl_errors()


def test_debugging_is_silent(image, monkeypatch):
    """OpenGL's debug output has nothing to say of high or medium severity, nor of anything that is undefined or deprecated."""
    monkeypatch.setenv("PROGISO_GL_DEBUG", "0")
    stage, found = Stage(True), []
    stage.render()
    kind = ctypes.CFUNCTYPE(
        None, *[ctypes.c_uint] * 4, ctypes.c_int, ctypes.c_char_p, ctypes.c_void_p
    )

    @kind
    def listen(_source, type_, _id, severity, _length, text, _user):
        if (
            severity in (0x9146, 0x9147) or 0x824C <= type_ <= 0x824F
        ):  # high and medium; errors to portability
            found.append(text)

    for switch in (0x92E0, 0x8242):  # debug output, and at once
        gl("glEnable")(switch)
    gl("glDebugMessageControl")(*[0x1100] * 3, 0, None, 1)  # all of it
    gl("glDebugMessageCallback")(ctypes.cast(listen, ctypes.c_void_p), None)
    try:
        for surfaces, settings in (
            (OPAQUE, {}),
            (NESTED, {**CACHED, "DetailedStatistics": True}),
            (OPAQUE, CACHED),
        ):
            volume = show(stage, image, surfaces, **settings)
            volume.GetProperty().ShadeOn()
            for size in ((160, 128), (90, 70)):
                stage.window.SetSize(*size)
                stage.render()
                progiso.depth(volume.GetMapper())
            stage.renderer.RemoveVolume(volume)
            stage.volumes.clear()
        assert not found
        gl("glEnable")(0xFFFF)
        assert found, "nothing was listened to"
    finally:
        gl("glDebugMessageCallback")(None, None)
        gl_errors()


# --- observers ---------------------------------------------------------------------------------------------------------------


class Trouble(Exception):
    pass


def observed(stage, event, does, on=None):
    """Add an observer that does something once."""
    done = []

    def act(caller, _event):
        if not done:
            done.append(True)
            does(caller)

    (on or stage.mapper).AddObserver(event, act)
    return done


@pytest.fixture
def scene(image):
    """A stage whose image takes many passes, and its picture."""
    stage = Stage(True)
    show(stage, image, OPAQUE, **CACHED, SpeculationLimit=1).GetProperty().ShadeOn()
    expected = stage.picture()
    stage.mapper.EmptyCache()
    time.sleep(0.21)  # windows ask observers whether to abort five times a second
    return stage, expected


@pytest.mark.parametrize("event", ["ProgressEvent", "StartEvent", "EndEvent", "AbortCheckEvent"])
def test_an_exception_in_an_observer(scene, event, capfd):
    """It is told and goes no farther."""
    stage, expected = scene

    def fail(_caller):
        raise Trouble("of the observer's own")

    target = {"ProgressEvent": stage.mapper, "StartEvent": stage.volumes[0]}.get(
        event, stage.window
    )
    done = observed(stage, event, fail, target)
    assert np.array_equal(stage.picture(), expected)
    assert done and "Trouble: of the observer's own" in capfd.readouterr().err
    assert np.array_equal(stage.picture(), expected)


def test_an_observer_aborts(scene):
    """After some pass; the next render goes on from there."""
    stage, expected = scene
    done = observed(stage, "AbortCheckEvent", lambda window: window.SetAbortRender(1), stage.window)
    stage.window.Render()
    assert done and not stage.mapper.GetConverged() and stage.mapper.GetCompletedFraction() < 1
    assert stage.mapper.GetNumberOfGLErrors() == 0
    assert np.array_equal(stage.picture(), expected)


def other_window(stage, image):
    """A window of its own for the stage's mapper."""
    other = Stage(True)
    other.look_at(image)
    volume = type(stage.volumes[0])()
    volume.SetMapper(stage.mapper)
    volume.SetProperty(stage.volumes[0].GetProperty())
    other.renderer.AddVolume(volume)
    other.renderer.ResetCameraClippingRange()
    other.volumes.append(volume)
    return other


DEEDS = {
    "renders": lambda stage, image: stage.window.Render(),
    "renders another window": lambda stage, image: Stage(True).render(),
    "renders the mapper in another window": lambda stage, image: other_window(
        stage, image
    ).window.Render(),
    "releases": lambda stage, image: stage.mapper.ReleaseGraphicsResources(stage.window),
    "changes the input": lambda stage, image: stage.mapper.SetInputData(
        make_image(blobs((20, 20, 20), 3))
    ),
    "changes the size": lambda stage, image: stage.window.SetSize(60, 50),
    "changes the isovalue": lambda stage, image: paint(stage.volumes[0], {0.3: (1, 0, 0, 1)}),
    "changes the budget": lambda stage, image: stage.mapper.SetMemoryBudget(1000),
    "empties the cache": lambda stage, image: stage.mapper.EmptyCache(),
    "picks": lambda stage, image: stage.mapper.GetHit(80, 64, [0] * 3, reference(0.0)),
    "takes the mapper away": lambda stage, image: stage.volumes[0].SetMapper(None),
    "takes the input away": lambda stage, image: stage.mapper.RemoveAllInputs(),
}


@pytest.mark.parametrize("event", ["ProgressEvent", "AbortCheckEvent", "StartEvent"])
@pytest.mark.parametrize("deed", DEEDS)
def test_an_observer_does_anything(scene, image, event, deed):
    """While the mapper renders: that may spoil the picture, but nothing else; undone, the picture is right."""
    stage, expected = scene
    mapper, volume, size = stage.mapper, stage.volumes[0], stage.window.GetSize()
    targets = {"ProgressEvent": mapper, "AbortCheckEvent": stage.window, "StartEvent": volume}
    done = observed(stage, event, lambda _: DEEDS[deed](stage, image), targets[event])
    with vtk_messages():
        stage.window.Render()
    assert done
    volume.SetMapper(mapper)
    mapper.SetInputData(image)
    mapper.SetMemoryBudget(0)
    paint(volume, OPAQUE)
    stage.window.SetSize(*size)
    stage.render()
    # VTK's meshes crash where they move to another window while they are rendered; OSMesa's windows are not drawn to after that
    if "OS" not in stage.window.GetClassName() or "mapper in another" not in deed:
        assert np.array_equal(stage.picture(), expected)


def test_an_observer_drops_the_last_reference(scene):
    """The mapper lives on until its render has ended."""
    stage, _ = scene
    observed(stage, "ProgressEvent", lambda _: stage.volumes.pop().SetMapper(None))
    stage.window.Render()
    gc.collect()
    assert not gl_errors()
