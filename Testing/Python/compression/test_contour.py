"""Isosurfaces as triangles are VTK's FlyingEdges' of the decoded image, in every bit."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

import progiso
from helpers.images import blobs, make_image, marschner_lobb, noise, samples_of
from helpers.messages import vtk_messages
from helpers.surfaces import (
    check_against_vtk,
    check_same_surface,
    contour_by,
    contoured,
    corners_of,
)
from progiso import vtkZFPContour
from progiso.data import SCANS, fetch

ROTATION = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]


def open_edges(surface):
    """Return the ends of the edges that only one triangle has."""
    corners = corners_of(surface)
    edges = np.sort(np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    edges, uses = np.unique(edges, axis=0, return_counts=True)
    return edges[uses == 1]


# --- the same surface -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCANS)
def test_scans(name):
    """All isovalues that a scan's catalogue entry proposes, at once."""
    volume = progiso.compress(progiso.read(fetch(name)), rate=8)
    surface = check_against_vtk(volume, list(SCANS[name].isovalues.values()))
    assert surface.GetNumberOfPolys() > 500_000


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    shape=st.tuples(*[st.integers(2, 27)] * 3),
    kind=st.sampled_from(["u1", "i2", "f4", "f8"]),
    seed=st.integers(0, 1000),
    rate=st.sampled_from([1, 4, 8, 20]),
    quantiles=st.lists(st.sampled_from([0, 0.1, 0.5, 0.8, 1]), min_size=1, max_size=3),
    brick_size=st.sampled_from([4, 8, 12, 64]),
    spacing=st.tuples(*[st.sampled_from([0.3, 1, 2.5])] * 3),
    start=st.tuples(*[st.integers(-9, 9)] * 3),
    turned=st.booleans(),
)
def test_random_fields(shape, kind, seed, rate, quantiles, brick_size, spacing, start, turned):
    """Integers hit the isovalue exactly: points of several edges then coincide, and stay apart."""
    values = (noise(shape, seed) * 5 + 50).astype(kind)
    direction = ROTATION if turned else None
    image = make_image(
        values, spacing=spacing, extent_start=start, origin=(1, -2, 3), direction=direction
    )
    isovalues = [float(np.quantile(values, q, method="nearest")) for q in quantiles]
    check_against_vtk(progiso.compress(image, rate=rate), isovalues, brick_size)


@pytest.mark.parametrize("direction", [np.eye(3), ROTATION, np.diag([1, -1, 1])])
def test_world_coordinates(direction):
    """Extent, origin, spacing and direction are taken as FlyingEdges takes them."""
    image = make_image(
        blobs((30, 28, 34), 1),
        spacing=(0.5, 2, 1),
        origin=(9, 8, 7),
        extent_start=(5, -6, 7),
        direction=direction,
    )
    surface = check_against_vtk(progiso.compress(image, rate=8), [0.1], 8)
    assert surface.GetNumberOfPolys() > 1000


def test_cell_data_lie_in_the_centres():
    values = blobs((20, 22, 24), 2)
    cells = make_image(
        values, cells=True, spacing=(0.5, 2, 1), origin=(9, 8, 7), extent_start=(5, -6, 7)
    )
    ours = contoured(progiso.compress(cells, rate=8), [0.1], 8)
    origin = np.array([9, 8, 7]) + 0.5 * np.array([0.5, 2, 1])
    centres = make_image(values, spacing=(0.5, 2, 1), origin=origin, extent_start=(5, -6, 7))
    check_same_surface(ours, contoured(progiso.compress(centres, rate=8), [0.1], 8))


def test_closed_where_the_volume_is():
    """Open edges of the surface lie in the volume's faces; a sphere inside has none."""
    sphere = -np.linalg.norm(np.stack(np.meshgrid(*[np.linspace(-1, 1, 40)] * 3)), axis=0)
    surface = contoured(progiso.compress(make_image(sphere), rate=10), [-0.7], 8)
    assert surface.GetNumberOfPolys() > 1000 and len(open_edges(surface)) == 0
    assert surface.GetNumberOfPoints() - surface.GetNumberOfPolys() // 2 == 2  # Euler's
    surface = contoured(progiso.compress(make_image(sphere), rate=10), [-1.2], 8)
    ends = vtk_to_numpy(surface.GetPoints().GetData())[open_edges(surface)]
    assert len(ends) > 100
    assert np.isin(ends, [0, 39]).any(axis=2).all()


def test_settings():
    volume = progiso.compress(make_image(blobs((20, 20, 20)), "density"), rate=8)
    for normals in (False, True):
        for gradients in (False, True):
            for scalars in (False, True):
                surface = progiso.contour(
                    volume, 0.1, normals=normals, gradients=gradients, scalars=scalars
                )
                data = surface.GetPointData()
                wanted = [normals and "Normals", gradients and "Gradients", scalars and "density"]
                assert {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())} == set(
                    wanted
                ) - {False}
                assert surface.GetFieldData().GetNumberOfArrays() == 0


def test_values_as_in_vtks_filters():
    ours, theirs = vtkZFPContour(), vtkFlyingEdges3D()
    for contour in (ours, theirs):
        contour.GenerateValues(4, 1.0, 2.5)
        contour.SetValue(4, 9.0)
    assert ours.GetNumberOfContours() == theirs.GetNumberOfContours() == 5
    assert [ours.GetValue(i) for i in range(5)] == [theirs.GetValue(i) for i in range(5)]
    time = ours.GetMTime()
    ours.SetNumberOfContours(1)
    assert ours.GetMTime() > time


def test_values_survive_the_round_trip():
    """The surface lies where the decoded samples say: every point's interpolated value is the
    isovalue."""
    volume = progiso.compress(make_image(blobs((24, 25, 26), 7)), rate=6)
    values = samples_of(progiso.decompress(volume))
    points = vtk_to_numpy(contoured(volume, [0.2], 8).GetPoints().GetData()).astype(float)
    low = np.floor(points).astype(int)
    part = points - low
    axis = part.argmax(axis=1)
    high = low.copy()
    high[np.arange(len(low)), axis] += part.max(axis=1) > 0
    t = part.max(axis=1)
    found = (1 - t) * values[tuple(low.T[::-1])] + t * values[tuple(high.T[::-1])]
    assert len(found) > 1000 and np.abs(found - 0.2).max() < 1e-5


# --- plain images ---------------------------------------------------------------------------------


def test_plain_images_are_vtks():
    image = make_image(marschner_lobb(20))
    check_same_surface(
        progiso.contour(image, [0.4, 0.6], gradients=True),
        contour_by(vtkFlyingEdges3D(), image, [0.4, 0.6]),
    )
    ours = progiso.contour(image, 0.4, rate=8, gradients=True)
    check_same_surface(ours, contoured(progiso.compress(image, rate=8), [0.4]))


@pytest.mark.parametrize("cells", [False, True])
def test_plain_array_and_component(cells):
    values = np.stack([blobs((12, 13, 14), seed) for seed in (1, 2)], axis=-1)
    image = make_image(values, "two", cells=cells)
    for component in (-1, 0, 1):
        exact = progiso.contour(image, 0.1, array="two", component=component)
        close = progiso.contour(image, 0.1, rate=30, array="two", component=component)
        assert exact.GetNumberOfPolys() == close.GetNumberOfPolys() > 100
        assert np.allclose(sorted(exact.GetBounds()), sorted(close.GetBounds()), atol=1e-3)


# --- errors ---------------------------------------------------------------------------------------


def test_plain_input_is_one_clear_error():
    algorithm = vtkZFPContour()
    with vtk_messages() as messages:
        surface = contour_by(algorithm, make_image(noise((4, 4, 4))), [0])
    assert len(messages) == 1 and "compress it first" in messages[0]
    assert surface.GetNumberOfPoints() == 0


def test_errors_name_what_is_wrong():
    image = make_image(noise((4, 4, 4)))
    for volume, isovalues, options, kind, words in (
        (image, float("nan"), {}, ValueError, "finite"),
        (image, [0, float("inf")], {}, ValueError, "finite"),
        (image, [], {}, ValueError, "isovalue"),
        (image, ["high"], {}, TypeError, "high"),
        (image, 0, {"rate": 40}, ValueError, "rate"),
        (image, 0, {"array": "none"}, ValueError, "'none'.*'field'"),
        (image, 0, {"component": 1}, ValueError, "component is 1"),
        (progiso.compress(image), 0, {"array": "none"}, ValueError, "'none'"),
        (make_image(noise((1, 4, 4))), 0, {}, ValueError, "4 x 4 x 1"),
        ([1, 2], 0, {}, TypeError, "vtkImageData"),
    ):
        with pytest.raises(kind, match=words):
            progiso.contour(volume, isovalues, **options)
