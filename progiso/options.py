"""Options that travel together, so that a new one is a field here and not a parameter everywhere.

`compress` documents the fields of `CompressionOptions`, `make_isosurface` those of `SurfaceStyle`
and `RenderOptions`. Functions that only pass options on take them as ``**options``; the classes
that end in ``Keywords`` tell editors and type checkers their names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from operator import index
from typing import Any, TypedDict, TypeVar

from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from ._numbers import finite, is_number
from ._typing import RGB, Progress, Rate

_Options = TypeVar("_Options")


@dataclass(frozen=True, kw_only=True)
class CompressionOptions:
    """What of a plain image is compressed, and how; see `progiso.compress`."""

    rate: Rate = None
    tolerance: float | None = None
    array: str | None = None
    component: int = 0
    axes: str | None = None
    mask_nan: bool = True
    levels: int = 0
    threads: int = 0
    progress: Progress | None = None


#: Most levels of detail that a volume may have.
MAX_LEVELS = 11

#: Whether coarser copies draw far parts of a surface; the order is that of the mapper's values.
LEVELS_OF_DETAIL = ("off", "on", "interactive", "conservative")

#: Bits per sample of what is not labels, where nothing else is asked for.
DEFAULT_RATE = 8.0


@dataclass(frozen=True)
class RateChoice:
    """How the rate of a compressed volume is found.

    Attributes
    ----------
    rate : float
        Bits per sample, in (0, 32].
    keep_labels : bool
        Whether labels and masks get the least rate from there on that leaves every sample on its
        side of every half-integer.
    tolerance : float
        Where it is above 0, the least rate that keeps every sample within it is taken instead.
    """

    rate: float = DEFAULT_RATE
    keep_labels: bool = False
    tolerance: float = 0.0


def rate_choice(rate: Rate = None, tolerance: float | None = None) -> RateChoice:
    """Check a rate and a tolerance as `progiso.compress` takes them.

    Raises
    ------
    TypeError
        When the rate is no number.
    ValueError
        When one is out of range, or both are given.

    Examples
    --------
    >>> rate_choice(4), rate_choice().keep_labels
    (RateChoice(rate=4.0, keep_labels=False, tolerance=0.0), True)
    """
    if tolerance is not None:
        if rate is not None and not _is_auto(rate):
            raise ValueError(f"give either a rate or a tolerance, not {rate!r} and {tolerance!r}")
        return RateChoice(tolerance=checked_tolerance(tolerance))
    if rate is None:
        return RateChoice(keep_labels=True)
    if _is_auto(rate):
        raise ValueError('rate="auto" takes a tolerance, the largest error of a sample')
    if not is_number(rate):
        raise TypeError(f'rate must be a number in (0, 32], "auto" or None, got {rate!r}')
    bits = float(rate)
    if not 0 < bits <= 32:
        raise ValueError(f"rate must be in (0, 32] bits per sample, got {bits:g}")
    return RateChoice(bits)


def checked_levels(levels: int, name: str = "levels") -> int:
    """Return a number of levels of detail, or that of one, which is from 0 to 11.

    Raises
    ------
    TypeError
        When it is no whole number.
    ValueError
        When it is out of range.

    Examples
    --------
    >>> checked_levels(3)
    3
    """
    try:
        number = index(levels)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, got {levels!r:.60}") from None
    if not 0 <= number <= MAX_LEVELS:
        raise ValueError(f"{name} must be from 0 to {MAX_LEVELS}, got {number}")
    return number


def checked_level_of_detail(level_of_detail: str) -> int:
    """Return the mapper's number of a level of detail.

    Raises
    ------
    ValueError
        When it is not one of `LEVELS_OF_DETAIL`.

    Examples
    --------
    >>> checked_level_of_detail("off")
    0
    """
    if level_of_detail not in LEVELS_OF_DETAIL:
        raise ValueError(
            "level_of_detail must be 'off', 'on', 'interactive' or 'conservative', got "
            f"{level_of_detail!r:.60}"
        )
    return LEVELS_OF_DETAIL.index(level_of_detail)


def levels_to_make(level_of_detail: str = "off") -> int:
    """Return how many levels a plain image gets where nobody says: all, if they may be drawn.

    Raises
    ------
    ValueError
        When there is no such level of detail.

    Examples
    --------
    >>> levels_to_make(), levels_to_make("on")
    (0, 11)
    """
    return MAX_LEVELS if checked_level_of_detail(level_of_detail) else 0


def _is_auto(rate: Rate) -> bool:
    return isinstance(rate, str) and rate == "auto"


def checked_tolerance(tolerance: float) -> float:
    """Return a tolerance, or raise `ValueError` unless it is a number above 0."""
    try:
        value = finite("tolerance", tolerance)
    except (TypeError, ValueError):
        value = 0.0
    if not value > 0:
        raise ValueError(f"tolerance must be a number above 0, got {tolerance!r}")
    return value


@dataclass(frozen=True, kw_only=True)
class SurfaceStyle:
    """How isosurfaces look; see `progiso.make_isosurface`."""

    color: RGB | Sequence[RGB] | vtkColorTransferFunction = (1.0, 1.0, 1.0)
    opacity: float | Sequence[float] = 1.0
    shade: bool = True
    ambient: float = 0.05
    diffuse: float = 0.8
    specular: float = 0.15
    specular_power: float = 20.0


@dataclass(frozen=True, kw_only=True)
class RenderOptions:
    """How the mapper works on an image; see `progiso.make_isosurface`."""

    speculation: bool | int = True
    memory_budget: int = 0
    level_of_detail: str = "off"
    pixel_tolerance: float = 1.0
    detailed: bool = False


class EncodingKeywords(TypedDict, total=False):
    """Keywords of `CompressionOptions` but for the array."""

    rate: Rate
    tolerance: float | None
    component: int
    axes: str | None
    mask_nan: bool
    levels: int
    threads: int
    progress: Progress | None


class CompressionKeywords(EncodingKeywords, total=False):
    """Keywords of `CompressionOptions`."""

    array: str | None


class MaterialKeywords(TypedDict, total=False):
    """Keywords of `SurfaceStyle` that describe the material."""

    ambient: float
    diffuse: float
    specular: float
    specular_power: float


class RenderKeywords(TypedDict, total=False):
    """Keywords of `RenderOptions`."""

    speculation: bool | int
    memory_budget: int
    level_of_detail: str
    pixel_tolerance: float
    detailed: bool


class PlotterKeywords(EncodingKeywords, MaterialKeywords, RenderKeywords, total=False):
    """What `progiso.add_isosurface` passes on."""


def take(kind: type[_Options], keywords: dict[str, Any], **fixed: Any) -> _Options:
    """Make options of the keywords that are theirs, and remove these.

    Parameters
    ----------
    kind : type
        One of the classes of options.
    keywords : dict
        Of several kinds of options; what `kind` has no field for stays.
    **fixed
        Fields that are not looked for among the keywords.

    Examples
    --------
    >>> keywords = {"rate": 4, "ambient": 1}
    >>> take(CompressionOptions, keywords).rate, keywords
    (4, {'ambient': 1})
    """
    names = {field.name for field in fields(kind)} - fixed.keys()  # type: ignore[arg-type]
    found = {name: keywords.pop(name) for name in names & keywords.keys()}
    return kind(**found, **fixed)
