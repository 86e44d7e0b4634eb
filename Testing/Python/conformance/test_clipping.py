"""Clipping planes and cropping regions."""

import numpy as np
import pytest

from helpers.comparison import (
    BACKGROUND,
    NESTED,
    OPAQUE,
    SIZE,
    ComparisonScene,
    both,
    check_like_vtk,
    check_scene_like_vtk,
    show,
    show_lit,
)
from helpers.geometry import CENTRE, PLANES, REGIONS, STRETCHED, TURNED, planes
from helpers.images import reference_volume
from helpers.layers import blend, capped, crossings_of
from progiso.measure import tolerances
from progiso.oracle.caster import Camera


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize(
    "normals", [[(1, 0, 0)], [(0.6, -0.5, 0.3)], [(1, 0.2, 0), (0, -1, 0.4), (0.1, 0, 1)]]
)
@pytest.mark.parametrize("matrix", [None, TURNED @ STRETCHED])
def test_clipping_planes(image, surfaces, normals, matrix):
    def build(scene):
        volume = show(scene, image, surfaces, matrix=matrix)
        for plane in planes(*normals):
            volume.GetMapper().AddClippingPlane(plane)

    check_scene_like_vtk(build)


def test_a_clipping_plane_moves(image):
    """A change of the plane itself, of which the mapper is not told, counts too."""
    cutters = [next(planes((1, 0, 0))) for _ in range(2)]
    scenes = both(lambda scene: show(scene, image))
    first = scenes[0].picture()
    for scene, cutter in zip(scenes, cutters):
        scene.mapper.AddClippingPlane(cutter)
        cutter.SetNormal(0, -1, 0)
    for origin in (CENTRE, CENTRE + 5):
        for cutter in cutters:
            cutter.SetOrigin(origin)
        check_like_vtk(*(scene.picture() for scene in scenes))
    scenes[0].mapper.RemoveAllClippingPlanes()
    assert np.array_equal(scenes[0].picture(), first)


def test_clipped_and_lit(cube):
    """The normals at a cut are those of the whole volume."""

    def build(scene):
        volume = show_lit(scene, cube)
        volume.GetMapper().AddClippingPlane(next(planes((1, 0.3, 0))))
        scene.shine()

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("regions", REGIONS)
def test_cropping(image, regions, surfaces):
    """Where a ray enters a region from outside VTK's mapper may show a surface that is not there;
    those pixels do not count."""

    def build(scene):
        mapper = show(scene, image, surfaces).GetMapper()
        mapper.CroppingOn()
        mapper.SetCroppingRegionPlanes(PLANES)
        mapper.SetCroppingRegionFlags(REGIONS[regions])

    scenes = both(build)
    pictures = [scene.picture() for scene in scenes]
    camera = Camera.from_vtk(scenes[0].camera)
    caps = capped(reference_volume(image), list(surfaces), camera, SIZE, (PLANES, REGIONS[regions]))
    assert caps.mean() < 0.3
    check_like_vtk(*pictures, beside=caps)


def test_cropping_and_clipping_of_a_moved_volume(image):
    """The regions turn with the volume, the clipping plane stays: as the caster's crossings."""
    scene = ComparisonScene(ours=True)
    mapper = show(scene, image, NESTED, matrix=TURNED).GetMapper()
    mapper.CroppingOn()
    mapper.SetCroppingRegionPlanes(PLANES)
    mapper.SetCroppingRegionFlags(REGIONS["inverted cross"])
    plane = next(planes((0.5, 1, 0)))
    mapper.AddClippingPlane(plane)
    picture = scene.picture()
    camera, volume = Camera.from_vtk(scene.camera), reference_volume(image, TURNED)
    crossings = crossings_of(
        volume, list(NESTED), camera, SIZE, cropping=(PLANES, REGIONS["inverted cross"])
    )
    origins, directions = camera.rays(SIZE)
    world = origins[crossings.ray] + crossings.depth[:, None] * directions[crossings.ray]
    crossings = crossings.only((world - plane.GetOrigin()) @ np.array(plane.GetNormal()) > 0)
    model = blend(crossings, list(NESTED.values()), BACKGROUND, SIZE)
    assert (
        np.abs(picture - model).max(axis=2) > tolerances.LAYERS_LEVELS
    ).mean() <= tolerances.LAYERS_PIXELS
