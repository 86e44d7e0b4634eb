"""Measure time and GPU memory over a sweep of memory budgets.

The sweep goes down, by equal factors, from what the mapper takes by itself beside the compressed
stream to the least that it can work with.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .fields import Field
from .orbit import render_orbit, times
from .settings import Settings
from .timing import summary

#: Budgets of a sweep.
POINTS = 7


def measure_budget(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure a field within smaller and smaller memory budgets.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings

    Returns
    -------
    dict
        ``free``, the point without a budget, and ``points``, each with ``budget`` and ``beside``
        (GPU memory beside the compressed stream) in bytes, ``total``, ``time`` (a
        `timing.summary`) and ``passes`` (mean).
    """
    free, memory = _measure(field, settings, 0)
    least = memory["least_budget"]
    budgets = np.geomspace(max(free["beside"], least), least, POINTS).round().astype(int)
    points = [
        {"budget": int(budget), **_measure(field, settings, int(budget))[0]} for budget in budgets
    ]
    return {**settings.heading(field), "free": free, "points": points}


def _measure(
    field: Field, settings: Settings, budget: int
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Render the orbit within a budget; return a point, and the memory at the end."""
    _, images = render_orbit(field, settings, memory_budget=budget)
    about = [image["statistics"] for image in images]
    memories = [a["memory"] for a in about]
    point = {
        "beside": max(memory["total"] - memory["compressed"] for memory in memories),
        "total": max(memory["total"] for memory in memories),
        "time": summary(times(images)),
        "passes": sum(len(a["passes"]) for a in about) / len(about),
    }
    return point, memories[-1]
