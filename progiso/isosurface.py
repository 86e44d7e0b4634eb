"""A volume prop with the progressive mapper, set up in one call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkVolumeProperty

from ._numbers import finite_list, is_number
from ._typing import RGB, ImageLike, Isovalues
from ._vtk import messages_of
from ._warnings import warn_user
from .appearance import MAX_ISOVALUES, as_list, check_count, is_color, set_colors, set_opacities
from .compression import doubts, is_compressed
from .io.arrays import as_image
from .options import RenderOptions, SurfaceStyle, checked_level_of_detail
from .vtkProgIsoKernels import vtkIsosurfaceVolume, vtkProgressiveIsosurfaceMapper

#: Most blocks that a ray tests ahead in one pass.
MAX_SPECULATION = 64

#: How many pixels the samples of a level of detail may be apart, at least and at most.
PIXEL_TOLERANCES = (1 / 16, 64)


def make_isosurface(
    image: ImageLike,
    isovalue: Isovalues,
    *,
    color: RGB | Sequence[RGB] | vtkColorTransferFunction = (1.0, 1.0, 1.0),
    opacity: float | Sequence[float] = 1.0,
    shade: bool = True,
    ambient: float = 0.05,
    diffuse: float = 0.8,
    specular: float = 0.15,
    specular_power: float = 20.0,
    speculation: bool | int = True,
    memory_budget: int = 0,
    level_of_detail: str = "off",
    pixel_tolerance: float = 1.0,
    detailed: bool = False,
    rate: float | None = None,
    mask_nan: bool = True,
) -> vtkIsosurfaceVolume:
    """Make a prop that shows isosurfaces of a plain or compressed volume.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain (then compressed by the mapper at `rate`), or a compressed volume. Arrays as in
        `compress`.
    isovalue : float or sequence of float
        In the units of the image's values; at most 256.
    color : sequence of 3 float, a sequence of such, or vtkColorTransferFunction, default: white
        Red, green and blue from 0 to 1: one colour for all isovalues, or one for each, which it
        keeps when it is changed. A transfer function gives the colours at the isovalues.
    opacity : float or sequence of float, default: 1
        One for all isovalues, or one for each: 0 hides a surface; below 1, what lies behind it
        shines through.
    shade : bool, default: True
        Whether lights shade the surface; otherwise it has the plain colour.
    ambient, diffuse, specular, specular_power : float
        Material, as in `vtkVolumeProperty`: the first three from 0 to 1, the last to 128.
    speculation : bool or int, default: True
        Whether rays test several blocks ahead in one pass, or how many at most (1 to 64).
    memory_budget : int, default: 0
        Bound in bytes on the GPU memory beside the compressed volume; 0 for the mapper's own
        choice.
    level_of_detail : str, default: "off"
        "on" draws each part of the surface from the coarsest copy of the volume whose samples are
        at most `pixel_tolerance` pixels apart there, so that time and memory follow the pixels
        (``levels`` of `statistics` tells how many come from which, ``uncertain`` where they may
        hide something); "interactive" does so only while the view moves; "conservative" looks at
        the volume itself where coarser copies show nothing that it may have, so that no ray misses
        what it would hit there, however thin; "off" is exact. A plain image gets such copies when
        it is compressed, a compressed volume has them by ``levels`` of `compress`; one without is
        drawn exactly, with a warning.
    pixel_tolerance : float, default: 1
        Pixels between samples, 1/16 to 64; more of them are faster.
    detailed : bool, default: False
        Whether the statistics include the time of each stage and the distinct blocks of each
        pass, which takes time itself.
    rate : float, optional
        Bits per sample for a plain image, in (0, 32]; by default as in `compress`.
    mask_nan : bool, default: True
        Whether NaN and infinite samples of a plain image are hidden, so that the surface has a hole
        there; otherwise they are an error of the mapper.

    Returns
    -------
    vtkIsosurfaceVolume
        To be added to a renderer. ``GetMapper()`` is the `vtkProgressiveIsosurfaceMapper`.

    Raises
    ------
    TypeError
        When `image` is neither an image nor an array.
    ValueError
        When a number is out of its range.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> from vtkmodules.vtkRenderingCore import vtkRenderer
    >>> image = progiso.read(fetch("sphere", size=32))
    >>> renderer = vtkRenderer()
    >>> renderer.AddVolume(progiso.make_isosurface(image, 0.8, color=(0.9, 0.85, 0.75)))

    A far view, from copies of the volume where these are fine enough for the pixels:

    >>> volume = progiso.compress(progiso.read(fetch("sphere", size=96)), levels=3)
    >>> renderer.AddVolume(progiso.make_isosurface(volume, 0.8, level_of_detail="on"))
    """
    style = SurfaceStyle(
        color=color,
        opacity=opacity,
        shade=shade,
        ambient=ambient,
        diffuse=diffuse,
        specular=specular,
        specular_power=specular_power,
    )
    options = RenderOptions(
        speculation=speculation,
        memory_budget=memory_budget,
        level_of_detail=level_of_detail,
        pixel_tolerance=pixel_tolerance,
        detailed=detailed,
    )
    prop = style_isosurface(image, isovalue, style, options)
    if rate is not None:
        prop.GetMapper().SetRate(_in_range("rate", rate, 0, 32, above=True))
    prop.GetMapper().SetMaskNonFinite(bool(mask_nan))
    return prop


def style_isosurface(
    image: ImageLike, isovalue: Isovalues, style: SurfaceStyle, options: RenderOptions
) -> vtkIsosurfaceVolume:
    """Make a prop as `make_isosurface` does, a plain image at the mapper's own rate."""
    mapper = vtkProgressiveIsosurfaceMapper()
    image = as_image(image)
    mapper.SetInputData(image)
    mapper.SetLitLikeMeshes(True)  # users expect the light that a contour's mesh would get
    mapper.SetSpeculationLimit(_speculation_limit(options.speculation))
    mapper.SetMemoryBudget(int(_in_range("memory_budget", options.memory_budget, 0, 2**62)))
    mapper.SetLevelOfDetail(checked_level_of_detail(options.level_of_detail))
    tolerance = _in_range("pixel_tolerance", options.pixel_tolerance, *PIXEL_TOLERANCES)
    mapper.SetPixelTolerance(tolerance)
    mapper.SetDetailedStatistics(bool(options.detailed))
    prop = vtkIsosurfaceVolume()
    prop.SetMapper(mapper)
    prop.SetProperty(_material(style))
    _set_isovalues(prop, isovalue, style)
    # a compressed volume can be judged now, a plain image is when the mapper compresses it
    doubt = doubts(image, isovalue) if is_compressed(image) else None
    if doubt is not None:
        warn_user(doubt)
    _pass_warnings_on(mapper, {doubt} if doubt is not None else set())
    return prop


def _pass_warnings_on(mapper: vtkProgressiveIsosurfaceMapper, told: set[str]) -> None:
    """Turn the mapper's warnings into Python's, each text once that was not told before."""

    def tell(_mapper: object, _event: str, text: str) -> None:
        for message in set(messages_of(text)) - told:
            told.add(message)
            warn_user(message)

    tell.CallDataType = "string0"  # type: ignore[attr-defined]
    observe: Any = mapper.AddObserver
    observe("WarningEvent", tell)


def _material(style: SurfaceStyle) -> vtkVolumeProperty:
    properties = vtkVolumeProperty()
    properties.SetShade(bool(style.shade))
    properties.SetAmbient(_in_range("ambient", style.ambient, 0, 1))
    properties.SetDiffuse(_in_range("diffuse", style.diffuse, 0, 1))
    properties.SetSpecular(_in_range("specular", style.specular, 0, 1))
    properties.SetSpecularPower(_in_range("specular_power", style.specular_power, 0, 128))
    return properties


def _set_isovalues(prop: vtkIsosurfaceVolume, isovalue: Isovalues, style: SurfaceStyle) -> None:
    """Set isovalues with the colours and opacities that they keep."""
    try:
        given = finite_list("isovalue", isovalue)
    except TypeError as error:
        raise ValueError(str(error)) from None
    if not 1 <= len(given) <= MAX_ISOVALUES:
        raise ValueError(f"isovalue: give 1 to {MAX_ISOVALUES} isovalues, not {len(given)}")
    opacities = _opacities(style.opacity)
    check_count("opacity", opacities, given)
    for i, value in enumerate(given):
        prop.GetProperty().GetIsoSurfaceValues().SetValue(i, value)
    set_opacities(prop, opacities)
    if isinstance(style.color, vtkColorTransferFunction):
        prop.GetProperty().SetColor(style.color)
    else:
        set_colors(prop, _rgb_colors(style.color, given))


def _opacities(opacity: float | Sequence[float]) -> list[float]:
    given = [opacity] if isinstance(opacity, str) else as_list(opacity, is_number)
    return [_in_range("opacity", each, 0, 1) for each in given]


def _rgb_colors(color: RGB | Sequence[RGB], isovalues: Sequence[object]) -> list[RGB]:
    """Return colours as tuples, one or as many as isovalues."""
    colors = [_rgb(each) for each in as_list(color, is_color)]
    check_count("color", colors, isovalues)
    return colors


def _rgb(color: Any) -> RGB:
    wanted = f"color must be red, green and blue from 0 to 1, got {color!r}"
    if isinstance(color, str) or not hasattr(color, "__len__"):
        raise TypeError(wanted)
    if len(color) != 3:
        raise ValueError(wanted)
    red, green, blue = (_in_range("color", part, 0, 1) for part in color)
    return red, green, blue


def _speculation_limit(speculation: bool | int) -> int:
    if isinstance(speculation, bool):
        return MAX_SPECULATION if speculation else 1
    return int(_in_range("speculation", speculation, 1, MAX_SPECULATION))


def _in_range(name: str, value: Any, low: float, high: float, *, above: bool = False) -> Any:
    """Return a number if low ≤ value ≤ high, or low < value when `above`; otherwise raise."""
    if not is_number(value):
        raise TypeError(f"{name} must be a number, got {value!r}")
    value = float(value)
    if not (low < value if above else low <= value) or not value <= high:
        bounds = f"{'(' if above else '['}{low}, {high}]"
        raise ValueError(f"{name} must be in {bounds}, got {value:g}")
    return value
