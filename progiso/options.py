"""Options that travel together, so that a new one is a field here and not a parameter everywhere.

`compress` documents the fields of `CompressionOptions`, `make_isosurface` those of `SurfaceStyle`
and `RenderOptions`. Functions that only pass options on take them as ``**options``; the classes
that end in ``Keywords`` tell editors and type checkers their names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, TypedDict, TypeVar

from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from ._typing import RGB, Progress

_Options = TypeVar("_Options")


@dataclass(frozen=True, kw_only=True)
class CompressionOptions:
    """What of a plain image is compressed, and how; see `progiso.compress`."""

    rate: float = 8.0
    array: str | None = None
    component: int = 0
    axes: str | None = None
    mask_nan: bool = False
    threads: int = 0
    progress: Progress | None = None


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
    detailed: bool = False


class EncodingKeywords(TypedDict, total=False):
    """Keywords of `CompressionOptions` but for the array."""

    rate: float
    component: int
    axes: str | None
    mask_nan: bool
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
