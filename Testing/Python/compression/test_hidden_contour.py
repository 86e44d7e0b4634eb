"""The contour has no triangle in a hidden cell."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

import progiso
from helpers.holes import ISOVALUE, KINDS, SHAPE, blank, speckles
from helpers.images import make_image, noise, without_checksums


@pytest.mark.parametrize("make", KINDS)
def test_triangles_are_those_of_visible_cells(make):
    """Of the surface without holes the triangles in visible cells are left, and their points."""
    image, hidden = make()
    holes = progiso.contour(image, ISOVALUE, gradients=True)
    bare = vtkImageData()
    bare.ShallowCopy(image)
    without_checksums(bare)
    for name in ("HiddenSamples", "HiddenCells"):
        bare.GetFieldData().RemoveArray("ProgIso.ZFP." + name)
    everything = corners_of(progiso.contour(bare, ISOVALUE))
    centres = everything.mean(axis=1) - 0.5 * (progiso.describe(image)["association"] == "cell")
    x, y, z = np.clip(np.floor(centres).astype(int), 0, np.array(hidden.shape[::-1]) - 1).T
    seen = everything[~hidden[z, y, x]]
    assert 0.1 * len(everything) < len(seen) < 0.99 * len(everything)
    assert np.array_equal(in_order(corners_of(holes)), in_order(seen))
    used = np.unique(vtk_to_numpy(holes.GetPolys().GetConnectivityArray()))
    assert np.array_equal(used, np.arange(holes.GetNumberOfPoints()))


def corners_of(surface):
    """Return the triangles' corners [triangle, corner, axis]."""
    points = vtk_to_numpy(surface.GetPoints().GetData())
    return points[vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)]


def in_order(triangles):
    flat = triangles.reshape(len(triangles), -1)
    return flat[np.lexsort(flat.T)]


def test_gradients_at_the_border_of_a_hole():
    z, y, x = np.meshgrid(*[np.arange(n, dtype=np.float32) for n in SHAPE], indexing="ij")
    image = progiso.compress(blank(make_image(z + 0.4 * y + 0.3 * x), speckles(SHAPE)), rate=32)
    surface = progiso.contour(image, 20.3, gradients=True)
    gradients = vtk_to_numpy(surface.GetPointData().GetArray("Gradients"))
    assert len(gradients) > 100
    assert np.abs(gradients - [0.3, 0.4, 1]).max() < 1e-4


def test_a_plain_image_hides_no_nan_from_the_contour():
    values = noise((8, 8, 8))
    values[3, 3, 3] = np.nan
    with pytest.raises(RuntimeError, match="give a rate"):
        progiso.contour(make_image(values), 0, mask_nan=True)
