"""GIPL (``.gipl``, ``.gipl.gz``): 256 bytes of header, then samples, the first byte the highest."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np

from .header_text import checked_geometry
from .source import Description, Selection
from .stored import Layout, StoredSource

_HEADER_BYTES = 256
_MAGIC = (719555000, 4026526128)
_DTYPES = {7: "i1", 8: "u1", 15: "i2", 16: "u2", 31: "u4", 32: "i4", 64: "f4", 65: "f8"}


def open_gipl(path: Path, selection: Selection) -> StoredSource:
    """Open a GIPL image, whose world is left-posterior-superior, as ITK takes it.

    The header is our own to read, as ITK's reader reads all samples at once.
    """
    with open(path, "rb") as file:
        packed = file.read(2) == b"\x1f\x8b"
    with gzip.open(path) if packed else open(path, "rb") as file:
        header = file.read(_HEADER_BYTES)
    if len(header) < _HEADER_BYTES or int.from_bytes(header[252:], "big") not in _MAGIC:
        raise ValueError(f"'{path}' is not a GIPL image")
    width, height, depth, times = (int(n) for n in np.frombuffer(header, ">u2", 4))
    kind = int.from_bytes(header[8:10], "big")
    if kind not in _DTYPES:
        raise ValueError(f"'{path}' has the unsupported GIPL type {kind}")
    layout = Layout(
        files=(path,),
        shape=(max(1, depth), height, width),
        dtype=np.dtype(_DTYPES[kind]).newbyteorder(">"),
        encoding="gzip" if packed else "raw",
        offset=0 if packed else _HEADER_BYTES,
        skipped_bytes=_HEADER_BYTES if packed else 0,
        volumes=max(1, times),
    )
    spacing = np.frombuffer(header, ">f4", 3, offset=10).astype(float)
    spacing[spacing == 0] = 1  # of a slice's third axis
    about = Description(
        what=str(path),
        shape=layout.shape,
        dtype=layout.dtype.newbyteorder("="),
        name=path.name.partition(".")[0],
        geometry=checked_geometry(
            path, np.diag(spacing), np.frombuffer(header, ">f8", 3, offset=204), space="LPS"
        ),
    )
    return StoredSource(about, layout, selection)
