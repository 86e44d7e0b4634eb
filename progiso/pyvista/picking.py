"""What is met at a pixel of a plotter's window."""

from __future__ import annotations

from typing import NamedTuple

from vtkmodules.vtkCommonCore import reference

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

    position: tuple
    isovalue: float


def renderer_of(plotter, prop):
    """The view of a plotter that a prop is in.

    Raises
    ------
    ValueError
        When it is in none.
    """
    for renderer in plotter.renderers:
        if renderer.HasViewProp(prop):
            return renderer
    raise ValueError("the prop is not in this plotter: add it by plotter.progiso.add_isosurface")


def surface_at(plotter, prop, x, y):
    """What of a prop is met at a pixel; see :meth:`IsosurfaceComponent.surface_at`."""
    left, bottom = renderer_of(plotter, prop).GetOrigin()
    complete(plotter)
    position, isovalue = [0.0] * 3, reference(0.0)
    if not prop.GetMapper().GetHit(int(x) - left, int(y) - bottom, position, isovalue):
        return None
    return SurfacePoint(tuple(position), float(isovalue))


def track_surface_clicks(plotter, prop, callback, side="right"):
    """Call a function for clicks; see :meth:`IsosurfaceComponent.track_surface_clicks`."""
    renderer_of(plotter, prop)

    def clicked(_point):
        met = surface_at(plotter, prop, *plotter.iren.interactor.GetEventPosition())
        if met is not None:
            callback(*met)

    plotter.track_click_position(clicked, side=side, viewport=True)
