"""`progiso contour`: the command line, and the formats that it writes."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import progiso
from helpers.images import blobs, make_image, noise
from helpers.programs import run_progiso
from helpers.surfaces import corners_of


def test_command_line(tmp_path):
    image = make_image(blobs((20, 22, 24)), spacing=(1, 2, 3))
    progiso.save(image, tmp_path / "plain.vti")
    progiso.save(progiso.compress(image, rate=6), tmp_path / "packed.vti")
    expected = progiso.contour(progiso.compress(image, rate=6), [0.1, 0.3])
    for arguments in (["packed.vti"], ["plain.vti", "--rate", 6]):
        name, *rest = arguments
        done = run_progiso(
            tmp_path, "contour", name, "out.vtp", "--isovalue", 0.1, "--isovalue", 0.3, *rest
        )
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
    """Another library reads back what was written; STL has no shared points."""
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
    done = run_progiso(tmp_path, "contour", *arguments)
    lines = done.stderr.strip().splitlines()
    assert done.returncode != 0 and len(lines) == 1 and word in lines[0], done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["plain.vti"]
