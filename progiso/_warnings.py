"""Warnings that point at the line of the user's program."""

from __future__ import annotations

import sys
import warnings


def warn_user(message: str) -> None:
    """Warn at the line that called into progiso, from however deep within."""
    level, frame = 1, sys._getframe(0)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("progiso."):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, stacklevel=level)
