"""The caster against closed forms, dense sampling, and VTK's own camera and geometry."""

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkCamera

from helpers.interpolation import interpolate
from progiso.measure import tolerances
from progiso.oracle.caster import Camera, Slack, Volume, cast, cast_rays


def random_rays(rng, shape, count):
    """Return rays from outside, from inside, along axes and through corners."""
    size = np.array(shape[::-1]) - 1.0
    targets = rng.uniform(0, 1, (count, 3)) * size
    targets[: count // 4] = np.round(targets[: count // 4])
    directions = rng.normal(size=(count, 3))
    directions[::7] = np.eye(3)[rng.integers(0, 3, len(directions[::7]))] * rng.choice(
        [-1, 1], (len(directions[::7]), 1)
    )
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    back = np.where(rng.uniform(size=count) < 0.3, 0.0, rng.uniform(0, 40, count))
    return targets - back[:, None] * directions, directions


def plain(values):
    return Volume(np.asarray(values), np.eye(4))


#: Along x, of nine; and where the first surface behind x = 0 is seen, and behind x = 4 and 8.5.
HIDDEN_CELLS = {
    "none": ((), (3.5, 7.5, np.inf)),
    "the first surface's": ((3,), (7.5, 7.5, np.inf)),
    "both surfaces'": ((3, 7), (np.inf, np.inf, np.inf)),
    "where rays begin": ((0, 4, 8), (3.5, 7.5, np.inf)),
    "up to a surface's": ((0, 1, 2, 4, 5, 6), (3.5, 7.5, np.inf)),
}


@pytest.mark.parametrize("case", HIDDEN_CELLS)
def test_hidden_cells(case):
    """No surface is in them, and none where a ray leaves them on another side than it entered."""
    columns, depths = HIDDEN_CELLS[case]
    x = np.arange(10.0)
    values = np.broadcast_to(2 - np.abs(x - 5.5), (6, 5, 10)).copy()
    hidden = np.zeros((5, 4, 9), bool)
    hidden[:, :, list(columns)] = True
    values[:, :, [i for i in range(1, 9) if hidden[0, 0, i - 1] and hidden[0, 0, i]]] = np.nan
    origins = np.array([[-3.0, 2.2, 1.7], [4.2, 2.2, 1.7], [8.5, 2.2, 1.7]])
    found = cast_rays(
        Volume(values, np.eye(4), hidden),
        0.0,
        origins,
        np.eye(3)[[0, 0, 0]],
        slack=tolerances.SLACK,
    )
    assert found.depth + origins[:, 0] == pytest.approx(depths, abs=tolerances.ORACLE_EXACT)
    assert (found.early <= found.depth).all() and (found.depth <= found.late).all()
    assert found.late + origins[:, 0] == pytest.approx(depths, abs=tolerances.CLEAR_VOXELS)


def test_hidden_everything_or_nothing():
    values = np.random.default_rng(5).normal(size=(6, 7, 8))
    origins, directions = random_rays(np.random.default_rng(6), values.shape, 300)
    whole = cast_rays(plain(values), 0.1, origins, directions).depth
    nothing, everything = (
        Volume(values, np.eye(4), np.full((5, 6, 7), hidden)) for hidden in (False, True)
    )
    assert np.isfinite(whole).any() and np.array_equal(
        cast_rays(nothing, 0.1, origins, directions).depth, whole
    )
    assert not np.isfinite(cast_rays(everything, 0.1, origins, directions).depth).any()


@pytest.mark.parametrize("seed", range(6))
def test_first_root_by_dense_sampling(seed):
    """Each hit is a root with a change of side, and no side changes before it."""
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(2, 9, 3))
    values = rng.normal(size=shape)
    origins, directions = random_rays(rng, shape, 400)
    isovalue = [0.0, 0.5, -0.3][seed % 3]
    result = cast_rays(plain(values), isovalue, origins, directions)

    t = np.linspace(0, 60, 60001)
    for origin, direction, depth in zip(origins, directions, result.depth):
        points = origin + t[:, None] * direction
        within = np.all((points >= 0) & (points <= np.array(shape[::-1]) - 1.0), axis=1)
        if not within.any():
            assert depth == np.inf or not (t[0] < depth < t[-1])
            continue
        path = t[within]
        inside = interpolate(values, points[within]) >= isovalue
        before = inside[path < depth - 1e-9]
        assert np.all(before == before[:1]), "a side changes before the hit"
        if np.isfinite(depth):
            at = origin + depth * direction
            assert abs(interpolate(values, at) - isovalue) < 1e-9
            around = (
                interpolate(values, origin + np.outer([depth - 1e-7, depth + 1e-7], direction))
                >= isovalue
            )
            assert around[0] != around[1]


def test_ramp():
    """A linear field has its plane where algebra puts it."""
    rng = np.random.default_rng(1)
    z, y, x = np.indices((9, 7, 11)).astype(float)
    gradient, isovalue = np.array([0.7, -1.3, 0.4]), 0.9
    values = gradient[0] * x + gradient[1] * y + gradient[2] * z
    origins, directions = random_rays(rng, values.shape, 3000)
    depth = cast_rays(plain(values), isovalue, origins, directions).depth
    expected = (isovalue - origins @ gradient) / (directions @ gradient)
    place = origins + expected[:, None] * directions
    outside = np.maximum(-place, place - (np.array(values.shape[::-1]) - 1.0)).max(axis=1)
    expected[(outside > 0) | (expected < 0)] = np.inf
    sure = np.abs(outside) > 1e-9
    assert np.isfinite(expected[sure]).sum() > 500
    assert np.array_equal(np.isfinite(depth[sure]), np.isfinite(expected[sure]))
    hit = sure & np.isfinite(expected)
    assert np.abs(depth[hit] - expected[hit]).max() < tolerances.ORACLE_EXACT


def test_sphere():
    """A sampled distance shows the sphere, from outside and from inside."""
    n, radius = 65, 20.0
    centre = (n - 1) / 2
    values = np.linalg.norm(np.stack(np.indices((n, n, n))) - centre, axis=0)
    for position in (
        (centre + 90, centre + 3, centre - 5),
        (centre + 1.0, centre - 4.0, centre + 2.5),
    ):
        camera = Camera(position, (centre, centre, centre), view_angle=40)
        result = cast(plain(values), radius, camera, (64, 48))
        origins, directions = camera.rays((64, 48))
        b = np.einsum("ij,ij->i", origins - centre, directions)
        c = np.einsum("ij,ij->i", origins - centre, origins - centre) - radius**2
        square = b * b - c
        near, far = -b - np.sqrt(np.maximum(square, 0)), -b + np.sqrt(np.maximum(square, 0))
        expected = np.where(near > 0, near, far).reshape(48, 64)
        clear = (square > 60).reshape(48, 64)
        assert clear.sum() > 500
        assert np.isfinite(result.depth[clear]).all()
        assert not np.isfinite(result.depth[(square < -60).reshape(48, 64)]).any()
        assert np.abs(result.depth - expected)[clear].max() < 3 * tolerances.ORACLE_SPHERE_VOXELS


def test_both_roots_within_one_cell():
    """``x * y`` along ``x + y = 1`` rises to 1/4 and falls again."""
    y, x = np.indices((2, 2))
    values = np.stack([x * y, x * y]).astype(float)
    direction = np.array([[1, -1, 0]]) / np.sqrt(2)
    origin = np.array([[-1, 2, 0.5]])
    root = (0.5 - np.sqrt(0.25 - 0.24) + 1) * np.sqrt(2)
    assert cast_rays(plain(values), 0.24, origin, direction).depth[0] == pytest.approx(
        root, abs=1e-12
    )
    assert cast_rays(plain(values), 0.26, origin, direction).depth[0] == np.inf


def test_equal_to_the_isovalue_is_inside():
    """A plateau at the isovalue is entered at its edge and not left before it falls."""
    values = np.broadcast_to(np.array([0.0, 1, 1, 1, 0]), (2, 2, 5))
    origin, direction = np.array([[-1, 0.5, 0.5]]), np.array([[1.0, 0, 0]])
    assert cast_rays(plain(values), 1.0, origin, direction).depth[0] == pytest.approx(
        2.0, abs=1e-12
    )
    assert cast_rays(plain(values), 1.0, origin + [2.5, 0, 0], direction).depth[0] == pytest.approx(
        1.5, abs=1e-12
    )
    assert cast_rays(plain(values[:, :, 1:4]), 1.0, origin, direction).depth[0] == np.inf


def test_no_caps_at_the_border():
    """A volume that is inside throughout shows nothing."""
    camera = Camera((30, 20, 10), (2, 2, 2))
    assert not np.isfinite(cast(plain(np.ones((5, 5, 5))), 0.5, camera, (16, 16)).depth).any()


def test_nothing_behind_the_camera():
    z = np.indices((9, 9, 9))[0].astype(float)
    camera = Camera((4, 4, 5), (4, 4, 8))
    assert not np.isfinite(cast(plain(z), 3.0, camera, (8, 8)).depth).any()
    assert np.isfinite(cast(plain(z), 7.0, camera, (8, 8)).depth).all()


def test_geometry_moves_with_the_camera():
    """A rotated, moved volume seen by a camera moved likewise gives the same depths."""
    rng = np.random.default_rng(3)
    values = rng.normal(size=(6, 7, 8))
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.linalg.det(rotation)
    place = Volume.from_geometry(values, (1, 2, 3), (1, 0.5, 2), rotation, (5, -3, 2))
    start = Volume.from_geometry(values, (0, 0, 0), (1, 0.5, 2))
    shift = place.index_to_world[:3, 3]
    for parallel in (None, 6.0):
        position, focal, up = np.array([20.0, 12, 17]), np.array([4.0, 2, 5]), np.array([0.1, 1, 0])
        before = cast(start, 0.2, Camera(position, focal, up, 40, parallel), (40, 30))
        moved = Camera(
            rotation @ position + shift, rotation @ focal + shift, rotation @ up, 40, parallel
        )
        after = cast(place, 0.2, moved, (40, 30))
        hit = np.isfinite(before.depth)
        assert hit.sum() > 100
        assert np.array_equal(hit, np.isfinite(after.depth))
        assert np.abs(before.depth[hit] - after.depth[hit]).max() < tolerances.ORACLE_EXACT


def test_slack_brackets_what_a_disturbed_field_shows():
    """Whatever an error within the slack does to the values, the depth stays between early and
    late."""
    rng = np.random.default_rng(4)
    values = rng.normal(size=(9, 9, 9))
    camera = Camera((25, 14, 19), (4, 4, 4), view_angle=30)
    result = cast(plain(values), 0.0, camera, (80, 60), slack=Slack(value=2e4))
    assert np.all(result.early <= result.depth) and np.all(result.depth <= result.late)
    moved = 0
    for seed in range(8):
        # Every cell's slack is at least the smallest of the largest values in the cells.
        noise = np.random.default_rng(seed).uniform(-1, 1, values.shape) * 2e4 * 2.0**-24 * 0.5
        other = cast(plain(values + noise), 0.0, camera, (80, 60)).depth
        assert np.all((result.early <= other) & (other <= result.late))
        moved += np.sum(other != result.depth)
    assert moved > 1000


@pytest.mark.parametrize("parallel", [False, True])
def test_rays_are_vtks(parallel):
    """Pixel centres, unprojected by ``vtkCamera``'s matrices, lie on the caster's rays."""
    width, height = 13, 8
    camera = vtkCamera()
    camera.SetPosition(3, -7, 11)
    camera.SetFocalPoint(0.5, 2, -1)
    camera.SetViewUp(0.2, 0.9, 0.3)
    camera.SetViewAngle(37)
    camera.SetParallelProjection(parallel)
    camera.SetParallelScale(4.2)
    camera.SetClippingRange(1, 100)
    matrix = camera.GetCompositeProjectionTransformMatrix(width / height, -1, 1)
    unproject = np.linalg.inv([[matrix.GetElement(r, c) for c in range(4)] for r in range(4)])
    origins, directions = Camera.from_vtk(camera).rays((width, height))
    for row, column in ((0, 0), (0, 12), (7, 0), (3, 5)):
        x, y = (column + 0.5) / width * 2 - 1, 1 - (row + 0.5) / height * 2
        point = unproject @ [x, y, 0.3, 1]
        point = point[:3] / point[3]
        ray = row * width + column
        along = (point - origins[ray]) @ directions[ray]
        assert along > 0
        off = np.linalg.norm(point - origins[ray] - along * directions[ray])
        assert off < tolerances.CAMERA_RELATIVE * along


def test_geometry_is_vtks():
    image = vtkImageData()
    image.SetExtent(3, 7, -2, 4, 10, 15)
    image.SetOrigin(1, 2, 3)
    image.SetSpacing(0.5, 2, 0.25)
    rotation = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    image.SetDirectionMatrix(rotation.ravel())
    volume = Volume.from_geometry(
        np.zeros((6, 7, 5)), image.GetOrigin(), image.GetSpacing(), rotation, (3, -2, 10)
    )
    for index in ((3, -2, 10), (7, 4, 15), (4, 0, 12)):
        expected = np.zeros(3)
        image.TransformIndexToPhysicalPoint(index, expected)
        got = volume.index_to_world @ [index[0] - 3, index[1] + 2, index[2] - 10, 1]
        assert got[:3] == pytest.approx(expected, abs=1e-12)


def test_bad_volumes_are_refused():
    with pytest.raises(ValueError, match="at least two samples"):
        cast(plain(np.zeros((1, 4, 4))), 0, Camera((9, 9, 9), (0, 0, 0)), (2, 2))
    with pytest.raises(ValueError, match="not finite"):
        cast(plain(np.full((4, 4, 4), np.nan)), 0, Camera((9, 9, 9), (0, 0, 0)), (2, 2))
