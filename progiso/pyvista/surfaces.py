"""Isosurfaces in a pyvista plotter, with pyvista's own colours, scalar bars and sliders."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPlane, vtkPlaneCollection
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from .._numbers import finite_list, is_number
from .._typing import RGB, ImageLike, Isovalues, Vector
from ..appearance import as_list, is_color
from ..compression import describe
from ..io.compressing import as_compressed
from ..isosurface import style_isosurface
from ..options import (
    CompressionOptions,
    PlotterKeywords,
    RenderOptions,
    SurfaceStyle,
    levels_to_make,
    take,
)
from ..vtkProgIsoKernels import vtkIsosurfaceVolume
from .capture import complete_captures

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: Keywords of `add_isosurface_slider` for the slider, and their names in pyvista.
_SLIDER_ARGUMENTS = {
    "title": "title",
    "pointa": "pointa",
    "pointb": "pointb",
    "widget_color": "color",
    "style": "style",
    "fmt": "fmt",
    "interaction_event": "interaction_event",
}


class ActorKeywords(PlotterKeywords, total=False):
    """Keywords of `add_isosurface`, for the methods that pass them on."""

    scalars: Any
    color: Any
    cmap: Any
    clim: float | tuple[float, float] | None
    log_scale: bool
    opacity: float | Sequence[float]
    show_scalar_bar: bool | None
    scalar_bar_args: dict[str, Any] | None
    lighting: bool | None
    name: str | None
    reset_camera: bool | None
    pickable: bool
    render: bool
    user_matrix: Any


def add_isosurface(
    plotter: pyvista.BasePlotter,
    volume: ImageLike,
    isovalue: Isovalues,
    *,
    scalars: Any = None,
    color: Any = None,
    cmap: Any = None,
    clim: float | tuple[float, float] | None = None,
    log_scale: bool = False,
    opacity: float | Sequence[float] = 1.0,
    show_scalar_bar: bool | None = None,
    scalar_bar_args: dict[str, Any] | None = None,
    lighting: bool | None = None,
    name: str | None = None,
    reset_camera: bool | None = None,
    pickable: bool = True,
    render: bool = True,
    user_matrix: Any = None,
    **options: Unpack[PlotterKeywords],
) -> vtkIsosurfaceVolume:
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
        In the units of the volume's values; at most 256. A whole number is an isovalue too, not a
        count: for that give ``numpy.linspace(low, high, count)``.
    scalars : str or array, optional
        Point or cell array of a plain image, by its name or itself; by default the active scalars.
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
    lighting : bool, optional
        Whether lights shade the surface; by default the theme's choice.
    name : str, optional
        An actor of this name is replaced.
    reset_camera : bool, optional
        Whether the camera is reset to see everything; by default when it was not set yet.
    pickable : bool, default: True
        Whether pyvista's hardware picker finds the prop. ``plotter.progiso.surface_at`` finds
        points on it.
    render : bool, default: True
        Whether to render at once if the plotter is showing.
    user_matrix : TransformLike, optional
        Transformation of the prop, applied last.
    **options
        ``ambient``, ``diffuse``, ``specular``, ``specular_power``, ``speculation``,
        ``memory_budget``, ``level_of_detail``, ``pixel_tolerance`` and ``detailed`` as in
        :func:`progiso.make_isosurface`; for plain data ``rate``, ``tolerance``, ``component``,
        ``mask_nan``, ``levels``, ``threads`` and ``progress`` as in :func:`progiso.compress`, but
        with all levels of detail, unless ``level_of_detail`` is ``"off"``.

    Returns
    -------
    vtkIsosurfaceVolume
        The prop. Change the i-th isovalue by
        ``prop.GetProperty().GetIsoSurfaceValues().SetValue(i, value)``.

    Raises
    ------
    TypeError
        When `volume` is neither an image nor an array, or there is no such option.
    ValueError
        When a number is out of its range, there is no such array, or the number of colours or
        opacities is neither one nor that of the isovalues.
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

    Coarser where that is fine enough for the pixels, while the view moves:

    >>> prop = progiso.add_isosurface(plotter, image, 20, level_of_detail="interactive")
    """
    keywords = dict(options)
    rendering = take(RenderOptions, keywords)
    keywords.setdefault("levels", levels_to_make(rendering.level_of_detail))
    image = as_compressed(volume, take(CompressionOptions, keywords, array=scalars))
    table = None
    if cmap is not None or (color is None and not is_number(isovalue)):
        if color is not None:
            raise ValueError("give either color or cmap, not both")
        table = _lookup_table(plotter, cmap, _checked_clim(clim, image), log_scale)
    style = take(
        SurfaceStyle,
        keywords,
        color=_colors(plotter, color) if table is None else _color_function(table),
        opacity=opacity,
        shade=plotter.theme.lighting if lighting is None else lighting,
    )
    if keywords:
        raise TypeError(f"add_isosurface() has no parameter {next(iter(keywords))!r}")
    prop = style_isosurface(image, isovalue, style, rendering)
    _warn_of_nothing(prop, image)
    if user_matrix is not None:
        prop.SetUserMatrix(pyvista.vtkmatrix_from_array(_matrix(user_matrix)))
    complete_captures(plotter)
    plotter.add_actor(prop, reset_camera=reset_camera, name=name, pickable=pickable, render=render)
    shown = plotter.theme.show_scalar_bar if show_scalar_bar is None else show_scalar_bar
    if table is not None and shown:
        _add_scalar_bar(plotter, table, describe(image)["array"], scalar_bar_args)
    return prop


def _warn_of_nothing(prop: vtkIsosurfaceVolume, image: vtkImageData) -> None:
    """Warn where all isovalues are outside the volume's values: the picture stays empty."""
    low, high = describe(image)["range"]
    isovalues = prop.GetProperty().GetIsoSurfaceValues()
    given = [isovalues.GetValue(i) for i in range(isovalues.GetNumberOfContours())]
    if not any(low <= value <= high for value in given):
        text = ", ".join(f"{value:g}" for value in given)
        warnings.warn(
            f"isovalue {text} is outside the volume's values, {low:g} to {high:g}: nothing shows",
            stacklevel=4,
        )


def add_isosurface_slider(
    plotter: pyvista.BasePlotter,
    volume: ImageLike,
    rng: tuple[float, float] | None = None,
    value: float | None = None,
    **options: Any,
) -> vtkIsosurfaceVolume:
    """Add an isosurface with a slider; see :meth:`IsosurfaceComponent.add_isosurface_slider`."""
    options.setdefault("levels", levels_to_make(options.get("level_of_detail", "off")))
    compression = take(CompressionOptions, options, array=options.pop("scalars", None))
    image = as_compressed(volume, compression)
    about = describe(image)
    low, high = about["range"] if rng is None else _ends("rng", rng)
    slider = {
        theirs: options.pop(ours) for ours, theirs in _SLIDER_ARGUMENTS.items() if ours in options
    }
    slider = {"title": about["array"], "interaction_event": "always", **slider}
    start = (low + high) / 2 if value is None else value
    prop = add_isosurface(plotter, image, start, **options)
    isovalues = prop.GetProperty().GetIsoSurfaceValues()

    def move(isovalue: float) -> None:
        isovalues.SetValue(0, isovalue)

    add_slider: Any = plotter.add_slider_widget  # its decorator hides the signature
    add_slider(move, (low, high), value=start, **slider)
    return prop


def clip(
    prop: vtkIsosurfaceVolume,
    normal: str | Vector = "x",
    origin: Vector | None = None,
    *,
    invert: bool = True,
) -> None:
    """Clip a prop by one plane; see :meth:`IsosurfaceComponent.clip`."""
    direction = _axis(normal) if isinstance(normal, str) else _vector("normal", normal)
    if not direction.any():
        raise ValueError("normal must not be zero, got (0, 0, 0)")
    plane = vtkPlane()
    plane.SetOrigin(*(prop.GetCenter() if origin is None else _vector("origin", origin)))
    plane.SetNormal(*(-direction if invert else direction))  # towards the side that stays
    planes = vtkPlaneCollection()
    planes.AddItem(plane)
    prop.GetMapper().SetClippingPlanes(planes)


def _vector(name: str, given: Any) -> npt.NDArray[np.float64]:
    """Return three finite coordinates, or raise."""
    wanted = f"{name} must be three finite numbers, got {given!r}"
    try:
        vector = np.array(finite_list(name, given))
    except (TypeError, ValueError) as error:
        raise type(error)(wanted) from None
    if vector.shape != (3,):
        raise ValueError(wanted)
    return vector


def _axis(name: str) -> npt.NDArray[np.float64]:
    """Return the unit vector of x, -x, y and so on."""
    if name[-1:] not in tuple("xyz") or name[:-1] not in ("", "+", "-"):
        raise ValueError(f"normal must be x, y, z, -x, -y, -z or a vector, got {name!r}")
    axis = np.eye(3)["xyz".index(name[-1])]
    return -axis if name[0] == "-" else axis


# ---- colours


def _colors(plotter: pyvista.BasePlotter, color: Any) -> list[RGB]:
    """Return red, green and blue of every colour given, or of the theme's."""
    default = plotter.theme.color
    given = [color] if color is None or isinstance(color, dict) else as_list(color, is_color)
    return [pyvista.Color(each, default_color=default).float_rgb for each in given]


def _checked_clim(clim: Any, image: vtkImageData) -> tuple[float, float]:
    """Return the least and the greatest isovalue of a map of colours."""
    if clim is None:
        low, high = describe(image)["range"]
        return low, high
    return _ends("clim", (-clim, clim) if is_number(clim) else clim)


def _ends(name: str, given: Any) -> tuple[float, float]:
    """Return two isovalues, the lesser first, or raise."""
    wanted = f"{name} must be the least and the greatest isovalue, got {given!r}"
    if isinstance(given, (str, bytes)):
        raise TypeError(wanted)
    try:
        ends = finite_list(name, given)
    except (TypeError, ValueError) as error:
        raise type(error)(wanted) from None
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise ValueError(wanted)
    return ends[0], ends[1]


def _lookup_table(
    plotter: pyvista.BasePlotter, cmap: Any, clim: tuple[float, float], log_scale: bool
) -> pyvista.LookupTable:
    if isinstance(cmap, pyvista.LookupTable):
        return cmap
    if log_scale and clim[0] <= 0:
        raise ValueError(f"log_scale needs values above 0: give a clim, instead of {clim}")
    theme = plotter.theme
    cmap = theme.cmap if cmap is None else cmap
    return pyvista.LookupTable(cmap, n_values=256, scalar_range=clim, log_scale=bool(log_scale))


def _color_function(table: pyvista.LookupTable) -> vtkColorTransferFunction:
    """Make a transfer function with a lookup table's colours, also when its range changes."""
    function = vtkColorTransferFunction()

    def fill(table: pyvista.LookupTable, _event: object) -> None:
        if table.log_scale:
            function.SetScaleToLog10()
        function.RemoveAllPoints()
        spread = np.geomspace if table.log_scale else np.linspace
        low, high = table.scalar_range
        for value in spread(low, high, table.n_values):
            function.AddRGBPoint(value, *table.map_value(value, opacity=False))

    fill(table, None)
    table.AddObserver("ModifiedEvent", fill)  # scalar bars of one title are shared, and widened
    return function


def _add_scalar_bar(
    plotter: pyvista.BasePlotter,
    table: pyvista.LookupTable,
    title: str,
    arguments: dict[str, Any] | None,
) -> None:
    mapper = pyvista.DataSetMapper()
    mapper.lookup_table = table
    mapper.scalar_range = table.scalar_range
    plotter.add_scalar_bar(**{"title": title or "", "mapper": mapper, **(arguments or {})})


def _matrix(transform: Any) -> npt.NDArray[np.float64]:
    """Make a 4x4 array of a pyvista or VTK transform, matrix, or array."""
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
