"""Samples that files hold one after the other: as they are, as text, or as compressed streams.

What has read the header of a format (NRRD, MetaImage, GIPL) says by a `Layout` where they are.
"""

from __future__ import annotations

import bz2
import gzip
import io
import os
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from .._typing import Array
from .source import Description, Region, Selection, Source

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

#: Bytes that are decoded at a time where they are not wanted.
_STEP = 2**18

#: How many times as long as its compressed bytes a stream of zlib or gzip can be, at most.
LONGEST_INFLATION = 1100


@dataclass(frozen=True, kw_only=True)
class Layout:
    """How files hold samples.

    Attributes
    ----------
    files : tuple of pathlib.Path
        They hold equal shares of the samples, one after the other.
    shape : tuple of 3 int
        Samples along z, y and x; x is fastest in the file.
    dtype : numpy.dtype
        Of the samples, with their byte order in the file.
    encoding : str
        "raw", "text", "hex", or a stream: "gzip", "bzip2", or "zlib" (which may be gzip, too).
    offset : int
        Bytes before the samples of each file; -1 where raw samples end it.
    skipped_lines : int
        Lines behind `offset` that come before the samples.
    skipped_bytes : int
        Bytes behind these lines, after decompression, that come before the samples; -1 where the
        samples end the file.
    components : int
        Values per sample.
    planar : bool
        Whether a file has all first components before all second ones.
    volumes : int
        Volumes of this shape, one after the other.
    """

    files: tuple[Path, ...]
    shape: tuple[int, int, int]
    dtype: np.dtype[Any]
    encoding: str = "raw"
    offset: int = 0
    skipped_lines: int = 0
    skipped_bytes: int = 0
    components: int = 1
    planar: bool = False
    volumes: int = 1

    @property
    def sample_bytes(self) -> int:
        """Bytes from one sample along x to the next."""
        return self.dtype.itemsize * (1 if self.planar else self.components)

    @property
    def volume_bytes(self) -> int:
        """Bytes of a volume; where components are planar, of one of them."""
        return int(np.prod(self.shape, dtype=object)) * self.sample_bytes

    @property
    def file_bytes(self) -> int:
        """Bytes of samples in each file, decoded."""
        planes = self.components if self.planar else 1
        return self.volume_bytes * planes * self.volumes // len(self.files)


class StoredSource(Source):
    """A volume whose samples lie in files as a `Layout` says.

    Parameters
    ----------
    about : Description
        What the header tells; what is chosen of it is added.
    layout : Layout
        Where the samples are.
    selection : Selection
        Its `time` chooses one of the volumes, its `component` one of the components.

    Raises
    ------
    FileNotFoundError
        When a file is not there.
    ValueError
        When one is too short, or what is selected is not there.
    """

    def __init__(self, about: Description, layout: Layout, selection: Selection) -> None:
        check_files(about.what, layout)
        time, notes = chosen(about.what, "time point", selection.time, layout.volumes)
        component = checked_index(about.what, "component", selection.component, layout.components)
        component = None if layout.components == 1 else component
        about = replace(
            about,
            shape=layout.shape,
            dtype=layout.dtype.newbyteorder("="),
            components=layout.components if component is None else 1,
            times=layout.volumes,
            sequential=layout.encoding != "raw" and len(layout.files) == 1,
            notes=about.notes + notes,
        )
        super().__init__(about)
        self._layout, self._time, self._component = layout, time, component

    def _open(self) -> _Samples:
        return _Samples(self.about.what, self._layout)

    def _read(self, region: Region) -> Array:
        layout = self._layout
        if not layout.planar:
            values = self._block(self._time * layout.volume_bytes, region, layout.components)
            return values if self._component is None else values[..., self._component]
        wanted = range(layout.components) if self._component is None else (self._component,)
        first = self._time * layout.components
        planes = [self._block((first + c) * layout.volume_bytes, region, 1) for c in wanted]
        return planes[0] if len(planes) == 1 else np.stack(planes, axis=-1)

    def _block(self, start: int, region: Region, components: int) -> Array:
        """Read a region of the volume that starts at a byte of the samples."""
        slices, rows, columns = region
        _, height, width = self.shape
        layout = self._layout
        row_bytes = width * layout.sample_bytes
        row_shape = (width, components) if components > 1 else (width,)
        found: Array = np.empty(
            (slices.stop - slices.start, rows.stop - rows.start, *row_shape), layout.dtype
        )
        if found.shape[1] == height:  # whole slices are one piece
            self._fill(start + slices.start * height * row_bytes, found)
        else:
            for z, part in zip(range(slices.start, slices.stop), found):
                self._fill(start + (z * height + rows.start) * row_bytes, part)
        return found[:, :, columns].astype(self.dtype, copy=False)

    def _fill(self, start: int, values: Array) -> None:
        self.handle.read_into(start, values.reshape(-1).view(np.uint8).data)


class _Samples:
    """All samples of a `Layout` as bytes; one file is open at a time."""

    def __init__(self, what: str, layout: Layout) -> None:
        self._what, self._layout = what, layout
        self._number, self._file = -1, _OpenFile(what, layout, 0)

    def read_into(self, start: int, memory: memoryview) -> None:
        """Fill memory with the bytes from `start` on."""
        share, done = self._layout.file_bytes, 0
        while done < len(memory):
            number, inside = divmod(start + done, share)
            count = min(len(memory) - done, share - inside)
            if number != self._number:
                self.close()
                self._number, self._file = number, _OpenFile(self._what, self._layout, number)
            self._file.read_into(inside, memory[done : done + count])
            done += count

    def close(self) -> None:
        self._file.close()


class _OpenFile:
    """The decoded samples in one file, read forwards; going back starts again."""

    def __init__(self, what: str, layout: Layout, number: int) -> None:
        self._what, self._layout, self._number = what, layout, number
        self._path = layout.files[number]
        self._file: IO[bytes] | None = None
        self._stream: Any = None
        self._position = 0

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
        self._file = self._stream = None

    def read_into(self, start: int, memory: memoryview) -> None:
        if self._stream is None or (start < self._position and self._layout.encoding != "raw"):
            self.close()
            self._start()
        if self._layout.encoding == "raw":
            self._stream.seek(start - self._position, 1)
            self._position = start
        self._pass_over(start - self._position)
        self._take(memory)
        if self._position == self._layout.file_bytes and self._layout.encoding != "raw":
            self._check_end()

    def _start(self) -> None:
        """Open the file at its first sample."""
        layout = self._layout
        self._open_stream()
        self._position = -max(0, layout.skipped_bytes)
        if layout.encoding == "raw":
            if -1 in (layout.offset, layout.skipped_bytes):
                self._stream.seek(-layout.file_bytes, os.SEEK_END)
                self._position = 0
        elif layout.encoding in ("text", "hex"):
            self._stream.skip(max(0, layout.skipped_bytes))
            self._position = 0
        elif layout.skipped_bytes == -1:
            before = self._length() - layout.file_bytes
            self.close()
            self._open_stream()
            self._position = -before

    def _open_stream(self) -> None:
        layout = self._layout
        self._file = open(self._path, "rb")
        self._file.seek(max(0, layout.offset))
        for _ in range(layout.skipped_lines):
            if not self._file.readline():
                break
        self._stream = _decoder(layout.encoding, layout.dtype)(self._file)

    def _length(self) -> int:
        """Count the decoded bytes."""
        scratch, length = memoryview(bytearray(_STEP)), 0
        while count := self._decode(scratch):
            length += count
        return length

    def _pass_over(self, count: int) -> None:
        memory = memoryview(bytearray(min(_STEP, max(0, count))))
        while count > 0:
            step = memory[: min(count, len(memory))]
            self._take(step)
            count -= len(step)

    def _take(self, memory: memoryview) -> None:
        """Fill memory with the next bytes."""
        done = 0
        while done < len(memory):
            count = self._decode(memory[done:])
            if not count:
                place = place_in(self._layout, self._number, self._position)
                raise ValueError(f"'{self._what}' is truncated: {self._own_name()}ends in {place}")
            done += count
            self._position += count

    def _decode(self, memory: memoryview) -> int:
        try:
            return int(self._stream.readinto(memory))
        except (EOFError, OSError, ValueError, OverflowError, zlib.error) as error:
            place = place_in(self._layout, self._number, self._position)
            raise ValueError(
                f"'{self._what}' is damaged: {self._own_name()}in {place}: {error}"
            ) from None

    def _check_end(self) -> None:
        """Read up to the stream's end, if it is near: its checksum lies there."""
        scratch = memoryview(bytearray(2**16))
        self._position += self._decode(scratch)

    def _own_name(self) -> str:
        own = str(self._path) == self._what
        return "it " if own else f"its data file '{self._path.name}' "


def place_in(layout: Layout, number: int, position: int) -> str:
    """Tell in which slice a byte of a file of samples lies."""
    slice_bytes = layout.volume_bytes // layout.shape[0]
    total = max(0, position) + number * layout.file_bytes
    volume, inside = divmod(total, layout.volume_bytes)
    which = f" of volume {volume}" if layout.volumes > 1 else ""
    return f"slice {inside // slice_bytes} of {layout.shape[0]}{which}"


def check_files(what: str, layout: Layout) -> None:
    """Raise where a file of samples is not there or too short, before any sample is read."""
    planes = layout.volumes * (layout.components if layout.planar else 1)
    total = layout.volume_bytes * planes
    if min(layout.shape) < 1 or layout.components < 1 or layout.volumes < 1:
        raise ValueError(f"'{what}' holds no samples: {layout.shape[::-1]}")
    if total % len(layout.files):
        raise ValueError(
            f"'{what}' names {len(layout.files)} data files, which cannot hold equal shares of "
            f"its {layout.shape[0]} slices"
        )
    for number, path in enumerate(layout.files):
        if not path.exists():
            raise FileNotFoundError(f"'{what}' names the data file '{path}', which is not there")
        if not path.is_file():
            raise ValueError(f"'{what}' names the data file '{path}', which is no regular file")
        _check_size(what, layout, number)


def _check_size(what: str, layout: Layout, number: int) -> None:
    """Raise where a file is too short for its samples, whatever is in it."""
    path, held = layout.files[number], layout.file_bytes
    size = path.stat().st_size - max(0, layout.offset)
    values = held // layout.dtype.itemsize
    needed = {"raw": held, "text": 2 * values - 1, "hex": 2 * held, "bzip2": 1}.get(
        layout.encoding, held // LONGEST_INFLATION
    )
    skipped = max(0, layout.skipped_bytes) if layout.encoding == "raw" else 0
    if size < max(1, needed + skipped):
        own = "it" if str(path) == what else f"its data file '{path}'"
        left = max(0, size - skipped) * held // max(1, needed)
        raise ValueError(
            f"'{what}' is truncated: {own} ends in {place_in(layout, number, left)}, with "
            f"{max(0, size)} bytes of at least {needed + skipped}"
        )


def checked_index(what: str, kind: str, index: int | None, count: int) -> int | None:
    """Return an index that is None or there; raise otherwise."""
    if index is not None and not 0 <= index < count:
        there = f"it has {count}, counted from 0" if count > 1 else "it has but one"
        raise ValueError(f"'{what}' has no {kind} {index}: {there}")
    return index


def chosen(what: str, kind: str, index: int | None, count: int) -> tuple[int, tuple[str, ...]]:
    """Return which of several is to be read, and a note where it was chosen by default."""
    if checked_index(what, kind, index, count) is not None or count == 1:
        return index or 0, ()
    return 0, (f"{kind} 0 of {count}: choose by --{kind.split()[0]}",)


# --- decoders -------------------------------------------------------------------------------------


def _decoder(encoding: str, dtype: np.dtype[Any]) -> Callable[[IO[bytes]], Any]:
    """Return what makes a stream of decoded bytes out of an open file."""
    if encoding == "text":
        return lambda file: Text(file, dtype)
    decoders: dict[str, Callable[[IO[bytes]], Any]] = {
        "raw": lambda file: file,
        "hex": Hex,
        "gzip": lambda file: gzip.GzipFile(fileobj=file),
        "bzip2": bz2.BZ2File,
        "zlib": Inflated,
    }
    return decoders[encoding]


class _Decoded(io.RawIOBase):
    """Bytes that are decoded piece by piece, as they are asked for."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self._left = memoryview(b"")

    def readable(self) -> bool:
        return True

    def skip(self, count: int) -> None:
        """Skip bytes that are not decoded."""
        self._file.seek(count, os.SEEK_CUR)

    def readinto(self, buffer: WriteableBuffer) -> int:
        view = memoryview(buffer).cast("B")
        if not self._left:
            self._left = memoryview(self._piece())
        count = min(len(view), len(self._left))
        view[:count] = self._left[:count]
        self._left = self._left[count:]
        return count

    def _piece(self) -> bytes:
        """Decode some more bytes; none at the end."""
        raise NotImplementedError


class Inflated(io.RawIOBase):
    """What a file holds from its current position on, as streams of zlib or gzip.

    Examples
    --------
    >>> Inflated(io.BytesIO(zlib.compress(b"samples"))).read()
    b'samples'
    """

    def __init__(self, file: IO[bytes]) -> None:
        self._file, self._inflater = file, zlib.decompressobj(47)

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: WriteableBuffer) -> int:
        view = memoryview(buffer).cast("B")
        data = b""
        while not data and not self._inflater.eof:
            packed = self._inflater.unconsumed_tail or self._file.read(2**16)
            if not packed:
                raise EOFError("the compressed stream ends early")
            data = self._inflater.decompress(packed, len(view))
        view[: len(data)] = data
        return len(data)


class Text(_Decoded):
    """Numbers that are written as text, separated by white space or commas, as their bytes."""

    def __init__(self, file: IO[bytes], dtype: np.dtype[Any]) -> None:
        super().__init__(file)
        self._dtype, self._begun = dtype, b""

    def _piece(self) -> bytes:
        while True:
            read = self._file.read(2**16)
            text = (self._begun + read).replace(b",", b" ")
            words = text.split()
            self._begun = b""
            if read and words and not text[-1:].isspace():
                self._begun = words.pop()  # it may go on
            if len(self._begun) > 400:
                raise ValueError("this is no text of numbers")
            if words or not read:
                return _numbers(words, self._dtype).tobytes()


def _numbers(words: Sequence[bytes], dtype: np.dtype[Any]) -> Array:
    """Make numbers of words; 2.0 is an integer, too, 2.5 and what does not fit are none."""
    if dtype.kind == "f":
        return np.array([float(w) for w in words], dtype)
    integers = [int(w) if w.lstrip(b"+-").isdigit() else _whole(w) for w in words]
    limits = np.iinfo(dtype)
    for value in integers:
        if not limits.min <= value <= limits.max:
            raise ValueError(f"{value} is no {dtype.name}")
    return np.array(integers, dtype)


def _whole(word: bytes) -> int:
    value = float(word)
    if not value.is_integer():
        raise ValueError(f"{word.decode('latin-1')} is no whole number")
    return int(value)


class Hex(_Decoded):
    """Bytes that are written as pairs of hexadecimal digits."""

    def _piece(self) -> bytes:
        while True:
            read = self._file.read(2**16)
            digits = b"".join(read.split())
            if len(digits) % 2:
                digits += self._file.read(1)
            if digits or not read:
                return bytes.fromhex(digits.decode("latin-1"))
