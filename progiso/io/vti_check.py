"""A look at a VTK XML file's arrays before VTK reads them, where VTK would crash.

VTK's reader writes as many strings as the data hold into an array of as many as the header tells,
and ends the process where a packed block announces more bytes than there is memory.
"""

from __future__ import annotations

import base64
import math
import mmap
import re
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Literal, TypeAlias

_ATTRIBUTE = re.compile(rb'(\w+)\s*=\s*"([^"]*)"')

#: How many times its size a packed file may hold; zlib and LZ4 reach less, LZMA on constant data.
_EXPANSION = 10000

#: Points that any file may announce, as one without arrays does, and points along an axis.
_MODEST, _LONGEST = 2**33, 2**28

_Order: TypeAlias = Literal["little", "big"]

#: What counts lengths in binary data: the file's ``header_type``.
_COUNTERS = {b"UInt32": 4, b"UInt64": 8}


def check_vti(path: Path) -> None:
    """Raise where strings are more than told, or packed data announce what they cannot hold.

    Raises
    ------
    ValueError
        The message names the file and the array.
    """
    if path.stat().st_size == 0:
        raise ValueError(f"'{path}' is empty")
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        end = data.find(b"<AppendedData")
        start = _start_of_appended(data)
        if end >= 0 and data[start - 1 : start] != b"_":
            raise ValueError(f"'{path}' is damaged: its appended data do not begin with '_'")
        end = len(data) if end < 0 else end
        root = _attributes(data, data.find(b"<VTKFile"))
        extent = _attributes(data, data.find(b"<ImageData", 0, end)).get(b"WholeExtent", b"")
        if not _may_be_there(extent, len(data)):
            raise ValueError(f"'{path}' is damaged: its extent is {extent.decode()}")
        for start in _tags(data, end):
            wrong = _wrong_with(data, start, _attributes(data, start), root)
            if wrong:
                raise ValueError(f"'{path}' is damaged: its {wrong}")


def _wrong_with(
    data: mmap.mmap, start: int, about: dict[bytes, bytes], root: dict[bytes, bytes]
) -> str | None:
    """Tell what is wrong with the array whose tag begins at a place, or None."""
    name, told = about.get(b"Name", b"").decode(errors="replace"), _told(about)
    if not 0 <= told <= _EXPANSION * len(data):
        return f"array '{name}' announces more than it can hold"
    if data[start : start + 7] == b"<Array ":
        found = _count(data, start, about, root)
        return None if found == told else f"strings '{name}' are {found}, not {told}"
    packed = root.get(b"compressor") and about.get(b"format") != b"ascii"
    read = _reader(data, start, about, root)
    if packed and not _may_unpack(read, len(data), empty=about.get(b"NumberOfTuples") == b"0"):
        return f"array '{name}' announces more than it can hold"
    return None


def _tags(data: mmap.mmap, end: int) -> Iterator[int]:
    """Yield where arrays' tags begin."""
    for tag in (b"<Array ", b"<DataArray "):
        start = data.find(tag, 0, end)
        while start >= 0:
            yield start
            start = data.find(tag, start + 1, end)


def _may_be_there(extent: bytes, file_bytes: int) -> bool:
    """Tell whether a file may hold so many points as its extent announces."""
    ends = [int(end) for end in extent.split()]
    counts = [stop - start + 1 for start, stop in zip(ends[::2], ends[1::2])]
    limit = max(_EXPANSION * file_bytes, _MODEST)
    longest, least = max(counts, default=0), min(counts, default=0)
    return least >= 0 and longest <= _LONGEST and math.prod(counts) <= limit


def _may_unpack(read: _Reader, file_bytes: int, *, empty: bool) -> bool:
    """Tell whether packed blocks may be as large as they announce; none only of an empty array."""
    blocks, size, last = read.numbers(3)
    if blocks == 0:
        return empty
    if (
        size == 0
        or blocks > file_bytes
        or max(size, last) > 2**31
        or blocks * size > _EXPANSION * file_bytes
    ):
        return False
    return sum(read.numbers(3 + blocks)[3:]) <= file_bytes


def _attributes(data: mmap.mmap, start: int) -> dict[bytes, bytes]:
    """Read the attributes of the tag that begins at a place."""
    end = data.find(b">", max(start, 0))
    if start < 0 or end < 0:
        return {}
    return dict(_ATTRIBUTE.findall(data[start:end]))


def _told(about: dict[bytes, bytes]) -> int:
    """Return the number of strings that a header tells of."""
    return int(about.get(b"NumberOfTuples", b"0")) * int(about.get(b"NumberOfComponents", b"1"))


def _count(data: mmap.mmap, start: int, about: dict[bytes, bytes], root: dict[bytes, bytes]) -> int:
    """Count the strings in an array's data, each of which ends with a zero."""
    if about.get(b"format") == b"ascii":
        place = data.find(b">", start) + 1
        return sum(int(number) == 0 for number in data[place : data.find(b"<", place)].split())
    read, packed = _reader(data, start, about, root), root.get(b"compressor", b"")
    if not packed:
        return read.block().count(0)
    if packed != b"vtkZLibDataCompressor":
        return _told(about)  # nothing here unpacks it
    return read.unpacked().count(0)


def _start_of_appended(data: mmap.mmap) -> int:
    """Return where appended data begin: behind the tag, blanks, and an underscore."""
    place = data.find(b">", data.find(b"<AppendedData")) + 1
    while data[place : place + 1].isspace():
        place += 1
    return place + 1


def _reader(
    data: mmap.mmap, start: int, about: dict[bytes, bytes], root: dict[bytes, bytes]
) -> _Reader:
    """Make what reads an array's binary data."""
    place, raw = data.find(b">", start) + 1, False
    if about.get(b"format") == b"appended":
        place = _start_of_appended(data) + int(about.get(b"offset", b"0"))
        raw = _attributes(data, data.find(b"<AppendedData")).get(b"encoding") == b"raw"
    counter = _COUNTERS.get(root.get(b"header_type", b"UInt32"), 4)
    order: _Order = "big" if root.get(b"byte_order") == b"BigEndian" else "little"
    return _Reader(data, place, raw, counter, order)


class _Reader:
    """Binary data at a place of a file: numbers of bytes, then the bytes, as base64 or raw."""

    def __init__(self, data: mmap.mmap, place: int, raw: bool, counter: int, order: _Order) -> None:
        self._data, self._place, self._raw = data, place, raw
        self._counter, self._order = counter, order
        while not raw and data[self._place : self._place + 1].isspace():
            self._place += 1

    def numbers(self, count: int) -> list[int]:
        """Read the first numbers."""
        data = self._bytes(0, count * self._counter)
        if len(data) < count * self._counter:
            raise ValueError("binary data end early")
        parts = [data[i * self._counter : (i + 1) * self._counter] for i in range(count)]
        return [int.from_bytes(part, self._order) for part in parts]

    def block(self) -> bytes:
        """Read the bytes behind a number, which tells how many they are."""
        return self._bytes(self._counter, self.numbers(1)[0])

    def unpacked(self) -> bytes:
        """Read zlib's blocks: their number, two sizes, a size each, then the blocks."""
        head = (3 + self.numbers(1)[0]) * self._counter
        sizes = self.numbers(head // self._counter)[3:]
        if not self._raw:  # the head and the blocks are encoded apart
            self._place += -(-head // 3) * 4
            head = 0
        found = b""
        for size in sizes:
            found += zlib.decompress(self._bytes(head, size))
            head += size
        return found

    def _bytes(self, first: int, count: int) -> bytes:
        if self._raw:
            return self._data[self._place + first : self._place + first + count]
        skipped = first // 3 * 4
        text = self._data[self._place + skipped : self._place + -(-(first + count) // 3) * 4]
        return base64.b64decode(text)[first % 3 : first % 3 + count]
