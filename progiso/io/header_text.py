"""Fields of text headers: decoded, told apart, and read as numbers with messages that name them."""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..geometry import set_axes
from .source import Geometry

#: No header is longer than this; where one seems to be, the file is of another kind.
LONGEST_HEADER = 2**24

_INTEGER = re.compile(r"[+-]?[0-9]+")
_NUMBER = re.compile(
    r"[+-]?([0-9]+\.?[0-9]*([eE][+-]?[0-9]+)?|\.[0-9]+([eE][+-]?[0-9]+)?|inf|nan)", re.I
)


def decode(line: bytes) -> str:
    """Decode a line, which is UTF-8 today and was Latin-1 in old files.

    Examples
    --------
    >>> decode("schädel".encode()), decode("schädel".encode("latin-1"))
    ('schädel', 'schädel')
    """
    try:
        return line.decode("utf-8")
    except UnicodeDecodeError:
        return line.decode("latin-1")


def integers(what: object, field: str, text: str, count: int | None = None) -> list[int]:
    """Read whole numbers out of a field, or raise `ValueError` that names the file and the field.

    Examples
    --------
    >>> integers("a.mha", "DimSize", "6 5 four", 3)
    Traceback (most recent call last):
        ...
    ValueError: 'a.mha': the field 'DimSize' must be 3 whole numbers, it is '6 5 four'
    """
    words = text.split()
    if any(not _INTEGER.fullmatch(word) for word in words) or count not in (None, len(words)):
        raise _wrong(what, field, text, count, "whole number")
    return [int(word) for word in words]


def reals(what: object, field: str, text: str, count: int | None = None) -> list[float]:
    """Read numbers out of a field, or raise `ValueError` that names the file and the field.

    More of them than `count` are left out, as ITK does it.
    """
    words = text.split()[:count]
    if any(not _NUMBER.fullmatch(word) for word in words) or count not in (None, len(words)):
        raise _wrong(what, field, text, count, "number")
    return [float(word) for word in words]


def _wrong(what: object, field: str, text: str, count: int | None, kind: str) -> ValueError:
    wanted = f"a {kind}" if count == 1 else f"{'' if count is None else f'{count} '}{kind}s"
    return ValueError(f"'{what}': the field '{field}' must be {wanted}, it is '{shortened(text)}'")


def shortened(text: str) -> str:
    """Return a text of at most 60 printable characters, for messages."""
    text = "".join(c if c.isprintable() else "?" for c in text)
    return text if len(text) <= 60 else text[:57] + "..."


def misspelt_fields(fields: Iterable[str], known: Collection[str]) -> tuple[str, ...]:
    """Return notes on fields that are unknown, but much like known ones.

    Examples
    --------
    >>> misspelt_fields(["ElementSpacng", "Hospital"], ["ElementSpacing", "DimSize"])
    ("the header field 'ElementSpacng' has no meaning: is 'ElementSpacing' meant?",)
    """
    notes = []
    for field in fields:
        alike = () if field in known else difflib.get_close_matches(field, known, 1, 0.85)
        notes += [
            f"the header field '{field}' has no meaning: is '{meant}' meant?" for meant in alike
        ]
    return tuple(notes[:8])


def data_file(what: Path, name: str) -> Path:
    """Return the path of a data file that a header names, relative to the header."""
    if not name or "\0" in name:
        raise ValueError(f"'{what}' names no data file: '{shortened(name)}'")
    return what.parent / name


def numbered_files(what: Path, pattern: str, first: int, last: int, step: int) -> list[Path]:
    """Return the files of a pattern such as "slice%03d.raw", for numbers from first to last.

    Raises
    ------
    ValueError
        When the pattern has not exactly one place for a number, or there are none or too many.
    """
    places = re.findall(r"%0?[0-9]{0,3}[du]", pattern)
    if len(places) != 1 or pattern.count("%") != 1:
        raise ValueError(f"'{what}': '{shortened(pattern)}' is no pattern of numbered files")
    if step == 0:
        raise ValueError(f"'{what}': the step of '{shortened(pattern)}' is 0")
    numbers = range(first, last + (1 if step > 0 else -1), step)
    if not 0 < len(numbers) <= 10**6:
        raise ValueError(f"'{what}': '{shortened(pattern)}' names {len(numbers)} files")
    width = int(places[0][1:-1] or 0)
    zeros = places[0].startswith("%0")
    names = [str(n).zfill(width) if zeros else str(n).rjust(width) for n in numbers]
    return [data_file(what, pattern.replace(places[0], name)) for name in names]


def checked_geometry(
    what: object,
    axes: npt.ArrayLike,
    origin: npt.ArrayLike,
    *,
    units: str | None = None,
    space: str | None = None,
) -> Geometry:
    """Make a geometry that an image can have, or raise `ValueError` that names the file."""
    from vtkmodules.vtkCommonDataModel import vtkImageData

    place: dict[str, Any] = {"axes": np.array(axes, float), "origin": np.array(origin, float)}
    try:
        set_axes(vtkImageData(), place["axes"], place["origin"])
    except ValueError as error:
        raise ValueError(f"'{what}': {error}") from None
    return Geometry(**place, units=units, space=space)
