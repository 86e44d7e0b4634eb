"""Summarize a series of times."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from typing import Any

import numpy as np


def summary(milliseconds: Sequence[float]) -> dict[str, Any]:
    """Compute median, mean, 95th percentile and extremes of times.

    Parameters
    ----------
    milliseconds : sequence of float
        At least one.

    Returns
    -------
    dict
        ``count``, ``mean``, ``median``, ``p95``, ``min`` and ``max``.

    Examples
    --------
    >>> summary([1.0, 2.0, 6.0])["mean"]
    3.0
    """
    return {
        "count": len(milliseconds),
        "mean": statistics.fmean(milliseconds),
        "median": statistics.median(milliseconds),
        "p95": float(np.percentile(milliseconds, 95)),
        "min": min(milliseconds),
        "max": max(milliseconds),
    }
