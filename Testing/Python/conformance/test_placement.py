"""Where the volume is, and the camera: matrices, directions, projections."""

import numpy as np
import pytest

import progiso
from helpers.comparison import (
    NESTED,
    OPAQUE,
    ComparisonScene,
    both,
    check_like_vtk,
    check_scene_like_vtk,
    far_apart,
    matrix_of,
    show,
    show_lit,
)
from helpers.geometry import CENTRE, MIRRORED, SHAPE, STRETCHED, TURNED
from helpers.images import blobs, make_image


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("matrix", [TURNED, STRETCHED, MIRRORED, TURNED @ STRETCHED @ MIRRORED])
def test_user_matrix(image, matrix, surfaces):
    check_scene_like_vtk(lambda scene: show(scene, image, surfaces, matrix=matrix))


@pytest.mark.parametrize("matrix", [TURNED, STRETCHED, MIRRORED, TURNED @ STRETCHED @ MIRRORED])
def test_user_matrix_and_light(cube, matrix):
    """Beside triangles, as VTK's mapper does not turn normals as planes.

    Only what their lit side shows counts.
    """
    ours, theirs = ComparisonScene(ours=True), ComparisonScene(ours=False)
    show_lit(ours, cube, matrix=matrix)
    look = theirs.add_mesh(cube, OPAQUE, matrix).GetProperty()
    look.LightingOn()
    look.SetAmbient(0)
    look.SetDiffuse(0.7)
    for scene in (ours, theirs):
        scene.shine(position=(60, 80, 30))
    pictures = ours.picture(), theirs.picture()
    check_like_vtk(*pictures, beside=pictures[1][..., 1] < 30)


@pytest.mark.parametrize("spacing", [(1, 1, 1), (0.5, 2, 1)])
def test_oriented_image(spacing):
    """The image has a direction matrix, an origin, and an extent that does not begin at 0."""
    direction = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    values = make_image(
        blobs(SHAPE, 12, waves=2),
        origin=(3, -4, 5),
        spacing=spacing,
        direction=direction,
        extent_start=(2, -7, 4),
    )
    compressed = progiso.compress(values, rate=16)
    check_scene_like_vtk(lambda scene: show(scene, compressed, NESTED))


def test_from_perspective_to_parallel(image):
    scenes = both(lambda scene: show(scene, image, NESTED))
    pictures = [scenes[0].picture()]
    for scene in scenes:
        scene.camera.ParallelProjectionOn()
        scene.camera.SetParallelScale(18)
    pictures.append(scenes[0].picture())
    check_like_vtk(pictures[1], scenes[1].picture())
    assert not np.array_equal(*pictures)


@pytest.mark.parametrize(
    "spacing, matrix, angle",
    [
        ((1, 1, 1), None, 60),
        ((1e-3, 1e-3, 1e-3), None, 60),
        ((1, 1, 1), TURNED, 60),
        ((1, 1, 1), STRETCHED, 60),
    ],
)
@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_camera_inside(spacing, matrix, angle, surfaces):
    compressed = progiso.compress(make_image(blobs(SHAPE, 12, waves=2), spacing=spacing), rate=16)
    place = np.append(CENTRE * spacing, 1)
    moved = np.eye(4) if matrix is None else matrix
    eye, focus = (moved @ (place + [*np.array(d) * spacing, 0]) for d in ((2, 3, 1), (9, 6, -4)))

    def build(scene):
        scene.add(compressed, surfaces, matrix=matrix)
        scene.camera.SetPosition(eye[:3])
        scene.camera.SetFocalPoint(focus[:3])
        scene.camera.SetViewAngle(angle)

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_near_plane_cuts_the_volume(image, surfaces):
    """The camera is outside.

    VTK's mapper moves the plane by a part of the range; what lies that close to it does not count.
    """
    scenes = both(lambda scene: show(scene, image, surfaces))
    for scene in scenes:
        scene.clipping_range = 40, 70
    pictures = [scene.picture() for scene in scenes]
    ahead = progiso.depth(scenes[0].mapper) * np.cos(np.radians(25))  # at least
    check_like_vtk(*pictures, beside=ahead < 40.2)
    whole = ComparisonScene(ours=True)
    show(whole, image, surfaces)
    assert far_apart(whole.picture(), pictures[0])[0] > 0.05


def test_model_transform(image):
    """The camera has a model transform of its own, which changes."""
    scenes = both(lambda scene: show(scene, image, NESTED))
    first = scenes[0].picture()
    for scene in scenes:
        scene.camera.SetModelTransformMatrix(matrix_of(TURNED))
    picture = scenes[0].picture()
    check_like_vtk(picture, scenes[1].picture())
    assert not np.array_equal(picture, first)
