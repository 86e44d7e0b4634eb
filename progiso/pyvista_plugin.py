"""progiso in pyvista: ``image.progiso.compress()`` and ``plotter.progiso.add_isosurface()``.

Importing progiso registers both with pyvista 0.48 or newer. With an older pyvista,
`progiso.add_isosurface` and `progiso.compress` do the same as plain functions.
"""

from __future__ import annotations

import numpy as np
import pyvista

from .compression import as_compressed, compress, decompress, describe, is_compressed
from .isosurface import make_isosurface
from .statistics import depth, statistics
from .surface import contour


def add_isosurface(
    plotter,
    volume,
    isovalue,
    *,
    scalars=None,
    component=0,
    color=None,
    rate=8.0,
    speculation=True,
    memory_budget=0,
    lighting=True,
    ambient=0.05,
    diffuse=0.8,
    specular=0.15,
    specular_power=20.0,
    name=None,
    reset_camera=None,
    pickable=True,
    render=True,
    user_matrix=None,
):
    """Add an isosurface of a volume to a plotter, without extracting a mesh.

    The surface is rendered from compressed data, progressively while the view is interactive and
    completely in screenshots.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        Where to add it.
    volume : pyvista.ImageData or numpy.ndarray
        A plain image, a compressed volume, or a three-dimensional array. Plain data are
        compressed at `rate`.
    isovalue : float
        In the units of the volume's values.
    scalars : str, optional
        Point or cell array of a plain image; by default the active scalars.
    component : int, default: 0
        Component of that array.
    color : ColorLike, optional
        Anything pyvista takes for a colour; by default the theme's.
    rate : float, default: 8
        Bits per sample that plain data are compressed to, in (0, 32].
    speculation : bool or int, default: True
        Whether rays test several blocks ahead in one pass, or how many at most (1 to 64).
    memory_budget : int, default: 0
        Bound in bytes on the GPU memory beside the compressed volume; 0 for the mapper's own
        choice.
    lighting : bool, default: True
        Whether light falls on the surface.
    ambient, diffuse, specular : float
        Material, from 0 to 1.
    specular_power : float, default: 20
        From 0 to 128.
    name : str, optional
        An actor of this name is replaced.
    reset_camera : bool, optional
        Whether the camera is reset to see everything; by default when it was not set yet.
    pickable : bool, default: True
        Whether the prop can be picked.
    render : bool, default: True
        Whether to render at once if the plotter is showing.
    user_matrix : TransformLike, optional
        Transformation of the prop, applied last.

    Returns
    -------
    vtkIsosurfaceVolume
        The prop. Change the isovalue by
        ``prop.GetProperty().GetIsoSurfaceValues().SetValue(0, value)``.

    Raises
    ------
    TypeError
        When `volume` is neither an image nor an array.
    ValueError
        When a number is out of its range or there is no such array.
    RuntimeError
        When the data cannot be compressed, for example because of NaN values.

    Examples
    --------
    >>> import progiso
    >>> import pyvista as pv
    >>> image = pv.ImageData(dimensions=(64, 64, 64))
    >>> image["distance"] = ((image.points - image.center) ** 2).sum(axis=1) ** 0.5
    >>> plotter = pv.Plotter(off_screen=True)
    >>> prop = progiso.add_isosurface(plotter, image, isovalue=20, color="tan")
    >>> picture = plotter.screenshot(return_img=True)
    """
    image = _compressed(volume, rate, scalars, component)
    prop = make_isosurface(
        image,
        isovalue,
        color=pyvista.Color(color, default_color=pyvista.global_theme.color).float_rgb,
        rate=rate,
        speculation=speculation,
        memory_budget=memory_budget,
        shade=lighting,
        ambient=ambient,
        diffuse=diffuse,
        specular=specular,
        specular_power=specular_power,
    )
    if user_matrix is not None:
        prop.SetUserMatrix(pyvista.vtkmatrix_from_array(_matrix(user_matrix)))
    plotter.add_actor(prop, reset_camera=reset_camera, name=name, pickable=pickable, render=render)
    return prop


def _compressed(volume, rate, scalars, component):
    """The compressed volume of whatever was passed."""
    if isinstance(volume, np.ndarray):
        if volume.ndim != 3:
            raise TypeError(f"an array must have 3 dimensions, this one has {volume.ndim}")
        volume = pyvista.wrap(volume)
    if not getattr(volume, "IsA", lambda _: False)("vtkImageData"):
        raise TypeError(f"expected pyvista.ImageData or an array, got {type(volume).__name__}")
    return as_compressed(volume, rate, scalars, component)


def _matrix(transform):
    """A 4x4 array of a pyvista or VTK transform, matrix, or array."""
    if hasattr(transform, "GetMatrix"):
        transform = transform.GetMatrix()
    if hasattr(transform, "GetElement"):
        size = 4 if transform.IsA("vtkMatrix4x4") else 3
        rows = range(size)
        transform = [[transform.GetElement(i, j) for j in rows] for i in rows]
    given = np.asarray(transform, float)
    if given.shape not in ((3, 3), (4, 4)):
        raise ValueError(f"user_matrix must be 3x3 or 4x4, got shape {given.shape}")
    matrix = np.eye(4)
    matrix[: given.shape[0], : given.shape[1]] = given
    return matrix


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

    def compress(self, rate=8.0, scalars=None, component=0, progress=None):
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
        return pyvista.wrap(compress(self._image, rate, scalars, component, progress=progress))

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
        """Add an isosurface; parameters as in :func:`progiso.add_isosurface`.

        Parameters
        ----------
        volume : pyvista.ImageData or numpy.ndarray
            A plain image, a compressed volume, or a three-dimensional array.
        isovalue : float
            In the units of the volume's values.
        **kwargs : dict, optional
            ``scalars``, ``component``, ``color``, ``rate``, ``speculation``, ``memory_budget``,
            ``lighting``, ``ambient``, ``diffuse``, ``specular``, ``specular_power``, ``name``,
            ``reset_camera``, ``pickable``, ``render`` and ``user_matrix``.

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
        >>> prop = plotter.progiso.add_isosurface(image, isovalue=7.5, color="ivory")
        """
        return add_isosurface(self._plotter, volume, isovalue, **kwargs)

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
        return statistics(prop.GetMapper(), self._plotter.renderer)

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
