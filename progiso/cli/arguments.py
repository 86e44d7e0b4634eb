"""Types of the command line's arguments; each parses a text or raises `ArgumentTypeError`."""

from __future__ import annotations

import argparse
import re


def _pattern(text: str, pattern: str, example: str) -> tuple[str, ...]:
    """Return the groups of a pattern that all of a text matches, or raise with an example."""
    match = re.fullmatch(pattern, text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' does not look like {example}")
    return match.groups()


def size(text: str) -> tuple[int, int]:
    """Parse a width and a height in pixels."""
    width, height = map(int, _pattern(text, r"([1-9]\d*)x([1-9]\d*)", "1280x720"))
    return width, height


def sides(text: str) -> int | tuple[int, int, int]:
    """Parse one number of samples for all axes, or three."""
    if text.isdecimal():
        return int(text)
    x, y, z = map(int, _pattern(text, r"(\d+)x(\d+)x(\d+)", "256 or 256x128x64"))
    return x, y, z


def orbit(text: str) -> tuple[int, int]:
    """Parse a position on the orbit and the number of positions."""
    position, count = map(int, _pattern(text, r"(\d+)/(\d+)", "0/10"))
    return position, count


def vector(text: str) -> tuple[float, ...]:
    """Parse three coordinates."""
    number = r"\s*([-+.\deE]+)\s*"
    parts = _pattern(text, ",".join([number] * 3), "0.5,-1,0.25")
    try:
        return tuple(map(float, parts))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' does not look like 0.5,-1,0.25") from None


def bits_per_sample(text: str) -> float | str:
    """Parse a rate: a number, or "auto"."""
    try:
        return text if text == "auto" else float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' does not look like 8, 12.5 or auto") from None


def byte_count(text: str) -> int:
    """Parse a number of bytes with an optional unit."""
    number, unit = _pattern(text, r"(\d+(?:\.\d+)?)([KMG]?)", "200000000, 200M or 1.5G")
    return int(float(number) * 1024 ** " KMG".index(unit or " "))


def zfp_header(text: str) -> tuple[tuple[int, int, int], float]:
    """Parse dimensions and rate."""
    x, y, z, rate = _pattern(text, r"(\d+)x(\d+)x(\d+):([.\d]+)", "256x256x108:8")
    return (int(x), int(y), int(z)), float(rate)


def number_or_name(text: str) -> int | str:
    """Parse a number, or keep a name."""
    return int(text) if text.isdecimal() else text
