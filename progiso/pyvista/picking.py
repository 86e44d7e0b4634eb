"""Points of isosurfaces at pixels of a plotter's window."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import pyvista
from vtkmodules.vtkCommonCore import reference

from ..vtkProgIsoKernels import vtkIsosurfaceVolume
from .capture import complete


class SurfacePoint(NamedTuple):
    """A point of an isosurface.

    Attributes
    ----------
    position : tuple of 3 float
        In world coordinates.
    isovalue : float
        Of the surface.
    """

    position: tuple[float, float, float]
    isovalue: float


def renderer_of(plotter: pyvista.BasePlotter, prop: vtkIsosurfaceVolume) -> pyvista.Renderer:
    """Find the view of a plotter that a prop is in.

    Raises
    ------
    ValueError
        When it is in none.
    """
    for renderer in plotter.renderers:
        if renderer.HasViewProp(prop):
            return renderer
    raise ValueError("the prop is not in this plotter: add it by plotter.progiso.add_isosurface")


def surface_at(
    plotter: pyvista.BasePlotter, prop: vtkIsosurfaceVolume, x: float, y: float
) -> SurfacePoint | None:
    """Find a prop's surface at a pixel; see :meth:`IsosurfaceComponent.surface_at`."""
    left, bottom = renderer_of(plotter, prop).GetOrigin()
    complete(plotter)
    position = [0.0, 0.0, 0.0]
    isovalue: Any = reference(0.0)
    if not prop.GetMapper().GetHit(int(x) - left, int(y) - bottom, position, isovalue):
        return None
    return SurfacePoint((position[0], position[1], position[2]), float(isovalue))


def track_surface_clicks(
    plotter: pyvista.BasePlotter,
    prop: vtkIsosurfaceVolume,
    callback: Callable[[tuple[float, float, float], float], object],
    *,
    side: str = "right",
) -> None:
    """Call a function for clicks; see :meth:`IsosurfaceComponent.track_surface_clicks`."""
    renderer_of(plotter, prop)

    iren: Any = plotter.iren

    def clicked(_point: object) -> None:
        met = surface_at(plotter, prop, *iren.interactor.GetEventPosition())
        if met is not None:
            callback(*met)

    track: Any = plotter.track_click_position  # its decorator hides the signature
    track(clicked, side=side, viewport=True)
