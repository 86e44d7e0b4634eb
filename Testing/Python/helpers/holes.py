"""Images in which much is hidden, and the cells that have no surface therefore."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes

import progiso
from helpers.images import blobs, make_image

HIDDEN_POINT, HIDDEN_CELL = vtkDataSetAttributes.HIDDENPOINT, vtkDataSetAttributes.HIDDENCELL
REFINED_CELL = vtkDataSetAttributes.REFINEDCELL
SHAPE = (26, 31, 29)
ISOVALUE = 0.15
SIZE = (120, 90)


def blank(image, points=None, cells=None, flag=HIDDEN_CELL):
    """Hide points and cells, given as arrays [z, y, x] of booleans; return the image."""
    for hidden, data, value in (
        (points, image.GetPointData(), HIDDEN_POINT),
        (cells, image.GetCellData(), flag),
    ):
        if hidden is not None:
            ghosts = numpy_to_vtk(np.where(hidden, value, 0).astype(np.uint8).ravel(), deep=True)
            ghosts.SetName(vtkDataSetAttributes.GhostArrayName())
            data.AddArray(ghosts)
    return image


def ball(shape, radius, centre=0.5):
    """Return a ball in an array [z, y, x]: a hole with a smooth border."""
    place = [np.arange(n) - centre * (n - 1) for n in shape]
    return sum(p**2 for p in np.meshgrid(*place, indexing="ij")) < radius**2


def speckles(shape, share=0.15, seed=4):
    """Return many small holes."""
    return np.random.default_rng(seed).random(shape) < share


def cells_of(points):
    """Return the cells, named by their lowest corners, that have one of some points."""
    cells = np.zeros(np.array(points.shape) - 1, bool)
    for corner in np.ndindex(2, 2, 2):
        cells |= points[tuple(slice(c, n - 1 + c) for c, n in zip(corner, points.shape))]
    return cells


def fewer(shape):
    """Return the numbers of cells between samples."""
    return tuple(n - 1 for n in shape)


def nan_image(hidden, values):
    """Return an image that is NaN where it is hidden."""
    return make_image(np.where(hidden, np.float32(np.nan), values))


#: How something gets hidden: the image, compressed, and the cells between its samples that have no
#: surface.
def hidden_points():
    hidden = ball(SHAPE, 12)
    return progiso.compress(blank(make_image(blobs(SHAPE, 3)), points=hidden), rate=12), cells_of(
        hidden
    )


def hidden_cells():
    hidden = ball(fewer(SHAPE), 12)
    return progiso.compress(blank(make_image(blobs(SHAPE, 3)), cells=hidden), rate=12), hidden


def refined_cells():
    hidden = ball(fewer(SHAPE), 12, 0.2)
    return progiso.compress(
        blank(make_image(blobs(SHAPE, 3)), cells=hidden, flag=REFINED_CELL), rate=12
    ), hidden


def hidden_cells_of_cell_data():
    hidden = speckles(SHAPE, 0.03)
    return progiso.compress(
        blank(make_image(blobs(SHAPE, 3), cells=True), cells=hidden), rate=12
    ), cells_of(hidden)


def hidden_points_of_cell_data():
    points = ball([n + 1 for n in SHAPE], 11, 0.4)
    hidden = cells_of(points)
    return progiso.compress(
        blank(make_image(blobs(SHAPE, 3), cells=True), points=points), rate=12
    ), cells_of(hidden)


def nan_samples():
    hidden = speckles(SHAPE, 0.02) | ball(SHAPE, 7, 0.8)
    return progiso.compress(nan_image(hidden, blobs(SHAPE, 3)), rate=12, mask_nan=True), cells_of(
        hidden
    )


def all_together():
    points, cells, nan = speckles(SHAPE, 0.01), ball(fewer(SHAPE), 6), ball(SHAPE, 5, 0.1)
    image = blank(nan_image(nan, blobs(SHAPE, 3)), points, cells)
    return progiso.compress(image, rate=12, mask_nan=True), cells_of(points | nan) | cells


KINDS = [
    hidden_points,
    hidden_cells,
    refined_cells,
    hidden_cells_of_cell_data,
    hidden_points_of_cell_data,
    nan_samples,
]
KINDS += [all_together]
