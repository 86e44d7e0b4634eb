"""VTK's render passes, and depth peeling."""

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkCameraPass,
    vtkFramebufferPass,
    vtkLightsPass,
    vtkOpaquePass,
    vtkOpenGLFXAAPass,
    vtkOverlayPass,
    vtkRenderPassCollection,
    vtkRenderStepsPass,
    vtkSequencePass,
    vtkSSAAPass,
    vtkSSAOPass,
    vtkTextureObject,
    vtkTranslucentPass,
    vtkVolumetricPass,
)

import progiso
from helpers.comparison import (
    BLUE,
    NESTED,
    OPAQUE,
    RED,
    ComparisonScene,
    check_like_vtk,
    check_scene_like_vtk,
    far_apart,
    show,
    show_lit,
)
from helpers.geometry import CENTRE, ball, planes
from helpers.messages import vtk_messages


def test_depth_peeling(image):
    """Translucent geometry lies before, within and behind an opaque isosurface, which VTK needs to
    peel, too."""

    def build(scene):
        show(scene, image)
        scene.peel(not scene.ours)
        scene.renderer.AddActor(ball(13, RED, 0.4))
        scene.renderer.AddActor(ball(9, BLUE, 0.5, CENTRE + 4))

    _, theirs, picture = check_scene_like_vtk(build)
    ours = ComparisonScene(ours=True)
    build(ours)
    ours.renderer.UseDepthPeelingForVolumesOn()
    assert np.array_equal(ours.picture(), picture)


def test_depth_peeling_and_clipping(image):
    def build(scene):
        show(scene, image).GetMapper().AddClippingPlane(next(planes((1, 0.2, 0))))
        scene.peel(not scene.ours)
        scene.renderer.AddActor(ball(13, RED, 0.4))
        scene.renderer.AddActor(ball(6))

    check_scene_like_vtk(build)


@pytest.mark.parametrize("for_volumes", [False, True])
def test_translucent_surfaces_cover_translucent_geometry(image, for_volumes):
    """A translucent isosurface is drawn over translucent geometry, peeled or not, as by VTK where
    volumes are not peeled."""

    def build(scene):
        show(scene, image, NESTED)
        scene.peel(for_volumes and scene.ours)
        scene.renderer.AddActor(ball(13, RED, 0.4))

    check_scene_like_vtk(build)


def passes(*kinds):
    """Return a camera pass with a sequence of render passes."""
    collection, sequence, camera = vtkRenderPassCollection(), vtkSequencePass(), vtkCameraPass()
    for kind in kinds:
        collection.AddItem(kind())
    sequence.SetPasses(collection)
    camera.SetDelegatePass(sequence)
    return camera


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_render_passes(image, surfaces):
    """A sequence of passes makes the same picture as the renderer."""

    def build(scene):
        show(scene, image, surfaces)
        scene.renderer.AddActor(ball(11))

    def build_by_passes(scene):
        build(scene)
        sequence = passes(
            vtkLightsPass, vtkOpaquePass, vtkTranslucentPass, vtkVolumetricPass, vtkOverlayPass
        )
        scene.renderer.SetPass(sequence)

    plain = ComparisonScene(ours=True)
    build(plain)
    _, _, picture = check_scene_like_vtk(build_by_passes)
    assert np.array_equal(picture, plain.picture())


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("depths", ["Fixed16", "Fixed24", "Fixed32", "Float32"])
def test_depth_formats(image, surfaces, depths):
    """A pass's framebuffer may keep depths in any format; VTK's mapper would have to be told."""
    plain, scene = ComparisonScene(ours=True), ComparisonScene(ours=True)
    for each in (plain, scene):
        show(each, image, surfaces)
        each.renderer.AddActor(ball(11))
    frame = vtkFramebufferPass()
    frame.SetDepthFormat(getattr(vtkTextureObject, depths))
    frame.SetDelegatePass(
        passes(vtkLightsPass, vtkOpaquePass, vtkTranslucentPass, vtkVolumetricPass)
    )
    scene.renderer.SetPass(frame)
    check_like_vtk(scene.picture(), plain.picture())


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_fxaa(image, surfaces):
    def build(scene):
        show(scene, image, surfaces)
        scene.renderer.AddActor(ball(11))
        smooth = vtkOpenGLFXAAPass()
        smooth.SetDelegatePass(vtkRenderStepsPass())
        scene.renderer.SetPass(smooth)

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_supersampling(image, surfaces):
    """The pass draws into a framebuffer larger than the window, where VTK's mapper shows no
    isosurface."""
    plain, scene = ComparisonScene(ours=True), ComparisonScene(ours=True)
    for each in (plain, scene):
        show(each, image, surfaces)
        each.renderer.AddActor(ball(11))
    fine = vtkSSAAPass()
    fine.SetDelegatePass(vtkRenderStepsPass())
    scene.renderer.SetPass(fine)
    apart = np.abs(scene.picture() - plain.picture()).max(axis=2)
    assert 0.002 < (apart > 20).mean() < 0.1, "edges are blended"
    assert (apart <= 2).mean() > 0.75, "the rest is the same"
    found = []
    for each in (plain, scene):
        position, isovalue = [0.0] * 3, reference(0.0)
        assert each.mapper.GetHit(80, 64, position, isovalue)
        found.append((*position, isovalue.get()))
    assert found[0] == pytest.approx(found[1], abs=0.5)


def occluded(scene):
    """Give a scene the ambient occlusion pass."""
    dark = vtkSSAOPass()
    dark.SetRadius(6)
    dark.SetKernelSize(64)
    dark.SetBias(0.05)
    dark.SetDelegatePass(vtkRenderStepsPass())
    scene.renderer.SetPass(dark)


def test_ambient_occlusion(cube):
    """The pass darkens the isosurface as it does its triangles. VTK's mapper shows none in it."""
    ours, theirs = ComparisonScene(ours=True), ComparisonScene(ours=True)
    show_lit(ours, cube)
    look = theirs.add_mesh(cube, OPAQUE).GetProperty()
    look.LightingOn()
    look.SetAmbient(0)
    look.SetDiffuse(0.7)
    bright, dark = [], []
    for scene in (ours, theirs):
        scene.renderer.AddActor(ball(11))
        bright.append(scene.picture())
        occluded(scene)
        dark.append(scene.picture())
    hit = np.isfinite(progiso.depth(ours.mapper))
    mine, triangles = ((a - b)[hit] for a, b in zip(bright, dark))
    assert triangles.mean() > 2 and np.corrcoef(mine.ravel(), triangles.ravel())[0, 1] > 0.9
    assert abs(mine.mean() - triangles.mean()) < 0.1 * triangles.mean()


def test_ambient_occlusion_of_an_unlit_surface(cube):
    """It has no normals: it counts as turned to the viewer, and darkens as far as it is not."""
    scene = ComparisonScene(ours=True)
    show(scene, cube)
    scene.renderer.AddActor(ball(11))
    bright = scene.picture()
    occluded(scene)
    with vtk_messages() as messages:  # VTK says that it wants shaded volumes
        darker = (bright - scene.picture())[np.isfinite(progiso.depth(scene.mapper))].max(axis=1)
    assert len(messages) == 1
    assert 0.1 < (darker > 20).mean() < 0.9 and darker.mean() < 80


def test_translucent_surfaces_occlude_nothing(image):
    """No shadow falls on them; the sphere behind keeps its own."""
    scene = ComparisonScene(ours=True)
    show(scene, image, NESTED)
    scene.renderer.AddActor(ball(11))
    plain = scene.picture()
    occluded(scene)
    assert far_apart(scene.picture(), plain)[0] < 0.2
