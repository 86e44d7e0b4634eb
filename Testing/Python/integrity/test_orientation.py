"""Surfaces have their normals and windings outward, whatever the image's axes; bad samples are
refused whichever way a surface is made."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy

import progiso
from helpers.holes import blank, speckles
from helpers.images import blobs, make_image, noise
from helpers.programs import run_progiso
from progiso import vtkZFPContour

AXES = {
    "right-handed": (1, 0, 0, 0, 1, 0, 0, 0, 1),
    "rotated": (0, -1, 0, 1, 0, 0, 0, 0, 1),
    "FreeSurfer's": (-1, 0, 0, 0, 0, 1, 0, -1, 0),
    "mirrored": (-1, 0, 0, 0, 1, 0, 0, 0, 1),
    "all mirrored": (-1, 0, 0, 0, -1, 0, 0, 0, -1),
    "sheared": (1, 0.5, 0, 0, 1, 0, 0, 0, 1),
    "sheared and mirrored": (2, 0.5, 0, 0, 1, 0.3, 0, 0, -1),
}
PATHS = {
    "plain": lambda image: image,
    "compressed": lambda image: progiso.compress(image, rate=32),
    "cells": lambda image: progiso.compress(as_cells(image), rate=32),
    "plain cells": lambda image: as_cells(image),
}


def as_cells(image):
    """Give an image's samples to the cells of another of the same axes."""
    other = type(image)()
    other.SetDimensions([n + 1 for n in image.GetDimensions()])
    other.SetSpacing(image.GetSpacing())
    other.SetDirectionMatrix(image.GetDirectionMatrix())
    other.GetCellData().SetScalars(image.GetPointData().GetScalars())
    return other


def parts(surface):
    """Return points, triangles' corners and normals."""
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    normals = surface.GetPointData().GetNormals()
    return (
        vtk_to_numpy(surface.GetPoints().GetData()).astype(float),
        corners,
        None if normals is None else vtk_to_numpy(normals),
    )


def ball(radius=10):
    z, y, x = np.mgrid[0:24, 0:25, 0:26]
    return (radius - np.sqrt((x - 12) ** 2 + (y - 12) ** 2 + (z - 11) ** 2)).astype(np.float32)


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("spacing", [(1, 1, 1), (0.5, 2, 3), (1, -2, 1)])
@pytest.mark.parametrize("path", PATHS)
def test_a_balls_surface(axes, spacing, path):
    """Its volume is positive, and normals are the field's direction down, by the inverse transpose
    of the axes."""
    image = make_image(ball(), spacing=spacing)
    image.SetDirectionMatrix(AXES[axes])
    surface = progiso.contour(PATHS[path](image), 4)
    points, corners, normals = parts(surface)
    matrix = np.reshape(AXES[axes], (3, 3)) * spacing
    centred = points - points.mean(axis=0)
    a, b, c = (centred[corners[:, i]] for i in range(3))
    volume = (a * np.cross(b, c)).sum() / 6
    expected = 4 / 3 * np.pi * 6**3 * abs(np.linalg.det(matrix))
    assert 0.95 * expected < volume < expected
    index = centred @ np.linalg.inv(matrix).T
    outward = index / np.linalg.norm(index, axis=1)[:, None] @ np.linalg.inv(matrix)
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    assert (normals * outward).sum(axis=1).min() > 0.99
    faces = np.cross(b - a, c - a)
    assert (faces * normals[corners].mean(axis=1)).sum(axis=1).min() >= 0


def test_files_for_printing(tmp_path):
    """What is written is turned outward, too, by the command line as well."""
    image = make_image(ball())
    image.SetDirectionMatrix(AXES["FreeSurfer's"])
    progiso.save(image, tmp_path / "head.mha")
    for rate in ([], ["--rate", 16]):
        done = run_progiso(tmp_path, "contour", "head.mha", "s.stl", "--isovalue", 4, *rate)
        assert done.returncode == 0, done.stderr
        data = np.frombuffer((tmp_path / "s.stl").read_bytes()[84:], "u1").reshape(-1, 50)
        values = np.ascontiguousarray(data[:, :48]).view("<f4").reshape(-1, 4, 3).astype(float)
        a, b, c = (values[:, i] - values[:, 1:].mean(axis=(0, 1)) for i in (1, 2, 3))
        assert (a * np.cross(b, c)).sum() / 6 > 800


def test_without_normals_and_with_gradients():
    for mirror in (1, -1):
        image = make_image(ball())
        image.SetDirectionMatrix(mirror, 0, 0, 0, 1, 0, 0, 0, 1)
        for source in (image, progiso.compress(image, rate=32)):
            bare = progiso.contour(source, 4, normals=False)
            points, corners, normals = parts(bare)
            centred = points - points.mean(axis=0)
            a, b, c = (centred[corners[:, i]] for i in range(3))
            assert normals is None and (a * np.cross(b, c)).sum() > 0
            surface = progiso.contour(source, 4, gradients=True)
            gradients = vtk_to_numpy(surface.GetPointData().GetArray("Gradients"))
            points = parts(surface)[0]
            assert ((points - points.mean(axis=0)) * gradients).sum(axis=1).max() < 0


def test_an_empty_surface_may_be_turned():
    image = make_image(ball())
    image.SetDirectionMatrix(AXES["mirrored"])
    assert progiso.contour(image, 99).GetNumberOfPoints() == 0
    vtkZFPContour.TurnOutward(image, progiso.contour(image, 99))


# --- the same checks ------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize("rate", [None, 8])
def test_bad_samples_are_counted(value, kind, rate):
    values = blobs((9, 9, 9)).astype(kind)
    values[:2, 3, 3:5] = value
    with pytest.raises(RuntimeError, match=r"'field' has .*\b4\b.*(--mask-nan|mask_nan)"):
        progiso.contour(make_image(values), 0.1, rate=rate, mask_nan=False)
    surface = progiso.contour(make_image(values), 0.1, rate=16)
    assert np.isfinite(parts(surface)[0]).all()


def test_bad_samples_of_other_components_do_not_matter():
    image = make_image(noise((6, 6, 6)))
    pair = np.stack([np.full(216, np.nan, np.float32), noise((6, 6, 6)).ravel()], axis=1)
    image.GetPointData().GetScalars().SetNumberOfComponents(2)
    image.GetPointData().GetScalars().SetNumberOfTuples(216)
    vtk_to_numpy(image.GetPointData().GetScalars())[:] = pair
    assert progiso.contour(image, 0, component=1).GetNumberOfPoints() > 100
    with pytest.raises(RuntimeError, match="216"):
        progiso.contour(image, 0, component=0)


def test_the_command_line_writes_no_nan(tmp_path):
    values = blobs((9, 9, 9))
    values[2] = np.nan
    progiso.save(make_image(values), tmp_path / "nan.vti")
    for rest in ([], ["--rate", 8, "--no-mask-nan"]):
        done = run_progiso(tmp_path, "contour", "nan.vti", "nan.stl", "--isovalue", 0.1, *rest)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1
        assert "81" in done.stderr and "--mask-nan" in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["nan.vti"]


@pytest.mark.parametrize("rate", [None, 8])
@pytest.mark.parametrize("number", [100, 800])
def test_arrays_that_do_not_fit(number, rate):
    """VTK's extractor would read memory beyond a shorter one."""
    image = make_image(blobs((9, 9, 9)))
    image.GetPointData().GetScalars().SetNumberOfTuples(number)
    with pytest.raises(RuntimeError, match=f"has {number} tuples, the image needs 729"):
        progiso.contour(image, 0.1, rate=rate)


@pytest.mark.parametrize("what", ["points", "cells"])
def test_hidden_samples_are_not_shown(what):
    """A plain surface would go through what the compressed one leaves out."""
    shape = (12, 12, 12) if what == "points" else (11, 11, 11)
    image = blank(make_image(blobs((12, 12, 12))), **{what: speckles(shape)})
    with pytest.raises(RuntimeError, match="hides .*rate"):
        progiso.contour(image, 0.1)
    assert progiso.contour(image, 0.1, rate=16).GetNumberOfPoints() > 0
