"""Show the table on the terminal and as Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Any

from rich.console import Console
from rich.table import Table

from ..measure.machine import machine_in_words
from ..measure.text import milliseconds, number
from .case import FAILED, LIMIT, OK

_STYLES = {OK: "green", LIMIT: "yellow", FAILED: "bold red"}

_ABOUT = """\
`python -m progiso verify` measures it anew, and exits with 1 where a case fails.

- **error** is what the picture is off by at the ray that comes closest to its limit. In *voxels*:
  along the ray, off the hit of a caster in double precision over the same decoded values. A ray
  grazes where the first place at which rounding makes a hit possible and the first at which it is
  certain are more than a thousandth of a voxel apart; it must stay between them. *∞* is a hit where
  none is possible, or a miss where one is certain. In *degrees*: between normals. In *rays*:
  those that slip through a closed surface, or hit one where there is nothing. In *faults*: 1
  where the one clear error that is due does not come. With levels of detail voxels are those of
  the level in which a ray hits, and the caster knows the law of levels. In *voxels of the level*:
  how far spheres are displaced in the mean, and how far behind the exact surface a conservative
  image has a hit. In *footprints*, pixels' widths at their depth times the tolerance: how far a
  depth jumps from frame to frame, its change in the exact image taken off.
- **limit** is what is granted: of depths 10⁻⁴ voxels, the rounding of a float32 distance, and 2⁻²⁹
  voxels of the axis with the largest spacing, in whose steps rays are made.
- **verdict**: *ok*, *failed*, or *limit* where the limit is the bound of something that cannot be
  done, which the note names.
- **time** is the least of a few complete images, wall clock, another image having been rendered
  before each; of several images that of the slowest. What stability costs shows beside the first
  row, a plain field's image.
- The note tells of the image with the error: how many rays hit, and where some graze, how many of
  those that can hit do, and how many of them do not have the caster's own hit."""


def print_table(rows: Sequence[dict[str, Any]]) -> None:
    """Print rows on standard output.

    Parameters
    ----------
    rows : sequence of dict
        See `case.row_of`.
    """
    table = Table(title="progiso verify")
    for heading in ("case", "verdict"):
        table.add_column(heading)
    for heading in ("error", "limit", "time_ms"):
        table.add_column(heading, justify="right")
    for section, members in groupby(rows, key=lambda row: row["section"]):
        table.add_row(f"[bold]{section}[/bold]")
        for row in members:
            style = _STYLES[row["verdict"]]
            table.add_row(
                row["case"],
                f"[{style}]{row['verdict']}[/{style}]",
                _error(row),
                _figure(row["limit"]),
                "" if row["time_ms"] is None else number(row["time_ms"]),
            )
    Console().print(table)


def markdown(document: dict[str, Any]) -> str:
    """Make a page of the rows.

    Parameters
    ----------
    document : dict
        ``machine``, ``runs`` and ``rows``.

    Returns
    -------
    str
    """
    run, rows = document["runs"][0], document["rows"]
    count = {verdict: sum(row["verdict"] == verdict for row in rows) for verdict in _STYLES}
    lines = [
        f"# Verification: {document['machine']['gl']}",
        "",
        machine_in_words(document["machine"]),
        "",
        f"`{run['command']}`, commit {run['commit'] or '–'}, {run['started']}, "
        f"{number(run['seconds'])} s: {len(rows)} cases, {count[OK]} ok, {count[LIMIT]} at a "
        f"limit that is stated, {count[FAILED]} failed." + _busy(run),
        "",
        _ABOUT,
        "",
    ]
    for section, members in groupby(rows, key=lambda row: row["section"]):
        lines += [f"## {section}", "", "| case | verdict | error | limit | time | note |"]
        lines += ["|---|---|---:|---:|---:|---|"]
        for row in members:
            verdict = row["verdict"] if row["verdict"] == OK else f"**{row['verdict']}**"
            time = milliseconds(row["time_ms"])
            cells = (row["case"], verdict, _error(row), _figure(row["limit"]), time, row["note"])
            lines.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
        lines.append("")
    return "\n".join(lines).rstrip() + "\n"


def _busy(run: dict[str, Any]) -> str:
    """Warn where other processes kept the machine busy."""
    others = run["others_cores"]
    if others is None or others < 0.1:
        return ""
    return (
        f" Others kept {number(others)} cores busy meanwhile: times are longer than they need be."
    )


def _error(row: dict[str, Any]) -> str:
    return "∞" if row["error"] is None else f"{_figure(row['error'])} {row['unit']}".rstrip()


def _figure(value: float | None) -> str:
    """Format two digits: orders of magnitude are what the table is about."""
    return "∞" if value is None else f"{value:.2g}"
