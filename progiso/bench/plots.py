"""Plot results, as in the paper's figures and beyond."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from ..measure.isosurface import Isosurface
from ..measure.mesh import Mesh
from ..measure.text import number, pixels
from .bounds import CONSERVATIVE, EXACT, OURS, THEIRS
from .driver import MOVEMENTS
from .errors import DEFAULT_DISTANCE
from .interactive import BASELINE
from .volume_mapper import VolumeMapper

# Okabe and Ito's colours, which colour-blind readers can tell apart; markers repeat them.
_BLUE, _ORANGE, _GREEN, _RED, _PINK, _SKY, _YELLOW, _BLACK = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#F0E442", "#000000",
)  # fmt: skip
_CYCLE = list(zip((_BLUE, _ORANGE, _GREEN, _RED, _PINK, _SKY, _BLACK), "os^Dv<P"))

_STYLE = {
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "lines.markersize": 6,
}


def draw_plots(document: dict[str, Any], folder: str | os.PathLike[str]) -> dict[str, list[str]]:
    """Draw all plots that the results allow.

    Parameters
    ----------
    document : dict
        See `document`.
    folder : str or os.PathLike
        Where the PNG files go.

    Returns
    -------
    dict
        {kind of measurement: names of its files}, in order.
    """
    plots: dict[str, list[str]] = {}
    for kind, draw in _DRAW.items():
        records = document["measurements"].get(kind, [])
        with matplotlib.rc_context(_STYLE):
            figures = draw(records) if records else {}
        for name, figure in figures.items():
            figure.savefig(Path(folder) / f"{name}.png", dpi=130, bbox_inches="tight")
            plots.setdefault(kind, []).append(f"{name}.png")
    return plots


def _figure(width: float, height: float, **layout: Any) -> tuple[Figure, Any]:
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(**layout)


def _titled(record: dict[str, Any]) -> str:
    return f"{record['field']}, {pixels(record['size'])}"


def _file(kind: str, record: dict[str, Any]) -> str:
    width, height = record["size"]
    return f"{kind}-{record['field']}-{width}x{height}"


def _log(axis: Axis) -> None:
    """Write few, plain numbers at a logarithmic axis that is drawn already."""
    low, high = axis.get_view_interval()
    steps = (1, 1.5, 2, 3, 4, 5, 7) if high < 10 * low else (1, 2, 5) if high < 999 * low else (1,)
    axis.set_major_locator(LogLocator(subs=steps, numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
    axis.set_minor_formatter(NullFormatter())


def _decade_below(values: Iterable[float]) -> float:
    """Return where logarithmic bars may begin."""
    return 10.0 ** np.floor(np.log10(0.9 * min(values)))


# ---- side by side


def _draw_peers(records: list[dict[str, Any]]) -> dict[str, Figure]:
    figures = {}
    for record in records:
        rows = [row for row in record["rows"] if "failed" not in row]
        figure, axes = _figure(8, 0.9 + 0.75 * len(rows))
        for i, row in enumerate(rows):
            bars = _peer_bars(row)
            for (label, value), offset in zip(bars, np.linspace(-0.27, 0.27, len(bars))):
                color = _PEER_COLORS[label]
                axes.barh(i + offset, value, 0.24, color=color)
                axes.text(value * 1.06, i + offset, f"{number(value)}", va="center", fontsize=8)
        axes.set_xscale("log")
        axes.margins(x=0.15)
        axes.set_xlim(left=_decade_below(row["later"]["mean"] for row in rows))
        _log(axes.xaxis)
        axes.set_yticks(range(len(rows)), [row["peer"] for row in rows])
        axes.invert_yaxis()
        axes.grid(axis="y", visible=False)
        axes.set_xlabel("milliseconds")
        axes.set_title(_titled(record))
        handles = [Patch(color=c, label=n) for n, c in _PEER_COLORS.items()]
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        figures[_file("peers", record)] = figure
    return figures


_PEER_COLORS = {
    "file to first image": _SKY,
    "first frame": _ORANGE,
    "later frames, mean": _BLUE,
}


def _peer_bars(row: dict[str, Any]) -> list[tuple[str, float]]:
    extraction = row["extraction"]["mean"] if "extraction" in row else 0.0
    values = (row["file_ms"], row["first_ms"] + extraction, row["later"]["mean"])
    return list(zip(_PEER_COLORS, values))


# ---- the paper's figures


def _draw_protocol(records: list[dict[str, Any]]) -> dict[str, Figure]:
    figures = {_file("passes", record): _passes(record) for record in records}
    figures["completeness"] = _completeness(records)
    with_explicit = [record for record in records if "left_out" not in record["explicit"]]
    if with_explicit:
        figures["active-blocks"] = _active_blocks(with_explicit)
    return figures


def _passes(record: dict[str, Any]) -> Figure:
    """Plot time and live rays per pass, with and without speculation (the paper's Figure 4)."""
    figure, (upper, lower) = _figure(7, 5, nrows=2, sharex=True)
    series = (("with", "with speculation", *_CYCLE[0]), ("without", "without", *_CYCLE[1]))
    for key, label, color, marker in series:
        rows = record["by_pass"][key]
        number_ = [row["pass"] for row in rows]
        style = {"color": color, "marker": marker, "label": label}
        upper.plot(number_, [row["ms"] for row in rows], **style)
        lower.plot(number_, [row["active_rays"] for row in rows], **style)
    upper.set_ylim(bottom=0)
    upper.set_ylabel("ms per pass")
    upper.legend()
    lower.set_yscale("log")
    lower.set_ylabel("live rays, mean of all images")
    lower.set_xlabel("pass")
    lower.xaxis.set_major_locator(MaxNLocator(integer=True))
    lower.set_xlim(left=0.5)
    upper.set_title(_titled(record))
    return figure


def _completeness(records: list[dict[str, Any]]) -> Figure:
    """Plot the completed part of the image per pass (the paper's Figure 6)."""
    figure, axes = _figure(7, 4)
    for record, (color, marker) in zip(records, _CYCLE * len(records)):
        rows = record["by_pass"]["with"]
        done = [100 * row["completed"] for row in rows]
        label = _titled(record)
        axes.plot([row["pass"] for row in rows], done, color=color, marker=marker, label=label)
    axes.set_ylim(0, 103)
    axes.set_xlabel("pass")
    axes.set_ylabel("complete pixels in %")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlim(left=0.5)
    axes.legend(loc="lower right")
    return figure


def _active_blocks(records: list[dict[str, Any]]) -> Figure:
    """Plot blocks in use beside those of explicit extraction (the paper's Figure 8)."""
    figure, axes = _figure(8, 1.2 + 0.7 * len(records))
    smallest = []
    for i, record in enumerate(records):
        active, explicit = record["active"], record["explicit"]["active_percent"]
        bars = (
            ("ProgIso", _BLUE, active["mean_percent"], active["max_percent"]),
            ("explicit extraction", _ORANGE, explicit, explicit),
        )
        for (label, color, means, largest), offset in zip(bars, (-0.19, 0.19)):
            mean, most = np.mean(means), np.max(largest)
            axes.barh(i + offset, mean, 0.34, color=color, label=label if i == 0 else None)
            axes.plot(most, i + offset, marker="|", ms=12, mew=2.5, color=_BLACK,
                      ls="none", label="largest" if i == 0 and offset > 0 else None)  # fmt: skip
            text = f"{number(mean)} %, largest {number(most)} %"
            axes.text(most * 1.1, i + offset, text, va="center", fontsize=8)
            smallest.append(mean)
    axes.set_yticks(range(len(records)), [_titled(record) for record in records])
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.set_xlim(_decade_below(smallest), 600)
    axes.set_xticks([t for t in (0.01, 0.1, 1, 10, 100) if t >= axes.get_xlim()[0]])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("active blocks in % of the volume's: mean (bar) and largest")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


# ---- error against run time


def _draw_errors(records: list[dict[str, Any]]) -> dict[str, Figure]:
    records = [record for record in records if "left_out" not in record]
    return {_file("error", record): _error_over_time(record) for record in records}


def _error_over_time(record: dict[str, Any]) -> Figure:
    figure, (upper, lower) = _figure(
        9, 7.5, nrows=2, sharex=True, gridspec_kw={"height_ratios": [2.2, 1]}
    )
    for (name, points), (color, marker) in zip(record["series"].items(), _CYCLE):
        points = [point for point in points if point["mean"] is not None]
        _draw_depth_error(upper, name, points, color, marker)
        _draw_wrong(lower, points, color, marker)
    for axes in (upper, lower):
        axes.set_xscale("log")
        axes.margins(x=0.1)
    upper.set_yscale("log")
    # Down to one wrong ray the axis is logarithmic, below it shows that there is none.
    one_ray = 100 / (record["size"][0] * record["size"][1])
    lower.set_yscale("symlog", linthresh=one_ray)
    lower.set_ylim(-0.3 * one_ray, 2 * max(lower.get_ylim()[1], one_ray))
    lower.yaxis.set_major_formatter(
        FuncFormatter(lambda value, _: "" if 0 < value < one_ray else number(value))
    )
    _log(lower.xaxis)
    _log(upper.yaxis)
    upper.set_ylabel("depth error in voxels:\nmean (marker) to 99th percentile (tick)")
    lower.set_ylabel("rays with wrong\nhit or miss in %")
    lower.set_xlabel("ms to that image")
    upper.set_title(f"{_titled(record)}, isovalue {number(record['isovalue'])}")
    handles, labels = upper.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def _draw_bounds(records: list[dict[str, Any]]) -> dict[str, Figure]:
    records = [record for record in records if "left_out" not in record]
    return {_file("bounds", record): _bounds_over_time(record) for record in records}


def _bounds_over_time(record: dict[str, Any]) -> Figure:
    """Plot depth and colour error over time, a column of panels for each view."""
    views = record["views"]
    figure, panels = _figure(12, 6.5, nrows=2, ncols=len(views), sharex="col", sharey="row")
    for view, column in zip(views, np.transpose(panels)):
        rows = {row["way"]: row for row in view["rows"] if "failed" not in row}
        for (label, ways), (color, marker) in zip(_BOUND_SERIES.items(), _CYCLE):
            chosen = [rows[way] for way in ways if way in rows]
            for axes, key in zip(column, ("mean", "color")):
                points = [(row["ms"], row[key]) for row in chosen if row[key] is not None]
                axes.plot(*np.reshape(points, (-1, 2)).T, color=color, marker=marker, label=label)
        column[0].set_title(view["view"], fontsize=10)
        for axes in column:
            axes.set_xscale("log")
            _log(axes.xaxis)
        column[1].set_xlabel("ms of a view after a move")
    panels[0, 0].set_yscale("log")
    panels[0, 0].set_ylabel("depth error in footprints, mean")
    panels[1, 0].set_ylim(bottom=0)
    panels[1, 0].set_ylabel("colour error, RMS, 0 to 255")
    figure.suptitle(f"{_titled(record)}, isovalue {number(record['isovalue'])}")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


#: The lines of a plot of bounds, by the ways at their points.
_BOUND_SERIES = {
    "Off": (EXACT,),
    "On: 0.5, 1, 2 pixels": tuple(way for way in OURS if way not in (EXACT, CONSERVATIVE)),
    "Conservative": (CONSERVATIVE,),
    "VTK: 1/4, 1, 4 voxels": tuple(THEIRS),
}


def _draw_rates(records: list[dict[str, Any]]) -> dict[str, Figure]:
    figure, (upper, lower) = _figure(8, 7, nrows=2, sharex=True)
    for record, (color, marker) in zip(records, _CYCLE):
        points = [point for point in record.get("points", []) if point["p99"]]
        name = record["field"].rsplit("-r", 1)[0]
        for axes, key, scale in ((upper, "p99", 1), (lower, "wrong", 100)):
            shown = [(point["rate"], scale * point[key]) for point in points if point[key]]
            axes.plot(*np.array(shown).reshape(-1, 2).T, color=color, marker=marker, label=name)
    for axes in (upper, lower):
        axes.set_yscale("log")
        _log(axes.yaxis)
    upper.set_ylabel("99 % of depths are off\nby less than so many voxels")
    lower.set_ylabel("rays with wrong\nhit or miss in %")
    lower.set_xlabel("bits per sample")
    upper.legend()
    return {"rates": figure}


def _draw_level_spheres(records: list[dict[str, Any]]) -> dict[str, Figure]:
    figure, axes = _figure(8, 4)
    rows = [row for record in records for row in record["spheres"]]
    largest = max(row["coarse_radius"] * 2 ** row["level"] for row in rows)
    rows = [row for row in rows if row["coarse_radius"] * 2 ** row["level"] == largest]
    names = dict.fromkeys(row["filter_name"] for row in rows)
    for name, (color, marker) in zip(names, _CYCLE):
        points = [(row["level"], row["surface"]) for row in rows if row["filter_name"] == name]
        axes.plot(*zip(*points), color=color, marker=marker, label=name)
    axes.set_ylim(bottom=0)
    axes.set_xticks(sorted({row["level"] for row in rows}))
    axes.set_xlabel("level")
    axes.set_ylabel("displacement × radius,\nin voxels of the level")
    axes.set_title(f"sphere of {number(largest)} voxels")
    axes.legend()
    return {"level_spheres": figure}


def _line(points: list[dict[str, Any]]) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Split a series into the points along one setting and those that stand alone."""
    line = [point for point in points if point["label"] != DEFAULT_DISTANCE]
    return line, [point for point in points if point["label"] == DEFAULT_DISTANCE]


def _draw_depth_error(
    axes: Axes, name: str, points: list[dict[str, Any]], color: str, marker: str
) -> None:
    line, alone = _line(points)
    axes.plot(*_xy(line, "mean"), color=color, marker=marker, label=name)
    axes.plot(*_xy(alone, "mean"), color=color, marker=marker, ls="none", mfc="white", ms=9,
              label=f"{name}, default" if alone else None)  # fmt: skip
    time, highest = _xy(points, "p99")
    axes.vlines(time, [point["mean"] for point in points], highest, color=color, lw=0.9, alpha=0.7)
    axes.plot(time, highest, color=color, marker="_", ms=7, ls="none")
    ends = zip((line[0], line[-1]), ((7, 4), (7, -10)))
    for point, offset in ends if len(line) > 1 else [(line[0], (7, 4))]:
        axes.annotate(
            point["label"], (point["ms"], point["mean"]), xytext=offset,
            textcoords="offset points", fontsize=7.5, color=color,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip


def _draw_wrong(axes: Axes, points: list[dict[str, Any]], color: str, marker: str) -> None:
    line, alone = _line(points)
    for part, style in ((line, {"ls": "--"}), (alone, {"ls": "none", "mfc": "white", "ms": 9})):
        time, wrong = _xy(part, "wrong")
        axes.plot(time, [100 * w for w in wrong], color=color, marker=marker, **style)


def _xy(points: list[dict[str, Any]], key: str) -> tuple[list[float], list[float]]:
    return [point["ms"] for point in points], [point[key] for point in points]


# ---- scaling and budgets


def _draw_image_scaling(records: list[dict[str, Any]]) -> dict[str, Figure]:
    figure, axes = _figure(7, 4)
    for record, (color, marker) in zip(records, _CYCLE * len(records)):
        points = record["points"]
        label = f"{record['field']}, exponent {number(record['exponent'])}"
        _power_series(axes, [p["pixels"] / 1e6 for p in points], points, label, color, marker)
    axes.set_xlabel("million pixels")
    axes.legend()
    return {"scaling-image": figure}


def _draw_volume_scaling(records: list[dict[str, Any]]) -> dict[str, Figure]:
    figure, axes = _figure(7, 4)
    for record, (color, marker) in zip(records, _CYCLE * len(records)):
        points = record["points"]
        surface = "growing surface" if record["grows"] else "same surface"
        label = f"{surface}, {pixels(record['size'])}, exponent {number(record['exponent'])}"
        _power_series(axes, [p["voxels"] / 1e6 for p in points], points, label, color, marker)
    axes.set_xlabel("million voxels")
    axes.legend()
    return {"scaling-volume": figure}


def _power_series(
    axes: Axes,
    x: Sequence[float],
    points: list[dict[str, Any]],
    label: str,
    color: str,
    marker: str,
) -> None:
    axes.plot(x, [p["time"]["mean"] for p in points], color=color, marker=marker, label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    _log(axes.xaxis)
    _log(axes.yaxis)
    axes.set_ylabel("ms to the complete image, mean")


def _draw_budget(records: list[dict[str, Any]]) -> dict[str, Figure]:
    figure, axes = _figure(7, 4)
    for record, (color, marker) in zip(records, _CYCLE * len(records)):
        points = record["points"]
        budget = [point["budget"] / 2**20 for point in points]
        time = [point["time"]["mean"] for point in points]
        axes.plot(budget, time, color=color, marker=marker, label=_titled(record))
    axes.set_ylim(bottom=0)
    axes.set_xscale("log")
    _log(axes.xaxis)
    axes.set_xlabel("memory budget in MiB")
    axes.set_ylabel("ms to the complete image, mean")
    axes.legend()
    return {"budget": figure}


# ---- fly-throughs and first images

_FLIGHT_COLORS = {
    Isosurface.label: _BLUE,
    BASELINE: _PINK,
    VolumeMapper.label: _ORANGE,
    Mesh.label: _GREEN,
}


def _draw_interactive(records: list[dict[str, Any]]) -> dict[str, Figure]:
    return {_file("interactive", record): _frame_times(record) for record in records}


def _frame_times(record: dict[str, Any]) -> Figure:
    """Plot the time of every frame, a panel for each movement, a line for each process."""
    figure, panels = _figure(13, 6.5, nrows=2, ncols=4, sharey=True)
    rows = [row for row in record["rows"] if "failed" not in row]
    for name, axes in zip(MOVEMENTS, panels.flat):
        for row in rows:
            frames = np.reshape(row["movements"][name]["ms"], (row["processes"], -1))
            place = (np.arange(frames.shape[1]) + 0.5) / frames.shape[1]
            for i, milliseconds in enumerate(frames):
                label = row["peer"] if i == 0 else None
                color = _FLIGHT_COLORS[row["peer"]]
                axes.plot(place, milliseconds, color=color, lw=1, marker=".", ms=3, label=label)
        axes.set_yscale("log")
        axes.set_xlim(0, 1)
        axes.set_xticks([])
        axes.set_title(name, fontsize=10)
    _log(panels[0, 0].yaxis)
    for axes in panels[:, 0]:
        axes.set_ylabel("ms of a frame")
    panels[-1, -1].axis("off")
    panels[-1, -1].legend(*panels[0, 0].get_legend_handles_labels(), loc="center")
    figure.suptitle(_titled(record))
    return figure


def _draw_first_image(records: list[dict[str, Any]]) -> dict[str, Figure]:
    return {_file("first-image", record): _way_to_the_image(record) for record in records}


def _way_to_the_image(record: dict[str, Any]) -> Figure:
    """Plot the times from opening the file on, and those of the images after."""
    rows = record["rows"]
    figure, (left, right) = _figure(
        11, 1.4 + 0.6 * len(rows), ncols=2, gridspec_kw={"width_ratios": [1.6, 1]}
    )
    parts = {"read_ms": "file read", "first_ms": "first picture", "complete_ms": "complete image"}
    labels = [f"{row['peer']}, {row['cache']} cache" for row in rows]
    for i, row in enumerate(rows):
        start = 0.0
        for (key, label), color in zip(parts.items(), (_YELLOW, _BLUE, _SKY)):
            end = row[key]["median"]
            left.barh(i, end - start, 0.6, left=start, color=color, label=None if i else label)
            start = end
        left.text(start, i, f" {number(start)}", va="center", fontsize=8)
        color, marker = _CYCLE[i % len(_CYCLE)]
        count = range(2, 2 + len(row["next_ms"]))
        right.plot(count, row["next_ms"], color=color, marker=marker, ms=4, label=labels[i])
    left.set_yticks(range(len(rows)), labels)
    left.invert_yaxis()
    left.margins(x=0.12)
    left.grid(axis="y", visible=False)
    left.set_xlabel("milliseconds from opening the file")
    left.legend(loc="upper left", bbox_to_anchor=(0.0, -0.25), ncols=3, fontsize=8)
    right.set_ylim(bottom=0)
    right.set_ylabel("ms")
    right.set_xlabel("image")
    right.xaxis.set_major_locator(MaxNLocator(integer=True))
    right.legend(loc="upper left", bbox_to_anchor=(0.0, -0.25), fontsize=8)
    figure.suptitle(_titled(record))
    return figure


# ---- long use


def _draw_soak(records: list[dict[str, Any]]) -> dict[str, Figure]:
    return {_file("soak", record): _memory_over_frames(record) for record in records}


def _memory_over_frames(record: dict[str, Any]) -> Figure:
    samples, warm_up = record["samples"], record["warm_up"]
    figure, (upper, lower) = _figure(8, 5.5, nrows=2, sharex=True)
    for axes, key, label, color in (
        (upper, "rss", "process", _BLUE),
        (lower, "peak", "mapper, most since the sample before", _SKY),
        (lower, "mapper", "mapper, at rest", _GREEN),
        (lower, "gpu", "in use, by nvidia-smi", _ORANGE),
    ):
        values = [value for value in samples[key] if value is not None]
        if values:
            axes.plot(samples["frame"], np.divide(values, 2**20), color=color, label=label)
    for axes, what in ((upper, "main memory"), (lower, "GPU memory")):
        axes.axvspan(0, warm_up, color="#eeeeee", label="warm-up")
        axes.set_ylim(bottom=0)
        axes.set_ylabel(f"{what} in MiB")
        axes.legend(loc="lower right", fontsize=8)
    lower.set_xlim(0, record["frames"])
    lower.set_xlabel("frames")
    upper.set_title(f"{_titled(record)}: memory over {record['frames']} frames")
    return figure


_DRAW = {
    "peers": _draw_peers,
    "protocol": _draw_protocol,
    "errors": _draw_errors,
    "rates": _draw_rates,
    "level_spheres": _draw_level_spheres,
    "bounds": _draw_bounds,
    "image_scaling": _draw_image_scaling,
    "volume_scaling": _draw_volume_scaling,
    "budget": _draw_budget,
    "interactive": _draw_interactive,
    "first_image": _draw_first_image,
    "soak": _draw_soak,
}
