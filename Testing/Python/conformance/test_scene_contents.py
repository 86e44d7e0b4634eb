"""Opaque and translucent geometry, and other volumes, in the same scene."""

import numpy as np
import pytest

import progiso
from helpers.comparison import (
    BLUE,
    NESTED,
    OPAQUE,
    RED,
    ComparisonScene,
    both,
    check_like_vtk,
    check_scene_like_vtk,
    far_apart,
    picture_of,
    show,
)
from helpers.geometry import ball, wall


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("share", [0.3, 0.85, 1.0, 1.15, 1.8])
def test_opaque_geometry(image, surfaces, share):
    """A wall stands before, between and behind the surfaces."""

    def build(scene):
        show(scene, image, surfaces)
        scene.renderer.AddActor(wall(scene.camera, share))

    check_scene_like_vtk(build)


@pytest.mark.parametrize("radius", [6, 12, 17])
def test_opaque_geometry_comes_and_goes(image, radius):
    """A change that the volume has no part in restarts a translucent picture, too."""
    scenes = both(lambda scene: show(scene, image, NESTED))
    bare = scenes[0].picture()
    balls = [ball(radius), ball(radius)]
    for scene, actor in zip(scenes, balls):
        scene.renderer.AddActor(actor)
    check_like_vtk(*(scene.picture() for scene in scenes))
    for actor in balls:
        actor.SetPosition(5, 5, 5)
    check_like_vtk(*(scene.picture() for scene in scenes))
    for actor in balls:
        actor.VisibilityOff()
    assert np.array_equal(scenes[0].picture(), bare)


@pytest.mark.parametrize("peels", [False, True])
def test_invisible_geometry_leaves_no_trace(image, peels):
    """A sphere of opacity 0 crosses the surface."""
    plain, scene = ComparisonScene(ours=True), ComparisonScene(ours=True)
    for each in (plain, scene):
        show(each, image, NESTED if peels else OPAQUE)
        each.peel(peels)
    scene.renderer.AddActor(ball(11, opacity=0.0))
    assert far_apart(scene.picture(), plain.picture())[0] == 0


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_several_volumes(image, surfaces):
    """Two volumes apart have a mapper, a place and colours each."""
    other = {0.2: (*BLUE, next(iter(surfaces.values()))[3])}

    def build(scene):
        scene.add(image, surfaces)
        place = np.eye(4)
        place[:3, 3] = 30, 0, 0
        scene.add(image, other, matrix=place)
        scene.look_at(image, 2, distance=2.5)

    check_scene_like_vtk(build)


def test_volumes_are_added_and_removed(image):
    def build(scene):
        scene.add(image, OPAQUE)
        scene.add(image, {0.1: (*RED, 1.0)}, matrix=np.diag([-1, 1, 1, 1]))
        scene.look_at(image, 1, distance=2.5)

    scenes = both(build)
    for change in ("RemoveVolume", "AddVolume"):
        for scene in scenes:
            getattr(scene.renderer, change)(scene.volumes[1])
        check_like_vtk(*(scene.picture() for scene in scenes))


def test_overlapping_opaque_volumes(image):
    """Opaque surfaces of two volumes hide each other by depth.

    VTK has vtkMultiVolume for that, so the caster is the reference.
    """
    half = np.eye(4)
    half[:3, 3] = 6, 4, 2
    scene = ComparisonScene(ours=True)
    scene.add(image, OPAQUE)
    scene.add(image, {0.1: (*RED, 1.0)}, matrix=half)
    scene.look_at(image, 1)
    scene.render()
    depths = [progiso.depth(volume.GetMapper()) for volume in scene.volumes]
    picture = picture_of(scene.window)
    reds = picture[..., 0] > picture[..., 1]
    clear = np.isfinite(depths[0]) & np.isfinite(depths[1])
    clear[clear] = np.abs(depths[0][clear] - depths[1][clear]) > 1e-2
    assert clear.sum() > 1000 and 100 < reds[clear].sum() < clear.sum() - 100
    assert np.array_equal(reds[clear], (depths[1] < depths[0])[clear])
