"""`progiso contour`: the command line, and the formats that it writes."""

import os
import subprocess
import sys

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import progiso
from helpers.images import blobs, make_image, noise, samples_of
from helpers.surfaces import contoured, corners_of


def call(folder, *arguments):
    """Run `progiso contour` in a folder."""
    command = [sys.executable, "-m", "progiso", "contour", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=os.environ)


def test_command_line(tmp_path):
    image = make_image(blobs((20, 22, 24)), spacing=(1, 2, 3))
    progiso.save(image, tmp_path / "plain.vti")
    progiso.save(progiso.compress(image, 6), tmp_path / "packed.vti")
    expected = progiso.contour(progiso.compress(image, 6), [0.1, 0.3])
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
    """The surface lies where the decoded samples say: every point's interpolated value is the
    isovalue."""
    volume = progiso.compress(make_image(blobs((24, 25, 26), 7)), 6)
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
