"""NRRD (``.nrrd``, ``.nhdr``): gzip, bzip2, raw and text encodings, with orientation.

VTK's own reader supports neither compression nor ``space directions``.
"""

from __future__ import annotations

import bz2
import gzip
import re
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO, Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, FilePath
from ..geometry import image_from_array, set_axes
from .slab_files import SlabFile, gunzipped, opened_at

#: The header's fields, keys in lower case.
_Fields = dict[str, str]

#: A vector, or None of an axis that has no direction.
_Axis = list[float] | None

_TYPES = {
    "int8": "signed char|int8|int8_t",
    "uint8": "uchar|unsigned char|uint8|uint8_t",
    "int16": "short|short int|signed short|signed short int|int16|int16_t",
    "uint16": "ushort|unsigned short|unsigned short int|uint16|uint16_t",
    "int32": "int|signed int|int32|int32_t",
    "uint32": "uint|unsigned int|uint32|uint32_t",
    "int64": "longlong|long long|long long int|signed long long|int64|int64_t",
    "uint64": "ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t",
    "float32": "float",
    "float64": "double",
}
_DTYPES = {name: dtype for dtype, names in _TYPES.items() for name in names.split("|")}
_DECODERS: dict[str, Callable[[bytes], bytes]] = {
    "raw": bytes,
    "gzip": gzip.decompress,
    "gz": gzip.decompress,
    "bzip2": bz2.decompress,
    "bz2": bz2.decompress,
}
_UNPACKERS: dict[str, Callable[[IO[bytes]], Any]] = {
    "gzip": gunzipped,
    "gz": gunzipped,
    "bzip2": bz2.BZ2File,
    "bz2": bz2.BZ2File,
}


def read_nrrd(path: FilePath) -> vtkImageData:
    """Read a three-dimensional NRRD, of one or more components per sample.

    Parameters
    ----------
    path : str or os.PathLike
        A ``.nrrd`` file, or a ``.nhdr`` header with its data in one file beside it.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        In the file's own world coordinates (its ``space``).

    Raises
    ------
    ValueError
        When the header is malformed or a field has an unsupported value.
    """
    path = Path(path)
    with open(path, "rb") as file:
        fields = _header(file, path)
        sizes, dtype = _layout(fields, path)
        raw = _encoded(file, fields, path)
    values = _decode(raw, fields, dtype, int(np.prod(sizes, dtype=object)), path)
    components, dimensions, vectors = _axes(fields, sizes, path)
    image = image_from_array(values, dimensions, name=path.stem, components=components)
    _place(image, fields, vectors)
    return image


def nrrd_slabs(path: FilePath) -> SlabFile | None:
    """Open a NRRD to be read some slices at a time; errors as in `read_nrrd`.

    Returns
    -------
    SlabFile or None
        None when its samples are text, or compressed and counted from the end.
    """
    path = Path(path)
    with open(path, "rb") as file:
        fields = _header(file, path)
        sizes, dtype = _layout(fields, path)
        data, offset = _data_file(fields, path), file.tell()
    components, dimensions, vectors = _axes(fields, sizes, path)
    encoding, skip = fields["encoding"].lower(), int(fields.get("byte skip", 0))
    if encoding not in _DECODERS or (encoding != "raw" and skip == -1):
        return None
    offset = _behind_lines(data or path, 0 if data else offset, int(fields.get("line skip", 0)))
    if encoding == "raw":
        bytes_held = int(np.prod(sizes, dtype=object)) * dtype.itemsize
        opener = opened_at(data or path, -bytes_held if skip == -1 else offset + skip)
    else:
        opener = opened_at(data or path, offset, wrap=_UNPACKERS[encoding], skip=skip)

    def place(image: vtkImageData) -> None:
        _place(image, fields, vectors)

    return SlabFile(
        path, path.stem, dimensions, dtype, open=opener, place=place, components=components
    )


def _behind_lines(path: Path, offset: int, lines: int) -> int:
    """Return the offset in a file that lies some lines behind another."""
    with open(path, "rb") as file:
        file.seek(offset)
        for _ in range(lines):
            file.readline()
        return file.tell()


def _axes(fields: _Fields, sizes: Sequence[int], path: Path) -> tuple[int, Dimensions, list[_Axis]]:
    """Return a sample's components, the samples along x, y and z, and their vectors, if any."""
    vectors = _vectors(fields.get("space directions", ""))
    *components, width, height, depth = sizes
    if not components:
        return 1, (width, height, depth), vectors
    # samples of several values: their axis comes first and has no direction
    if vectors and vectors[0] is not None:
        raise ValueError(f"'{path}': only a first axis of components is supported, not {sizes}")
    return components[0], (width, height, depth), vectors[1:]


def _header(file: IO[bytes], path: Path) -> _Fields:
    """Read the fields up to the blank line; the file is left at the data."""
    if not file.readline(64).startswith(b"NRRD"):
        raise ValueError(f"'{path}' is not a NRRD file")
    fields: _Fields = {}
    for line in iter(lambda: file.readline(65536).decode("latin-1").strip(), ""):
        key, separator, value = line.partition(":")
        if separator and not line.startswith("#") and not value.startswith("="):
            fields[key.strip().lower()] = value.strip()
    return fields


def _layout(fields: _Fields, path: Path) -> tuple[list[int], np.dtype[Any]]:
    """Return the sizes, fastest axis first, and the sample type with its byte order."""
    missing = [key for key in ("type", "dimension", "sizes", "encoding") if key not in fields]
    if missing:
        raise ValueError(f"'{path}' lacks the NRRD field '{missing[0]}'")
    sizes = [int(size) for size in fields["sizes"].split()]
    if len(sizes) != int(fields["dimension"]) or len(sizes) not in (3, 4):
        raise ValueError(f"'{path}' is not a three-dimensional image: sizes {fields['sizes']}")
    if fields["type"] not in _DTYPES:
        raise ValueError(f"'{path}' has the unsupported NRRD type '{fields['type']}'")
    big = fields.get("endian", "little") == "big"
    return sizes, np.dtype(_DTYPES[fields["type"]]).newbyteorder(">" if big else "<")


def _encoded(file: IO[bytes], fields: _Fields, path: Path) -> bytes:
    """Read the encoded samples, from behind the header or from the detached file."""
    detached = _data_file(fields, path)
    return file.read() if detached is None else detached.read_bytes()


def _data_file(fields: _Fields, path: Path) -> Path | None:
    """Return the file that holds the samples, or None when they follow the header."""
    detached = fields.get("data file", fields.get("datafile"))
    if detached is None:
        return None
    if detached.startswith("LIST") or "%" in detached:
        raise ValueError(f"'{path}': data in several files is not supported")
    return path.parent / detached


def _decode(raw: bytes, fields: _Fields, dtype: np.dtype[Any], count: int, path: Path) -> Array:
    """Decode the samples, in native byte order."""
    encoding = fields["encoding"].lower()
    for _ in range(int(fields.get("line skip", 0))):
        raw = raw[raw.index(b"\n") + 1 :]
    if encoding in ("txt", "text", "ascii"):
        return np.array(raw.split(), dtype.newbyteorder("="))
    if encoding not in _DECODERS:
        raise ValueError(f"'{path}' has the unsupported NRRD encoding '{encoding}'")
    try:
        raw = _DECODERS[encoding](raw)
    except (OSError, EOFError, ValueError, zlib.error) as error:
        raise ValueError(f"'{path}' is damaged: {error}") from None
    skip = int(fields.get("byte skip", 0))
    raw = raw[-count * dtype.itemsize :] if skip == -1 else raw[skip:]
    if len(raw) < count * dtype.itemsize:
        raise ValueError(f"'{path}' is truncated: {len(raw)} of {count * dtype.itemsize} bytes")
    values = np.frombuffer(raw, dtype, count)
    return values.astype(dtype.newbyteorder("="), copy=False)


def _vectors(text: str) -> list[_Axis]:
    """Parse "(1,0,0) none (0,0,1)" into vectors and None."""
    words = re.findall(r"none|\([^)]*\)", text)
    return [None if w == "none" else [float(v) for v in w[1:-1].split(",")] for w in words]


def _place(image: vtkImageData, fields: _Fields, vectors: list[_Axis]) -> None:
    """Set the geometry from space directions, or else from plain spacings."""
    origin: list[Any] = _vectors(fields.get("space origin", "")) or [[0.0, 0.0, 0.0]]
    if len(vectors) == 3 and all(v is not None and len(v) == 3 for v in vectors):
        set_axes(image, np.array(vectors).T, origin[0])
        return
    spacings = [float(s) for s in fields.get("spacings", "").split()][-3:]
    if len(spacings) == 3 and np.isfinite(spacings).all():
        set_axes(image, np.diag(spacings), origin[0])
