"""Colours and opacities of isosurfaces, as the transfer functions that VTK's mappers look up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from ._typing import RGB
from .vtkProgIsoKernels import vtkIsosurfaceVolume

#: Most isovalues that a prop can show.
MAX_ISOVALUES = 256


def as_list(given: Any, is_one: Callable[[Any], bool]) -> list[Any]:
    """Make a list of one thing or of several.

    Parameters
    ----------
    given : object
        One thing, or a sequence of such.
    is_one : callable
        Tells one thing from a sequence.

    Examples
    --------
    >>> as_list(3.0, lambda given: isinstance(given, float))
    [3.0]
    """
    try:
        return [given] if is_one(given) else list(given)
    except TypeError:
        return [given]  # whoever checks it says what is wrong with it


def is_color(given: Any) -> bool:
    """Tell a colour from a sequence of colours."""
    return isinstance(given, str) or any(isinstance(part, Real) for part in given)


def check_count(name: str, given: Sequence[object], isovalues: Sequence[object]) -> None:
    """Check that there is one of something, or one for each isovalue.

    Raises
    ------
    ValueError
        When there are more or fewer; the message has the name.
    """
    if len(given) not in (1, len(isovalues)):
        wanted = "1" if len(isovalues) == 1 else f"1 or {len(isovalues)}"
        raise ValueError(f"{name}: {len(given)} for {len(isovalues)} isovalues; give {wanted}")


def set_colors(prop: vtkIsosurfaceVolume, colors: Sequence[RGB]) -> None:
    """Give a prop's i-th isovalue the i-th colour, also when it is changed later.

    Parameters
    ----------
    prop : vtkIsosurfaceVolume
        Its property gets a new transfer function.
    colors : list of (float, float, float)
        One for all isovalues, or one for each.
    """
    function = vtkColorTransferFunction()
    prop.GetProperty().SetColor(function)
    _follow_isovalues(prop, function, function.AddRGBPoint, colors)


def set_opacities(prop: vtkIsosurfaceVolume, opacities: Sequence[float]) -> None:
    """Give a prop's i-th isovalue the i-th opacity, also when it is changed later.

    Parameters
    ----------
    prop : vtkIsosurfaceVolume
        Its property gets a new transfer function.
    opacities : list of float
        One for all isovalues, or one for each.
    """
    function = vtkPiecewiseFunction()
    prop.GetProperty().SetScalarOpacity(function)
    _follow_isovalues(prop, function, function.AddPoint, [(opacity,) for opacity in opacities])


def _follow_isovalues(
    prop: vtkIsosurfaceVolume,
    function: vtkColorTransferFunction | vtkPiecewiseFunction,
    add: Callable[..., object],
    entries: Sequence[tuple[float, ...]],
) -> None:
    """Keep a transfer function's points at the isovalues."""
    places: list[float] = []

    # Runs before every render, since vtkContourValues reports a change before it makes it. The
    # prop owns this observer: a reference to the prop in it would keep both alive.
    def follow(prop: vtkIsosurfaceVolume, _event: object) -> None:
        isovalues = prop.GetProperty().GetIsoSurfaceValues()
        now = [isovalues.GetValue(i) for i in range(isovalues.GetNumberOfContours())]
        if now != places:
            places[:] = now
            function.RemoveAllPoints()
            for i, value in enumerate(now):
                add(value, *entries[i % len(entries)])

    follow(prop, None)
    if len(entries) > 1:
        prop.AddObserver("StartEvent", follow)
