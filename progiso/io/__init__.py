"""Volumes in files, one module a format; `formats` has the table of them."""

from .formats import open_source
from .slabs import compress_slabs
from .source import Selection, Source
from .volumes import compress_file, read, save

__all__ = ["Selection", "Source", "compress_file", "compress_slabs", "open_source", "read", "save"]
