"""A volume prop with the progressive mapper, set up in one call."""

from __future__ import annotations

import math
from numbers import Real

from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkVolumeProperty

from ._vtk import image_data
from .appearance import MAX_ISOVALUES, as_list, check_count, is_color, set_colors, set_opacities
from .vtkProgIsoKernels import vtkIsosurfaceVolume, vtkProgressiveIsosurfaceMapper

#: Most blocks that a ray tests ahead in one pass.
MAX_SPECULATION = 64


def make_isosurface(
    image,
    isovalue,
    color=(1.0, 1.0, 1.0),
    rate=8.0,
    speculation=True,
    memory_budget=0,
    shade=True,
    ambient=0.05,
    diffuse=0.8,
    specular=0.15,
    specular_power=20.0,
    opacity=1.0,
    mask_nan=False,
):
    """Make a prop that shows isosurfaces of a plain or compressed volume.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Plain (then compressed by the mapper at `rate`), or a compressed volume.
    isovalue : float or sequence of float
        In the units of the image's values; at most 16.
    color : sequence of 3 float, a sequence of such, or vtkColorTransferFunction, default: white
        Red, green and blue from 0 to 1: one colour for all isovalues, or one for each, which it
        keeps when it is changed. A transfer function gives the colours at the isovalues.
    rate : float, default: 8
        Bits per sample for a plain image, in (0, 32].
    speculation : bool or int, default: True
        Whether rays test several blocks ahead in one pass, or how many at most (1 to 64).
    memory_budget : int, default: 0
        Bound in bytes on the GPU memory beside the compressed volume; 0 for the mapper's own
        choice.
    shade : bool, default: True
        Whether light falls on the surface; without, it has the plain colour.
    ambient, diffuse, specular, specular_power : float
        Material, as in `vtkVolumeProperty`: the first three from 0 to 1.
    opacity : float or sequence of float, default: 1
        One for all isovalues, or one for each: 0 hides a surface, below 1 what lies behind it
        shines through.
    mask_nan : bool, default: False
        Whether NaN and infinite samples of a plain image are hidden, so that the surface has a hole
        there; else they are an error of the mapper.

    Returns
    -------
    vtkIsosurfaceVolume
        To be added to a renderer. ``GetMapper()`` is the `vtkProgressiveIsosurfaceMapper`.

    Raises
    ------
    TypeError
        When `image` is no image.
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
    """
    mapper = vtkProgressiveIsosurfaceMapper()
    mapper.SetInputData(image_data(image))
    mapper.SetRate(_in_range("rate", rate, 0, 32, above=True))
    mapper.SetMaskNonFinite(bool(mask_nan))
    mapper.SetLitLikeMeshes(True)  # it takes the place of a contour's mesh
    mapper.SetSpeculationLimit(_speculation_limit(speculation))
    mapper.SetMemoryBudget(int(_in_range("memory_budget", memory_budget, 0, 2**62)))
    properties = vtkVolumeProperty()
    properties.SetShade(bool(shade))
    properties.SetAmbient(_in_range("ambient", ambient, 0, 1))
    properties.SetDiffuse(_in_range("diffuse", diffuse, 0, 1))
    properties.SetSpecular(_in_range("specular", specular, 0, 1))
    properties.SetSpecularPower(_in_range("specular_power", specular_power, 0, 128))
    volume = vtkIsosurfaceVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(properties)
    _set_isovalues(volume, isovalue, color, opacity)
    return volume


def _set_isovalues(volume, isovalue, color, opacity):
    """Isovalues with the colours and opacities that they keep."""
    given = [isovalue] if isinstance(isovalue, str) else as_list(isovalue, _is_number)
    if not 1 <= len(given) <= MAX_ISOVALUES:
        raise ValueError(f"isovalue: give 1 to {MAX_ISOVALUES} isovalues, not {len(given)}")
    opacities = _opacities(opacity)
    check_count("opacity", opacities, given)
    for i, value in enumerate(given):
        volume.GetProperty().GetIsoSurfaceValues().SetValue(i, _finite("isovalue", value))
    set_opacities(volume, opacities)
    if isinstance(color, vtkColorTransferFunction):
        volume.GetProperty().SetColor(color)
    else:
        set_colors(volume, _rgb_colors(color, given))


def _opacities(opacity):
    given = [opacity] if isinstance(opacity, str) else as_list(opacity, _is_number)
    return [_in_range("opacity", each, 0, 1) for each in given]


def _rgb_colors(color, isovalues):
    """Colours as tuples, one or as many as isovalues."""
    colors = [_rgb(each) for each in as_list(color, is_color)]
    check_count("color", colors, isovalues)
    return colors


def _rgb(color):
    wanted = f"color must be red, green and blue from 0 to 1, got {color!r}"
    if isinstance(color, str) or not hasattr(color, "__len__"):
        raise TypeError(wanted)
    if len(color) != 3:
        raise ValueError(wanted)
    return tuple(_in_range("color", part, 0, 1) for part in color)


def _speculation_limit(speculation):
    if isinstance(speculation, bool):
        return MAX_SPECULATION if speculation else 1
    return int(_in_range("speculation", speculation, 1, MAX_SPECULATION))


def _is_number(value):
    return isinstance(value, Real)


def _finite(name, value):
    if not isinstance(value, Real) or not math.isfinite(value):
        raise ValueError(f"{name} must be a finite number, got {value!r}")
    return float(value)


def _in_range(name, value, low, high, above=False):
    """Check low ≤ value ≤ high, or low < value when `above`."""
    if not isinstance(value, Real):
        raise TypeError(f"{name} must be a number, got {value!r}")
    if not (low < value if above else low <= value) or not value <= high:
        bounds = f"{'(' if above else '['}{low}, {high}]"
        raise ValueError(f"{name} must be in {bounds}, got {value}")
    return value
