"""The measures that benchmarks judge by: depth errors, topology, peers' depths, cameras."""

import numpy as np
import pytest

import progiso
from helpers.images import blobs, make_image, noise
from progiso.bench.explicit import BlockRanges
from progiso.bench.volume_mapper import VolumeMapper
from progiso.measure import tolerances
from progiso.measure.agreement import depth_error
from progiso.measure.mesh import Mesh, extract
from progiso.measure.topology import topology
from progiso.measure.view import opposite, turned
from progiso.oracle.caster import Camera, Volume, cast


def test_depth_error_of_a_shifted_image():
    values = blobs((24, 22, 26), 1)
    volume = Volume.from_geometry(values, spacing=(0.5, 1, 2))
    result = cast(volume, 0.0, Camera((40, 30, 70), (6, 10, 20), view_angle=45), (80, 60))
    hit = np.isfinite(result.depth)
    assert 500 < hit.sum() < hit.size
    assert set(depth_error(result.depth, result.depth, result.voxels).values()) == {0}
    shifted = depth_error(result.depth - 0.25 / result.voxels, result.depth, result.voxels)
    assert (
        shifted["mean"] == pytest.approx(0.25)
        and shifted["p99"] == pytest.approx(0.25)
        and shifted["wrong"] == 0
    )
    partial = result.depth.copy()
    partial[:30] = np.inf
    assert depth_error(partial, result.depth, result.voxels)["wrong"] == hit[:30].sum() / hit.size
    everywhere = np.where(hit, result.depth, 1.0)
    assert depth_error(everywhere, result.depth, result.voxels)["wrong"] == np.mean(~hit)
    assert depth_error(np.full_like(partial, np.inf), result.depth, result.voxels)["mean"] is None


@pytest.mark.parametrize("border", [False, True])
def test_topology(border):
    """There are two tori and a ball, which the volume's border may cut."""
    z, y, x = np.indices((40, 50, 90), dtype=float)

    def torus(at):
        return 5 - np.hypot(np.hypot(x - at, y - 25.2) - 13, z - 19.7)

    ball = 7 - np.sqrt((x - 20.1) ** 2 + (y - 25.3) ** 2 + (z - (1.5 if border else 20.2)) ** 2)
    values = np.maximum(np.maximum(torus(20.3), torus(65.6)), ball).astype(np.float32)
    found = topology(make_image(values), 0.0)
    assert (found["components"], found["genus"], found["euler"]) == (3, 2, 2)
    assert topology(make_image(values), 100.0) == {
        "triangles": 0,
        "components": 0,
        "euler": 0,
        "genus": 0,
    }


@pytest.fixture(scope="module")
def ramp():
    """Return a plane in a volume of flat voxels, its camera, and the caster's image of it."""
    z, y, x = np.indices((20, 24, 28)).astype(np.float32)
    values = 0.7 * x - 0.4 * y + 0.5 * z
    image = make_image(values, spacing=(1, 1, 2), origin=(5, -3, 2))
    camera = progiso.orbit_camera(image, 1, 5)
    volume = Volume.from_geometry(values, image.GetOrigin(), image.GetSpacing())
    seen = Camera(camera.position, camera.focal_point, camera.view_up, camera.view_angle)
    return image, camera, cast(volume, 9.0, seen, (150, 100))


def off(view, camera, expected):
    """Return signed depth errors in voxels, where both hit. Almost all rays agree on that."""
    view.render_from(camera)
    depth = view.depth()
    view.close()
    both = np.isfinite(depth) & np.isfinite(expected.depth)
    assert (
        both.sum() > 500
        and np.mean(np.isfinite(depth) != np.isfinite(expected.depth)) < tolerances.IMAGE_PIXELS
    )
    return (depth[both] - expected.depth[both]) * expected.voxels[both]


def test_depth_of_a_mesh(ramp):
    image, camera, expected = ramp
    mesh, _ = extract(image, 9.0)
    error = off(Mesh(mesh, (150, 100)), camera, expected)
    assert np.abs(error).max() < tolerances.MESH_DEPTH_VOXELS


@pytest.mark.parametrize("distance", [0.1, 0.5])
def test_depth_of_vtks_mapper(ramp, distance):
    """It shades at the first sample beyond the surface, up to one sample distance too deep, half of
    it in the mean."""
    image, camera, expected = ramp
    error = off(VolumeMapper(image, 9.0, (150, 100), distance), camera, expected)
    assert error.min() > -tolerances.TEXTURE_VOXELS
    assert error.max() < distance + tolerances.TEXTURE_VOXELS
    assert 0.25 * distance < error.mean() < 0.75 * distance


@pytest.mark.parametrize("shape", [(9, 13, 10), (8, 4, 5), (12, 11, 6)])
def test_blocks_of_explicit_extraction(shape):
    """Counted cell by cell: a block is held where one of its cells is, active with the blocks of
    its cells' corners."""
    values = noise(shape, 4)
    held, active = set(), set()
    for cell in np.ndindex(*(n - 1 for n in shape)):
        corners = values[tuple(slice(c, c + 2) for c in cell)]
        if corners.min() < 1.5 <= corners.max():
            held.add(tuple(c // 4 for c in cell))
    blocks = [-(-n // 4) for n in shape]
    for block in held:
        for offset in np.ndindex(2, 2, 2):
            neighbour = tuple(b + o for b, o in zip(block, offset))
            if all(n < b for n, b in zip(neighbour, blocks)):
                active.add(neighbour)
    counted = BlockRanges(values).count(1.5)
    # a block's range may hold the isovalue where none of its cells does
    assert len(held) <= counted["held"] and len(active) <= counted["active"] <= counted[
        "blocks"
    ] == np.prod(blocks)
    ranges = {
        block: values[tuple(slice(4 * b, 4 * b + 5) for b in block)]
        for block in np.ndindex(*(-(-(n - 1) // 4) for n in shape))
    }
    assert counted["held"] == sum(r.min() < 1.5 <= r.max() for r in ranges.values())


def test_cameras_move_as_said():
    camera = progiso.orbit_camera((0, 4, 0, 2, 0, 3), 4, 5)
    away = np.subtract(camera.position, camera.focal_point)
    moved = np.subtract(turned(camera, 2.0).position, camera.focal_point)
    behind = np.subtract(opposite(camera).position, camera.focal_point)
    assert np.linalg.norm(moved) == pytest.approx(np.linalg.norm(away))
    assert moved @ away / (away @ away) == pytest.approx(np.cos(np.radians(2)))
    assert behind == pytest.approx(-away)
