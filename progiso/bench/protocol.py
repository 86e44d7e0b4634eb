"""Run the paper's evaluation (section 5): random isovalues from an orbit of cameras.

Three runs over the same images (see `orbit`), one after the other: for the times, with nothing
else measured; for the counts of blocks; and without speculation.
"""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..geometry import samples_of
from ..measure.isosurface import cache_bytes, other_bytes, stage_times
from ..measure.machine import available_bytes
from .explicit import BLOCK_BYTES, BlockRanges, measure_mesh
from .fields import Field, decompressed, gib
from .orbit import render_orbit, times
from .settings import Settings
from .timing import summary

#: How many isovalues meshes are made of, at most; they are evenly chosen.
MESHES = 5

#: Bytes of hit, depth, normal, ray, and the window's colour and depth.
_BYTES_PER_PIXEL = 32

#: Main memory that extraction may take, in volumes of float32 samples.
_EXTRACTION_VOLUMES = 2.5


def measure_protocol(field: Field, settings: Settings) -> dict[str, Any]:
    """Run the protocol on a field.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings

    Returns
    -------
    dict
        ``first_ms``, ``time`` (a `timing.summary`), ``table2``, ``memory``, ``by_pass`` (``with``
        and ``without`` speculation), ``time_without`` speculation, ``active``, ``stage_ms``,
        ``moved_bytes`` and ``explicit``.
    """
    first, timed = render_orbit(field, settings)
    once = replace(settings, repeat=1)
    _, counted = render_orbit(field, once, detailed=True)
    _, without = render_orbit(field, once, speculation=False)
    counts = [image["statistics"] for image in counted]
    return {
        **settings.heading(field),
        "first_ms": first,
        "time": summary(times(timed)),
        "table2": _table2(counts, field.blocks, settings.size),
        "memory": _memory([image["statistics"]["memory"] for image in timed], field, settings),
        "by_pass": {"with": _by_pass(timed), "without": _by_pass(without)},
        "time_without": summary(times(without)),
        "active": _active(counts, field.blocks),
        "stage_ms": _stages(counts),
        "moved_bytes": _moved_bytes(counts, field.rate, settings.size),
        "explicit": _measure_explicit(field, settings),
    }


def _passes(images: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [one for image in images for one in image["passes"]]


def _table2(images: list[dict[str, Any]], blocks: int, size: tuple[int, int]) -> dict[str, float]:
    """Compute the columns of the paper's Table 2."""
    passes, pixels = _passes(images), size[0] * size[1]
    speculation = [p["speculation"] for p in passes]
    return {
        "passes_median": statistics.median(len(image["passes"]) for image in images),
        "visible_percent": _mean([100 * p["visible_blocks"] / blocks for p in passes]),
        "speculation_median": statistics.median(speculation) if speculation else 0,
        "utilisation_percent": _mean([100 * p["pairs"] / pixels for p in passes]),
    }


def _mean(values: Sequence[float]) -> float:
    return statistics.fmean(values) if values else 0.0


def _memory(memories: list[dict[str, Any]], field: Field, settings: Settings) -> dict[str, Any]:
    """Summarize the mapper's memory: means over the images, and the largest."""
    totals = [memory["total"] for memory in memories]
    return {
        "total_mean": _mean(totals),
        "total_max": max(totals),
        "cache_mean": _mean([cache_bytes(memory) for memory in memories]),
        "compressed": memories[0]["compressed"],
        "other_max": max(other_bytes(memory) for memory in memories),
        "blocks": field.blocks,
        "pixels": settings.size[0] * settings.size[1],
    }


def _by_pass(images: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Average by pass number: time over the images that have such a pass, the rest over all."""
    passes = [image["statistics"]["passes"] for image in images]
    longest = max(len(series) for series in passes)
    rows = []
    for i in range(longest):
        present = [series[: i + 1] for series in passes if len(series) > i]
        rays = sum(series[i]["active_rays"] for series in present)
        done = [series[i]["completed"] if len(series) > i else 1.0 for series in passes]
        rows.append(
            {
                "pass": i + 1,
                "images": len(present),
                "ms": _mean([_elapsed(series) for series in present]),
                "active_rays": rays / len(passes),
                "completed": _mean(done),
            }
        )
    return rows


def _elapsed(series: list[dict[str, Any]]) -> float:
    """Return the milliseconds of the last of some passes."""
    before = series[-2]["elapsed_ms"] if len(series) > 1 else 0.0
    return series[-1]["elapsed_ms"] - before


def _stages(images: list[dict[str, Any]]) -> dict[str, float]:
    """Average the milliseconds of an image's stages over all images."""
    shares = [stage_times(image) for image in images]
    names = dict.fromkeys(name for share in shares for name in share)
    return {name: sum(share.get(name, 0.0) for share in shares) / len(shares) for name in names}


def _moved_bytes(images: list[dict[str, Any]], rate: float, size: tuple[int, int]) -> float:
    """The least that an image has to move, on average: what is decoded is read compressed and
    written as float32, what is intersected is read once a pass, and a pixel is written by the
    stages (`_BYTES_PER_PIXEL`).
    """
    passes = _passes(images)
    decoded = sum(p["decoded_blocks"] for p in passes) * (8 * rate + BLOCK_BYTES)
    intersected = sum(p["active_blocks"] for p in passes) * BLOCK_BYTES
    return (decoded + intersected) / len(images) + _BYTES_PER_PIXEL * size[0] * size[1]


def _active(images: list[dict[str, Any]], blocks: int) -> dict[str, list[float]]:
    """Compute each image's active blocks in percent: mean and largest over its passes."""
    shares = [[100 * p["active_blocks"] / blocks for p in image["passes"]] for image in images]
    return {
        "mean_percent": [_mean(series) for series in shares],
        "max_percent": [max(series, default=0.0) for series in shares],
    }


def _measure_explicit(field: Field, settings: Settings) -> dict[str, Any]:
    """Count the blocks that explicit extraction decodes, and make meshes at some isovalues."""
    if settings.no_mesh_of(field):
        return {"left_out": settings.no_mesh_of(field)}
    needed, available = int(_EXTRACTION_VOLUMES * 4 * field.voxels), available_bytes()
    if needed > available:
        reason = f"extraction takes {gib(needed)} of main memory, {gib(available)} are available"
        return {"left_out": reason}
    image = decompressed(field)
    isovalues = settings.isovalues_of(field)
    ranges = BlockRanges(samples_of(image))
    counts = [ranges.count(isovalue) for isovalue in isovalues]
    chosen = np.unique(np.linspace(0, len(isovalues) - 1, MESHES).round().astype(int))
    return {
        "active_percent": [100 * c["active"] / c["blocks"] for c in counts],
        "held_percent": [100 * c["held"] / c["blocks"] for c in counts],
        "cache_mean": _mean([BLOCK_BYTES * c["active"] for c in counts]),
        "meshes": [measure_mesh(image, isovalues[i]) for i in chosen],
    }
