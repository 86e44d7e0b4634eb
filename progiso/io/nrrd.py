"""NRRD (``.nrrd``, ``.nhdr``): all encodings, one file or several, with orientation."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from .header_text import (
    LONGEST_HEADER,
    checked_geometry,
    data_file,
    decode,
    integers,
    misspelt_fields,
    numbered_files,
    reals,
    shortened,
)
from .source import SPACES, Description, Geometry, Selection
from .stored import Layout, StoredSource

_TYPES = {
    "int8": "signed char|int8|int8_t",
    "uint8": "uchar|unsigned char|uint8|uint8_t",
    "int16": "short|short int|signed short|signed short int|int16|int16_t",
    "uint16": "ushort|unsigned short|unsigned short int|uint16|uint16_t",
    "int32": "int|signed int|int32|int32_t",
    "uint32": "uint|unsigned int|uint32|uint32_t",
    "int64": "longlong|long long|long long int|signed long long|signed long long int|int64|int64_t",
    "uint64": "ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t",
    "float32": "float",
    "float64": "double",
}
_DTYPES = {name: dtype for dtype, names in _TYPES.items() for name in names.split("|")}
_ENCODINGS = {
    "raw": "raw",
    **dict.fromkeys(("txt", "text", "ascii"), "text"),
    "hex": "hex",
    **dict.fromkeys(("gz", "gzip"), "gzip"),
    **dict.fromkeys(("bz2", "bzip2"), "bzip2"),
}

#: Fields of the format, without the blanks that some of them may have.
_KNOWN = set(
    """number content dimension type blocksize encoding endian min max oldmin oldmax datafile
    lineskip byteskip sampleunits sizes spacings thicknesses axismins axismaxs centers centerings
    labels units kinds space spacedimension spaceunits spaceorigin spacedirections
    measurementframe""".split()
)

_SPACES = {
    "right-anterior-superior": "RAS",
    "left-anterior-superior": "LAS",
    "left-posterior-superior": "LPS",
}

#: Kinds of axes along which samples have components (and not time points).
_COMPONENT_KINDS = re.compile(
    r"(list|vector|point|covariant-vector|normal|stub|scalar|complex|quaternion|[23]-vector"
    r"|[34]-color|3-gradient|3-normal|4-vector|(rgb|hsv|xyz|rgba)-color|.*matrix)",
)


def open_nrrd(path: Path, selection: Selection) -> StoredSource:
    """Open a NRRD (``.nrrd``, ``.nhdr``) of three axes of samples, or two.

    One axis more may come first or last: of components, or of time points. The header is our own to
    read, as ITK's reader and pynrrd read all samples at once.
    """
    header = _Header(path)
    sizes = header.sizes()
    vectors = header.vectors("spacedirections", len(sizes))
    first, last = _other_axes(path, header, sizes, vectors)
    inner = slice(1 if first else 0, len(sizes) - (1 if last else 0))
    width, height, depth = (*sizes[inner], 1)[:3]
    planar = bool(last) and _COMPONENT_KINDS.fullmatch(header.kind(-1)) is not None
    components = sizes[0] if first else sizes[-1] if planar else 1
    files, offset = header.data_files(sizes)
    layout = Layout(
        files=tuple(files),
        shape=(depth, height, width),
        dtype=header.dtype(),
        encoding=header.encoding(),
        offset=offset,
        skipped_lines=header.skip("lineskip"),
        skipped_bytes=header.skip("byteskip"),
        components=components,
        planar=planar,
        volumes=sizes[-1] if last and not planar else 1,
    )
    about = Description(
        what=str(path),
        shape=layout.shape,
        dtype=layout.dtype.newbyteorder("="),
        name=path.stem,
        geometry=_geometry(path, header, len(sizes), inner, vectors),
        labels=True if any(k.startswith("Segment0_") for k in header.pairs) else None,
        notes=misspelt_fields(header.fields, _KNOWN),
    )
    return StoredSource(about, layout, selection)


class _Header:
    """A header's fields: names in lower case and without blanks, as some may have one or not."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.fields: dict[str, str] = {}
        self.pairs: dict[str, str] = {}
        with open(path, "rb") as file:
            if not file.readline(64).startswith(b"NRRD"):
                raise ValueError(f"'{path}' is not a NRRD file")
            for line in iter(lambda: decode(file.readline(2**16)).strip(), ""):
                if file.tell() > LONGEST_HEADER:
                    raise ValueError(f"'{path}' has no end of its header")
                self._add(line)
                if self.fields.get("datafile", "").split()[:1] == ["LIST"]:
                    break
            self.length = file.tell()
            listed = [decode(line).strip() for line in file.read(LONGEST_HEADER).splitlines()]
        self.listed = [line for line in listed if line] if "datafile" in self.fields else []

    def _add(self, line: str) -> None:
        if line.startswith("#"):
            return
        key, separator, value = line.partition(":")
        if value.startswith("="):
            self.pairs[key] = value[1:]
        elif separator:
            self.fields[re.sub(r"[\s_]", "", key).lower()] = value.strip()

    def needed(self, key: str) -> str:
        if key not in self.fields:
            raise ValueError(f"'{self.path}' lacks the NRRD field '{key}'")
        return self.fields[key]

    def sizes(self) -> list[int]:
        """Return the samples along each axis, the fastest first."""
        (count,) = integers(self.path, "dimension", self.needed("dimension"), 1)
        sizes = integers(self.path, "sizes", self.needed("sizes"), count)
        if not 2 <= count <= 5:
            raise ValueError(f"'{self.path}' is no volume: its dimension is {count}")
        if min(sizes) < 1:
            raise ValueError(f"'{self.path}' holds no samples: sizes {self.fields['sizes']}")
        return sizes

    def dtype(self) -> np.dtype[Any]:
        """Return the samples' type with their byte order."""
        kind = " ".join(self.needed("type").lower().split())
        if kind not in _DTYPES:
            raise ValueError(f"'{self.path}' has the unsupported NRRD type '{shortened(kind)}'")
        endian = self.fields.get("endian", "little").lower()
        if endian not in ("little", "big"):
            raise ValueError(
                f"'{self.path}': the field 'endian' must be little or big, it is "
                f"'{shortened(endian)}'"
            )
        return np.dtype(_DTYPES[kind]).newbyteorder(">" if endian == "big" else "<")

    def encoding(self) -> str:
        name = self.needed("encoding").lower()
        if name not in _ENCODINGS:
            raise ValueError(f"'{self.path}' has the unsupported NRRD encoding '{shortened(name)}'")
        return _ENCODINGS[name]

    def skip(self, key: str) -> int:
        (count,) = integers(self.path, key, self.fields.get(key, "0"), 1)
        if count < (-1 if key == "byteskip" else 0):
            raise ValueError(f"'{self.path}': the field '{key}' is {count}")
        return count

    def kind(self, axis: int) -> str:
        """Return what the field "kinds" says of an axis, in lower case."""
        kinds = self.fields.get("kinds", "").lower().split()
        return kinds[axis] if kinds else ""

    def words(self, key: str, count: int) -> list[str]:
        """Return a field of one word for each axis; empty where there is no such field."""
        words = self.fields.get(key, "").split()
        if words and len(words) != count:
            raise ValueError(
                f"'{self.path}': the field '{key}' must have {count} words, it is "
                f"'{shortened(self.fields[key])}'"
            )
        return words

    def vectors(self, key: str, count: int) -> list[list[float] | None]:
        """Return a field of vectors, "(1,0,0) none (0,0,1)"; empty where there is none."""
        text = self.fields.get(key, "")
        found = re.findall(r"none|\([^()]*\)", text)
        if text and (len(found) != count or re.sub(r"none|\([^()]*\)|\s", "", text)):
            raise ValueError(
                f"'{self.path}': the field '{key}' must be {count} vectors, it is "
                f"'{shortened(text)}'"
            )
        return [
            None if v == "none" else reals(self.path, key, v[1:-1].replace(",", " ")) for v in found
        ]

    def data_files(self, sizes: list[int]) -> tuple[list[Path], int]:
        """Return the files with the samples, and how many bytes come first in them."""
        name = self.fields.get("datafile")
        if name is None:
            return [self.path], self.length
        words = name.split()
        if words[:1] == ["LIST"]:
            if not self.listed:
                raise ValueError(f"'{self.path}' lists no data files")
            return [data_file(self.path, line) for line in self.listed], 0
        if len(words) in (4, 5) and "%" in words[0]:
            first, last, step = integers(self.path, "data file", " ".join(words[1:4]), 3)
            return numbered_files(self.path, words[0], first, last, step), 0
        return [data_file(self.path, name)], 0


def _other_axes(
    path: Path, header: _Header, sizes: list[int], vectors: list[list[float] | None]
) -> tuple[bool, bool]:
    """Tell whether the first axis and the last one are not of space."""
    count = len(sizes)
    kinds = [k.lower() for k in header.words("kinds", count)]
    if any(vectors):
        others = [i for i, v in enumerate(vectors) if v is None]
    else:
        others = [i for i, k in enumerate(kinds) if k not in ("domain", "space", "none", "???")]
    if not others and count > 3:  # all kinds alike: few values first are components
        others = [0, 4] if count == 5 else [0] if sizes[0] <= 4 and not any(vectors) else [3]
    if not set(others) <= {0, count - 1} or count - len(others) not in (2, 3):
        raise ValueError(
            f"'{path}': of {count} axes, {sizes}, three must be of space, one more may come first "
            "and one last; its kinds or space directions say otherwise"
        )
    return 0 in others, count - 1 in others


def _geometry(
    path: Path, header: _Header, count: int, inner: slice, vectors: list[list[float] | None]
) -> Geometry:
    """Return the place of the axes of space."""
    given = [v for v in vectors[inner] if v is not None]
    used = len(range(count)[inner])
    (origin,) = header.vectors("spaceorigin", 1) or [None]
    if origin is not None and not used <= len(origin) <= 4:
        raise ValueError(f"'{path}': its space origin {origin} is no place of {used} axes")
    axes, start = np.eye(3), np.zeros(3)
    if len(given) == used and all(used <= len(v) <= 4 for v in given):
        for axis, vector in enumerate(given):
            axes[:, axis] = _padded(vector)
        if used == 2:
            normal = np.cross(axes[:, 0], axes[:, 1])
            axes[:, 2] = normal / (np.linalg.norm(normal) or 1)
    else:
        steps, start = _spacings(header, count, inner)
        axes = np.diag(steps)
    return checked_geometry(
        path,
        axes,
        start if origin is None else _padded(origin),
        units=_units(header),
        space=_space(header),
    )


def _padded(vector: list[float]) -> list[float]:
    """Return the three numbers of a vector in space, of which time may be a fourth."""
    return [*vector, 0.0][:3]


def _space(header: _Header) -> str | None:
    name = header.fields.get("space", "").lower()
    known = _SPACES.get(name.removesuffix("-time"), name)
    short = known.upper().removesuffix("T")
    return short if short in SPACES else known or None


def _units(header: _Header) -> str | None:
    text = header.fields.get("spaceunits", header.fields.get("units", ""))
    units = [u for u in re.findall(r'"([^"]*)"', text) if u]
    return units[0] if units else None


def _spacings(header: _Header, count: int, inner: slice) -> tuple[np.ndarray, np.ndarray]:
    """Return the steps along the axes of space, and the first samples' places."""
    steps, start = np.ones(3), np.zeros(3)
    for key, target in (("spacings", steps), ("axismins", start)):
        words = header.words(key, count)
        if words:
            values = np.array(reals(header.path, key, " ".join(words)))[inner]
            usable = np.isfinite(values) & ((values != 0) | (key != "spacings"))
            target[: len(values)][usable] = values[usable]
            if key == "axismins":  # samples are in the middle of cells unless the header says node
                centers = header.fields.get("centers", header.fields.get("centerings", "")).split()
                cells = np.array([c.lower() != "node" for c in centers or ["cell"] * count])[inner]
                target[: len(values)] += np.where(usable & cells, steps[: len(values)] / 2, 0)
    return steps, start
