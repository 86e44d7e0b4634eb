"""Isosurfaces as triangles, held against VTK's FlyingEdges bit by bit."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

import progiso
from progiso import vtkZFPContour


def contour_by(algorithm, image, isovalues):
    """Contour an image with gradients, normals and scalars; return the surface."""
    algorithm.SetInputData(image)
    for i, isovalue in enumerate(isovalues):
        algorithm.SetValue(i, isovalue)
    algorithm.SetComputeGradients(True)
    algorithm.Update()
    return algorithm.GetOutput()


def contoured(image, isovalues, brick_size=64, threads=0):
    """Contour a compressed volume."""
    algorithm = vtkZFPContour()
    algorithm.SetBrickSize(brick_size)
    algorithm.SetNumberOfThreads(threads)
    return contour_by(algorithm, image, isovalues)


def corners_of(surface):
    """Return the corners of every triangle, as numbers of points."""
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def points_of(surface):
    """Return the bits of every point's coordinates, normal, gradient and isovalue."""
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
    """Return the points in order of their bits, the triangles in that of their corners' ranks."""
    points, corners = points_of(surface), corners_of(surface)
    order = np.lexsort(points.T)
    points = points[order]
    ranks = np.empty(len(points), int)
    ranks[order] = np.cumsum(np.any(points != np.roll(points, 1, axis=0), axis=1))
    triangles = ranks[corners]
    return points, triangles[np.lexsort(triangles.T)]


def check_same_surface(ours, theirs):
    """Check that surfaces have the same points and triangles, whatever their order."""
    for mine, expected in zip(canonical(ours), canonical(theirs)):
        assert np.array_equal(mine, expected)


def check_against_vtk(volume, isovalues, brick_size=64):
    """Compare with FlyingEdges on the decoded image, turned outward; return the surface."""
    surface = contoured(volume, isovalues, brick_size)
    expected = contour_by(vtkFlyingEdges3D(), progiso.decompress(volume), isovalues)
    vtkZFPContour.TurnOutward(volume, expected)
    check_same_surface(surface, expected)
    return surface
