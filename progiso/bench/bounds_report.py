"""Tables of `bounds`: errors of levels of detail beside their times, and VTK's."""

from __future__ import annotations

from typing import Any

from ..measure.text import count, milliseconds, number, percent, pixels, table
from .bounds import REFERENCE, VIEWS
from .latency import MOVE

_PARTS = ", ".join(f"{100 * part:.0f} % ({view})" for view, part in VIEWS.items())

_ABOUT = f"""\
*Off* draws the volume itself, *On* each part of the surface from the coarsest level whose samples
are at most a pixel apart there (or as many pixels as it says), *Conservative* likewise, but looks
at the volume itself where a level may hide something. VTK's isosurface mapper takes samples so many
voxels apart along a ray. It draws the decompressed volume, in the same material and light, but with
normals of its own, from differences of samples a voxel away. The volume covers
{_PARTS} of the image's height."""

_COLUMNS = f"""\
*Depth error*: how far off depths are where both hit, in footprints of a pixel, which are the
distance of neighbouring pixels' rays at that depth. *Missed* and *invented*: pixels without a hit
where there should be one, and the other way round, in parts of the hits that there should be.
*Colour error*: root mean square of red, green and blue, 0 to 255, where anything is shown, against
{REFERENCE}×{REFERENCE} samples a pixel of *Off*, averaged. *Time*: of the view after a move by
{MOVE:g}°, both views having been rendered before, median. *Blocks*: what a first image decodes as
rays meet them (times are of volumes that are decoded whole, where they are small). *Levels*: pixels
whose surface is drawn from each, level 0 being the volume. *Uncertain*: pixels before whose surface
a level may hide something, in parts of the rectangle of pixels in which the volume lies."""

_EXACT = {
    "caster": "a double-precision caster over the decompressed samples",
    "Off": "the image *Off*, as the volume is too large for the caster",
}

_HEADERS = [
    "view", "way", "depth error: mean", "99 %", "largest", "missed", "invented", "colour error",
    "time", "blocks", "levels", "uncertain",
]  # fmt: skip


def tables_of_bounds(records: list[dict[str, Any]]) -> list[str]:
    """Make the lines of a page of what `bounds.measure_bounds` measured."""
    lines = ["## Bounds of levels of detail", ""]
    lines += [text for about in (_ABOUT, _COLUMNS) for text in (about.replace("\n", " "), "")]
    for record in records:
        lines += _table(record)
    return lines


def _table(record: dict[str, Any]) -> list[str]:
    name = f"{record['field']}, {pixels(record['size'])}"
    if "left_out" in record:
        return [f"{name}: {record['left_out']}.", ""]
    hits = ", ".join(f"{count(view['hits'])} ({view['view']})" for view in record["views"])
    return [
        f"### {name}, isovalue {number(record['isovalue'])}",
        "",
        f"Depths are held against {_EXACT[record['exact']]}. Pixels that should hit: {hits}.",
        "",
        *table(_HEADERS, [row for view in record["views"] for row in _rows(view)]),
    ]


def _rows(view: dict[str, Any]) -> list[list[str]]:
    names = [view["view"], *[""] * (len(view["rows"]) - 1)]
    return [[name, row["way"], *_cells(row)] for name, row in zip(names, view["rows"])]


def _cells(row: dict[str, Any]) -> list[str]:
    if "failed" in row:
        return [row["failed"], *[""] * (len(_HEADERS) - 3)]
    return [
        *(number(row[key]) for key in ("mean", "p99", "largest")),
        *(percent(100 * row[key]) for key in ("missed", "invented")),
        number(row["color"]),
        milliseconds(row["ms"]),
        count(row["blocks"]) if "blocks" in row else "",
        _levels(row["levels"]) if "levels" in row else "",
        percent(100 * row["uncertain"]) if "uncertain" in row else "",
    ]


def _levels(levels: dict[str, int]) -> str:
    """List the levels that pixels are drawn from."""
    return ", ".join(f"{level}: {count(drawn)}" for level, drawn in levels.items() if drawn) or "–"
