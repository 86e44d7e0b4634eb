"""Measure time over image size and over volume size.

A series of volumes is one gyroid sampled more and more finely: with the same surface at every size
(k fixed), and with one that grows with the volume (k in proportion to the side). The images' size
is fixed. The exponent is that of the power law that fits the mean times best, by least squares of
the logarithms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..measure.isosurface import other_bytes
from .fields import Field, TooLarge
from .orbit import render_orbit, times
from .settings import Settings
from .timing import summary

#: Samples along x, y and z; the last is the paper's largest volume.
VOLUME_SIZES = (*((n, n, n) for n in (64, 128, 256, 512, 1024)), (2048, 2048, 1920))

#: Periods per side where the surface is the same, and samples per period where it grows.
FIXED_K, SAMPLES_PER_PERIOD = 6.0, 128 / 3

#: Bits per sample.
RATE = 2.0


def measure_image_scaling(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure a field at several image sizes.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        Its `images` are measured.

    Returns
    -------
    dict
        ``points``, each with ``size``, ``pixels``, ``time`` and ``other_bytes`` (beside payload
        and cache); ``exponent`` of time over pixels; ``bytes_per_pixel``, the slope of
        ``other_bytes``. The latter two are None with fewer than two points.
    """
    points = []
    for size in settings.images:
        figures = _measure(field, replace(settings, size=size))
        points.append({"size": list(size), "pixels": size[0] * size[1], **figures})
    pixels = [point["pixels"] for point in points]
    return {
        **settings.heading(field),
        "points": points,
        "exponent": exponent(pixels, [point["time"]["mean"] for point in points]),
        "bytes_per_pixel": slope(pixels, [point["other_bytes"] for point in points]),
    }


def measure_volume_scaling(
    grows: bool, settings: Settings, sizes: Sequence[tuple[int, int, int]] = VOLUME_SIZES
) -> dict[str, Any]:
    """Measure the gyroid at several sizes.

    Parameters
    ----------
    grows : bool
        Whether the surface grows with the volume.
    settings : settings.Settings
        Volumes with a side above its `largest` are left out.
    sizes : sequence of tuple of int
        Samples along x, y and z.

    Returns
    -------
    dict
        ``grows``, ``points``, each with ``field``, ``voxels``, ``blocks``, ``time`` and
        ``other_bytes`` (beside payload and cache); ``exponent`` of time over voxels;
        ``bytes_per_block``, the slope of ``other_bytes``; ``left_out``: {field: reason}.
    """
    points, left_out = [], {}
    fields = [_gyroid(dimensions, grows) for dimensions in sizes]
    for field in fields:
        if settings.largest is not None and max(field.dimensions) > settings.largest:
            left_out[field.name] = f"larger than {settings.largest}"
            continue
        try:
            figures = _measure(field, settings)
        except TooLarge as error:
            left_out[field.name] = str(error)
            continue
        about = {"field": field.name, "voxels": field.voxels, "blocks": field.blocks}
        points.append({**about, **figures})
    heading = settings.heading(fields[0])
    means = [point["time"]["mean"] for point in points]
    return {
        **{key: value for key, value in heading.items() if key != "field"},
        "grows": grows,
        "points": points,
        "exponent": exponent([point["voxels"] for point in points], means),
        "bytes_per_block": slope(
            [point["blocks"] for point in points], [point["other_bytes"] for point in points]
        ),
        "left_out": left_out,
    }


def _gyroid(dimensions: tuple[int, int, int], grows: bool) -> Field:
    k = round(max(dimensions) / SAMPLES_PER_PERIOD, 2) if grows else FIXED_K
    return Field("gyroid", dimensions, RATE, k)


def _measure(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure the orbit's times, and GPU memory beside stream and cache."""
    _, images = render_orbit(field, settings)
    memory = images[-1]["statistics"]["memory"]
    return {"time": summary(times(images)), "other_bytes": other_bytes(memory)}


def exponent(x: Sequence[float], y: Sequence[float]) -> float | None:
    """Return the exponent of the power law that fits best.

    Parameters
    ----------
    x, y : sequence of float
        Positive.

    Returns
    -------
    float or None
        None with fewer than two points.

    Examples
    --------
    >>> round(exponent([1, 2, 4], [3, 12, 48]), 6)
    2.0
    """
    if len(x) < 2:
        return None
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def slope(x: Sequence[float], y: Sequence[float]) -> float | None:
    """Return the slope of the line that fits best.

    Parameters
    ----------
    x, y : sequence of float

    Returns
    -------
    float or None
        None with fewer than two points.
    """
    return float(np.polyfit(x, y, 1)[0]) if len(x) > 1 else None
