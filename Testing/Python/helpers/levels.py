"""What the references say of a volume's levels of detail."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes

import progiso
from helpers.holes import HIDDEN_CELL, cells_of
from helpers.images import reference_volume, samples_of
from progiso.oracle.caster import Volume
from progiso.oracle.levels import Level, Pyramid


def hidden_cells_of(image):
    """Return the cells of a decompressed image that have no surface; None without any."""
    hidden = cells_of(np.isnan(samples_of(image)))
    ghosts = image.GetCellData().GetArray(vtkDataSetAttributes.GhostArrayName())
    if ghosts is not None:
        hidden |= (vtk_to_numpy(ghosts) & HIDDEN_CELL != 0).reshape(hidden.shape)
    return hidden if hidden.any() else None


def reference_pyramid(compressed, user_matrix=None):
    """Give the caster a compressed volume and all of its levels."""
    volume = reference_volume(compressed, user_matrix)
    hidden = hidden_cells_of(progiso.decompress(compressed))
    levels = []
    for number, about in enumerate(progiso.describe(compressed)["levels"], 1):
        level = progiso.decompress(compressed, level=number)
        levels.append(Level(samples_of(level), tuple(about["steps"]), hidden_cells_of(level)))
    return Pyramid(Volume(volume.values, volume.index_to_world, hidden), tuple(levels))
