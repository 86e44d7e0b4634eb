"""Volumes in files, one module a format; `formats` has the table of them."""

from .arrays import source_of
from .compressing import compress, compress_file
from .formats import open_source
from .slabs import compress_slabs
from .source import Selection, Source
from .volumes import read, save

__all__ = [
    "Selection",
    "Source",
    "compress",
    "compress_file",
    "compress_slabs",
    "open_source",
    "read",
    "save",
    "source_of",
]
