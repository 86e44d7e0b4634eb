"""The last line of a ``.vti`` file that `save` writes: checksums of all that is before it.

A compressed stream has checksums of its own, wherever it lies; this line also covers the image's
geometry, the names of arrays, other arrays and the XML around them, and it is looked at before VTK
is, whose readers may crash on damaged files. To them it is a comment.
"""

from __future__ import annotations

import os
import re
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

_PART = 2**20
_LINE = "<!-- ProgIso: CRC-32 of every MiB of the {} bytes before: {} -->\n"
_PATTERN = re.compile(
    rb"<!-- ProgIso: CRC-32 of every MiB of the (\d+) bytes before: ([0-9a-f ]+) -->\n\Z"
)
_ADVICE = "; if it was changed on purpose, remove its last line"


def add_footer(path: Path) -> None:
    """Append the line to a complete file."""
    size = path.stat().st_size
    sums = " ".join(f"{value:08x}" for value in _checksums(path, size))
    with open(path, "a", encoding="ascii") as file:
        file.write(_LINE.format(size, sums))


def check_footer(path: Path) -> bool:
    """Check that a file of VTK's XML formats is not truncated, and as its last line says.

    All of the file is read, by several threads.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    bool
        Whether there is such a line. Files of VTK and of earlier versions have none.

    Raises
    ------
    ValueError
        When the file is damaged or truncated; the message names the place.
    """
    size = path.stat().st_size
    with open(path, "rb") as file:
        file.seek(max(0, size - 4096 - size // 50000))  # the line has 9 bytes for each MiB
        tail = file.read()
    found = _PATTERN.search(tail)
    if found is None:
        if b"</VTKFile>" not in tail:
            raise ValueError(f"'{path}' is truncated: it does not end with </VTKFile>")
        if b"ProgIso: CRC-32" in tail[tail.rindex(b"</VTKFile>") :]:
            what = "its last line, which has its checksums, cannot be read"
            raise ValueError(f"'{path}' is damaged: {what}{_ADVICE}")
        return False
    expected, actual = int(found[1]), size - (len(tail) - found.start())
    sums = [int(text, 16) for text in found[2].split()]
    if actual != expected or len(sums) != -(-expected // _PART):
        raise ValueError(
            f"'{path}' is damaged: its last line speaks of {expected} bytes before it, and there "
            f"are {actual}{_ADVICE}"
        )
    pairs = enumerate(zip(_checksums(path, expected), sums))
    damaged = [number for number, (now, then) in pairs if now != then]
    if damaged:
        first = damaged[0] * _PART
        raise ValueError(
            f"'{path}' is damaged: {len(damaged)} of its {len(sums)} MiB do not match their "
            f"checksums, the first from byte {first} to {min(first + _PART, expected) - 1}{_ADVICE}"
        )
    return True


def _checksums(path: Path, size: int) -> list[int]:
    """Return zlib's CRC-32 of every MiB of a file's first bytes."""
    with open(path, "rb") as file, ThreadPoolExecutor(min(8, os.cpu_count() or 1)) as pool:
        number = file.fileno()

        def checksum(start: int) -> int:
            return zlib.crc32(os.pread(number, min(_PART, size - start), start))

        return list(pool.map(checksum, range(0, size, _PART)))
