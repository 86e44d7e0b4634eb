"""A volume prop with the progressive mapper, set up in one call."""

from __future__ import annotations

import math
from numbers import Real

from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkVolumeProperty

from ._vtk import image_data
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
):
    """Make a prop that shows an isosurface of a plain or compressed volume.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Plain (then compressed by the mapper at `rate`), or a compressed volume.
    isovalue : float
        In the units of the image's values.
    color : sequence of 3 float, default: white
        Red, green and blue from 0 to 1.
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
    mapper.SetSpeculationLimit(_speculation_limit(speculation))
    mapper.SetMemoryBudget(int(_in_range("memory_budget", memory_budget, 0, 2**62)))
    properties = vtkVolumeProperty()
    properties.GetIsoSurfaceValues().SetValue(0, _finite("isovalue", isovalue))
    properties.SetColor(_constant_color(color))
    properties.SetShade(bool(shade))
    properties.SetAmbient(_in_range("ambient", ambient, 0, 1))
    properties.SetDiffuse(_in_range("diffuse", diffuse, 0, 1))
    properties.SetSpecular(_in_range("specular", specular, 0, 1))
    properties.SetSpecularPower(_in_range("specular_power", specular_power, 0, 128))
    volume = vtkIsosurfaceVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(properties)
    return volume


def _constant_color(color):
    """A transfer function of one colour, so that moving the isovalue keeps it."""
    function = vtkColorTransferFunction()
    function.AddRGBPoint(0.0, *(_in_range("color", c, 0, 1) for c in color))
    return function


def _speculation_limit(speculation):
    if isinstance(speculation, bool):
        return MAX_SPECULATION if speculation else 1
    return int(_in_range("speculation", speculation, 1, MAX_SPECULATION))


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
