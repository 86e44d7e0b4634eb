"""Check values and isovalues at the ends of what numbers can hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np

from ..io import compress
from ..isosurface import make_isosurface
from ..measure import tolerances
from ..oracle import caster
from .case import Case, Outcome, Settings, worst_of
from .fields import blobs, coordinates, make_image, noise
from .scene import RATE, Picture, check_depths, check_views, compressed, decoded

_SHAPE = (24, 20, 28)
_NOISE = tolerances.GRAZING_FRACTION_NOISE


def _scaled(scale: float, settings: Settings) -> Outcome:
    values = (blobs(_SHAPE, 9).astype(float) * scale).astype(np.float32)
    return check_views(settings, compressed(values), [0.1 * scale, -0.3 * scale])


def _in_units(offset: float, scale: float, kind: type[np.number], settings: Settings) -> Outcome:
    """Render values that float32 cannot hold; the caster has them in double precision."""
    field = blobs(_SHAPE, 9).astype(float)
    values = offset + scale * field
    if np.issubdtype(kind, np.integer):
        values = np.round(values)
    values = values.astype(kind)
    image = compressed(values)
    # what double precision, or the type, has left of the field
    volume = caster.Volume.from_image((values.astype(float) - offset) / scale, image)
    return worst_of(
        check_depths(settings, image, isovalue, volume=volume, level=(isovalue - offset) / scale)
        for isovalue in (offset + scale * 0.1003, offset - scale * 0.3002)
    )


def _largest(settings: Settings) -> Outcome:
    """Render white noise up to the largest float32; differences exceed it."""
    values = noise(_SHAPE, 12)
    values = (values * (3.3e38 / np.abs(values).max())).astype(np.float32)
    return check_views(settings, compressed(values), (0.0, 1e38, -2e38), grazing=_NOISE)


def _integers(kind: str, settings: Settings) -> Outcome:
    """Render white noise over the whole range of an integer type."""
    about = np.iinfo(kind)
    values = np.random.default_rng(13).integers(about.min, about.max, _SHAPE, kind, endpoint=True)
    middle = (float(about.min) + float(about.max)) / 2
    reach = float(about.max) - middle
    image = compressed(values)
    return check_views(settings, image, (middle, middle + 0.9 * reach), grazing=_NOISE)


def _whole(isovalue: float, settings: Settings, **more: Any) -> Outcome:
    """Render whole values: edges and plateaus lie at the isovalue exactly."""
    values = np.clip(np.round(blobs((24, 20, 28), 10) + 1), 0, 2).astype(np.float32)
    return check_depths(settings, compressed(values), isovalue, grazing=1.0, **more)


def _outside(settings: Settings) -> Outcome:
    image = compressed(blobs(_SHAPE, 9))
    return check_views(settings, image, (100.0, -100.0, 1e300, -1e300), hits=False)


def _constant(settings: Settings) -> Outcome:
    image = compressed(np.full((12, 12, 12), 3.0))
    return check_views(settings, image, (2.9, 3.0, 3.1), hits=False, grazing=1.0)


def _negative_zero(settings: Settings) -> Outcome:
    """Render zeros of either sign at isovalue zero: they are inside."""
    values = np.minimum(blobs(_SHAPE, 14), -0.0).astype(np.float32)
    signs = np.random.default_rng(15).choice([-0.0, 0.0], values.shape)
    values = np.where(values == 0, signs, values).astype(np.float32)
    return check_depths(settings, compressed(values), 0.0, grazing=1.0)


def _digits(settings: Settings) -> Outcome:
    """Render an isovalue between two float32 values, which must not be rounded to one."""
    values = np.float32(1000) + 2.0**-14 * np.round(64 * blobs(_SHAPE, 9))
    return check_depths(settings, compressed(values.astype(np.float32)), 1000 + 2.0**-14 * 4.5)


# --- what is refused ------------------------------------------------------------------------------


def _refused(attempt: Callable[[], object], *texts: str) -> Outcome:
    """Check that an attempt raises one error that names all of `texts`."""
    start = perf_counter()
    try:
        attempt()
    except (RuntimeError, ValueError) as error:
        message = str(error)
    else:
        message = ""
    milliseconds = 1e3 * (perf_counter() - start)
    named = bool(message) and all(text in message for text in texts)
    note = f"says: {message}" if message else "no error came"
    return Outcome(0.0 if named else 1.0, 0.0, milliseconds, "faults", note)


def _not_finite(_settings: Settings) -> Outcome:
    values = noise(_SHAPE, 16)
    values.flat[[3, 77, 1000]] = np.nan
    values.flat[[5, 99]] = np.inf, -np.inf
    return _refused(
        lambda: compress(make_image(values), rate=RATE, mask_nan=False), "3 NaN", "2 infinite"
    )


def _no_isovalue(_settings: Settings) -> Outcome:
    image = compressed(blobs(_SHAPE, 9))
    return _refused(lambda: make_isosurface(image, float("nan")), "finite")


def _no_isovalue_later(settings: Settings) -> Outcome:
    """Set an isovalue of NaN at the property, past Python's checks."""
    view = Picture(compressed(blobs(_SHAPE, 9)), 0.1, settings.size)
    view.set_isovalue(float("nan"))
    try:
        return _refused(view.render, "isovalue")
    finally:
        view.close()


def _hidden(cached: bool, settings: Settings) -> Outcome:
    """Render NaN in a ball and here and there: only cells of numbers have a surface."""
    shape = (26, 31, 29)
    place = np.stack(coordinates(shape), axis=-1)
    hole = np.linalg.norm(place - (20.0, 12.0, 11.0), axis=-1) < 8
    hole |= np.random.default_rng(19).random(shape) < 0.02
    values = np.where(hole, np.nan, blobs(shape, 3)).astype(np.float32)
    image = compress(make_image(values), rate=RATE, mask_nan=True)
    cells = np.zeros(np.array(shape) - 1, bool)
    for corner in np.ndindex(2, 2, 2):
        cells |= hole[tuple(slice(c, n - 1 + c) for c, n in zip(corner, shape))]
    volume = replace(decoded(image), hidden=cells)
    return check_views(settings, image, (0.15, -0.2), volume=volume, cached=cached)


CASES = (
    Case("values of 1e-28", partial(_scaled, 1e-28)),
    Case("values of 1e30", partial(_scaled, 1e30)),
    Case("values up to the largest float32", _largest),
    Case("values of 1e-30", partial(_in_units, 0.0, 1e-30, np.float32)),
    Case("denormal values, 1e-40", partial(_in_units, 0.0, 1e-40, np.float32)),
    Case("values of 1e-300", partial(_in_units, 0.0, 1e-300, np.float64), quick=False),
    Case("values of 1e300", partial(_in_units, 0.0, 1e300, np.float64)),
    Case("1e8 + 1e-3 f", partial(_in_units, 1e8, 1e-3, np.float64)),
    Case("-1e12 + f", partial(_in_units, -1e12, 1.0, np.float64), quick=False),
    Case("1e9 + 500 f, int32", partial(_in_units, 1e9, 500.0, np.int32), quick=False),
    Case("300 + f, doubles", partial(_in_units, 300.0, 1.0, np.float64), quick=False),
    *(
        Case(f"{kind}, the whole range", partial(_integers, kind), kind in ("int8", "uint64"))
        for kind in ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64")
    ),
    Case("zeros of either sign at isovalue 0", _negative_zero),
    Case("isovalue equal to voxels", partial(_whole, 1.0)),
    Case("isovalue equal to the maximum", partial(_whole, 2.0)),
    Case("isovalue equal to the minimum", partial(_whole, 0.0, hits=False)),
    Case("isovalue outside of the range", _outside),
    Case("isovalue between two float32 values", _digits),
    Case("constant volume", _constant, quick=False),
    Case("isovalue NaN", _no_isovalue),
    Case("isovalue NaN, at the property", _no_isovalue_later),
    Case("values NaN and infinite", _not_finite),
    Case("values NaN, hidden", partial(_hidden, False)),
    Case("values NaN, hidden, pass by pass", partial(_hidden, True), quick=False),
)
