"""Format numbers for people."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence


def number(value: float | None) -> str:
    """Format three significant digits, without an exponent where that stays short.

    Parameters
    ----------
    value : float or None

    Returns
    -------
    str
        A dash for None.

    Examples
    --------
    >>> [number(v) for v in (None, 0, 0.012345, 5, 1234.5, 2e9)]
    ['–', '0', '0.0123', '5', '1234', '2e+09']
    """
    if value is None:
        return "–"
    if value == 0:
        return "0"
    digits = 2 - math.floor(math.log10(abs(value)))
    if not -4 < digits < 8:
        return f"{value:.3g}"
    text = f"{round(value, digits):.{max(0, digits)}f}" if digits > 0 else f"{value:.0f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def milliseconds(value: float | None) -> str:
    """Format a time in milliseconds or seconds.

    Examples
    --------
    >>> milliseconds(12.345), milliseconds(12345), milliseconds(None)
    ('12.3 ms', '12.3 s', '–')
    """
    if value is None:
        return "–"
    return f"{number(value)} ms" if value < 10_000 else f"{number(value / 1e3)} s"


def bytes_(value: float | None) -> str:
    """Format an amount of memory in KiB, MiB or GiB.

    Examples
    --------
    >>> bytes_(2**20 * 1.5), bytes_(2**34), bytes_(None)
    ('1.5 MiB', '16 GiB', '–')
    """
    if value is None:
        return "–"
    for unit, size in (("GiB", 2**30), ("MiB", 2**20)):
        if abs(value) >= size:
            return f"{number(value / size)} {unit}"
    return f"{number(value / 2**10)} KiB"


def count(value: float | None) -> str:
    """Format a large number in thousands or millions.

    Examples
    --------
    >>> count(668_000), count(2_240_000), count(12)
    ('668 k', '2.24 M', '12')
    """
    if value is None:
        return "–"
    for unit, size in (("M", 10**6), ("k", 10**3)):
        if value >= size:
            return f"{number(value / size)} {unit}"
    return number(value)


def percent(value: float) -> str:
    """Format a percentage.

    Examples
    --------
    >>> percent(31.04)
    '31 %'
    """
    return f"{number(value)} %"


def pixels(size: Sequence[int]) -> str:
    """Format an image's size.

    Examples
    --------
    >>> pixels((1280, 720))
    '1280×720'
    """
    return f"{size[0]}×{size[1]}"


def table(headers: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Make a Markdown table; the first column is text, the others are numbers.

    Parameters
    ----------
    headers : sequence of str
    rows : sequence of sequence of str

    Returns
    -------
    list of str
        Lines.
    """
    lines = [_row(headers), _row(["---", *["---:"] * (len(headers) - 1)])]
    return [*lines, *(_row(row) for row in rows), ""]


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"
