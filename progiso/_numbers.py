"""Numbers as users have them: Python's, NumPy's, decimal ones, and arrays without axes."""

from __future__ import annotations

import math
from decimal import Decimal
from numbers import Real
from typing import Any

import numpy as np


def is_number(given: Any) -> bool:
    """Tell whether something is one real number.

    Also decimals, and arrays of NumPy, xarray and others that have no axes, are.

    Examples
    --------
    >>> is_number(np.array(6)), is_number(Decimal("0.5")), is_number("6"), is_number([6])
    (True, True, False, False)
    """
    if isinstance(given, (Real, Decimal)):
        return True
    if isinstance(given, (str, bytes)) or getattr(given, "shape", None) != ():
        return False
    return np.asarray(given).dtype.kind in "biuf"


def finite_list(name: str, given: Any) -> list[float]:
    """Return one number or several as a list of floats; errors as of `finite`.

    Examples
    --------
    >>> finite_list("isovalue", 6), finite_list("isovalue", (Decimal(1), 2))
    ([6.0], [1.0, 2.0])
    """
    try:
        several = [given] if is_number(given) or isinstance(given, (str, bytes)) else list(given)
    except TypeError:
        several = [given]
    return [finite(name, one) for one in several]


def finite(name: str, given: Any) -> float:
    """Return a finite number as a float.

    Raises
    ------
    TypeError
        When it is no number; the message has the name.
    ValueError
        When it is infinite or NaN.

    Examples
    --------
    >>> finite("isovalue", np.array(6))
    6.0
    """
    if not is_number(given):
        raise TypeError(f"{name} must be a finite number, got {given!r}")
    value = float(given)
    if not math.isfinite(value):
        raise ValueError(f"{name} must be a finite number, got {value:g}")
    return value
