"""Hidden points and cells: a surface ends where a cell has a hidden corner."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUniformGrid
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkThreshold
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

import progiso
from helpers.comparison import GREEN, OPAQUE, ComparisonScene, check_like_vtk, far_apart, show
from helpers.geometry import SHAPE
from helpers.images import blobs, make_image
from progiso.measure import tolerances


def blanked(kind):
    """Make an image with much hidden by VTK's own means; `kind` is points, cells or cell data."""
    grid = vtkUniformGrid()
    grid.ShallowCopy(make_image(blobs(SHAPE, 12, waves=2), cells=kind == "cell data"))
    rng = np.random.default_rng(1)
    for corner in rng.integers(1, np.array(SHAPE[::-1]) - 6, (90, 3)):
        for offset in np.ndindex(5, 5, 5):
            if kind == "points":
                grid.BlankPoint(grid.ComputePointId(corner + offset))
            else:
                grid.BlankCell(grid.ComputeCellId(corner + offset))
    return grid


def visible_triangles(image):
    """Return VTK's triangles in the cells that VTK calls visible.

    Of cell data, those between the centres of such cells.
    """
    seen = np.array([image.IsCellVisible(i) for i in range(image.GetNumberOfCells())], bool)
    centres = image.GetCellData().GetArray("field")
    part = make_image(
        vtk_to_numpy(centres or image.GetPointData().GetArray("field")).reshape(SHAPE),
        origin=[bool(centres) / 2] * 3,
    )
    if centres:
        hidden = ~seen.reshape(SHAPE)
        corners = [
            hidden[tuple(slice(c, n - 1 + c) for c, n in zip(corner, SHAPE))]
            for corner in np.ndindex(2, 2, 2)
        ]
        seen = ~np.any(corners, axis=0).ravel()
    flags = numpy_to_vtk(seen.astype(float), deep=True)
    flags.SetName("visible")
    part.GetCellData().AddArray(flags)
    threshold, contour = vtkThreshold(), vtkContourFilter()
    threshold.SetInputData(part)
    threshold.SetInputArrayToProcess(0, 0, 0, 1, "visible")
    threshold.SetLowerThreshold(0.5)
    contour.SetInputConnection(threshold.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, "field")
    contour.SetValue(0, 0.1)
    contour.Update()
    return contour.GetOutput()


@pytest.mark.parametrize("kind", ["points", "cells", "cell data"])
def test_blanking(kind):
    """VTK's mapper leaves out half a voxel more around what is hidden: its triangles are the
    reference."""
    grid = blanked(kind)
    ours, theirs = ComparisonScene(ours=True), ComparisonScene(ours=False)
    compressed = progiso.compress(grid, rate=24)
    show(ours, compressed)
    mapper, actor = vtkPolyDataMapper(), vtkActor()
    mapper.SetInputData(visible_triangles(grid))
    mapper.ScalarVisibilityOff()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(GREEN)
    actor.GetProperty().LightingOff()
    theirs.renderer.AddActor(actor)
    theirs.look_at(compressed)
    picture = ours.picture()
    check_like_vtk(picture, theirs.picture())
    whole = ComparisonScene(ours=True)
    show(
        whole,
        progiso.compress(make_image(blobs(SHAPE, 12, waves=2), cells=kind == "cell data"), rate=24),
    )
    assert far_apart(picture, whole.picture())[0] > 2 * tolerances.VTK_PIXELS, (
        "hardly anything that is seen is hidden"
    )


def test_the_mapper_takes_a_uniform_grid_itself():
    grid = blanked("points")
    pictures = []
    for image in (grid, progiso.compress(grid, rate=24)):
        scene = ComparisonScene(ours=True)
        scene.add(image, OPAQUE, Rate=24)
        scene.look_at(progiso.compress(grid, rate=24))
        pictures.append(scene.picture())
    assert np.array_equal(*pictures)
