"""Measure cold images, small moves and first passes.

Cold, of a view
    The cache is emptied, so that nothing of the volume is decoded, and the complete image is
    rendered.
Moved
    Then the camera moves by 2 degrees about the focal point, sideways on a great circle, and the
    complete image is rendered again.
First pass
    As cold, but the time until the first partial image is drawn: one pass, its hits shaded. A
    small volume, of which all is decoded when it is loaded, needs one pass for any image; its
    cache is not emptied for that, which would load it again.
"""

from __future__ import annotations

from typing import Any

from ..measure.isosurface import Isosurface
from ..measure.view import turned
from .fields import Field, compressed
from .settings import Settings
from .timing import summary

#: Degrees of a small move.
MOVE = 2.0


def measure_latency(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure cold images, small moves and first passes of a field.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        All positions are seen at the first isovalue.

    Returns
    -------
    dict
        ``cold``, ``moved`` and ``first_pass``, each a `timing.summary`.
    """
    image, isovalue = compressed(field), settings.isovalues_of(field)[0]
    cameras = settings.cameras(image)
    view = Isosurface(image, isovalue, settings.size)
    view.warm_up(cameras[-1])
    for camera in cameras:  # lets the cache grow
        view.render_from(camera)
    cold, moved, first = [], [], []
    for camera in cameras * settings.repeat:
        view.mapper.EmptyCache()
        cold.append(view.render_from(camera))
        moved.append(view.render_from(turned(camera, MOVE)))
    view.set_passes_per_render(1)
    cached = view.statistics()["memory"]["buffers"].get("cache_map", 0) > 0
    for camera in cameras * settings.repeat:
        if cached:
            view.mapper.EmptyCache()
        first.append(view.render_from(camera))
    view.close()
    return {
        **settings.heading(field),
        "isovalues": [isovalue],
        "cold": summary(cold),
        "moved": summary(moved),
        "first_pass": summary(first),
    }
