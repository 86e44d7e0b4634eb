"""Render a volume from an orbit of cameras at every isovalue, as most figures need."""

from __future__ import annotations

from typing import Any

from ..measure.isosurface import Isosurface
from .fields import Field, compressed
from .settings import Settings


def render_orbit(
    field: Field, settings: Settings, **options: Any
) -> tuple[float, list[dict[str, Any]]]:
    """Render a field at every isovalue from every position of the orbit, in a new window.

    Before that one image is rendered and not counted, on a GPU for a second: it uploads the volume,
    compiles the shaders and wakes the GPU up. From then on the block cache lives on from image to
    image.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
    **options
        Of `ours.Isosurface`.

    Returns
    -------
    first : float
        Milliseconds of the image that is not counted.
    images : list of dict
        Of every other image ``ms``, and ``statistics`` (see `progiso.statistics`).
    """
    image, isovalues = compressed(field), settings.isovalues_of(field)
    cameras = settings.cameras(image)
    view = Isosurface(image, isovalues[0], settings.size, **options)
    first = view.warm_up(cameras[-1])
    images = []
    for isovalue in isovalues * settings.repeat:
        view.set_isovalue(isovalue)
        for camera in cameras:
            milliseconds = view.render_from(camera)
            images.append({"ms": milliseconds, "statistics": view.statistics()})
    view.close()
    return first, images


def times(images: list[dict[str, Any]]) -> list[float]:
    """Return the milliseconds of the images of `render_orbit`."""
    return [image["ms"] for image in images]
