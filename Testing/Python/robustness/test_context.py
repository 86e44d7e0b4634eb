"""The context and its shader compiler: what they lack is one clear error; a context may go."""

import ctypes
import gc

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkRenderWindow

import progiso
from helpers import REPOSITORY
from helpers.comparison import NESTED, OPAQUE, ComparisonScene, show
from helpers.faults import is_empty, messages_of, run_program
from helpers.gl_hooks import gl, gl_errors, intercepted
from helpers.scenes import CACHED


@pytest.mark.parametrize(
    "file", ["MarkBlocks.comp", "CastRays.comp", "PlanPass.comp", "Composite.frag"]
)
def test_a_shader_does_not_compile(image, file):
    """Every render tries again; the first tells of it, in the compiler's own words."""
    scene = ComparisonScene(ours=True)
    scene.render()  # makes the context
    show(scene, image, OPAQUE, **CACHED).GetProperty().ShadeOn()
    mark = next((REPOSITORY / "Kernels").rglob(file)).read_bytes().splitlines()[0]

    def refuse(original, shader, count, strings, lengths):
        if mark in strings[0]:
            strings = (ctypes.c_char_p * 1)(b"#version 430\n#error no such luck\n")
        original(shader, count, strings, lengths)

    with intercepted("glShaderSource", refuse):
        for first in (True, False):
            messages, picture = messages_of(scene)
            assert len(messages) == first
            assert not first or (
                f"shader {file.split('.')[0]} does not build on this driver" in messages[0]
                and "no such luck" in messages[0]
            )
            assert is_empty(picture) and not gl_errors() and not scene.mapper.GetConverged()
    assert np.ptp(scene.picture().reshape(-1, 3), axis=0).max() > 50


PICTURES = """
import sys
sys.path[:0] = {path!r}
import numpy as np
from helpers.scenes import CACHED
from helpers.comparison import ComparisonScene
from helpers.images import blobs, make_image
from helpers.comparison import NESTED, OPAQUE, show
import progiso

image = progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)
pictures = []
for surfaces, settings in ((OPAQUE, {{}}), (NESTED, CACHED), (OPAQUE, CACHED)):
    scene = ComparisonScene(ours=True)
    show(scene, image, surfaces, **settings).GetProperty().ShadeOn()
    pictures.append(scene.picture().astype(np.uint8))
about = scene.window.ReportCapabilities()
np.savez({file!r}, pictures=pictures, extensions=about.split("extensions:")[1].split())
print(about.split("OpenGL version string:")[1].split()[0])
"""

REFUSED = """
import sys
sys.path[:0] = {path!r}
import numpy as np
from helpers.comparison import ComparisonScene, picture_of
from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.comparison import OPAQUE, show
import progiso

scene = ComparisonScene(ours=True)
show(scene, progiso.compress(make_image(blobs((16, 16, 16), 12)), rate=8), OPAQUE)
told = []
for _ in range(2):
    with vtk_messages() as messages:
        scene.window.Render()
    assert np.ptp(picture_of(scene.window).reshape(-1, 3), axis=0).max() == 0
    told += messages
assert len(told) == 1, told
print(*told)
"""


# What came after OpenGL 4.3, or never became a part of it. (Mesa cannot do without what did.)
LATER = """
ARB_bindless_texture ARB_buffer_storage ARB_clear_texture ARB_clip_control
ARB_conditional_render_inverted ARB_cull_distance ARB_derivative_control ARB_direct_state_access
ARB_enhanced_layouts ARB_ES3_1_compatibility ARB_ES3_2_compatibility ARB_get_texture_sub_image
ARB_gl_spirv ARB_gpu_shader_int64 ARB_indirect_parameters ARB_multi_bind ARB_parallel_shader_compile
ARB_pipeline_statistics_query ARB_polygon_offset_clamp ARB_post_depth_coverage
ARB_query_buffer_object ARB_shader_atomic_counter_ops ARB_shader_ballot ARB_shader_clock
ARB_shader_draw_parameters ARB_shader_group_vote ARB_shader_texture_image_samples
ARB_shader_viewport_layer_array ARB_sparse_buffer ARB_spirv_extensions ARB_texture_barrier
ARB_texture_filter_anisotropic ARB_texture_filter_minmax ARB_texture_mirror_clamp_to_edge
ARB_texture_stencil8 ARB_transform_feedback_overflow_query AMD_gpu_shader_int64 AMD_pinned_memory
AMD_shader_trinary_minmax ATI_meminfo EXT_memory_object EXT_memory_object_fd
EXT_shader_framebuffer_fetch EXT_shader_framebuffer_fetch_non_coherent
INTEL_shader_atomic_float_minmax KHR_blend_equation_advanced KHR_blend_equation_advanced_coherent
MESA_framebuffer_flip_y MESA_pack_invert MESA_shader_integer_functions NV_shader_atomic_float
NV_texture_barrier NVX_gpu_memory_info
""".split()


@pytest.fixture
def mesa():
    """Skip where Mesa does not make the contexts."""
    if "OS" not in vtkRenderWindow().GetClassName():
        pytest.skip("only Mesa's contexts can be told to be older than they are")


def test_plain_opengl_4_3(mesa, tmp_path):
    """Without extensions beyond 4.3 the pictures are the same, bit for bit."""
    full, floor = tmp_path / "full.npz", tmp_path / "floor.npz"
    run_program(PICTURES, file=str(full))
    version = run_program(
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
    """Without compute shaders there is one error a render, which says what is missing."""
    printed = run_program(
        REFUSED,
        MESA_GL_VERSION_OVERRIDE="4.2",
        MESA_GLSL_VERSION_OVERRIDE="420",
        MESA_EXTENSION_OVERRIDE="-GL_ARB_compute_shader",
    )
    assert (
        "needs OpenGL 4.3 (compute shaders),"
        " but this context offers 4.2 without GL_ARB_compute_shader" in printed
    )


@pytest.mark.parametrize("closed", ["finalized", "destroyed"])
@pytest.mark.parametrize("other", [False, True])
def test_a_context_goes_while_the_mapper_is_out_of_the_scene(image, settings, closed, other):
    """Nobody tells the mapper.

    It is shown again, in that window or another, beside a mapper made meanwhile.
    """
    first, second = ComparisonScene(ours=True), ComparisonScene(ours=True)
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
        first = ComparisonScene(ours=True, size=size)
    scene = second if other else first
    neighbour = show(scene, image, NESTED, **settings)
    assert np.array_equal(scene.picture(), expected)
    scene.renderer.RemoveVolume(neighbour)
    scene.volumes.clear()
    volume.SetMapper(mapper)
    scene.renderer.AddVolume(volume)
    scene.volumes.append(volume)
    assert np.array_equal(scene.picture(), expected) and not gl_errors()


def test_debugging_is_silent(image, monkeypatch):
    """OpenGL's debug output has nothing of high or medium severity, undefined or deprecated."""
    monkeypatch.setenv("PROGISO_GL_DEBUG", "0")
    scene, found = ComparisonScene(ours=True), []
    scene.render()
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
            volume = show(scene, image, surfaces, **settings)
            volume.GetProperty().ShadeOn()
            for size in ((160, 128), (90, 70)):
                scene.window.SetSize(*size)
                scene.render()
                progiso.depth(volume.GetMapper())
            scene.renderer.RemoveVolume(volume)
            scene.volumes.clear()
        assert not found
        gl("glEnable")(0xFFFF)
        assert found, "nothing was listened to"
    finally:
        gl("glDebugMessageCallback")(None, None)
        gl_errors()
