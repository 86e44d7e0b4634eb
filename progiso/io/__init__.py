"""Volumes in files: `read` and `save` by suffix, `compress_file` and `compress_slabs` some slices at a time."""

from .slabs import compress_slabs
from .volumes import compress_file, read, save

__all__ = ["compress_file", "compress_slabs", "read", "save"]
