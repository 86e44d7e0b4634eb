"""Formats whose readers are not sources yet."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Progress
from .images import ImageSource
from .nifti import nifti_slabs, read_nifti
from .others import read_other
from .slab_files import SlabFile
from .source import Description, Region, Selection, Source

_READERS = {
    ".nii": (read_nifti, nifti_slabs),
    ".gz": (read_nifti, nifti_slabs),
}


def open_legacy(path: Path, selection: Selection) -> Source:
    """Open a file by the readers that there were before sources."""
    read, slabs = _READERS[path.suffix.lower()]
    file = slabs(path)
    return SlabSource(file, read) if file else ImageSource(path, read(path), selection.array)


def open_other(path: Path, selection: Selection) -> Source:
    """Open a file of another format."""
    from .formats import FORMATS

    return ImageSource(path, read_other(path, FORMATS), selection.array)


class SlabSource(Source):
    """A file that is read from the first slice to the last."""

    def __init__(self, file: SlabFile, read: Callable[[Path], vtkImageData]) -> None:
        self._file, self._read_whole = file, read
        self.vtk_type = file.vtk_type if file.convert is None else None
        kind = file.dtype if file.convert is None else np.dtype("f4")
        super().__init__(
            Description(
                what=str(file.path),
                shape=file.dimensions[::-1],
                dtype=kind.newbyteorder("="),
                components=file.components,
                name=file.name,
            )
        )

    def _read(self, region: Region) -> Array:
        raise NotImplementedError

    def slabs(self) -> Iterator[Array]:
        yield from self._file.slabs()

    def image(self, progress: Progress | None = None) -> vtkImageData:
        return self._read_whole(self._file.path)

    def place(self, image: vtkImageData) -> None:
        self._file.place(image)
