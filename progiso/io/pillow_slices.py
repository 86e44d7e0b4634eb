"""One slice in a picture that Pillow reads."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from .._typing import Array
from .axes import Step

#: Bytes and types that Pillow gives of its modes' samples.
_MODES = {
    "1": (1, "u1"),
    "L": (1, "u1"),
    "P": (1, "u1"),
    "LA": (2, "u1"),
    "RGB": (3, "u1"),
    "RGBA": (4, "u1"),
    "CMYK": (4, "u1"),
    "YCbCr": (3, "u1"),
    "I;16": (1, "u2"),
    "I;16B": (1, "u2"),
    "I;16L": (1, "u2"),
    "I": (1, "i4"),
    "F": (1, "f4"),
}


class PillowSlice:
    """A picture; its header is read at once, its samples by `read`.

    Attributes
    ----------
    shape : tuple of int
        Rows, columns and, of colours, components.
    dtype : numpy.dtype
        Of the samples.
    steps : dict of str to Step
        Nothing: pictures tell the size of a print.
    notes : tuple of str
        What a user should know.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        with Image.open(file) as picture:
            if picture.mode not in _MODES:
                raise ValueError(f"'{file}' has samples of an unknown kind, {picture.mode!r}")
            raw = str(picture.tile[0][3]) if picture.tile else ""
            if raw.startswith(("RGB;16", "RGBA;16", "LA;16")):
                raise ValueError(
                    f"'{file}' has colours of 16 bits, of which Pillow keeps 8: convert it to TIFF"
                )
            components, kind = _MODES[picture.mode]
            self.notes = (
                ("samples are numbers of colours of a palette",) if picture.mode == "P" else ()
            )
            width, height = picture.size
        self.shape = (height, width, components)[: 2 + (components > 1)]
        self.dtype = np.dtype(kind)
        self.steps: dict[str, Step] = {}

    def read(self, rows: slice, columns: slice) -> Array:
        """Read part of the slice."""
        with Image.open(self._file) as picture:
            samples = np.asarray(picture)
        return samples[rows, columns].astype(self.dtype, copy=False)
