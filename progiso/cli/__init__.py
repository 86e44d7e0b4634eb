"""The command line: ``python -m progiso COMMAND``; see its ``--help``."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from typing import Any

from .parser import make_parser

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    arguments : sequence of str, optional
        By default those of the process.

    Returns
    -------
    int
        Exit status: 0, 1 when the command failed, 130 when it was interrupted. Wrong usage exits
        with 2 from within.

    Examples
    --------
    >>> main(["data", "sphere", "--size", "16"])  # doctest: +ELLIPSIS
    /.../progiso/sphere_16x16x16_float32.raw
    0
    """
    parsed = make_parser().parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _print_note  # type: ignore[assignment]
            parsed.run(parsed)
    except (OSError, ValueError, RuntimeError, TypeError, ImportError, MemoryError) as error:
        message = " ".join(str(error).split()) or type(error).__name__
        print(f"progiso: error: {message}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("progiso: interrupted", file=sys.stderr)
        return 130
    return 0


def _print_note(message: Warning | str, *_where: Any) -> None:
    """Print a warning without the line of Python that it comes from."""
    print(f"progiso: note: {' '.join(str(message).split())}", file=sys.stderr)
