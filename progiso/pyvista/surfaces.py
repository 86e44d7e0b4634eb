"""Isosurfaces in a pyvista plotter, with pyvista's own colours, scalar bars and sliders."""

from __future__ import annotations

import warnings
from numbers import Real

import numpy as np
import pyvista
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from ..appearance import as_list, is_color
from ..compression import as_compressed, describe
from ..isosurface import make_isosurface
from .capture import complete_captures

#: What a slider takes of what `add_isosurface_slider` is given.
_SLIDER_ARGUMENTS = {
    "title": "title",
    "pointa": "pointa",
    "pointb": "pointb",
    "widget_color": "color",
    "style": "style",
    "fmt": "fmt",
    "interaction_event": "interaction_event",
}


def add_isosurface(
    plotter,
    volume,
    isovalue,
    *,
    scalars=None,
    component=0,
    color=None,
    cmap=None,
    clim=None,
    log_scale=False,
    opacity=1.0,
    show_scalar_bar=None,
    scalar_bar_args=None,
    rate=8.0,
    speculation=True,
    memory_budget=0,
    lighting=None,
    ambient=0.05,
    diffuse=0.8,
    specular=0.15,
    specular_power=20.0,
    name=None,
    reset_camera=None,
    pickable=True,
    render=True,
    user_matrix=None,
    mask_nan=False,
):
    """Add isosurfaces of a volume to a plotter, without extracting a mesh.

    They are rendered from compressed data, progressively while the view is interactive and
    completely in screenshots.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        Where to add them.
    volume : pyvista.ImageData or numpy.ndarray
        A plain image, a compressed volume, or a three-dimensional array [x, y, z]. Plain data are
        compressed at `rate`.
    isovalue : float or sequence of float
        In the units of the volume's values; at most 16. A whole number is an isovalue too, not a
        count: for that give ``numpy.linspace(low, high, count)``.
    scalars : str, optional
        Point or cell array of a plain image; by default the active scalars.
    component : int, default: 0
        Component of that array.
    color : ColorLike or sequence of ColorLike, optional
        Anything pyvista takes for a colour, or one such for each isovalue, which it keeps when it
        is changed. By default the theme's for one isovalue; several are coloured by `cmap`.
    cmap : str, list, matplotlib.colors.Colormap or pyvista.LookupTable, optional
        Colours isosurfaces by their isovalues; by default the theme's.
    clim : sequence of 2 float, optional
        Isovalues at the ends of `cmap`, or one number for minus to plus that; by default the
        range of the volume's values.
    log_scale : bool, default: False
        Whether `cmap` is spread over the logarithm of isovalues.
    opacity : float or sequence of float, default: 1
        One for all isovalues, or one for each: 0 hides a surface, below 1 what lies behind it
        shines through.
    show_scalar_bar : bool, optional
        Whether `cmap` is shown as a scalar bar; by default the theme's choice.
    scalar_bar_args : dict, optional
        For :meth:`pyvista.Plotter.add_scalar_bar`; ``title`` is by default the array's name.
    rate : float, default: 8
        Bits per sample that plain data are compressed to, in (0, 32].
    speculation : bool or int, default: True
        Whether rays test several blocks ahead in one pass, or how many at most (1 to 64).
    memory_budget : int, default: 0
        Bound in bytes on the GPU memory beside the compressed volume; 0 for the mapper's own
        choice.
    lighting : bool, optional
        Whether light falls on the surface; by default the theme's choice.
    ambient, diffuse, specular : float
        Material, from 0 to 1.
    specular_power : float, default: 20
        From 0 to 128.
    name : str, optional
        An actor of this name is replaced.
    reset_camera : bool, optional
        Whether the camera is reset to see everything; by default when it was not set yet.
    pickable : bool, default: True
        Whether pyvista's hardware picker finds the prop. ``plotter.progiso.surface_at`` tells the
        place.
    render : bool, default: True
        Whether to render at once if the plotter is showing.
    user_matrix : TransformLike, optional
        Transformation of the prop, applied last.
    mask_nan : bool, default: False
        Whether NaN and infinite samples of plain data are hidden, so that the surface has a hole
        there; else they are an error.

    Returns
    -------
    vtkIsosurfaceVolume
        The prop. Change the i-th isovalue by
        ``prop.GetProperty().GetIsoSurfaceValues().SetValue(i, value)``.

    Raises
    ------
    TypeError
        When `volume` is neither an image nor an array.
    ValueError
        When a number is out of its range, there is no such array, or there are neither one nor as
        many colours or opacities as isovalues.
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

    Several isovalues, the outer surface translucent, coloured by their values:

    >>> prop = progiso.add_isosurface(plotter, image, [10, 20], cmap="plasma", opacity=[1, 0.3])
    """
    image = as_compressed(volume, rate, scalars, component, mask_nan=mask_nan)
    table = None
    if cmap is not None or (color is None and not isinstance(isovalue, Real)):
        if color is not None:
            raise ValueError("give either color or cmap, not both")
        table = _lookup_table(plotter, cmap, _checked_clim(clim, image), log_scale)
    prop = make_isosurface(
        image,
        isovalue,
        color=_colors(plotter, color) if table is None else _color_function(table),
        rate=rate,
        speculation=speculation,
        memory_budget=memory_budget,
        shade=plotter.theme.lighting if lighting is None else lighting,
        ambient=ambient,
        diffuse=diffuse,
        specular=specular,
        specular_power=specular_power,
        opacity=opacity,
    )
    _warn_of_nothing(prop, image)
    if user_matrix is not None:
        prop.SetUserMatrix(pyvista.vtkmatrix_from_array(_matrix(user_matrix)))
    complete_captures(plotter)
    plotter.add_actor(prop, reset_camera=reset_camera, name=name, pickable=pickable, render=render)
    shown = plotter.theme.show_scalar_bar if show_scalar_bar is None else show_scalar_bar
    if table is not None and shown:
        _add_scalar_bar(plotter, table, describe(image)["array"], scalar_bar_args)
    return prop


def _warn_of_nothing(prop, image):
    """Say so where no isovalue lies among the volume's values: the picture stays empty."""
    low, high = describe(image)["range"]
    isovalues = prop.GetProperty().GetIsoSurfaceValues()
    given = [isovalues.GetValue(i) for i in range(isovalues.GetNumberOfContours())]
    if not any(low <= value <= high for value in given):
        text = ", ".join(f"{value:g}" for value in given)
        warnings.warn(
            f"isovalue {text} is outside the volume's values, {low:g} to {high:g}: nothing shows",
            stacklevel=4,
        )


def add_isosurface_slider(plotter, volume, rng=None, value=None, **kwargs):
    """Add an isosurface with a slider; see :meth:`IsosurfaceComponent.add_isosurface_slider`."""
    image = as_compressed(
        volume,
        kwargs.pop("rate", 8.0),
        kwargs.pop("scalars", None),
        kwargs.pop("component", 0),
        mask_nan=kwargs.pop("mask_nan", False),
    )
    about = describe(image)
    low, high = about["range"] if rng is None else rng
    slider = {
        theirs: kwargs.pop(ours) for ours, theirs in _SLIDER_ARGUMENTS.items() if ours in kwargs
    }
    slider = {"title": about["array"], "interaction_event": "always", **slider}
    start = (low + high) / 2 if value is None else value
    prop = add_isosurface(plotter, image, start, **kwargs)
    isovalues = prop.GetProperty().GetIsoSurfaceValues()

    def move(isovalue):
        isovalues.SetValue(0, isovalue)

    plotter.add_slider_widget(move, (low, high), value=start, **slider)
    return prop


def clip(prop, normal="x", origin=None, invert=True):
    """Clip a prop by one plane; see :meth:`IsosurfaceComponent.clip`."""
    if isinstance(normal, str):
        if normal.lstrip("+-") not in ("x", "y", "z"):
            raise ValueError(f"normal must be x, y, z, -x, -y, -z or a vector, got {normal!r}")
        axis = np.eye(3)["xyz".index(normal[-1])]
        normal = -axis if normal[0] == "-" else axis
    plane = vtkPlane()
    plane.SetOrigin(prop.GetCenter() if origin is None else origin)
    plane.SetNormal(np.negative(normal) if invert else normal)  # which points to what stays
    planes = vtkPlaneCollection()
    planes.AddItem(plane)
    prop.GetMapper().SetClippingPlanes(planes)


# ---- colours


def _colors(plotter, color):
    """Red, green and blue of every colour given, or of the theme's."""
    default = plotter.theme.color
    given = [color] if color is None or isinstance(color, dict) else as_list(color, is_color)
    return [pyvista.Color(each, default_color=default).float_rgb for each in given]


def _checked_clim(clim, image):
    """Least and greatest isovalue of a map of colours."""
    if clim is None:
        return tuple(describe(image)["range"])
    low, high = (-clim, clim) if isinstance(clim, Real) else clim
    if not low < high:
        raise ValueError(f"clim must be the least and the greatest isovalue, got {clim!r}")
    return low, high


def _lookup_table(plotter, cmap, clim, log_scale):
    if isinstance(cmap, pyvista.LookupTable):
        return cmap
    if log_scale and clim[0] <= 0:
        raise ValueError(f"log_scale needs values above 0: give a clim, instead of {clim}")
    theme = plotter.theme
    cmap = theme.cmap if cmap is None else cmap
    return pyvista.LookupTable(cmap, n_values=256, scalar_range=clim, log_scale=bool(log_scale))


def _color_function(table):
    """A transfer function with a lookup table's colours, also when its range changes."""
    function = vtkColorTransferFunction()

    def fill(table, _event):
        if table.log_scale:
            function.SetScaleToLog10()
        function.RemoveAllPoints()
        spread = np.geomspace if table.log_scale else np.linspace
        for value in spread(*table.scalar_range, table.n_values):
            function.AddRGBPoint(value, *table.map_value(value, opacity=False))

    fill(table, None)
    table.AddObserver("ModifiedEvent", fill)  # the scalar bar is shared, and widened, by title
    return function


def _add_scalar_bar(plotter, table, title, arguments):
    mapper = pyvista.DataSetMapper()
    mapper.lookup_table = table
    mapper.scalar_range = table.scalar_range
    plotter.add_scalar_bar(**{"title": title or "", "mapper": mapper, **(arguments or {})})


# ---- what else is passed


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
