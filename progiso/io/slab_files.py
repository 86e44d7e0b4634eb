"""Files whose samples can be read some slices at a time, from the first to the last."""

from __future__ import annotations

import gzip
import io
import zlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, FilePath

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

#: Bytes of samples that are read at a time, in whole layers of blocks.
_SLAB_BYTES = 2**25


@dataclass(frozen=True)
class SlabFile:
    """A volume in a file of which only the header has been read.

    Attributes
    ----------
    path : pathlib.Path
        For messages.
    name : str
        Of the array.
    dimensions : tuple of int
        Samples along x, y and z.
    dtype : numpy.dtype
        Of the values in the file, with their byte order.
    open : callable
        Opens the file at the first sample, for a ``with`` statement; see `opened_at`.
    place : callable
        Sets the geometry of a `vtkImageData` of these dimensions.
    components : int
        Values per sample.
    vtk_type : int or None
        VTK's number of the type, where NumPy's has several.
    convert : callable or None
        What to do with samples in native byte order.
    from_top : bool
        Whether the file begins with the last slice; it must be seekable then.
    """

    path: Path
    name: str
    dimensions: Dimensions
    dtype: np.dtype[Any]
    _: KW_ONLY
    open: Callable[[], AbstractContextManager[Any]]
    place: Callable[[vtkImageData], None]
    components: int = 1
    vtk_type: int | None = None
    convert: Callable[[Array], Array] | None = None
    from_top: bool = False

    def slabs(self) -> Iterator[Array]:
        """Read the volume some slices at a time.

        Yields
        ------
        numpy.ndarray, shape (depth, height, width) or (depth, height, width, components)
            The next slices, in native byte order; a multiple of 4 of them unless they are the last.
            The same memory every time: use it before the next is asked for.

        Raises
        ------
        ValueError
            When the file is damaged or ends early.
        """
        width, height, slices = self.dimensions
        shape = (height, width) + ((self.components,) if self.components > 1 else ())
        slice_bytes = int(np.prod(shape)) * self.dtype.itemsize
        step = min(slices, max(4, _SLAB_BYTES // slice_bytes // 4 * 4))
        memory: Array = np.empty((step, *shape), self.dtype)
        with self.open() as file:
            start = file.tell() if self.from_top else 0
            for first in range(0, slices, step):
                slab = memory[: min(step, slices - first)]
                if self.from_top:
                    file.seek(start + (slices - first - len(slab)) * slice_bytes)
                self._fill(file, slab, first)
                yield self._native(slab[::-1] if self.from_top else slab)

    def _fill(self, file: Any, slab: Array, first: int) -> None:
        """Read bytes until a slab is full."""
        view, done = slab.reshape(-1).view(np.uint8).data, 0
        while done < len(view):
            try:
                count = file.readinto(view[done:])
            except (EOFError, zlib.error, OSError) as error:
                raise ValueError(f"'{self.path}' is damaged: {error}") from None
            if not count:
                place = first + done * len(slab) // len(view)
                raise ValueError(
                    f"'{self.path}' is truncated: it ends in slice {place} of {self.dimensions[2]}"
                )
            done += count

    def _native(self, slab: Array) -> Array:
        slab = slab.astype(slab.dtype.newbyteorder("="), copy=False)
        return slab if self.convert is None else self.convert(slab)

    def vtk_arrays(self) -> Iterator[vtkDataArray]:
        """Yield the slabs as VTK arrays; their memory, too, is the same every time."""
        kind = self.vtk_type if self.convert is None else None
        for slab in self.slabs():
            flat = np.ascontiguousarray(slab).reshape(-1, self.components)
            yield numpy_to_vtk(flat if self.components > 1 else flat[:, 0], array_type=kind)


class Inflated(io.RawIOBase):
    """What a file holds from its current position on, decompressed by zlib.

    Examples
    --------
    >>> Inflated(io.BytesIO(zlib.compress(b"samples"))).read()
    b'samples'
    """

    def __init__(self, file: IO[bytes]) -> None:
        self._file, self._inflater = file, zlib.decompressobj()

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: WriteableBuffer) -> int:
        view = memoryview(buffer).cast("B")
        inflater, data = self._inflater, b""
        while not data and not inflater.eof:
            packed = inflater.unconsumed_tail or self._file.read(2**16)
            if not packed:
                break
            data = inflater.decompress(packed, len(view))
        view[: len(data)] = data
        return len(data)


def opened_at(
    path: FilePath,
    offset: int = 0,
    *,
    wrap: Callable[[Any], AbstractContextManager[Any]] | None = None,
    skip: int = 0,
) -> Callable[[], AbstractContextManager[Any]]:
    """Make a function that opens a file at its samples, for a ``with`` statement.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    offset : int, default: 0
        Bytes to skip in it; from its end when negative.
    wrap : callable, optional
        What decodes the file from there.
    skip : int, default: 0
        Bytes to skip after decoding.

    Returns
    -------
    callable

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.NamedTemporaryFile() as file:
    ...     _ = file.write(b"header samples"), file.flush()
    ...     with opened_at(file.name, 7)() as opened:
    ...         opened.read()
    b'samples'
    """

    @contextmanager
    def open_it() -> Iterator[Any]:
        with open(path, "rb") as file:
            file.seek(offset, 2 if offset < 0 else 0)
            with nullcontext(file) if wrap is None else wrap(file) as unwrapped:
                if skip:
                    unwrapped.seek(skip)
                yield unwrapped

    return open_it


def gunzipped(file: IO[bytes]) -> gzip.GzipFile:
    """Open what a file holds from its current position on, decompressed by gzip."""
    return gzip.GzipFile(fileobj=file)
