"""Isosurfaces as triangles: those of VTK's FlyingEdges on the decoded image, in every bit, brick by brick."""

import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkSMPTools
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import progiso
from helpers.images import blobs, make_image, marschner_lobb, metadata, noise, samples_of
from helpers.messages import vtk_messages
from progiso import vtkZFPContour
from progiso.data import SCANS, fetch

ROTATION = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]


def run(algorithm, image, isovalues):
    """Contour with gradients, normals and scalars."""
    algorithm.SetInputData(image)
    for i, isovalue in enumerate(isovalues):
        algorithm.SetValue(i, isovalue)
    algorithm.SetComputeGradients(True)
    algorithm.Update()
    return algorithm.GetOutput()


def contoured(image, isovalues, brick_size=64, threads=0):
    algorithm = vtkZFPContour()
    algorithm.SetBrickSize(brick_size)
    algorithm.SetNumberOfThreads(threads)
    return run(algorithm, image, isovalues)


def corners_of(surface):
    """The corners of every triangle, as numbers of points."""
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def points_of(surface):
    """Every point's coordinates, normal, gradient and isovalue, in bits."""
    if surface.GetNumberOfPoints() == 0:
        return np.zeros((0, 10), np.uint32)
    data = surface.GetPointData()
    columns = [
        surface.GetPoints().GetData(),
        data.GetNormals(),
        data.GetVectors(),
        data.GetScalars(),
    ]
    columns = [vtk_to_numpy(array).reshape(surface.GetNumberOfPoints(), -1) for array in columns]
    return np.hstack([column.astype(np.float32) for column in columns]).view(np.uint32)


def canonical(surface):
    """Points in order of their bits, and triangles in that of their corners' ranks among them."""
    points, corners = points_of(surface), corners_of(surface)
    order = np.lexsort(points.T)
    points = points[order]
    ranks = np.empty(len(points), int)
    ranks[order] = np.cumsum(np.any(points != np.roll(points, 1, axis=0), axis=1))
    triangles = ranks[corners]
    return points, triangles[np.lexsort(triangles.T)]


def check_same(ours, theirs):
    """The same points and triangles, whatever their order."""
    for mine, expected in zip(canonical(ours), canonical(theirs)):
        assert np.array_equal(mine, expected)


def check_against_vtk(volume, isovalues, brick_size=64):
    """Compare with FlyingEdges on the decoded image; return the surface."""
    surface = contoured(volume, isovalues, brick_size)
    check_same(surface, run(vtkFlyingEdges3D(), progiso.decompress(volume), isovalues))
    return surface


def open_edges(surface):
    """Ends of the edges that only one triangle has."""
    corners = corners_of(surface)
    edges = np.sort(np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    edges, uses = np.unique(edges, axis=0, return_counts=True)
    return edges[uses == 1]


# --- the same surface ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCANS)
def test_scans(name):
    """All that a scan's catalogue entry proposes, at once."""
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
    """Extent, origin, spacing and direction, as FlyingEdges has them."""
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
    check_same(ours, contoured(progiso.compress(centres, rate=8), [0.1], 8))


def test_closed_where_the_volume_is():
    """Edges of the surface lie in the volume's faces; a sphere has none."""
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


# --- bricks and threads --------------------------------------------------------------------------------------------------------


def test_threads_do_not_show():
    """Not even in the order of points and triangles, nor does the backend."""
    volume = progiso.compress(make_image(blobs((50, 40, 60), 4, waves=6)), rate=6)
    first = contoured(volume, [0.1, 0.3], 8, threads=1)
    before = vtkSMPTools.GetBackend()
    try:
        for backend in ("Sequential", "STDThread"):
            vtkSMPTools.SetBackend(backend)
            for threads in (0, 2, 5):
                other = contoured(volume, [0.1, 0.3], 8, threads)
                assert np.array_equal(points_of(other), points_of(first))
                assert np.array_equal(corners_of(other), corners_of(first))
                assert vtkSMPTools.GetBackend() == backend
    finally:
        vtkSMPTools.SetBackend(before)


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_memory_is_that_of_a_brick_a_thread(threads):
    """Whatever the volume's size: 32 cells, a sample more, one on either side, in whole blocks, is 40 samples a side."""
    algorithm = vtkZFPContour()
    algorithm.SetBrickSize(32)
    algorithm.SetNumberOfThreads(threads)
    surface = run(algorithm, progiso.compress(make_image(blobs((130, 140, 150), 5)), rate=4), [0.1])
    assert surface.GetNumberOfPolys() > 10_000
    brick = 4 * 40**3
    assert brick <= algorithm.GetPeakSampleBytes() <= threads * brick < 4 * 130 * 140 * 150


def test_bricks_are_decoded_when_they_hold_an_isovalue():
    """Every brick once, then those only that other isovalues need."""
    z = np.broadcast_to(np.arange(65.0)[:, None, None], (65, 33, 33))
    algorithm = vtkZFPContour()
    algorithm.SetBrickSize(16)
    volume = progiso.compress(make_image(z), rate=32)
    run(algorithm, volume, [3.5])
    assert algorithm.GetNumberOfDecodedBricks() == algorithm.GetNumberOfBricks() == 2 * 2 * 4
    for isovalues, layers in (([20.5], 1), ([20.5, 60.25], 2), ([1000, -1], 0)):
        run(algorithm, volume, isovalues)
        assert algorithm.GetNumberOfDecodedBricks() == 4 * layers
    check_same(run(algorithm, volume, [16, 40.5]), contoured(volume, [16, 40.5], 16))
    run(algorithm, progiso.compress(make_image(z), rate=16), [20.5])
    assert algorithm.GetNumberOfDecodedBricks() == 16


def test_brick_sizes_are_multiples_of_four():
    algorithm = vtkZFPContour()
    for asked, taken in ((1, 4), (35, 32), (36, 36), (10_000, 256)):
        algorithm.SetBrickSize(asked)
        assert algorithm.GetBrickSize() == taken


def test_progress_rises_in_the_calling_thread():
    seen = []
    volume = progiso.compress(make_image(blobs((257, 129, 129))), rate=2)
    progiso.contour(volume, 0.1, threads=1, progress=seen.append)
    assert len(seen) >= 2 and seen == sorted(seen) and seen[-1] == 1


def test_unaligned_memory():
    """A stream in someone's NumPy array may begin at any byte."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData

    volume = progiso.compress(make_image(blobs((20, 20, 20))), rate=8)
    stream = metadata(volume, "Stream")
    shifted = np.empty(len(stream) + 16, np.uint8)
    shifted = shifted[(3 - shifted.ctypes.data) % 8 :][: len(stream)]
    shifted[:] = stream
    array = numpy_to_vtk(shifted)
    array.SetName("ProgIso.ZFP.Stream")
    moved = vtkImageData()
    moved.ShallowCopy(volume)
    moved.GetFieldData().AddArray(array)
    check_same(contoured(moved, [0.1]), contoured(volume, [0.1]))


# --- plain images ----------------------------------------------------------------------------------------------------------------


def test_plain_images_are_vtks():
    image = make_image(marschner_lobb(20))
    check_same(
        progiso.contour(image, [0.4, 0.6], gradients=True),
        run(vtkFlyingEdges3D(), image, [0.4, 0.6]),
    )
    ours = progiso.contour(image, 0.4, rate=8, gradients=True)
    check_same(ours, contoured(progiso.compress(image, rate=8), [0.4]))


@pytest.mark.parametrize("cells", [False, True])
def test_plain_array_and_component(cells):
    values = np.stack([blobs((12, 13, 14), seed) for seed in (1, 2)], axis=-1)
    image = make_image(values, "two", cells)
    for component in (0, 1):
        exact = progiso.contour(image, 0.1, array="two", component=component)
        close = progiso.contour(image, 0.1, rate=30, array="two", component=component)
        assert exact.GetNumberOfPolys() == close.GetNumberOfPolys() > 100
        assert np.allclose(sorted(exact.GetBounds()), sorted(close.GetBounds()), atol=1e-3)


# --- errors ------------------------------------------------------------------------------------------------------------------------


def test_plain_input_is_one_clear_error():
    algorithm = vtkZFPContour()
    with vtk_messages() as messages:
        surface = run(algorithm, make_image(noise((4, 4, 4))), [0])
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


# --- files -------------------------------------------------------------------------------------------------------------------------


def call(folder, *arguments):
    """Run `progiso contour` in a folder."""
    command = [sys.executable, "-m", "progiso", "contour", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=os.environ)


def test_command_line(tmp_path):
    image = make_image(blobs((20, 22, 24)), spacing=(1, 2, 3))
    progiso.save(image, tmp_path / "plain.vti")
    progiso.save(progiso.compress(image, rate=6), tmp_path / "packed.vti")
    expected = progiso.contour(progiso.compress(image, rate=6), [0.1, 0.3])
    for arguments in (["packed.vti"], ["plain.vti", "--rate", 6]):
        name, *rest = arguments
        done = call(tmp_path, name, "out.vtp", "--isovalue", 0.1, "--isovalue", 0.3, *rest)
        assert done.returncode == 0, done.stderr
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(tmp_path / "out.vtp"))
        reader.Update()
        read = reader.GetOutput()
        assert np.array_equal(corners_of(read), corners_of(expected))
        for array in ("GetNormals", "GetScalars"):
            mine, theirs = (getattr(s.GetPointData(), array)() for s in (read, expected))
            assert np.array_equal(vtk_to_numpy(mine), vtk_to_numpy(theirs))
        assert f"{expected.GetNumberOfPolys()} triangles" in done.stdout
        (tmp_path / "out.vtp").unlink()


@pytest.mark.parametrize("suffix", [".vtp", ".stl", ".ply", ".obj"])
def test_formats(tmp_path, suffix):
    """What another library reads back; STL has no shared points."""
    pyvista = pytest.importorskip("pyvista")
    surface = progiso.contour(make_image(blobs((12, 12, 12))), 0.1)
    progiso.save_surface(surface, tmp_path / f"surface{suffix}")
    read = pyvista.read(tmp_path / f"surface{suffix}")
    assert read.n_cells == surface.GetNumberOfPolys()
    assert np.allclose(read.bounds, surface.GetBounds(), atol=1e-5)
    assert [p.name for p in tmp_path.iterdir()] == [f"surface{suffix}"]


def test_pyvista_accessor():
    pyvista = pytest.importorskip("pyvista")
    volume = pyvista.wrap(make_image(blobs((12, 12, 12)))).progiso.compress(rate=8)
    surface = volume.progiso.contour([0.1])
    assert isinstance(surface, pyvista.PolyData) and surface.n_cells > 100


FAILURES = {
    "isovalue": (["plain.vti", "x.vtp"], "--isovalue"),
    "no number": (["plain.vti", "x.vtp", "--isovalue", "nan"], "finite"),
    "suffix": (["plain.vti", "x.xyz", "--isovalue", 0], ".vtp"),
    "folder": (["plain.vti", "nowhere/x.vtp", "--isovalue", 0], "nowhere"),
    "rate": (["plain.vti", "x.vtp", "--isovalue", 0, "--rate", 33], "rate"),
    "array": (["plain.vti", "x.vtp", "--isovalue", 0, "--array", "none"], "none"),
    "file": (["none.vti", "x.vtp", "--isovalue", 0], "none.vti"),
}


@pytest.mark.parametrize("case", FAILURES)
def test_errors_are_one_line(tmp_path, case):
    arguments, word = FAILURES[case]
    progiso.save(make_image(noise((4, 4, 4))), tmp_path / "plain.vti")
    done = call(tmp_path, *arguments)
    lines = done.stderr.strip().splitlines()
    assert done.returncode != 0 and len(lines) == 1 and word in lines[0], done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["plain.vti"]


def test_values_survive_the_round_trip():
    """The surface lies where the decoded samples say: every point's interpolated value is the isovalue."""
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
