"""Volumes in files, one module a format; `volumes` has the table of formats."""

from .slabs import compress_slabs
from .volumes import compress_file, read, save

__all__ = ["compress_file", "compress_slabs", "read", "save"]
