"""Depths and levels of detail that the mapper sees against those of the double-precision caster."""

import dataclasses

import numpy as np
import pytest

import progiso
from helpers.holes import ball, speckles
from helpers.images import blobs, make_image, noise
from helpers.levels import reference_pyramid
from helpers.scenes import CACHED, Scene, check_depth, orbit
from progiso.measure import tolerances
from progiso.oracle import levels
from progiso.oracle.caster import Camera

SIZE = (160, 120)


def gyroid(shape):
    """Return a field whose surfaces are everywhere, and smooth."""
    z, y, x = np.meshgrid(*(2 * np.pi / 40 * np.arange(n) for n in shape), indexing="ij")
    return np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)


def holed(shape):
    """Return a field with a hole through all levels, and small ones that end with the first."""
    return np.where(ball(shape, 22) | speckles(shape, 0.002), np.nan, blobs(shape, 3, waves=6))


def check_levels(
    pyramid, image, isovalue, camera, tolerance, seen, grazing=tolerances.GRAZING_FRACTION,
    user_matrix=None, conservative=False, **settings
):  # fmt: skip
    """Hold depths against the caster, and the statistics' levels, of which all of `seen` are."""
    scene = Scene(image, isovalue, camera, SIZE, user_matrix, PixelTolerance=tolerance, **settings)
    scene.mapper.SetLevelOfDetailToOn()
    if conservative:
        scene.mapper.SetLevelOfDetailToConservative()
    got = scene.depth()
    expected = levels.cast(
        pyramid,
        isovalue,
        camera,
        SIZE,
        tolerance=tolerance,
        conservative=conservative,
        slack=tolerances.SLACK,
        clip=scene.clipping_range,
    )
    check_depth(got, expected, grazing)
    counts = np.bincount(expected.level[expected.level >= 0], minlength=len(pyramid.steps))
    assert (counts[list(seen)] > 100).all()
    pixels = [scene.mapper.GetStatistics().GetLevelPixels(i) for i in range(len(counts))]
    # a ray that grazes may hit another level, or nothing
    assert np.abs(pixels - counts).sum() <= 2 * np.sum(expected.early != expected.late)


@pytest.mark.parametrize("settings", [{}, {"SpeculationLimit": 3, **CACHED}])
@pytest.mark.parametrize("field", ["gyroid", "noise", "holes"])
def test_fields(field, settings):
    shape = (90, 140, 131)
    make, isovalue, near, grazing = {
        "gyroid": (gyroid, 0.1, 2.5, tolerances.GRAZING_FRACTION),
        "noise": (noise, 0.6, 3.5, tolerances.GRAZING_FRACTION_NOISE),
        "holes": (holed, 0.2, 2.5, tolerances.GRAZING_FRACTION),
    }[field]
    image = progiso.compress(make_image(make(shape)), rate=8, levels=11)
    pyramid = reference_pyramid(image)
    camera = orbit(pyramid.volume, 2, 5, view_angle=70, distance=0.6)
    check_levels(pyramid, image, isovalue, camera, near, (0, 1), grazing, **settings)
    check_levels(pyramid, image, isovalue, camera, 5.0, (1,), grazing, **settings)


@pytest.mark.parametrize("weight", [0.0, 0.3, 0.9])
def test_parallel_projection(weight):
    """All of the image has one weight of the next level."""
    shape = (90, 140, 131)
    image = progiso.compress(make_image(gyroid(shape) + 0.1 * noise(shape)), rate=8, levels=11)
    pyramid = reference_pyramid(image)
    spacing = 2 * (levels.BLENDING * (1 - weight) + weight)
    camera = dataclasses.replace(orbit(pyramid.volume, 1, 5), parallel_scale=75.0)
    check_levels(pyramid, image, 0.1, camera, spacing / (2 * 75.0 / SIZE[1]), (0,))


@pytest.mark.parametrize("cells", [False, True])
def test_anisotropic_and_placed_anywhere(cells):
    """Levels halve the fine axes first; the image is turned, far away, and of cells."""
    rotation = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]
    user = np.eye(4)
    user[:3, :3] = 1.5 * rotation * np.linalg.det(rotation)
    user[:3, 3] = (3e3, -2e3, 1e3)
    image = progiso.compress(
        make_image(gyroid((35, 128, 71)), spacing=(0.7, 0.3, 1.9), cells=cells), rate=8, levels=11
    )
    pyramid = reference_pyramid(image, user)
    assert [steps.tolist() for steps in pyramid.steps[1:]] == [[1, 2, 1], [2, 4, 1]]
    camera = orbit(pyramid.volume, 1, 4, view_angle=60, distance=0.9)
    check_levels(pyramid, image, 0.1, camera, 2.2, (0, 1), user_matrix=user)


def test_along_the_axes():
    """Rays lie in planes of voxels of all levels, and end in even and odd numbers of samples."""
    shape = (65, 66, 97)
    image = progiso.compress(make_image(noise(shape)), rate=16, levels=11)
    pyramid = reference_pyramid(image)
    # pixels are half a sample wide: their centres lie on samples and halfway between them
    centre = np.array(shape[::-1]) // 2 + 0.25
    for axis in range(3):
        away = 80.0 * np.eye(3)[axis]
        for sign in (-1, 1):
            camera = Camera(
                tuple(centre + sign * away), tuple(centre), tuple(np.roll(away, 1)), 50.0, 30.0
            )
            grazing = tolerances.GRAZING_FRACTION_NOISE
            check_levels(pyramid, image, 0.8, camera, 3.7, (0,), grazing)


def sheets(shape):
    """Return bent sheets that are hardly thicker than a sample, among blobs."""
    away = np.abs(4 * blobs(shape, 5, waves=2) % 2 - 1)
    return np.maximum(1 - 8 * away, blobs(shape, 3, waves=6) - 1)


@pytest.mark.parametrize("settings", [{}, {"SpeculationLimit": 3, **CACHED}])
@pytest.mark.parametrize("field", ["gyroid", "sheets", "holes"])
def test_conservative(field, settings):
    shape = (90, 140, 131)
    make, isovalue, seen = {
        "gyroid": (gyroid, 0.1, 1),
        "sheets": (sheets, 0.5, 0),  # of the volume itself, whatever level is drawn
        "holes": (holed, 0.2, 0),
    }[field]
    image = progiso.compress(make_image(make(shape)), rate=16, levels=11)
    pyramid = reference_pyramid(image)
    camera = orbit(pyramid.volume, 2, 5, view_angle=70, distance=0.6)
    check_levels(pyramid, image, isovalue, camera, 4.0, (0,), conservative=True, **settings)
    # no ray lies in a plane of voxels, where holes may begin
    camera = dataclasses.replace(camera, parallel_scale=59.3)
    check_levels(pyramid, image, isovalue, camera, 3.5, (seen,), conservative=True, **settings)
