"""Judge measured figures by the project's goals.

Every function takes measured figures and returns a `Verdict`, or None where no goal is set for
that machine (see `machine.describe_machine`), field (its name, or its number of voxels) or image
size (width and height in pixels). Times are in milliseconds, memory is in bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..measure.text import bytes_, milliseconds, number
from .literature import GPU, SOFTWARE, literature

HD = (1280, 720)
PAPERS_LARGEST = (2048, 2048, 1920)

#: Milliseconds on an NVIDIA H200 at 1280x720.
COMPLETE_MS, COMPLETE_LARGEST_MS, FIRST_PASS_MS, FILE_MS = 10.0, 20.0, 3.0, 2000.0

#: How many times faster than the paper's implementation: as published, and with its sort replaced.
FASTER_THAN_PAPER = {GPU: (50.0, 10.0), SOFTWARE: (10.0, 1.0)}

#: Largest ratio of a move of two degrees to the cold image; exponent of time over voxels; GPU
#: memory beside stream and cache, per block and per pixel; and its ratio to VTK's mapper's.
MOVED, EXPONENT, BYTES_PER_BLOCK, BYTES_PER_PIXEL, MEMORY = 0.5, 0.15, 3, 40, 0.1

#: Bytes that memory may grow by in a thousand frames: of the process, whose heap fragments and
#: whose driver caches; of the GPU, whose driver rounds to MiB; of the mapper, which counts exactly.
GROWTH = {"rss": 2**20, "gpu": 2**20, "mapper": 0}

#: Part of the cores that other processes may keep busy during a measurement.
QUIET = 0.05

#: Samples from which on a volume counts as large.
LARGE = 1024**3

#: Largest ratio to commit 9de4cd9 of an image's median time on a GPU at 1280x720, by movement and
#: field, and of its processor time without a GPU.
AGAINST_BASELINE = {
    "next view": {
        "gyroid-256-": 0.65,
        "gyroid-512-": 0.65,
        "gyroid-1024-k24-r4": 0.5,
        "gyroid-1024-k6-r2": 0.5,
        "gyroid-2048x2048x1920-k6-": 0.5,
    },
    "moved by 2°": {"gyroid-256-": 0.65, "gyroid-512-": 0.65, "gyroid-1024-": 0.5},
}
CPU_AGAINST_BASELINE = 0.6

#: Movements of a fly-through, in which VTK's mapper must be slower and no frame may take long: so
#: many times the median, and milliseconds.
SMOOTH = ("orbit", "dolly in", "dolly out", "far view", "isovalue sweep")
HITCH, HITCH_MS = 3.0, 33.0

#: The movement in which VTK's mapper may be faster.
_FAR = "far view"

#: Milliseconds from opening a file to a picture in a process whose driver has compiled nothing, by
#: the beginning of the field's name; from that limit to the complete image; and how many times the
#: time of a process whose shaders are compiled the next images may take.
FIRST_PICTURE_MS = {"gyroid-256-": 500.0, "gyroid-1024-": 1200.0}
COMPLETE_AFTER_MS, NEXT_IMAGES = 500.0, 1.25

#: Prefixes of the names of fields that must be faster than VTK's mapper without a GPU.
FASTER_WITHOUT_GPU = ("ct-cranium-", "mri-brain-", "gyroid-256-k6-")


@dataclass(frozen=True)
class Verdict:
    """A figure beside its goal.

    Attributes
    ----------
    what : str
        What is judged.
    measured, goal : str
        The figure, and what it shall be.
    met : bool
    timed : bool, default: True
        Whether times are judged, which other processes disturb.
    """

    what: str
    measured: str
    goal: str
    met: bool
    timed: bool = True


def machine_kind(machine: dict[str, Any]) -> str | None:
    """Return `literature.GPU` or `SOFTWARE`; None for a machine that has no goals of its own.

    Parameters
    ----------
    machine : dict
        See `machine.describe_machine`.
    """
    if "NVIDIA" in machine["gl"]:
        return GPU
    return SOFTWARE if "llvmpipe" in machine["gl"] and machine["cores"] <= 2 else None


def is_busy(machine: dict[str, Any], record: dict[str, Any]) -> bool:
    """Tell whether others kept the machine so busy that a record's times tell little.

    Parameters
    ----------
    machine : dict
    record : dict
        With ``others_cores``, the cores that were busy for others (None where unknown).
    """
    return (record["others_cores"] or 0.0) > QUIET * machine["cores"]


def _at_most(
    what: str,
    value: float,
    limit: float,
    show: Callable[[float], str],
    note: str = "",
    timed: bool = True,
) -> Verdict:
    return Verdict(what, show(value), f"≤ {show(limit)}{note}", value <= limit, timed)


def _on_gpu(machine: dict[str, Any], size: Sequence[int]) -> bool:
    return machine_kind(machine) == GPU and tuple(size) == HD


def complete_image(
    machine: dict[str, Any], size: Sequence[int], voxels: int, mean_ms: float
) -> Verdict | None:
    """Judge the mean time of a complete image."""
    if not _on_gpu(machine, size):
        return None
    largest = PAPERS_LARGEST[0] * PAPERS_LARGEST[1] * PAPERS_LARGEST[2]
    limit = COMPLETE_LARGEST_MS if voxels >= largest else COMPLETE_MS
    return _at_most("complete image, mean", mean_ms, limit, milliseconds, f" ({GPU})")


def first_pass(machine: dict[str, Any], size: Sequence[int], mean_ms: float) -> Verdict | None:
    """Judge the mean time to the first partial image."""
    if not _on_gpu(machine, size):
        return None
    return _at_most("first pass, mean", mean_ms, FIRST_PASS_MS, milliseconds, f" ({GPU})")


def file_to_image(machine: dict[str, Any], size: Sequence[int], ms: float) -> Verdict | None:
    """Judge the time from a file to the first image."""
    if not _on_gpu(machine, size):
        return None
    return _at_most("file to first image", ms, FILE_MS, milliseconds, f" ({GPU})")


def moved(cold_ms: float, moved_ms: float) -> Verdict:
    """Judge the mean time after a move of two degrees against that of the cold image."""
    limit = MOVED * cold_ms
    goal = f"≤ half of cold ({milliseconds(limit)})"
    return Verdict("move by 2°", milliseconds(moved_ms), goal, moved_ms <= limit)


def time_exponent(value: float | None) -> Verdict | None:
    """Judge the exponent of time over voxels; None without one."""
    return (
        None if value is None else _at_most("time over voxels, exponent", value, EXPONENT, number)
    )


def per_block(value: float | None) -> Verdict | None:
    """Judge the bytes of GPU memory per block beside its stream; None without a figure."""
    if value is None:
        return None
    return _at_most("GPU bytes per block", value, BYTES_PER_BLOCK, number, timed=False)


def per_pixel(value: float | None) -> Verdict | None:
    """Judge the bytes of GPU memory per pixel; None without a figure."""
    if value is None:
        return None
    return _at_most("GPU bytes per pixel", value, BYTES_PER_PIXEL, number, timed=False)


def beside_payload(memory: dict[str, Any]) -> Verdict:
    """Judge the memory beside stream and cache, of `protocol.measure_protocol`."""
    limit = BYTES_PER_BLOCK * memory["blocks"] + BYTES_PER_PIXEL * memory["pixels"]
    note = f" ({BYTES_PER_BLOCK} a block, {BYTES_PER_PIXEL} a pixel)"
    what = "GPU memory beside payload and cache"
    return _at_most(what, memory["other_max"], limit, bytes_, note, timed=False)


def within_budget(beside: int, budget: int) -> Verdict:
    """Judge the GPU memory beside the compressed stream by the budget that was set."""
    return _at_most("GPU memory beside the stream", beside, budget, bytes_, timed=False)


def memory_growth(what: str, key: str, bytes_per_frame: float | None) -> Verdict | None:
    """Judge the growth of memory, see `soak.measure_soak`; None without a figure."""
    if bytes_per_frame is None:
        return None
    grown, limit = 1000 * bytes_per_frame, GROWTH[key]
    note = " in 1000 frames"
    return Verdict(what, bytes_(grown), f"≤ {bytes_(limit)}{note}", grown <= limit, timed=False)


def no_gl_errors(count: int) -> Verdict:
    """Judge the number of OpenGL errors of a long run."""
    return Verdict("OpenGL errors", str(count), "none", count == 0, timed=False)


def against_mapper(
    machine: dict[str, Any],
    size: Sequence[int],
    field: str,
    voxels: int,
    ours_ms: float,
    mapper_ms: float,
) -> Verdict | None:
    """Judge the mean time of complete images by that of VTK's mapper."""
    kind = machine_kind(machine)
    without_gpu = kind == SOFTWARE and field.startswith(FASTER_WITHOUT_GPU)
    large = kind == GPU and voxels >= LARGE
    if tuple(size) != HD or not (without_gpu or large):
        return None
    what, limit = "complete image, against VTK's mapper", milliseconds(mapper_ms)
    return Verdict(what, milliseconds(ours_ms), f"< VTK's mapper ({limit})", ours_ms < mapper_ms)


def memory_against_mapper(
    machine: dict[str, Any], voxels: int, ours_bytes: int, mapper_bytes: int
) -> Verdict | None:
    """Judge the largest GPU memory by that with VTK's mapper."""
    if machine_kind(machine) != GPU or voxels < LARGE:
        return None
    limit = MEMORY * mapper_bytes
    goal = f"≤ a tenth of VTK's mapper ({bytes_(limit)})"
    return Verdict("GPU memory", bytes_(ours_bytes), goal, ours_bytes <= limit, timed=False)


def against_paper(
    machine: dict[str, Any], field: str, size: Sequence[int], mean_ms: float
) -> list[Verdict]:
    """Judge the mean time of a complete image by the paper's implementation and its variant."""
    kind = machine_kind(machine)
    figure = literature(kind, field, size)
    if kind is None or figure is None:
        return []
    variants = ("the paper's implementation", "the same with its sort replaced")
    times = zip(variants, (figure.ms, figure.strong_ms), FASTER_THAN_PAPER[kind])
    return [
        Verdict(
            f"complete image, against {variant}",
            f"{number(theirs / mean_ms)} times as fast",
            f"≥ {number(factor)} times as fast as {variant} ({kind})",
            theirs >= factor * mean_ms,
        )
        for variant, theirs, factor in times
        if theirs is not None
    ]


def error_against_mapper(
    field: str, ours: Sequence[dict[str, Any]], mapper: dict[str, Any]
) -> Verdict | None:
    """Judge whether some rate is faster than VTK's mapper at no larger mean depth error.

    Parameters
    ----------
    field : str
    ours : sequence of dict
        The points of the rates, see `errors.measure_errors`.
    mapper : dict
        The point of VTK's default sample distance.
    """
    if not field.startswith(FASTER_WITHOUT_GPU):
        return None
    good = [p for p in ours if p["mean"] is not None and p["mean"] <= mapper["mean"]]
    best = min(good, key=lambda point: point["ms"], default=None)
    if best is None:
        measured = "no rate is as exact"
    else:
        measured = f"{milliseconds(best['ms'])}, {number(best['mean'])} voxels at {best['label']}"
    goal = f"< {milliseconds(mapper['ms'])}, ≤ {number(mapper['mean'])} voxels (VTK's mapper)"
    what = "time at equal or smaller depth error"
    return Verdict(what, measured, goal, best is not None and best["ms"] < mapper["ms"])


# ---- fly-throughs and first images


def _ratios(ours: dict[str, Any], theirs: dict[str, Any], *keys: str) -> list[float]:
    """Divide our times by theirs."""
    return [ours[key] / theirs[key] for key in keys]


def _by_prefix(limits: dict[str, float], field: str) -> float | None:
    """Return the limit of the fields whose names begin so."""
    return next((limit for prefix, limit in limits.items() if field.startswith(prefix)), None)


def movement_against_mapper(
    machine: dict[str, Any],
    field: str,
    movement: str,
    ours: dict[str, Any],
    theirs: dict[str, Any],
) -> Verdict | None:
    """Judge the frames of a movement by those of VTK's mapper.

    Parameters
    ----------
    machine : dict
    field, movement : str
    ours, theirs : dict
        The `timing.summary` of the frames.
    """
    kind, what = machine_kind(machine), f"{movement}, against VTK's mapper"
    if kind == SOFTWARE and field.startswith(FASTER_WITHOUT_GPU) and movement == "next view":
        keys, names = ["median"], "median"
    elif kind == GPU and movement in SMOOTH and movement != _FAR:
        keys, names = ["median", "p95", "max"], "median, 95 % and largest"
    else:
        return None
    ratios = _ratios(ours, theirs, *keys)
    measured = f"{' / '.join(map(number, ratios))} ×"
    return Verdict(what, measured, f"< 1 × the mapper's {names}", max(ratios) < 1)


def movement_against_baseline(
    machine: dict[str, Any],
    field: str,
    size: Sequence[int],
    movement: str,
    ours: dict[str, Any],
    theirs: dict[str, Any],
) -> Verdict | None:
    """Judge the frames of a movement by those of the earlier commit, in the same run.

    Parameters
    ----------
    machine : dict
    field : str
    size : sequence of int
    movement : str
    ours, theirs : dict
        ``time`` and ``cpu_ms`` of the frames, see `interactive`.
    """
    kind, timed = machine_kind(machine), True
    if kind == SOFTWARE and field.startswith(FASTER_WITHOUT_GPU) and movement == "next view":
        timed = False  # others hardly change the processor's time
        ratio, what, limit = ours["cpu_ms"] / theirs["cpu_ms"], "CPU time", CPU_AGAINST_BASELINE
    elif kind == GPU and tuple(size) == HD:
        (ratio,) = _ratios(ours["time"], theirs["time"], "median")
        found = _by_prefix(AGAINST_BASELINE.get(movement, {}), field)
        if found is None:
            return None
        what, limit = "median", found
    else:
        return None
    goal = f"≤ {number(limit)} × the baseline's {what}"
    what = f"{movement}, against the baseline"
    return Verdict(what, f"{number(ratio)} ×", goal, ratio <= limit, timed)


def no_hitch(machine: dict[str, Any], movement: str, ours: dict[str, Any]) -> Verdict | None:
    """Judge the longest frame of a movement, of its `timing.summary`."""
    if machine_kind(machine) != GPU or movement not in SMOOTH:
        return None
    limit = min(HITCH * ours["median"], HITCH_MS)
    goal = f"≤ {number(HITCH)} × the median and {milliseconds(HITCH_MS)}"
    return Verdict(
        f"{movement}, longest frame", milliseconds(ours["max"]), goal, ours["max"] <= limit
    )


def first_picture(
    machine: dict[str, Any], field: str, size: Sequence[int], row: dict[str, Any]
) -> list[Verdict]:
    """Judge the way to a first image where the driver has compiled nothing, see `first_image`."""
    limit = _by_prefix(FIRST_PICTURE_MS, field)
    if not _on_gpu(machine, size) or limit is None:
        return []
    whole, first, complete = limit + COMPLETE_AFTER_MS, row["first_ms"], row["complete_ms"]
    return [
        _at_most("first picture, median", first["median"], limit, milliseconds),
        _at_most("complete image, median", complete["median"], whole, milliseconds),
    ]


def next_images(
    machine: dict[str, Any], emptied: dict[str, Any], kept: dict[str, Any]
) -> Verdict | None:
    """Judge the images after the first one by those of a process whose shaders were compiled."""
    if machine_kind(machine) != GPU:
        return None
    (ratio,) = _ratios(emptied["next"], kept["next"], "median")
    goal = f"≤ {number(NEXT_IMAGES)} × those with compiled shaders"
    return Verdict("next images, median", f"{number(ratio)} ×", goal, ratio <= NEXT_IMAGES)
