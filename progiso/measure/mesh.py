"""Extract a mesh by vtkFlyingEdges3D, and show it."""

from __future__ import annotations

from time import perf_counter

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from .._vtk import vtk_errors
from .packed_depth import DepthRange
from .view import View

_VTK_KIB = 1024  # unit of GetActualMemorySize()


def extract(
    image: vtkImageData, isovalue: float, normals: bool = True
) -> tuple[vtkPolyData, float]:
    """Extract an isosurface.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Plain.
    isovalue : float
    normals : bool, default: True

    Returns
    -------
    mesh : vtkmodules.vtkCommonDataModel.vtkPolyData
    milliseconds : float
        Of wall clock.

    Raises
    ------
    RuntimeError
        With VTK's message, when it reported an error.
    """
    filter_ = vtkFlyingEdges3D()
    filter_.SetInputData(image)
    filter_.SetValue(0, isovalue)
    filter_.SetComputeNormals(normals)
    filter_.ComputeScalarsOff()
    with vtk_errors("cannot extract the isosurface"):
        start = perf_counter()
        filter_.Update()
        elapsed = perf_counter() - start
    return filter_.GetOutput(), 1e3 * elapsed


def mesh_bytes(mesh: vtkPolyData) -> int:
    """Return the main memory that a mesh takes, in bytes."""
    return _VTK_KIB * mesh.GetActualMemorySize()


class Mesh(View):
    """A triangle mesh, rasterised.

    Parameters
    ----------
    mesh : vtkmodules.vtkCommonDataModel.vtkPolyData
        See `extract`.
    size : tuple of int
        Width and height in pixels.
    """

    label = "VTK FlyingEdges"

    def __init__(self, mesh: vtkPolyData, size: tuple[int, int]) -> None:
        self.mapper = vtkPolyDataMapper()
        self.mapper.SetInputData(mesh)
        self.mapper.ScalarVisibilityOff()
        prop = vtkActor()
        prop.SetMapper(self.mapper)
        super().__init__(prop, size)

    def depth(self) -> np.ndarray:
        """Render once more, and read the distances along the rays."""
        depths = DepthRange.of(self)
        tag, code = "//VTK::Light::Impl", depths.glsl("length(vertexVC.xyz)")
        shader = self.prop.GetShaderProperty()
        shader.AddFragmentShaderReplacement(tag, True, f"{tag}\n{code}", False)
        self.render()
        shader.ClearAllFragmentShaderReplacements()
        return depths.read(self)

    def depth_resolution(self) -> float:
        """Return the resolution of `depth` in world units."""
        return DepthRange.of(self).resolution
