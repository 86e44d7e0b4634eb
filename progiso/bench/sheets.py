"""Put pictures of one view beside each other, and below them what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from .._typing import Array

#: By how much differences are amplified.
AMPLIFIED = 4

#: Pixels of a small picture's longer side at least, which are enlarged to so many, and around it.
_LEAST, _MARGIN = 240, 3

#: Pixels between the pictures, and of a line of text.
_GAP, _LINE = 8, 22

_DPI = 100


def draw_sheet(pictures: dict[str, Array], path: Path) -> None:
    """Draw a row of pictures, and below them their differences from the last one.

    They are cut to what is shown, and enlarged by a whole number where that is small.

    Parameters
    ----------
    pictures : dict of numpy.ndarray, shape (height, width, 3)
        By the names that they get; red, green and blue from 0 to 255, on black. The last one is
        what they should look like.
    path : pathlib.Path
        Of a PNG file; its folder is made when it is missing.
    """
    names = list(pictures)
    window = _shown(list(pictures.values()))
    cut = [picture[window].astype(np.float32) for picture in pictures.values()]
    differences = [AMPLIFIED * np.abs(picture - cut[-1]) for picture in cut[:-1]]
    scale = max(1, round(_LEAST / max(cut[0].shape[:2])))
    height, width = (scale * side for side in cut[0].shape[:2])
    total = (2 * (height + _LINE), len(names) * (width + _GAP) - _GAP)
    canvas = np.full((*total, 3), 255, np.uint8)
    figure = Figure(figsize=(total[1] / _DPI, total[0] / _DPI), dpi=_DPI)
    tops = (_LINE, height + 2 * _LINE)
    for row, top in zip((cut, differences), tops):
        for column, picture in enumerate(row):
            left = column * (width + _GAP)
            large = picture.repeat(scale, 0).repeat(scale, 1)
            canvas[top : top + height, left : left + width] = np.clip(large + 0.5, 0, 255)
    figure.figimage(canvas)
    texts = [*names, f"differences from the {names[-1]}, times {AMPLIFIED}"]
    places = [(column * (width + _GAP), _LINE) for column in range(len(names))]
    for text, (left, bottom) in zip(texts, [*places, (0, height + 2 * _LINE)]):
        figure.text(
            left / total[1], 1 - (bottom - 0.3 * _LINE) / total[0], text, fontsize=9, va="baseline"
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=_DPI)


def _shown(pictures: list[Array]) -> tuple[slice, slice]:
    """Return the rows and columns in which any picture shows something, and some around."""
    seen = np.logical_or.reduce([picture.any(axis=-1) for picture in pictures])
    if not seen.any():
        return slice(None), slice(None)
    rows, columns = (np.nonzero(seen.any(axis=axis))[0] for axis in (1, 0))
    return _around(rows), _around(columns)


def _around(numbers: Array) -> slice:
    return slice(max(0, int(numbers[0]) - _MARGIN), int(numbers[-1]) + _MARGIN + 1)
