"""The table: its sections and their cases."""

from __future__ import annotations

from . import compression, cracks, geometry, normals, stiff, values
from .case import row_of

SECTIONS = {
    "Stiff fields": stiff.CASES,
    "Values": values.CASES,
    "Normals": normals.CASES,
    "Geometry": geometry.CASES,
    "Compression": compression.CASES,
    "Cracks": cracks.CASES,
}


def cases(quick=False, containing=""):
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


def measure(listed, settings, started=None):
    """Measure cases.

    Parameters
    ----------
    listed : sequence of tuple
        See `cases`.
    settings : case.Settings
    started : callable, optional
        Called with number, section and case before each.

    Returns
    -------
    list of dict
        See `case.row_of`.
    """
    rows = []
    for number, (section, case) in enumerate(listed, 1):
        if started is not None:
            started(number, section, case)
        rows.append(row_of(section, case, settings))
    return rows
