"""Time and GPU memory over a sweep of memory budgets.

The sweep goes down from what the mapper takes by itself to little more than what it cannot do
without: the compressed stream, the value ranges and the buffers of the image.
"""

from __future__ import annotations

from .orbit import render_orbit, times
from .ours import other_bytes
from .timing import summary

#: Parts of what the mapper takes by itself beyond what it cannot do without.
PARTS = (1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125)


def measure_budget(field, settings):
    """Measure a field within smaller and smaller memory budgets.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings

    Returns
    -------
    dict
        ``free``, the point without a budget, and ``points``, each with ``budget`` and ``total`` in
        bytes, ``time`` (a `timing.summary`) and ``passes`` (mean), or ``failed`` with a reason.
    """
    free, memory = _measure(field, settings, 0)
    least = memory["compressed"] + other_bytes(memory)
    points = []
    for part in PARTS:
        budget = least + int(part * (memory["total"] - least))
        try:
            point, _ = _measure(field, settings, budget)
        except RuntimeError as error:
            point = {"failed": str(error)}
        points.append({"budget": budget, **point})
    return {**settings.heading(field), "free": free, "points": points}


def _measure(field, settings, budget):
    """The orbit's images within a budget: a point, and the memory at the end."""
    _, images = render_orbit(field, settings, memory_budget=budget)
    about = [image["statistics"] for image in images]
    point = {
        "total": max(a["memory"]["total"] for a in about),
        "time": summary(times(images)),
        "passes": sum(len(a["passes"]) for a in about) / len(about),
    }
    return point, about[-1]["memory"]
