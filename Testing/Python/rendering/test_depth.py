"""Depths that the mapper sees against those of the double-precision caster, in the same decoded
values."""

import numpy as np
import pytest

import progiso
from helpers.images import blobs, make_image, marschner_lobb, noise, reference_volume
from helpers.scenes import Scene, check_depth, check_scene, orbit
from progiso.measure import tolerances
from progiso.oracle.caster import Camera, cast

rotation = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]
rotation *= np.linalg.det(rotation)


def compressed(values, rate=8, **geometry):
    return progiso.compress(make_image(values, **geometry), rate=rate)


# --- fields and cameras ---------------------------------------------------------------------------


@pytest.mark.parametrize("i", range(4))
@pytest.mark.parametrize("rate", [2, 8, 32])
def test_marschner_lobb(rate, i):
    image = compressed(marschner_lobb(41), rate)
    check_scene(image, 0.5, orbit(reference_volume(image), i, 4))


@pytest.mark.parametrize("seed", range(6))
def test_white_noise(seed):
    """There are roots in almost every cell, many of them double."""
    rng = np.random.default_rng(seed)
    image = compressed(noise(tuple(rng.integers(5, 30, 3)), seed), rng.choice([4, 8, 16.5]))
    camera = orbit(reference_volume(image), seed, 6)
    check_scene(image, rng.uniform(-0.5, 2.5), camera, grazing=tolerances.GRAZING_FRACTION_NOISE)


@pytest.mark.parametrize(
    "shape",
    [(2, 2, 2), (2, 9, 33), (5, 5, 5), (4, 4, 4), (8, 12, 16), (9, 13, 17), (3, 70, 6), (65, 2, 3)],
)
def test_shapes(shape):
    """Volumes of one cell or one block, with partial blocks and macrocells on any side."""
    image = compressed(noise(shape, 11), 16)
    volume = reference_volume(image)
    for i in range(2):
        check_scene(
            image,
            0.1,
            orbit(volume, i, 3),
            (96, 72),
            grazing=tolerances.GRAZING_FRACTION_NOISE,
            volume=volume,
        )


@pytest.mark.parametrize("seed", range(4))
def test_random_cameras(seed):
    rng = np.random.default_rng(seed)
    image = compressed(blobs((40, 36, 44), seed))
    volume = reference_volume(image)
    for _ in range(3):
        direction = rng.normal(size=3)
        position = np.array([21.5, 17.5, 19.5]) + direction / np.linalg.norm(
            direction
        ) * rng.uniform(30, 400)
        camera = Camera(
            tuple(position),
            tuple(rng.uniform(10, 30, 3)),
            tuple(rng.normal(size=3)),
            rng.uniform(5, 90),
        )
        check_scene(image, rng.uniform(-0.3, 0.3), camera, (120, 90), volume=volume)


@pytest.mark.parametrize("seed", range(3))
def test_camera_inside(seed):
    rng = np.random.default_rng(seed)
    image = compressed(blobs((40, 36, 44), seed))
    volume = reference_volume(image)
    for _ in range(3):
        position = rng.uniform(2, 33, 3)
        camera = Camera(
            tuple(position), tuple(position + rng.normal(size=3)), view_angle=rng.uniform(30, 110)
        )
        check_scene(image, rng.uniform(-0.3, 0.3), camera, (120, 90), volume=volume)


@pytest.mark.parametrize("i", range(3))
def test_parallel_projection(i):
    image = compressed(blobs((40, 36, 44), 5))
    volume = reference_volume(image)
    camera = orbit(volume, i, 3)
    check_scene(
        image, 0.1, Camera(camera.position, camera.focal_point, parallel_scale=25.0), volume=volume
    )


@pytest.mark.parametrize("parallel_scale", [None, 12.0, 11.5])
@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [-1, 1])
def test_along_an_axis(axis, sign, parallel_scale):
    """Rays follow an axis: half lie exactly on planes of voxels, central ones meet corners."""
    image = compressed(blobs((25, 25, 25), 6))
    position = np.full(3, 12.0)
    position[axis] += sign * 50
    up = np.roll([0, 1, 0], axis).astype(float)
    camera = Camera(tuple(position), (12, 12, 12), tuple(up), 40, parallel_scale)
    check_scene(image, 0.05, camera, (49, 49))
    check_scene(image, 0.05, camera, (48, 48))


def test_rays_in_planes_of_voxels():
    """Every sample of a parallel ray lies in a face, an edge or a corner of cells."""
    image = compressed(marschner_lobb(17), 32)
    volume = reference_volume(image)
    # Pixels of half a voxel: every other lies on planes of voxels in both directions; up to an
    # eighth on the volume's border, which grazes.
    for position, scale in (((8, 8, 60), 8.25), ((48, 8, 48), 8.25), ((48, 48, 48), 12.0)):
        camera = Camera(position, (8, 8, 8), (0, 1, 0), parallel_scale=scale)
        check_scene(image, 0.5, camera, (33, 33), volume=volume, grazing=1 / 8)


# --- geometry -------------------------------------------------------------------------------------

GEOMETRIES = {
    "anisotropic": dict(spacing=(0.5, 3, 1.2)),
    "1 to 1000": dict(spacing=(0.01, 10, 1)),
    "rotated": dict(direction=rotation, spacing=(1, 0.7, 1.3), origin=(5, -6, 7)),
    "mirrored": dict(direction=np.diag([-1.0, 1, 1]), spacing=(1, 2, 1)),
    "extent": dict(extent_start=(-7, 20, 3), origin=(1, 2, 3), spacing=(1, 0.5, 2)),
    "far and small": dict(origin=(1e6, -1e6, 1e6), spacing=(1e-3, 1e-3, 1e-3)),
    "tiny": dict(spacing=(1e-9, 1e-9, 1e-9)),
    "huge": dict(spacing=(1e9, 1e9, 1e9)),
    "cells": dict(cells=True, spacing=(1, 0.5, 2), origin=(3, 2, 1)),
    "cells rotated": dict(
        cells=True, direction=rotation, spacing=(1, 0.5, 2), extent_start=(2, 3, 4)
    ),
}


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", GEOMETRIES)
def test_geometry(name, parallel):
    image = compressed(blobs((30, 27, 33), 7), **GEOMETRIES[name])
    volume = reference_volume(image)
    for i in range(2):
        camera = orbit(volume, i, 3)
        if parallel:
            reach = np.linalg.norm(np.subtract(camera.position, camera.focal_point))
            camera = Camera(camera.position, camera.focal_point, parallel_scale=reach / 3)
        check_scene(image, 0.1, camera, (120, 90), volume=volume)


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("kind", ["rigid", "scaled", "sheared", "mirrored"])
def test_user_matrix(kind, parallel):
    matrix = np.eye(4)
    matrix[:3, 3] = (3, -20, 8)
    matrix[:3, :3] = {
        "rigid": rotation,
        "scaled": rotation @ np.diag([1, 2, 0.5]),
        "sheared": [[1, 0.4, 0], [0, 1, 0.2], [0.1, 0, 1.5]],
        "mirrored": np.diag([1, 1, -1.0]),
    }[kind]
    image = compressed(
        blobs((30, 27, 33), 8), direction=rotation, spacing=(1, 1.5, 0.8), origin=(1, 2, 3)
    )
    volume = reference_volume(image, matrix)
    camera = orbit(volume, 1, 3)
    if parallel:
        camera = Camera(camera.position, camera.focal_point, parallel_scale=25)
    check_scene(image, 0.1, camera, user_matrix=matrix, volume=volume)


# --- values ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-28, 1e-20, 1e-3, 1e4, 1e20, 1e30, 1e37])
def test_scales_of_values(scale):
    """From the least that zfp takes (see test_filters.py) to the most that float32 holds no square
    overflows or vanishes; `compress` would give the least of them units of their own."""
    values = blobs((24, 24, 24), 9) * np.float32(scale)
    image = progiso.compress_slabs(values, rate=12, units=(0, 1))
    check_scene(image, 0.1 * scale, orbit(reference_volume(image), 1, 3))


def test_isovalue_far_from_zero():
    """Small differences on a large offset lose half their digits; the rest must do."""
    image = compressed(blobs((24, 24, 24), 9) + np.float32(1000), 20)
    check_scene(image, 1000.1, orbit(reference_volume(image), 2, 3))


def test_isovalue_of_many_digits():
    """An isovalue between two float32 values is not rounded to one of them."""
    values = np.float32(1000) + 2.0**-14 * np.round(64 * blobs((24, 24, 24), 9))
    image = compressed(values, 32)
    check_scene(image, 1000 + 2.0**-14 * 4.5, orbit(reference_volume(image), 2, 3))


@pytest.mark.parametrize("isovalue", [0.0, 1.0, 2.0])
def test_isovalue_equal_to_voxels(isovalue):
    """A field of three whole values has plateaus and edges exactly at the isovalue.

    Where it is hit must stay possible.
    """
    image = compressed(np.clip(np.round(blobs((24, 20, 28), 10) + 1), 0, 2).astype(np.float32), 32)
    volume = reference_volume(image)
    assert set(np.unique(volume.values)) == {0, 1, 2}
    camera = orbit(volume, 1, 3)
    scene = Scene(image, isovalue, camera)
    got, expected = (
        scene.depth(),
        cast(volume, isovalue, camera, (160, 120), slack=tolerances.SLACK),
    )
    check_depth(got, expected, grazing=1.0)
    # Inside is "at least the isovalue", and whole numbers are exact: nothing is below the least,
    # and plateaus are hit at their edges.
    assert np.isfinite(got).any() == (isovalue > 0)
    assert np.mean(np.isfinite(got) != np.isfinite(expected.depth)) < 0.01


def test_constant_volume_shows_nothing():
    image = compressed(np.full((12, 12, 12), 3.0))
    for isovalue in (2.9, 3.0, 3.1):
        assert not np.isfinite(
            Scene(image, isovalue, orbit(reference_volume(image), 1, 3)).depth()
        ).any()


@pytest.mark.parametrize("isovalue", [-100.0, 100.0])
def test_isovalue_out_of_range_shows_nothing(isovalue):
    scene = Scene(compressed(blobs((24, 24, 24), 9)), isovalue, Camera((60, 50, 70), (12, 12, 12)))
    assert not np.isfinite(scene.depth()).any()
    assert scene.statistics()["converged"]


def test_empty_blocks():
    """Blocks of zeros are stored as one bit; their neighbours' faces still count."""
    values = np.zeros((25, 25, 25), np.float32)
    values[10:14, 9:15, 11] = 1
    values[4, 4, 4] = values[19, 20, 4] = 1
    image = compressed(values, 16)
    check_scene(image, 0.4, orbit(reference_volume(image), 1, 4))


# --- plain input ----------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [4, 8])
def test_plain_image_is_compressed_at_the_rate(rate):
    """A plain image shows exactly what its compressed volume shows."""
    plain = make_image(marschner_lobb(33))
    camera = orbit(reference_volume(progiso.compress(plain, rate=rate)), 1, 3)
    direct = Scene(plain, 0.5, camera, Rate=rate).depth()
    assert np.isfinite(direct).any()
    assert (
        direct.tobytes() == Scene(progiso.compress(plain, rate=rate), 0.5, camera).depth().tobytes()
    )


# --- real scans -----------------------------------------------------------------------------------

SCANS = {"ct-cranium": 226.0, "mri-brain": 45.0}


@pytest.fixture(scope="module")
def scan(request):
    """Return a real scan, compressed once for all its tests."""
    from progiso.data import fetch

    return progiso.compress(progiso.read(fetch(request.param)), rate=8), SCANS[request.param]


@pytest.mark.parametrize("scan", SCANS, indirect=True)
def test_scan(scan):
    image, isovalue = scan
    volume = reference_volume(image)
    for i in (0, 3):
        check_scene(image, isovalue, orbit(volume, i, 10), (240, 135), volume=volume)


@pytest.mark.parametrize("scan", ["ct-cranium"], indirect=True)
def test_cranium_at_full_size(scan):
    """The image by which the project is judged first."""
    image, isovalue = scan
    volume = reference_volume(image)
    check_scene(image, isovalue, orbit(volume, 4, 10), (1280, 720), volume=volume)
