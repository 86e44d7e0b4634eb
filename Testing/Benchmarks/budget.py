"""Time and GPU memory over a sweep of memory budgets.

The sweep goes down from what the mapper takes by itself to little more than what it cannot do
without: the compressed stream, the value ranges and the buffers of the image.
"""

from __future__ import annotations

from .fields import compressed
from .ours import Isosurface, other_bytes
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
    """Times of the orbit's images at every isovalue, after one that is not counted; memory."""
    image, isovalues = compressed(field), settings.isovalues_of(field)
    cameras = settings.cameras(image)
    view = Isosurface(image, isovalues[0], settings.size, memory_budget=budget)
    view.render_from(cameras[-1])
    times, passes, total = [], [], 0
    for isovalue in isovalues:
        view.set_isovalue(isovalue)
        for camera in cameras * settings.repeat:
            times.append(view.render_from(camera))
            about = view.statistics()
            passes.append(len(about["passes"]))
            total = max(total, about["memory"]["total"])
    view.close()
    point = {"total": total, "time": summary(times), "passes": sum(passes) / len(passes)}
    return point, about["memory"]
