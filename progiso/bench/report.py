"""Write results as Markdown, every figure beside its goal."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..io.files import atomic_path
from ..measure.isosurface import Isosurface
from ..measure.machine import machine_in_words
from ..measure.text import bytes_, count, milliseconds, number, percent, pixels, table
from . import goals
from .bounds_report import tables_of_bounds
from .driver import MOVEMENTS
from .errors import DEFAULT_DISTANCE
from .fields import parse_field
from .first_image import TIMES
from .interactive import BASELINE
from .level_report import tables_of_levels, tables_of_spheres
from .literature import BANDWIDTH, SOURCE, literature
from .volume_mapper import VolumeMapper

PAGE = "results.md"

_NO_GOAL = ""
_MET, _NOT_JUDGED = "met", "*not judged, busy*"


def write_markdown(
    document: dict[str, Any],
    path: str | os.PathLike[str],
    plots: dict[str, list[str]] | None = None,
) -> Path:
    """Write results as Markdown.

    Parameters
    ----------
    document : dict
        See `document`.
    path : str or os.PathLike
    plots : dict, optional
        Files to show, see `plots.draw_plots`, relative to the page.

    Returns
    -------
    pathlib.Path
    """
    path = Path(path)
    with atomic_path(path) as temporary:
        temporary.write_text(markdown(document, plots or {}), encoding="utf-8")
    return path


def markdown(document: dict[str, Any], plots: dict[str, list[str]]) -> str:
    """Make Markdown of results; parameters as in `write_markdown`.

    Returns
    -------
    str
    """
    report = _Report(document["machine"])
    body: list[str] = []
    for kind, section in _SECTIONS.items():
        records = document["measurements"].get(kind, [])
        if records:
            body += section(report, records)
            body += [line for name in plots.get(kind, []) for line in (f"![]({name})", "")]
    lines = [*_heading(document), *_summary(report), *body]
    return "\n".join(lines).rstrip() + "\n"


class _Report:
    """Collects the verdicts on a machine."""

    def __init__(self, machine: dict[str, Any]) -> None:
        self.machine = machine
        self.verdicts: list[tuple[dict[str, Any], goals.Verdict]] = []

    def goal(self, record: dict[str, Any], *verdicts: goals.Verdict | None) -> str:
        """Make a cell that judges figures; None among the verdicts are figures without a goal."""
        found = [verdict for verdict in verdicts if verdict is not None]
        self.verdicts += [(record, verdict) for verdict in found]
        texts = (f"{verdict.goal}: {self.judge(record, verdict)}" for verdict in found)
        return "; ".join(texts) or _NO_GOAL

    def judge(self, record: dict[str, Any], verdict: goals.Verdict) -> str:
        """Tell whether a goal is met; times that other processes disturbed are not judged."""
        if verdict.timed and goals.is_busy(self.machine, record):
            return _NOT_JUDGED
        return _MET if verdict.met else "**not met**"


def _of(record: dict[str, Any]) -> str:
    """Tell what a record is of."""
    name = record.get("field") or f"gyroid, {_surface(record)}"
    return f"{name}, {pixels(record['size'])}"


def _heading(document: dict[str, Any]) -> list[str]:
    lines = [
        f"# Benchmarks: {document['machine']['gl']}",
        "",
        machine_in_words(document["machine"]),
        "",
        *_about_times(document),
    ]
    rows = [
        [
            f"`{run['command']}`",
            run["commit"] or "–",
            run["started"],
            f"{number(run['seconds'])} s" + ("" if run["complete"] else ", not complete"),
        ]
        for run in document["runs"]
    ]
    return lines + table(["command", "commit", "started", "took"], rows)


def _about_times(document: dict[str, Any]) -> list[str]:
    """Tell what times are, and whether they can be relied on; nothing where there are none."""
    measured = document["measurements"]
    records = [r for kind, records in measured.items() if kind not in _UNTIMED for r in records]
    if not records:
        return []
    lines = ["Times are wall clock from the call of `Render()` to the end of the GPU's work.", ""]
    busy = [r["others_cores"] for r in records if goals.is_busy(document["machine"], r)]
    if not busy:
        return lines
    return [
        *lines,
        f"**The machine was busy**: other processes took up to {number(max(busy))} of its "
        f"{document['machine']['cores']} cores during {len(busy)} of {len(records)} "
        "measurements. Their times are too long, and not all by the same factor: do not compare "
        "them. No goal is judged by them; measure again on a quiet machine.",
        "",
    ]


def _summary(report: _Report) -> list[str]:
    if not report.verdicts:
        return []
    judged = [report.judge(record, verdict) for record, verdict in report.verdicts]
    met, left = judged.count(_MET), judged.count(_NOT_JUDGED)
    rows = [
        [
            _of(record),
            verdict.what,
            verdict.measured,
            verdict.goal,
            judgement,
            number(record["others_cores"]),
        ]
        for (record, verdict), judgement in zip(report.verdicts, judged)
    ]
    unjudged = f", {left} not judged" if left else ""
    heading = [f"## Goals: {met} of {len(judged) - left} met{unjudged}", ""]
    return heading + table(["of", "what", "measured", "goal", "", "others' cores"], rows)


# ---- side by side


def _peers(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    headers = [
        "field", "peer", "file to first image", "extraction", "first frame",
        "later frames: mean", "median", "min", "GPU memory", "main memory", "triangles",
        "literature: the paper's implementation*", "goal",
    ]  # fmt: skip
    rows = [cells for record in records for cells in _peer_rows(report, record)]
    return [
        "## Side by side",
        "",
        "In one process, one after the other, each in a new window. *File to first image*: "
        "reading (a `.vti` with appended data for ProgIso, the plain file for VTK, both in the "
        "system's file cache), extraction, and the *first frame*: upload, shaders, complete image. "
        "Shaders may be in the driver's cache from fields before. *GPU memory*: the "
        "most in use above what was before, by nvidia-smi; for ProgIso also, in brackets, what "
        "its mapper says it holds. *Main memory*: peak of the process above what it was before, "
        "with a software renderer's share and mapped files.",
        "",
        *table(headers, rows),
        f"\\* Not measured in this run. {SOURCE}.",
        "",
    ]


def _peer_rows(report: _Report, record: dict[str, Any]) -> Iterator[list[str]]:
    by_peer = {row["peer"]: row for row in record["rows"]}
    for peer, row in by_peer.items():
        name = _of(record) if peer == Isosurface.label else ""
        if "failed" in row:
            yield [name, peer, row["failed"], *[""] * 10]
            continue
        ours = peer == Isosurface.label
        yield [
            name,
            peer,
            milliseconds(row["file_ms"]),
            milliseconds(row["extraction"]["mean"]) if "extraction" in row else "",
            milliseconds(row["first_ms"]),
            milliseconds(row["later"]["mean"]),
            milliseconds(row["later"]["median"]),
            milliseconds(row["later"]["min"]),
            _gpu_memory(row),
            bytes_(row["rss_bytes"]),
            count(row["triangles"]) if "triangles" in row else "",
            _literature(report.machine, record) if ours else "",
            _peer_goals(report, record, by_peer) if ours else _NO_GOAL,
        ]


def _gpu_memory(row: dict[str, Any]) -> str:
    seen = bytes_(row["gpu_bytes"])
    return f"{seen} ({bytes_(row['mapper_bytes'])})" if "mapper_bytes" in row else seen


def _literature(machine: dict[str, Any], record: dict[str, Any]) -> str:
    figure = literature(goals.machine_kind(machine), record["field"], record["size"])
    if figure is None:
        return "–"
    strong = "" if figure.strong_ms is None else f" ({milliseconds(figure.strong_ms)})"
    memory = "" if figure.gpu_mib is None else f", {figure.gpu_mib:g} MiB"
    return f"{milliseconds(figure.ms)}{strong}{memory}"


def _peer_goals(report: _Report, record: dict[str, Any], by_peer: dict[str, dict[str, Any]]) -> str:
    machine, size, field = report.machine, record["size"], record["field"]
    ours, mapper = by_peer[Isosurface.label], by_peer.get(VolumeMapper.label, {"failed": ""})
    voxels, mean = parse_field(field).voxels, ours["later"]["mean"]
    verdicts = [
        goals.complete_image(machine, size, voxels, mean),
        goals.file_to_image(machine, size, ours["file_ms"]),
        *goals.against_paper(machine, field, size, mean),
    ]
    if "failed" not in mapper:
        theirs = mapper["later"]["mean"]
        verdicts.append(goals.against_mapper(machine, size, field, voxels, mean, theirs))
        if mapper["gpu_bytes"]:
            verdicts.append(
                goals.memory_against_mapper(machine, voxels, ours["gpu_bytes"], mapper["gpu_bytes"])
            )
    return report.goal(record, *verdicts)


# ---- the paper's protocol


def _protocol(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    return [
        "## The paper's protocol",
        "",
        "Random isovalues of the range of interest, each from all positions of the orbit; the "
        "block cache lives on from image to image.",
        "",
        *_protocol_times(report, records),
        *_table2(records),
        *_stages(report, records),
        *_tables34(report, records),
    ]


def _protocol_times(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    headers = [
        "field", "isovalues × positions", "first frame", "complete image: mean", "median", "min",
        "max", "without speculation: mean", "goal",
    ]  # fmt: skip
    rows = []
    for record in records:
        time, voxels = record["time"], parse_field(record["field"]).voxels
        verdict = goals.complete_image(report.machine, record["size"], voxels, time["mean"])
        rows.append(
            [
                _of(record),
                f"{len(record['isovalues'])} × {record['positions']}",
                milliseconds(record["first_ms"]),
                *(milliseconds(time[key]) for key in ("mean", "median", "min", "max")),
                milliseconds(record["time_without"]["mean"]),
                report.goal(record, verdict),
            ]
        )
    return table(headers, rows)


def _table2(records: list[dict[str, Any]]) -> list[str]:
    headers = [
        "field", "passes, median", "blocks visible per pass", "speculation, median", "utilisation",
    ]  # fmt: skip
    rows = [
        [
            _of(record),
            number(record["table2"]["passes_median"]),
            percent(record["table2"]["visible_percent"]),
            number(record["table2"]["speculation_median"]),
            percent(record["table2"]["utilisation_percent"]),
        ]
        for record in records
    ]
    return ["Passes (the paper's Table 2):", "", *table(headers, rows)]


def _stages(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    """Tabulate the times of stages, the longest first."""
    names = dict.fromkeys(name for record in records for name in record["stage_ms"])
    if not names:
        return []
    total = {name: sum(r["stage_ms"].get(name, 0.0) for r in records) for name in names}
    ordered = sorted(names, key=lambda name: total[name], reverse=True)
    bandwidth = BANDWIDTH.get(goals.machine_kind(report.machine) or "")
    rows = [
        [
            _of(record),
            *(milliseconds(record["stage_ms"].get(name)) for name in ordered),
            bytes_(record["moved_bytes"]),
            *([milliseconds(1e3 * record["moved_bytes"] / bandwidth)] if bandwidth else []),
        ]
        for record in records
    ]
    floor = [f"floor ({bandwidth / 1e12:g} TB/s)"] if bandwidth else []
    return [
        "Stages, means over the images, timed in a run of their own, beside the bytes that have to "
        "be moved: what is decoded, intersected and drawn, each read and written once:",
        "",
        *table(["field", *ordered, "bytes to move", *floor], rows),
    ]


def _tables34(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    headers = [
        "field", "total", "cache", "explicit: stream + blocks + mesh", "reduction",
        "explicit: blocks", "reduction", "triangles", "mesh", "FlyingEdges' peak",
        "beside payload and cache", "goal",
    ]  # fmt: skip
    rows = []
    for record in records:
        memory = record["memory"]
        rows.append(
            [
                _of(record),
                bytes_(memory["total_mean"]),
                bytes_(memory["cache_mean"]),
                *_explicit_cells(memory, record["explicit"]),
                bytes_(memory["other_max"]),
                report.goal(record, goals.beside_payload(memory)),
            ]
        )
    return [
        "Memory, means over the images (Tables 3 and 4). *Explicit* is extraction from the same "
        "compressed volume: all blocks that hold the isovalue and their + neighbours decoded, and "
        "the whole mesh; *FlyingEdges' peak* is main memory beside the decompressed volume.",
        "",
        *table(headers, rows),
    ]


def _explicit_cells(memory: dict[str, Any], explicit: dict[str, Any]) -> list[str]:
    if "left_out" in explicit:
        return [explicit["left_out"], *[""] * 6]
    meshes = explicit["meshes"]
    mesh = np.mean([m["bytes"] for m in meshes])
    total = memory["compressed"] + explicit["cache_mean"] + mesh
    peaks = [m["peak_bytes"] for m in meshes if m["peak_bytes"] is not None]
    return [
        bytes_(total),
        f"{number(total / memory['total_mean'])} ×",
        bytes_(explicit["cache_mean"]),
        f"{number(explicit['cache_mean'] / memory['cache_mean'])} ×",
        count(np.mean([m["triangles"] for m in meshes])),
        bytes_(mesh),
        bytes_(max(peaks, default=None)),
    ]


# ---- first images and small moves


def _latency(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    headers = [
        "field", "cold: mean (median, min)", "moved by 2°: mean (median, min)",
        "first pass: mean (median, min)", "goal",
    ]  # fmt: skip
    rows = []
    for record in records:
        cold, moved, first = (record[key]["mean"] for key in ("cold", "moved", "first_pass"))
        size = record["size"]
        verdicts = (
            goals.moved(cold, moved),
            goals.first_pass(report.machine, size, first),
        )
        rows.append(
            [
                _of(record),
                *(_mean_and_more(record[key]) for key in ("cold", "moved", "first_pass")),
                report.goal(record, *verdicts),
            ]
        )
    return [
        "## First images and small moves",
        "",
        "*Cold*: the cache is emptied, so that nothing of the volume is decoded, then the complete "
        "image is rendered. *Moved*: then the camera moves by 2° about the focal point. *First "
        "pass*: as cold, until the first partial image is drawn; a small volume that is decoded "
        "when it is loaded has but one pass, and is not loaded again for it.",
        "",
        *table(headers, rows),
    ]


def _mean_and_more(time: dict[str, Any]) -> str:
    median, least = milliseconds(time["median"]), milliseconds(time["min"])
    return f"{milliseconds(time['mean'])} ({median}, {least})"


# ---- error against run time


def _errors(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    lines = [
        "## Depth error against run time",
        "",
        "Against a double-precision caster over the uncompressed samples: how far off the depth "
        "is, in voxels along the ray, where both hit; and the part of all rays that hit where "
        "they should not or the other way round (of a partial image also what it has not "
        "finished). Times are medians of the view after its opposite, the view having been "
        "rendered before. *Pass by pass*: blocks are decoded as rays meet them, of small volumes "
        "too.",
        "",
    ]
    for record in records:
        lines += _error_table(report, record)
    return lines


def _error_table(report: _Report, record: dict[str, Any]) -> list[str]:
    if "left_out" in record:
        return [f"{_of(record)}: {record['left_out']}.", ""]
    resolution = ", ".join(
        f"{peer} {number(voxels)}" for peer, voxels in record["resolution"].items()
    )
    rows = [
        [
            name,
            point["label"],
            milliseconds(point["ms"]),
            *(number(point[key]) for key in ("mean", "median", "p99")),
            percent(100 * point["wrong"]),
        ]
        for name, points in record["series"].items()
        for point in points
    ]
    mapper = next(p for p in record["series"][VolumeMapper.label] if p["label"] == DEFAULT_DISTANCE)
    rates = record["series"]["ProgIso, rates"]
    verdict = goals.error_against_mapper(record["field"], rates, mapper)
    goal = report.goal(record, verdict)
    return [
        f"### {_of(record)}, isovalue {number(record['isovalue'])}",
        "",
        f"{count(record['oracle']['hits'])} rays hit. The depths' source resolves, in voxels: "
        f"{resolution} (of VTK's peers the shader writes 24 bits in place of the colour, for the "
        "volume mapper where it shades). The extraction is part of the time where it says so.",
        "",
        *table(["way", "", "time", "error: mean", "median", "99 %", "wrong rays"], rows),
        *([f"Goal: {goal} ({verdict.measured}).", ""] if verdict else []),
    ]


# ---- rates


def _rates(_report: _Report, records: list[dict[str, Any]]) -> list[str]:
    records = [record for record in records if "left_out" not in record]
    lines = [
        "## Rates",
        "",
        "Depths against a double-precision caster over the uncompressed samples, in voxels along "
        "the ray where both hit; rays that miss the surface where they should hit it, and that hit "
        "one where there is none, of all rays. Errors of samples in parts of their range. Surfaces "
        "that hang together and their handles (genus, of V − E + F) are those of FlyingEdges' mesh "
        "of the decompressed samples, closed at the volume's border.",
        "",
        "The least of the measured bits per sample from which on:",
        "",
        *table(["field", *_RATE_GOALS], [_least_rates(record) for record in records]),
    ]
    for record in records:
        lines += _rate_table(record)
    return lines


#: Goals that a user may have for a rate.
_RATE_GOALS = {
    "99 % of depths within 0.1 voxels": lambda point, _: point["p99"] <= 0.1,
    "0.01 voxels": lambda point, _: point["p99"] <= 0.01,
    "1 of 1000 rays wrong at most": lambda point, _: point["wrong"] <= 1e-3,
    "1 of 10000": lambda point, _: point["wrong"] <= 1e-4,
    "surfaces and handles within 5 %": lambda point, exact: all(
        abs(point[key] - exact[key]) <= 0.05 * exact[key] for key in ("components", "genus")
    ),
}


def _least_rates(record: dict[str, Any]) -> list[str]:
    points, exact = record["points"], record["topology"]
    cells = [record["field"].rsplit("-r", 1)[0]]
    for reached in _RATE_GOALS.values():
        failing = [i for i, p in enumerate(points) if p["p99"] is None or not reached(p, exact)]
        first = failing[-1] + 1 if failing else 0
        cells.append(number(points[first]["rate"]) if first < len(points) else "–")
    return cells


def _rate_table(record: dict[str, Any]) -> list[str]:
    low, high = record["range"]
    exact = record["topology"]
    rows = [
        [
            number(point["rate"]),
            *(_part(point[key], high - low) for key in ("max_error", "rms_error")),
            *(number(point[key]) for key in ("median", "p99")),
            *(percent(100 * point[key]) for key in ("missed", "invented")),
            *_surface_cells(point),
        ]
        for point in record["points"]
    ]
    rows.append(["uncompressed", *[""] * 6, *_surface_cells(exact)])
    headers = [
        *("bits per sample", "sample error: largest", "RMS", "depth error: median", "99 %"),
        *("missed rays", "invented rays", "surfaces", "handles", "triangles"),
    ]
    return [
        f"### {record['field'].rsplit('-r', 1)[0]}, {pixels(record['size'])}, isovalue "
        f"{number(record['isovalue'])}",
        "",
        f"Samples from {number(low)} to {number(high)}; {count(record['hits'])} rays hit.",
        "",
        *table(headers, rows),
    ]


def _part(value: float, whole: float) -> str:
    """Format a part of a whole."""
    return f"{value / whole:.1e}" if value else "0"


def _surface_cells(point: dict[str, Any]) -> list[str]:
    return [str(point["components"]), str(point["genus"]), str(point["triangles"])]


# ---- scaling and budgets


def _image_scaling(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    rows = [
        [
            record["field"] if i == 0 else "",
            pixels(point["size"]),
            *(milliseconds(point["time"][key]) for key in ("mean", "median", "min")),
            bytes_(point["other_bytes"]),
            _image_goals(report, record, point),
        ]
        for record in records
        for i, point in enumerate(record["points"])
    ]
    headers = ["field", "image", "mean", "median", "min", "beside payload and cache", "goal"]
    fits = [
        [
            record["field"],
            number(record["exponent"]),
            number(record["bytes_per_pixel"]),
            report.goal(record, goals.per_pixel(record["bytes_per_pixel"])),
        ]
        for record in records
    ]
    return [
        "## Scaling with image size",
        "",
        *table(headers, rows),
        *table(["field", "time over pixels, exponent", "GPU bytes per pixel", "goal"], fits),
    ]


def _image_goals(report: _Report, record: dict[str, Any], point: dict[str, Any]) -> str:
    seen = {**record, "size": point["size"]}
    mean = point["time"]["mean"]
    voxels = parse_field(record["field"]).voxels
    return report.goal(
        seen,
        goals.complete_image(report.machine, point["size"], voxels, mean),
        *goals.against_paper(report.machine, record["field"], point["size"], mean),
    )


def _surface(record: dict[str, Any]) -> str:
    return "growing surface" if record["grows"] else "same surface"


def _volume_scaling(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    lines = ["## Scaling with volume size", ""]
    for record in records:
        rows = [
            [
                point["field"],
                count(point["voxels"]),
                *(milliseconds(point["time"][key]) for key in ("mean", "median", "min")),
                report.goal(
                    {**record, "field": point["field"]},
                    goals.complete_image(
                        report.machine, record["size"], point["voxels"], point["time"]["mean"]
                    ),
                ),
            ]
            for point in record["points"]
        ]
        left_out = [f"{name}: {reason}" for name, reason in record["left_out"].items()]
        verdicts = (
            goals.time_exponent(record["exponent"]),
            goals.per_block(record["bytes_per_block"]),
        )
        goal = report.goal(record, *verdicts) or "too few sizes to tell"
        lines += [
            f"{_surface(record).capitalize()}, {pixels(record['size'])}: exponent of time over "
            f"voxels {number(record['exponent'])}; {number(record['bytes_per_block'])} bytes of "
            f"GPU memory for one more block ({goal}).",
            "",
            *table(["field", "voxels", "mean", "median", "min", "goal"], rows),
            *([f"Left out: {'; '.join(left_out)}.", ""] if left_out else []),
        ]
    return lines


def _budget(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    rows = []
    for record in records:
        free = record["free"]
        rows.append([_of(record), "none", *_budget_cells(free), _NO_GOAL])
        for point in record["points"]:
            verdict = goals.within_budget(point["beside"], point["budget"])
            cells = _budget_cells(point)
            rows.append(["", bytes_(point["budget"]), *cells, report.goal(record, verdict)])
    headers = [
        *("field", "budget", "GPU memory beside the stream", "in all", "passes, mean"),
        *("mean", "median", "min", "goal"),
    ]
    return ["## Memory budgets", "", *table(headers, rows)]


def _budget_cells(point: dict[str, Any]) -> list[str]:
    times = (milliseconds(point["time"][key]) for key in ("mean", "median", "min"))
    sizes = bytes_(point["beside"]), bytes_(point["total"])
    return [*sizes, number(point["passes"]), *times]


# ---- fly-throughs


def _interactive(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    lines = [
        "## Fly-throughs",
        "",
        "Milliseconds of complete images: median / 95 % / largest. Each way to an image runs in a "
        "process of its own, after another one has filled the driver's cache of shaders, and makes "
        "the movements in this order; VTK's ways show the decompressed volume. *Orbit*: by 2° a "
        "frame, from where the first image was seen. *Dolly*: to half the distance, then to four "
        "times it. *Far view*: an orbit at eight times it. *Next view*: from all around, at each "
        "isovalue. *Moved by 2°*: after an image for which the cache of blocks was emptied. "
        "FlyingEdges extracts anew where the isovalue changes.",
        "",
    ]
    for record in records:
        lines += _flight(report, record)
    return lines


def _flight(report: _Report, record: dict[str, Any]) -> list[str]:
    """Tabulate the frames of a volume and a size, and what they are judged by."""
    rows = [
        [row["peer"], row["failed"], *[""] * len(MOVEMENTS)]
        if "failed" in row
        else [
            row["peer"],
            row["commit"] or "–",
            *(_percentiles(row["movements"][name]["time"]) for name in MOVEMENTS),
        ]
        for row in record["rows"]
    ]
    by_peer = {row["peer"]: row for row in record["rows"] if "failed" not in row}
    judged = [
        [f"ours: {name}", *(_judged(report, record, judge(name)) for name in MOVEMENTS)]
        for name, judge in _flight_judges(report, record, by_peer)
    ]
    return [
        f"### {_of(record)}, {record['frames']} frames",
        "",
        *table(["way", "commit", *MOVEMENTS], rows),
        *table(["goal", *MOVEMENTS], judged),
    ]


def _percentiles(time: dict[str, Any]) -> str:
    return " / ".join(number(time[key]) for key in ("median", "p95", "max"))


_Judge = Callable[[str], "tuple[str, goals.Verdict | None]"]


def _flight_judges(
    report: _Report, record: dict[str, Any], by_peer: dict[str, dict[str, Any]]
) -> Iterator[tuple[str, _Judge]]:
    """Yield what the frames are compared with, and what makes figure and verdict of a movement."""
    machine, field, size = report.machine, record["field"], record["size"]
    ours = by_peer[Isosurface.label]["movements"]
    mapper, baseline = by_peer.get(VolumeMapper.label), by_peer.get(BASELINE)
    if mapper is not None:
        times = mapper["movements"]

        def against_mapper(name: str) -> tuple[str, goals.Verdict | None]:
            mine, theirs = ours[name]["time"], times[name]["time"]
            verdict = goals.movement_against_mapper(machine, field, name, mine, theirs)
            return _ratio(mine, theirs), verdict

        yield "of VTK's mapper's", against_mapper
    if baseline is not None:
        earlier = baseline["movements"]

        def against_baseline(name: str) -> tuple[str, goals.Verdict | None]:
            mine, theirs = ours[name], earlier[name]
            verdict = goals.movement_against_baseline(machine, field, size, name, mine, theirs)
            cores = f"; CPU time {number(mine['cpu_ms'] / theirs['cpu_ms'])} ×"
            return _ratio(mine["time"], theirs["time"]) + cores, verdict

        yield f"of the baseline's ({baseline['commit']})", against_baseline

    def longest(name: str) -> tuple[str, goals.Verdict | None]:
        mine = ours[name]["time"]
        return f"{number(mine['max'] / mine['median'])} ×", goals.no_hitch(machine, name, mine)

    yield "longest frame, of the median", longest


def _ratio(ours: dict[str, Any], theirs: dict[str, Any]) -> str:
    return " / ".join(number(ours[key] / theirs[key]) for key in ("median", "p95", "max")) + " ×"


def _judged(
    report: _Report, record: dict[str, Any], figure: tuple[str, goals.Verdict | None]
) -> str:
    """Make a cell of a figure and, where there is a goal, its verdict."""
    text, verdict = figure
    return text if verdict is None else f"{text} ({report.goal(record, verdict)})"


# ---- first images in a new process

_TIMES = {
    "window_ms": "empty window",
    "read_ms": "file read",
    "first_ms": "first picture",
    "complete_ms": "complete image",
}


def _first_image(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    rows = [cells for record in records for cells in _first_image_rows(report, record)]
    headers = [
        "field", "way", "commit", "driver's cache of shaders",
        *(_TIMES[key] for key in TIMES), "next images: median, max", "goal",
    ]  # fmt: skip
    splits = [cells for record in records for cells in _split_rows(record)]
    return [
        "## First image of a new process",
        "",
        "Medians; the empty window is there before. Then the times count from opening the file, "
        "which is in the system's file cache, to where it is *read*, to a *first picture* of "
        "which a part is complete, and to the *complete image*. The *next images* move by 2° each.",
        "",
        *table(headers, rows),
        *_split(splits),
    ]


def _first_image_rows(report: _Report, record: dict[str, Any]) -> Iterator[list[str]]:
    by_kind = {(row["peer"], row["cache"]): row for row in record["rows"]}
    for (peer, cache), row in by_kind.items():
        verdicts: list[goals.Verdict | None] = []
        if (peer, cache) == (Isosurface.label, "emptied"):
            kept = by_kind[peer, "kept"]
            verdicts = [
                *goals.first_picture(report.machine, record["field"], record["size"], row),
                goals.next_images(report.machine, row, kept),
            ]
        yield [
            _of(record),
            peer,
            row["commit"] or "–",
            cache,
            *(milliseconds(row[key]["median"]) for key in TIMES),
            f"{milliseconds(row['next']['median'])}, {milliseconds(row['next']['max'])}",
            report.goal(record, *verdicts),
        ]


def _split(rows: list[list[str]]) -> list[str]:
    """Tabulate how the time up to the complete image splits; nothing where no mapper tells."""
    if not rows:
        return []
    headers = [
        "field", "driver's cache of shaders", "input", "upload", "ranges and decoding",
        "waits for programs", "programs: until compiled (waited)",
    ]  # fmt: skip
    return [
        "What the mapper tells of the last of these processes. Programs that the driver compiles "
        "in threads overlap each other and the rest; the render waits for those that it needs:",
        "",
        *table(headers, rows),
    ]


def _split_rows(record: dict[str, Any]) -> Iterator[list[str]]:
    for row in record["rows"]:
        loading = row["statistics"].get("loading")
        if loading is None:  # as with the earlier commit
            continue
        programs = sorted(loading["programs"].items(), key=lambda item: -item[1]["ms"])
        yield [
            _of(record),
            row["cache"],
            *(milliseconds(loading[key]) for key in ("input_ms", "upload_ms", "preparation_ms")),
            milliseconds(sum(times["waited_ms"] for _, times in programs)),
            ", ".join(
                f"{name} {number(times['ms'])} ({number(times['waited_ms'])})"
                for name, times in programs
            ),
        ]


# ---- long use


_MEMORY_NAMES = {
    "rss": "main memory of the process",
    "gpu": "GPU memory in use (nvidia-smi)",
    "mapper": "GPU memory, as the mapper counts it",
}


def _soak(report: _Report, records: list[dict[str, Any]]) -> list[str]:
    lines = [
        "## Long use",
        "",
        "Every frame has another camera and other isovalues; now and then the image's size, the "
        "look, the budget, the volume, its colours or the mapper itself change. Memory is told of "
        "one and the same scene, to which the view returns for every sample. *Growth*: the median "
        "slope between all samples after the warm-up, in 1000 frames.",
        "",
    ]
    for record in records:
        rows = list(_growth_rows(report, record))
        errors = report.goal(record, goals.no_gl_errors(record["gl_errors"]))
        changes = ", ".join(f"{what} {times}" for what, times in record["changes"].items())
        peak = bytes_(max(record["samples"]["peak"]))
        headers = ["memory", "at first", "warmed up", "at last", "growth", "goal"]
        lines += [
            f"### {_of(record)}, {record['frames']} frames",
            "",
            *table(headers, rows),
            f"The mapper's most: {peak}. OpenGL errors: {record['gl_errors']} (goal: {errors}). "
            f"Changes beside camera and isovalues: {changes}.",
            "",
        ]
    return lines


def _growth_rows(report: _Report, record: dict[str, Any]) -> Iterator[list[str]]:
    samples, warm_up = record["samples"], record["warm_up"]
    first = next(i for i, n in enumerate(samples["frame"]) if n >= warm_up)
    for key, name in _MEMORY_NAMES.items():
        grown = record["growth"][key]
        if grown is None:
            continue
        cells = (samples[key][0], samples[key][first], samples[key][-1], 1000 * grown)
        verdict = goals.memory_growth(f"growth of {name}", key, grown)
        yield [name, *map(bytes_, cells), report.goal(record, verdict)]


#: Kinds of measurements without times.
_UNTIMED = {"rates", "level_spheres", "levels"}

_SECTIONS = {
    "peers": _peers,
    "protocol": _protocol,
    "latency": _latency,
    "errors": _errors,
    "rates": _rates,
    "level_spheres": lambda _report, records: tables_of_spheres(records),
    "levels": lambda _report, records: tables_of_levels(records),
    "bounds": lambda _report, records: tables_of_bounds(records),
    "image_scaling": _image_scaling,
    "volume_scaling": _volume_scaling,
    "budget": _budget,
    "interactive": _interactive,
    "first_image": _first_image,
    "soak": _soak,
}
