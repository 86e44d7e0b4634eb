"""Name the sets: which measurements they are made of, and on which fields."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from ..measure.machine import describe_machine
from ..measure.text import pixels
from .bounds import LARGEST_IMAGE, measure_bounds
from .budget import measure_budget
from .errors import measure_errors
from .fields import Field, parse_field
from .first_image import measure_first_image
from .goals import HD
from .interactive import measure_interactive
from .latency import measure_latency
from .levels import measure_levels, measure_spheres
from .peers import measure_peers
from .protocol import measure_protocol
from .rates import measure_rates
from .scaling import measure_image_scaling, measure_volume_scaling
from .settings import PEERS, Settings
from .soak import measure_soak

SCANS = ("ct-cranium-r8", "mri-brain-r8")
SMALL = ("marschner-lobb-128-k6-r4", "gyroid-256-k6-r2")
LARGE = ("gyroid-512-k12-r4", "gyroid-1024-k24-r4", "gyroid-1024-k24-r2", "gyroid-1024-k6-r2")
LARGEST = ("gyroid-2048x2048x1920-k48-r1", "gyroid-2048x2048x1920-k6-r1")
QUICK = (*SCANS, SMALL[0])
FLOWN_THROUGH = (SMALL[1], LARGE[0], LARGE[1], LARGE[3], *LARGEST)

#: Kind of a record, what it is of, and the function that makes it.
Step = tuple[str, str, Callable[[], dict[str, Any]]]


@dataclass(frozen=True)
class Defaults:
    """Holds a set's defaults.

    Attributes
    ----------
    description : str
    fields : tuple of str
    isovalues : int or str
        See `settings.Settings`.
    positions : int
        Of the orbit.
    """

    description: str
    fields: tuple[str, ...]
    isovalues: int | str
    positions: int


SETS = {
    "quick": Defaults("a bit of everything, within minutes without a GPU", QUICK, 2, 2),
    "paper": Defaults(
        "the paper's protocol, first images and small moves", (*SCANS, *SMALL, *LARGE), 100, 10
    ),
    "scaling": Defaults("time over image and volume size", (SMALL[1],), PEERS, 10),
    "peers": Defaults(
        "beside VTK's isosurface mapper and FlyingEdges", (*SCANS, *SMALL, *LARGE), PEERS, 10
    ),
    "errors": Defaults("depth error against run time", (*SCANS, *SMALL), PEERS, 10),
    "rates": Defaults("errors and topology over the bits per sample", (*SCANS, *SMALL), PEERS, 10),
    "levels": Defaults("filters and rates of levels of detail", (*SCANS, *SMALL), PEERS, 10),
    "bounds": Defaults(
        "errors and times of levels of detail, beside VTK's isosurface mapper",
        (SMALL[1], LARGE[1], *SCANS),
        PEERS,
        10,
    ),
    "budget": Defaults("time and memory within memory budgets", (LARGE[0],), PEERS, 10),
    "interactive": Defaults(
        "frames of a fly-through, beside VTK's and an earlier commit's", FLOWN_THROUGH, PEERS, 10
    ),
    "first-image": Defaults(
        "from opening a file to its image, shaders compiled or not",
        (SMALL[1], LARGE[3]),
        PEERS,
        10,
    ),
    "soak": Defaults("memory over thousands of random changes", ("gyroid-64-k3-r8",), PEERS, 2),
}

#: Size of the images of `bounds` without a GPU; with one it is `HD`.
SMALL_IMAGE = (640, 360)

#: What `quick` leaves out of the longer series.
_QUICK_IMAGES = (SMALL_IMAGE, HD)
_QUICK_VOLUMES = tuple((n, n, n) for n in (64, 128, 256))
_QUICK_RATES, _QUICK_DISTANCES = (2.0, 4.0, 8.0, 16.0), (0.25, 0.5, 1.0)


def steps(name: str, fields: Sequence[str], settings: Settings) -> list[Step]:
    """List the measurements of a set, in order.

    Parameters
    ----------
    name : str
        One of `SETS`.
    fields : sequence of str
        Names of the fields to measure.
    settings : settings.Settings

    Returns
    -------
    list of (str, str, callable)
        Kind of the record, what it is of, and the function that makes it.
    """
    return _STEPS[name]([parse_field(field) for field in fields], settings)


def _each(
    kind: str, measure: Callable[..., dict[str, Any]], fields: Sequence[Field], *arguments: Any
) -> list[Step]:
    return [(kind, field.name, partial(measure, field, *arguments)) for field in fields]


def _paper(fields: Sequence[Field], settings: Settings) -> list[Step]:
    by_field = zip(
        _each("protocol", measure_protocol, fields, settings),
        _each("latency", measure_latency, fields, settings),
    )
    return [step for pair in by_field for step in pair]


def _levels(fields: Sequence[Field], settings: Settings) -> list[Step]:
    spheres = ("level_spheres", "spheres", measure_spheres)
    return [spheres, *_each("levels", measure_levels, fields, settings)]


def _scaling(fields: Sequence[Field], settings: Settings) -> list[Step]:
    volumes = [
        ("volume_scaling", "same surface", partial(measure_volume_scaling, False, settings)),
        ("volume_scaling", "growing surface", partial(measure_volume_scaling, True, settings)),
    ]
    return _each("image_scaling", measure_image_scaling, fields, settings) + volumes


def _each_size(
    kind: str, measure: Callable[..., dict[str, Any]], fields: Sequence[Field], settings: Settings
) -> list[Step]:
    return [
        (
            kind,
            f"{field.name}, {pixels(size)}",
            partial(measure, field, replace(settings, size=size)),
        )
        for field in fields
        for size in settings.images
    ]


def _bounds(fields: Sequence[Field], settings: Settings) -> list[Step]:
    software = "llvmpipe" in describe_machine()["gl"]
    sizes = settings.images or (SMALL_IMAGE if software else HD,)
    if max(max(size) for size in sizes) > LARGEST_IMAGE:
        raise ValueError(f"images of bounds must be at most {LARGEST_IMAGE} pixels wide and high")
    return _each_size("bounds", measure_bounds, fields, replace(settings, images=sizes))


def _quick(fields: Sequence[Field], settings: Settings) -> list[Step]:
    fixed = replace(settings, isovalues=PEERS, images=_QUICK_IMAGES)
    width, height = settings.size
    small = replace(fixed, size=(max(1, width // 2), max(1, height // 2)))
    volumes = partial(measure_volume_scaling, False, fixed, _QUICK_VOLUMES)
    return [
        *_each("peers", measure_peers, fields, fixed),
        *_paper(fields, settings),
        *_each("errors", measure_errors, fields, small, _QUICK_RATES, _QUICK_DISTANCES),
        *_each("image_scaling", measure_image_scaling, fields[-1:], fixed),
        ("volume_scaling", "same surface", volumes),
    ]


_STEPS: dict[str, Callable[[Sequence[Field], Settings], list[Step]]] = {
    "quick": _quick,
    "paper": _paper,
    "scaling": _scaling,
    "peers": partial(_each, "peers", measure_peers),
    "errors": partial(_each, "errors", measure_errors),
    "rates": partial(_each, "rates", measure_rates),
    "levels": _levels,
    "bounds": _bounds,
    "budget": partial(_each, "budget", measure_budget),
    "interactive": partial(_each_size, "interactive", measure_interactive),
    "first-image": partial(_each, "first_image", measure_first_image),
    "soak": partial(_each, "soak", measure_soak),
}
