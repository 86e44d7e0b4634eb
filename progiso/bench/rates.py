"""Measure what a rate costs: errors of samples and depths, wrong rays, topology.

All is held against the uncompressed samples: depths against the double-precision caster, the
topology of FlyingEdges' mesh against that of the mesh without compression.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..compression import decompress
from ..geometry import samples_of
from ..io import compress
from ..measure.agreement import depth_error
from ..measure.isosurface import Isosurface
from ..measure.topology import topology
from ..oracle.caster import Cast
from .errors import cast_uncompressed, of_one_image
from .fields import Field, plain
from .settings import Settings

#: Bits per sample.
RATES = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 24.0, 32.0)


def measure_rates(
    field: Field, settings: Settings, rates: Sequence[float] = RATES
) -> dict[str, Any]:
    """Measure what the rates make of one image of a field, and of its surface.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        The image is that of the first isovalue from the first position.
    rates : sequence of float
        Bits per sample.

    Returns
    -------
    dict
        ``isovalue``, ``range`` (of the samples), ``hits`` of the caster, ``topology`` without
        compression, and ``points``, each with ``rate``, ``max_error`` and ``rms_error`` of the
        samples, `depth_error`'s figures and `topology`'s. With ``left_out`` there is no image.
    """
    return of_one_image(field, settings, lambda: _measure(field, settings, rates))


def _measure(field: Field, settings: Settings, rates: Sequence[float]) -> dict[str, Any]:
    image, isovalue = plain(field), settings.isovalues_of(field)[0]
    expected = cast_uncompressed(field, settings)
    values = samples_of(image)
    return {
        "isovalue": isovalue,
        "range": [float(values.min()), float(values.max())],
        "hits": int(np.isfinite(expected.depth).sum()),
        "topology": topology(image, isovalue),
        "points": [_point(image, isovalue, settings, expected, rate) for rate in rates],
    }


def _point(
    image: vtkImageData, isovalue: float, settings: Settings, expected: Cast, rate: float
) -> dict[str, Any]:
    volume = compress(image, rate=rate)
    view = Isosurface(volume, isovalue, settings.size)
    view.render_from(settings.cameras(image)[0])
    depth = view.depth()
    view.close()
    decoded = decompress(volume)
    return {
        "rate": rate,
        **_sample_errors(samples_of(decoded), samples_of(image)),
        **depth_error(depth, expected.depth, expected.voxels),
        **topology(decoded, isovalue),
    }


def _sample_errors(decoded: np.ndarray, values: np.ndarray) -> dict[str, float]:
    """Compute the largest and the root mean square error of the samples, slice by slice."""
    largest, squares = 0.0, 0.0
    for ours, theirs in zip(decoded, values):
        off = np.abs(ours - theirs.astype(float))
        largest, squares = max(largest, float(off.max())), squares + float(np.square(off).sum())
    return {"max_error": largest, "rms_error": float(np.sqrt(squares / values.size))}
