"""``plotter.progiso``: isosurfaces in pyvista's plotters.

pyvista imports this module by its entry point when a plotter's ``progiso`` is first used; progiso
does where pyvista is imported already.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista

from .._typing import ImageLike, Isovalues, Vector
from ..statistics import depth, statistics
from ..vtkProgIsoKernels import vtkIsosurfaceVolume
from .capture import complete
from .picking import SurfacePoint, renderer_of, surface_at, track_surface_clicks
from .surfaces import ActorKeywords, add_isosurface, add_isosurface_slider, clip

if TYPE_CHECKING:
    from typing_extensions import Unpack


@pyvista.register_plotter_component("progiso")
class IsosurfaceComponent:
    """``plotter.progiso`` of every pyvista plotter.

    Examples
    --------
    >>> import progiso
    >>> import pyvista as pv
    >>> image = pv.ImageData(dimensions=(32, 32, 32))
    >>> image["height"] = image.points[:, 2]
    >>> plotter = pv.Plotter(off_screen=True)
    >>> prop = plotter.progiso.add_isosurface(image, isovalue=12.5)
    >>> plotter.show(auto_close=False)
    >>> plotter.progiso.statistics(prop)["converged"]
    True
    """

    def __init__(self, plotter: pyvista.BasePlotter) -> None:
        self._plotter = plotter

    def add_isosurface(
        self, volume: ImageLike, isovalue: Isovalues, **options: Unpack[ActorKeywords]
    ) -> vtkIsosurfaceVolume:
        """Add isosurfaces; parameters as in :func:`progiso.add_isosurface`.

        Parameters
        ----------
        volume : pyvista.ImageData or numpy.ndarray
            A plain image, a compressed volume, or a three-dimensional array.
        isovalue : float or sequence of float
            In the units of the volume's values; at most 256.
        **options
            All other parameters of :func:`progiso.add_isosurface`.

        Returns
        -------
        vtkIsosurfaceVolume
            The prop.

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> plotter = pv.Plotter(off_screen=True)
        >>> prop = plotter.progiso.add_isosurface(image, isovalue=[3, 7.5], opacity=[0.5, 1])
        """
        return add_isosurface(self._plotter, volume, isovalue, **options)

    def add_isosurface_slider(
        self,
        volume: ImageLike,
        rng: tuple[float, float] | None = None,
        value: float | None = None,
        **options: Any,
    ) -> vtkIsosurfaceVolume:
        """Add an isosurface with a slider for its isovalue.

        The volume is compressed once; moving the slider renders, progressively.

        Parameters
        ----------
        volume : pyvista.ImageData or numpy.ndarray
            A plain image, a compressed volume, or a three-dimensional array.
        rng : sequence of 2 float, optional
            Least and greatest isovalue; by default the range of the volume's values.
        value : float, optional
            The first isovalue; by default the middle of `rng`.
        **options
            ``title`` (by default the array's name), ``pointa``, ``pointb``, ``widget_color``,
            ``style``, ``fmt`` and ``interaction_event`` (by default ``"always"``: while the
            slider moves) as in :meth:`pyvista.Plotter.add_slider_widget`, and what
            :meth:`add_isosurface` takes.

        Returns
        -------
        vtkIsosurfaceVolume
            The prop; the slider is in ``plotter.slider_widgets``.

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> plotter = pv.Plotter(off_screen=True)
        >>> prop = plotter.progiso.add_isosurface_slider(image, cmap="viridis")
        >>> prop.GetProperty().GetIsoSurfaceValues().GetValue(0)
        7.5
        """
        return add_isosurface_slider(self._plotter, volume, rng, value, **options)

    def clip(
        self,
        prop: vtkIsosurfaceVolume,
        normal: str | Vector = "x",
        origin: Vector | None = None,
        *,
        invert: bool = True,
    ) -> None:
        """Clip a prop's isosurfaces by a plane, which replaces the planes set before.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.
        normal : str or sequence of 3 float, default: "x"
            The plane's normal, or ``"x"``, ``"-x"``, ``"y"`` and so on.
        origin : sequence of 3 float, optional
            A point of the plane; by default the centre of the volume.
        invert : bool, default: True
            As in pyvista's ``clip``: the side that the normal points to is removed; otherwise the
            other side is.

        Examples
        --------
        A plane that is moved by hand:

        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> plotter = pv.Plotter(off_screen=True)
        >>> prop = plotter.progiso.add_isosurface(image, 7.5)
        >>> def cut(normal, origin):
        ...     plotter.progiso.clip(prop, normal, origin)
        >>> widget = plotter.add_plane_widget(cut)
        """
        clip(prop, normal, origin, invert=invert)

    def surface_at(self, prop: vtkIsosurfaceVolume, x: float, y: float) -> SurfacePoint | None:
        """Find the point of a prop's surface at a pixel of the window.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.
        x, y : float
            Pixel from the left and from the bottom, as ``plotter.mouse_position`` has it.

        Returns
        -------
        SurfacePoint or None
            ``position`` in world coordinates and ``isovalue`` of the nearest surface (with
            translucent surfaces, the isovalue of the last one that shows); None where there is no
            surface. The image is completed first.

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
        >>> prop = plotter.progiso.add_isosurface(image, 7.5)
        >>> plotter.show(auto_close=False)
        >>> plotter.progiso.surface_at(prop, 100, 100).isovalue
        7.5
        """
        return surface_at(self._plotter, prop, x, y)

    def track_surface_clicks(
        self,
        prop: vtkIsosurfaceVolume,
        callback: Callable[[tuple[float, float, float], float], object],
        *,
        side: str = "right",
    ) -> None:
        """Call a function with each point of a prop's surface that is clicked on.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.
        callback : callable
            Called with ``position`` and ``isovalue`` of :meth:`surface_at`, if a click meets a
            surface.
        side : str, default: "right"
            The mouse button, ``"right"`` or ``"left"``.

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> plotter = pv.Plotter(off_screen=True)
        >>> prop = plotter.progiso.add_isosurface(image, 7.5)
        >>> plotter.progiso.track_surface_clicks(prop, lambda position, isovalue: print(position))
        """
        track_surface_clicks(self._plotter, prop, callback, side=side)

    def complete(self) -> None:
        """Finish the image that shows, however long that takes.

        ``plotter.screenshot``, ``write_frame`` and ``get_image_depth`` do it by themselves;
        ``plotter.image`` and VTK's own filters on an interactive window take an unfinished image.

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> plotter = pv.Plotter(off_screen=True)
        >>> prop = plotter.progiso.add_isosurface(image, 7.5)
        >>> plotter.show(auto_close=False)
        >>> plotter.progiso.complete()
        """
        complete(self._plotter)

    def statistics(self, prop: vtkIsosurfaceVolume) -> dict[str, Any]:
        """Collect the statistics of a prop's last image, see :func:`progiso.statistics`.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.

        Returns
        -------
        dict
        """
        return statistics(prop.GetMapper(), renderer_of(self._plotter, prop))

    def depth(self, prop: vtkIsosurfaceVolume) -> npt.NDArray[np.float32]:
        """Return the distances from the camera in a prop's last image, see :func:`progiso.depth`.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.

        Returns
        -------
        numpy.ndarray of float32, shape (height, width)
        """
        return depth(prop.GetMapper())
