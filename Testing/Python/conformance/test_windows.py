"""Viewports, several windows, resizing, multisampling, stereo."""

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkRenderer

from helpers.comparison import (
    NESTED,
    OPAQUE,
    ComparisonScene,
    both,
    check_like_vtk,
    check_scene_like_vtk,
    far_apart,
    picture_of,
    show,
)
from helpers.geometry import ball
from progiso.measure import tolerances


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_viewports(image, surfaces):
    """Two renderers with one mapper show the same volume from two sides; two others show something
    else."""

    def build(scene):
        show(scene, image, surfaces)
        scene.renderer.SetViewport(0.5, 0.0, 1.0, 0.5)
        for corner in ((0, 0), (0.5, 0.5), (0, 0.5)):
            other = vtkRenderer()
            other.SetViewport(*corner, corner[0] + 0.5, corner[1] + 0.5)
            other.SetBackground(0.3, 0.2, 0.2)
            scene.window.AddRenderer(other)
            if corner == (0, 0):
                other.AddActor(ball(10))  # hides nothing in the other viewports
            else:
                other.AddVolume(scene.volumes[0])
                scene.look_at(image, int(4 * corner[0]), camera=other.GetActiveCamera())
            other.ResetCameraClippingRange() if corner != (0, 0) else other.ResetCamera()

    check_scene_like_vtk(build, size=(240, 200))


def test_several_windows(image):
    """Each window has a mapper of its own for the same image; then one mapper goes from window to
    window."""
    scenes = [ComparisonScene(ours=True), ComparisonScene(ours=True)]
    for scene in scenes:
        show(scene, image, NESTED)
    pictures = [scene.picture() for scene in scenes for _ in range(2)]
    assert all(np.array_equal(pictures[0], picture) for picture in pictures)
    wanderer = scenes[0].volumes[0]
    for scene in scenes:
        scene.renderer.RemoveAllViewProps()
    for scene in (scenes[1], scenes[0], scenes[1]):
        scene.renderer.AddVolume(wanderer)
        scene.render()
        assert np.array_equal(picture_of(scene.window), pictures[0])
        scene.renderer.RemoveVolume(wanderer)


def test_window_resize(image):
    scenes = both(lambda scene: show(scene, image, NESTED))
    for size in ((160, 128), (90, 130), (200, 70)):
        for scene in scenes:
            scene.window.SetSize(*size)
        pictures = [scene.picture() for scene in scenes]
        assert pictures[0].shape == (size[1], size[0], 3)
        check_like_vtk(*pictures)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_multisampling(image, surfaces):
    """With opaque geometry, whose depth is resolved from the multisampled framebuffer."""

    def build(scene):
        show(scene, image, surfaces)
        scene.renderer.AddActor(ball(11))

    ours, _, picture = check_scene_like_vtk(build, samples=8)
    plain = ComparisonScene(ours=True)
    build(plain)
    assert not np.array_equal(picture, plain.picture())  # the sphere's edges are smooth


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize(
    "kind", ["CrystalEyes", "Left", "Right", "Anaglyph", "SplitViewportHorizontal"]
)
def test_stereo(cube, surfaces, kind):
    """Beside triangles, as in VTK's mapper an eye's rays go on in the volume as from between the
    eyes."""
    ours, theirs, mono = (
        ComparisonScene(ours=True),
        ComparisonScene(ours=False),
        ComparisonScene(ours=True),
    )
    show(ours, cube, surfaces)
    theirs.add_mesh(cube, surfaces)
    show(mono, cube, surfaces)
    for scene in (ours, theirs):
        scene.camera.SetEyeAngle(15)  # so that what shears the rays shows
        scene.window.StereoCapableWindowOn()
        scene.window.StereoRenderOn()
        getattr(scene.window, "SetStereoTypeTo" + kind)()
    pictures = ours.picture(), theirs.picture()
    check_like_vtk(*pictures)
    assert far_apart(mono.picture(), pictures[0])[0] > 1.5 * tolerances.VTK_PIXELS
