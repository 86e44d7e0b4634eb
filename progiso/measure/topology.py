"""Count an isosurface's components and handles, which noise and low rates change."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkConnectivityFilter

from ..geometry import image_from_array, samples_of
from .mesh import extract


def topology(image: vtkImageData, isovalue: float) -> dict[str, int]:
    """Count surfaces and handles of FlyingEdges' mesh, closed at the volume's border.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Plain.
    isovalue : float

    Returns
    -------
    dict
        ``triangles``; ``components``, the surfaces that hang together; ``euler``, the number
        V − E + F; and ``genus``, the handles of all of them.
    """
    values = samples_of(image).astype(np.float32)
    outside = min(float(values.min()), isovalue) - 1  # below, so that the border gets caps
    closed = np.pad(values, 1, constant_values=outside)
    mesh, _ = extract(image_from_array(closed.ravel(), closed.shape[::-1]), isovalue, False)
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    euler = len(np.unique(corners)) - _edges(corners) + len(corners)
    components = _components(mesh) if len(corners) else 0
    return {
        "triangles": len(corners),
        "components": components,
        "euler": euler,
        "genus": components - euler // 2,
    }


def _edges(corners: np.ndarray) -> int:
    """Count the edges of triangles."""
    ends = np.sort(np.vstack([corners[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    keys = ends[:, 0].astype(np.int64) << 32 | ends[:, 1]
    keys.sort()
    return int((np.diff(keys, prepend=-1) != 0).sum())


def _components(mesh: vtkPolyData) -> int:
    connectivity = vtkConnectivityFilter()
    connectivity.SetInputData(mesh)
    connectivity.SetExtractionModeToAllRegions()
    connectivity.ColorRegionsOff()
    connectivity.Update()
    return connectivity.GetNumberOfExtractedRegions()
