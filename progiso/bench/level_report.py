"""Tables of `levels`: filters for levels of detail, and the bits that they need."""

from __future__ import annotations

from typing import Any

from ..measure.text import number, percent, table

_ABOUT = """\
How levels might be made of the one before. *Half-band* is [−1 0 9 16 9 0 −1]/32 along each axis,
coarse sample j on fine sample 2j; *limited*, each coarse sample is kept within the range of the
three fine ones around it, along each axis in turn, and border samples stay as they are. Chosen is
the latter. Like the half-band filter it moves no surface to second order; and no coarse sample lies
beyond the values of the fine ones around it, so that no level shows an isosurface where the
original has none nearby. [1 2 1]/4 moves surfaces. Means do, too, and lie half a voxel aside, so
that coarse planes are no fine planes. Samples beyond a border are those mirrored in the border
sample, in place and value, whence all that [1 2 1]/4 overshoots."""

_SPHERES = """\
How far the surface of a level lies inside a sphere of R voxels of the level, in voxels of the
level, times R: of the filter alone, and of the trilinear interpolant at level 0's samples, which
cuts corners whatever the filter. In theory the filter's part tends to 1/6 = 0.167 for [1 2 1]/4, to
1/12 = 0.083 for means, and is 0 for the half-band filter; the interpolant adds 1/8 at level 1, 5/32
at level 2, and 1/6 in the end."""

_FIELDS = """\
How far a level's interpolant is off the fine samples, and how far its samples lie beyond the range
of these, in parts of the range; and the part of the samples that do."""

_BITS = """\
The least whole number of bits per sample more than level 0's with which a level's samples are off
by no more than level 0's. And with the bits that a level gets, its number and 2 more than level 0:
how far they are off, in parts of that."""


def tables_of_spheres(records: list[dict[str, Any]]) -> list[str]:
    """Make the lines of a page of what `levels.measure_spheres` measured."""
    rows = [
        [
            row["filter_name"],
            str(row["level"]),
            number(row["coarse_radius"]),
            *(f"{round(row[key], 3) + 0:.3f}" for key in ("filter", "surface", "largest")),
        ]
        for record in records
        for row in record["spheres"]
    ]
    headers = ["filter", "level", "R", "filter: displacement × R", "surface: × R", "largest"]
    about = [_line(_ABOUT), "", "### Spheres", "", _line(_SPHERES), ""]
    return ["## Levels of detail", "", *about, *table(headers, rows)]


def tables_of_levels(records: list[dict[str, Any]]) -> list[str]:
    """Make the lines of a page of what `levels.measure_levels` measured."""
    records = [record for record in records if "left_out" not in record]
    rows = [
        [
            _name(record),
            row["filter_name"],
            str(row["level"]),
            *(_part(row[key]) for key in ("largest", "rms", "overshoot")),
            percent(100 * row["outside"]),
        ]
        for record in records
        for row in record["filters"]
    ]
    headers = ["field", "filter", "level", "largest", "RMS", "overshoot", "samples outside"]
    fields = ["### Fields", "", _line(_FIELDS), "", *table(headers, rows)]
    return [*fields, "### Bits", "", _line(_BITS), "", *_bits(records)]


def _bits(records: list[dict[str, Any]]) -> list[str]:
    rows = [
        [
            _name(record),
            number(point["rate"]),
            *(str(row["least"]) for row in point["levels"]),
            *(f"{row['error']:.2f}" for row in point["levels"]),
        ]
        for record in records
        for point in record["rates"]
    ]
    count = len(records[0]["rates"][0]["levels"]) if records else 0
    headers = [f"{what}level {i + 1}" for what in ("more bits: ", "error: ") for i in range(count)]
    return table(["field", "bits per sample of level 0", *headers], rows)


def _line(text: str) -> str:
    return text.replace("\n", " ")


def _name(record: dict[str, Any]) -> str:
    return str(record["field"]).rsplit("-r", 1)[0]


def _part(value: float) -> str:
    return f"{value:.1e}" if value else "0"
