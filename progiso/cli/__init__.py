"""The command line: ``python -m progiso COMMAND``; see its ``--help``."""

from .commands import main

__all__ = ["main"]
