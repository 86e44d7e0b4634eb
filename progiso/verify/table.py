"""List the sections of the table, and measure their cases."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from typing import Any

from . import compression, cracks, geometry, level_cracks, levels, normals, stiff, values
from .case import Case, Settings, row_of

#: Called with number, section and case before each.
Started = Callable[[int, str, Case], None]

SECTIONS = {
    "Stiff fields": stiff.CASES,
    "Values": values.CASES,
    "Normals": normals.CASES,
    "Geometry": geometry.CASES,
    "Compression": compression.CASES,
    "Cracks": cracks.CASES,
    "Levels of detail": levels.CASES + level_cracks.CASES,
}


def cases(quick: bool = False, containing: str = "") -> list[tuple[str, Case]]:
    """List what is to be measured.

    Parameters
    ----------
    quick : bool
        Whether only the quick table's cases.
    containing : str
        Only sections and cases with this text in their names.

    Returns
    -------
    list of tuple
        Section and `case.Case`.
    """
    return [
        (section, case)
        for section, listed in SECTIONS.items()
        for case in listed
        if (case.quick or not quick) and containing.lower() in f"{section}: {case.name}".lower()
    ]


def measure(
    listed: Sequence[tuple[str, Case]],
    settings: Settings,
    started: Started | None = None,
    jobs: int = 1,
) -> list[dict[str, Any]]:
    """Measure cases.

    Parameters
    ----------
    listed : sequence of tuple
        See `cases`.
    settings : case.Settings
    started : callable, optional
        Called with number, section and case before each.
    jobs : int, default: 1
        Processes that measure side by side: most of the time is the caster's, in one thread.

    Returns
    -------
    list of dict
        See `case.row_of`.
    """
    if jobs == 1:
        return [_measured(started, n, *each, settings) for n, each in enumerate(listed, 1)]
    names = [(section, case.name) for section, case in listed]
    fresh = multiprocessing.get_context("spawn")  # OpenGL does not survive a fork
    with ProcessPoolExecutor(min(jobs, len(listed)), fresh) as pool:
        rows = [pool.submit(_row_named, *name, settings) for name in names]
        return [
            _awaited(started, n, *each, row) for n, (each, row) in enumerate(zip(listed, rows), 1)
        ]


def _measured(
    started: Started | None, number: int, section: str, case: Case, settings: Settings
) -> dict[str, Any]:
    if started is not None:
        started(number, section, case)
    return row_of(section, case, settings)


def _awaited(
    started: Started | None, number: int, section: str, case: Case, row: Future[dict[str, Any]]
) -> dict[str, Any]:
    if started is not None:
        started(number, section, case)
    return row.result()


def _row_named(section: str, name: str, settings: Settings) -> dict[str, Any]:
    """Measure a case by its name, since cases cannot be sent between processes."""
    (case,) = (case for case in SECTIONS[section] if case.name == name)
    return row_of(section, case, settings)
