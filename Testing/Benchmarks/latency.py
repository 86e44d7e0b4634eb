"""First images and small moves of a view.

Cold, of a view
    A new mapper renders the complete image from the opposite side of the orbit. That uploads the
    volume, compiles the shaders and leaves the opposite side's blocks in the cache. Then it
    renders the complete image from the view: this is the cold time.
Moved
    Then the camera moves by 2 degrees about the focal point, sideways on a great circle, and the
    complete image is rendered again.
First pass
    As cold, but the time until the first partial image is drawn: one pass, its hits shaded.
"""

from __future__ import annotations

from .fields import compressed
from .ours import Isosurface
from .timing import summary
from .view import opposite, turned

#: Degrees of a small move.
MOVE = 2.0


def measure_latency(field, settings):
    """Measure first images and small moves of a field.

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
    cold, moved, first = [], [], []
    for camera in settings.cameras(image) * settings.repeat:
        view = _seen_from_behind(image, isovalue, camera, settings.size)
        cold.append(view.render_from(camera))
        moved.append(view.render_from(turned(camera, MOVE)))
        view.close()
        view = _seen_from_behind(image, isovalue, camera, settings.size)
        view.set_passes_per_render(1)
        first.append(view.render_from(camera))
        view.close()
    return {
        **settings.heading(field),
        "isovalues": [isovalue],
        "cold": summary(cold),
        "moved": summary(moved),
        "first_pass": summary(first),
    }


def _seen_from_behind(image, isovalue, camera, size):
    """A new view that has rendered the opposite side."""
    view = Isosurface(image, isovalue, size)
    view.render_from(opposite(camera))
    return view
