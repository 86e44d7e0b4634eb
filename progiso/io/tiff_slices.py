"""One slice in a TIFF file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .._typing import Array
from .source import Selection
from .tiff import TiffSource, first_page, open_tiff


class TiffSlice:
    """A TIFF file of one page; its tags are read at once, its samples by `read`.

    Attributes
    ----------
    shape : tuple of int
        Rows, columns and, of colours, components.
    dtype : numpy.dtype
        Of the samples.
    steps : dict of str to Step
        What the tags tell of distances of samples.
    notes : tuple of str
        None.
    """

    notes: tuple[str, ...] = ()

    def __init__(self, file: Path) -> None:
        self._file = file
        self.shape, dtype, self.steps = first_page(file)
        self.dtype: np.dtype[Any] = dtype.newbyteorder("=")

    def read(self, rows: slice, columns: slice) -> Array:
        """Read part of the slice."""
        with open_tiff(self._file, Selection()) as source:
            assert isinstance(source, TiffSource)
            return source.read((slice(0, 1), rows, columns))[0]
