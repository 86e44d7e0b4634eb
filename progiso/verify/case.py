"""Define what a case is, and make its row of the table."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

#: Verdicts. `LIMIT`: within the bound that is stated for what float32 or a format cannot do.
OK, FAILED, LIMIT = "ok", "failed", "limit"


@dataclass(frozen=True)
class Settings:
    """Tells how cases are rendered.

    Attributes
    ----------
    size : tuple of int
        Width and height of the images in pixels, where a case has none of its own.
    repeat : int
        How often an image is timed; the best counts.
    rays : int
        How many are cast at closed surfaces.
    """

    size: tuple[int, int] = (320, 240)
    repeat: int = 3
    rays: int = 1_000_000


#: The settings of ``--quick``.
QUICK = Settings((128, 96), 2, 100_000)


@dataclass(frozen=True)
class Outcome:
    """Holds what a case has found.

    Attributes
    ----------
    error, limit : float
        In `unit`; an infinite error is a hit where none is possible, or a miss where one is
        certain.
    time_ms : float, optional
        Of the slowest image; None where nothing is rendered.
    unit : str
    note : str
        What a reader should know.
    documented : bool
        Whether the limit is more than is asked of other cases: the bound of what cannot be done.
    defect : str
        What else is wrong; empty where nothing is.
    """

    error: float
    limit: float
    time_ms: float | None = None
    unit: str = "voxels"
    note: str = ""
    documented: bool = False
    defect: str = ""


@dataclass(frozen=True)
class Case:
    """Describes a row of the table before it is measured.

    Attributes
    ----------
    name : str
    measure : callable
        Takes `Settings`, returns an `Outcome`. An exception makes the case fail.
    quick : bool
        Whether the quick table has it.
    """

    name: str
    measure: Callable[[Settings], Outcome]
    quick: bool = True


def worst_of(outcomes: Iterable[Outcome]) -> Outcome:
    """Pick the outcome nearest to its limit, with the longest time and the first defect of all."""
    outcomes = list(outcomes)
    worst = max(outcomes, key=lambda outcome: outcome.error / outcome.limit)
    times = [outcome.time_ms for outcome in outcomes if outcome.time_ms is not None]
    return Outcome(
        worst.error,
        worst.limit,
        max(times, default=None),
        worst.unit,
        worst.note,
        worst.documented,
        next((outcome.defect for outcome in outcomes if outcome.defect), ""),
    )


def row_of(section: str, case: Case, settings: Settings) -> dict[str, Any]:
    """Measure a case.

    Parameters
    ----------
    section : str
        Of the table.
    case : Case
    settings : Settings

    Returns
    -------
    dict
        ``case``, ``verdict``, ``error`` (None: infinite, or there is none to tell), ``limit``,
        ``time_ms``, ``section``, ``unit`` and ``note``.
    """
    try:
        outcome = case.measure(settings)
    except (RuntimeError, ValueError, MemoryError, AssertionError) as error:
        outcome = Outcome(math.inf, 0.0, unit="", defect=f"{type(error).__name__}: {error}")
    failed = bool(outcome.defect) or not outcome.error <= outcome.limit
    verdict = FAILED if failed else LIMIT if outcome.documented else OK
    return {
        "case": case.name,
        "verdict": verdict,
        "error": outcome.error if math.isfinite(outcome.error) else None,
        "limit": outcome.limit if math.isfinite(outcome.limit) else None,
        "time_ms": outcome.time_ms,
        "section": section,
        "unit": outcome.unit,
        "note": "; ".join(filter(None, (outcome.defect, outcome.note))),
    }
