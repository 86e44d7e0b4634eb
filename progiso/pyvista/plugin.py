"""progiso in pyvista: ``image.progiso.compress()`` and ``plotter.progiso.add_isosurface()``.

Importing progiso registers both with pyvista 0.48 or newer. With an older pyvista,
`progiso.add_isosurface` and `progiso.compress` do the same as plain functions.
"""

from __future__ import annotations

import pyvista

from ..compression import compress, decompress, describe, is_compressed
from ..mesh import contour
from ..statistics import depth, statistics
from .capture import complete
from .picking import renderer_of, surface_at, track_surface_clicks
from .surfaces import add_isosurface, add_isosurface_slider, clip

__all__ = ["ImageAccessor", "IsosurfaceComponent", "add_isosurface"]


class ImageAccessor:
    """``image.progiso`` of every :class:`pyvista.ImageData`.

    Examples
    --------
    >>> import progiso
    >>> import pyvista as pv
    >>> image = pv.ImageData(dimensions=(16, 16, 16))
    >>> image["height"] = image.points[:, 2]
    >>> volume = image.progiso.compress(rate=4)
    >>> volume.progiso.is_compressed, volume.progiso.info["rate"]
    (True, 4.0)
    """

    def __init__(self, image):
        self._image = image

    def compress(self, rate=8.0, scalars=None, component=0, progress=None, mask_nan=False):
        """Compress one array with fixed-rate ZFP, see :func:`progiso.compress`.

        Parameters
        ----------
        rate : float, default: 8
            Bits per sample, in (0, 32].
        scalars : str, optional
            Point or cell array; by default the active scalars.
        component : int, default: 0
            Component of that array.
        progress : callable, optional
            Called with the fraction done, from 0 to 1.
        mask_nan : bool, default: False
            Whether NaN and infinite samples are hidden; else they are an error.

        Returns
        -------
        pyvista.ImageData
            A compressed volume; ``save("volume.vti")`` stores it.

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> volume = image.progiso.compress(rate=4)
        """
        return pyvista.wrap(
            compress(self._image, rate, scalars, component, progress=progress, mask_nan=mask_nan)
        )

    def decompress(self, progress=None):
        """Decompress a compressed volume into float32, see :func:`progiso.decompress`.

        Parameters
        ----------
        progress : callable, optional
            Called with the fraction done, from 0 to 1.

        Returns
        -------
        pyvista.ImageData

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> image.progiso.compress(rate=4).progiso.decompress().array_names
        ['height']
        """
        return pyvista.wrap(decompress(self._image, progress=progress))

    def contour(self, isovalues, **kwargs):
        """Extract isosurfaces as triangles, see :func:`progiso.contour`.

        Parameters
        ----------
        isovalues : float or sequence of float
            In the units of the image's values.
        **kwargs
            Other parameters of :func:`progiso.contour`.

        Returns
        -------
        pyvista.PolyData

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> image.progiso.compress(rate=4).progiso.contour(7.5).n_points
        256
        """
        return pyvista.wrap(contour(self._image, isovalues, **kwargs))

    @property
    def is_compressed(self):
        """bool: whether the image is a compressed volume."""
        return is_compressed(self._image)

    @property
    def info(self):
        """dict: metadata of a compressed volume, see :func:`progiso.describe`."""
        return describe(self._image)


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

    def __init__(self, plotter):
        self._plotter = plotter

    def add_isosurface(self, volume, isovalue, **kwargs):
        """Add isosurfaces; parameters as in :func:`progiso.add_isosurface`.

        Parameters
        ----------
        volume : pyvista.ImageData or numpy.ndarray
            A plain image, a compressed volume, or a three-dimensional array.
        isovalue : float or sequence of float
            In the units of the volume's values; at most 16.
        **kwargs : dict, optional
            ``scalars``, ``component``, ``color``, ``cmap``, ``clim``, ``log_scale``, ``opacity``,
            ``show_scalar_bar``, ``scalar_bar_args``, ``rate``, ``speculation``,
            ``memory_budget``, ``lighting``, ``ambient``, ``diffuse``, ``specular``,
            ``specular_power``, ``name``, ``reset_camera``, ``pickable``, ``render``,
            ``user_matrix`` and ``mask_nan``.

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
        return add_isosurface(self._plotter, volume, isovalue, **kwargs)

    def add_isosurface_slider(self, volume, rng=None, value=None, **kwargs):
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
        **kwargs : dict, optional
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
        return add_isosurface_slider(self._plotter, volume, rng, value, **kwargs)

    def clip(self, prop, normal="x", origin=None, invert=True):
        """Clip a prop's isosurfaces by a plane, instead of the planes that clipped them before.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.
        normal : str or sequence of 3 float, default: "x"
            The plane's normal, or ``"x"``, ``"-x"``, ``"y"`` and so on.
        origin : sequence of 3 float, optional
            A point of the plane; by default the centre of the volume.
        invert : bool, default: True
            As in pyvista's ``clip``: what the normal points to goes away; else it stays.

        Examples
        --------
        A plane to be moved by hand:

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
        clip(prop, normal, origin, invert)

    def surface_at(self, prop, x, y):
        """Tell where a prop's surface is met at a pixel of the window.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.
        x, y : float
            Pixel from the left and from the bottom, as ``plotter.mouse_position`` has it.

        Returns
        -------
        SurfacePoint or None
            ``position`` in world coordinates and ``isovalue`` of the nearest surface (of
            translucent surfaces the isovalue is that of the last that shows); None where there is
            none. The image is completed first.

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

    def track_surface_clicks(self, prop, callback, side="right"):
        """Call a function with each point of a prop's surface that is clicked on.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.
        callback : callable
            Called with ``position`` and ``isovalue`` of :meth:`surface_at`; not where a click
            meets no surface.
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
        track_surface_clicks(self._plotter, prop, callback, side)

    def complete(self):
        """Finish the image that shows, however long that takes.

        ``plotter.screenshot``, ``write_frame`` and ``get_image_depth`` do it by themselves;
        ``plotter.image`` and VTK's own filters on an interactive window take what is there.

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

    def statistics(self, prop):
        """Statistics of a prop's last image, see :func:`progiso.statistics`.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.

        Returns
        -------
        dict
        """
        return statistics(prop.GetMapper(), renderer_of(self._plotter, prop))

    def depth(self, prop):
        """Distances from the camera in a prop's last image, see :func:`progiso.depth`.

        Parameters
        ----------
        prop : vtkIsosurfaceVolume
            What `add_isosurface` returned.

        Returns
        -------
        numpy.ndarray of float32, shape (height, width)
        """
        return depth(prop.GetMapper())


def _register():
    """Attach the accessor and the component where pyvista has extension points (0.48)."""
    if hasattr(pyvista, "register_dataset_accessor"):
        pyvista.register_dataset_accessor("progiso", pyvista.ImageData)(ImageAccessor)
    if hasattr(pyvista, "register_plotter_component"):
        pyvista.register_plotter_component("progiso")(IsosurfaceComponent)


_register()
