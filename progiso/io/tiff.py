"""TIFF files: stacks, BigTIFF, ImageJ's and OME's hyperstacks and what else tifffile reads.

tifffile knows pages, axes and codecs; strips and tiles are read here, only those of a region.
"""

from __future__ import annotations

import itertools
import logging
import math
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import tifffile

from .._typing import Array, Dimensions
from .axes import AxesSource, Step, Values, choose, lay_out, place, unit_of
from .errors import lost_data
from .source import Description, Selection, Source

#: What tifffile logs, and does not raise, where pages cannot be read; in lower case.
_LOSSES = (
    "missing",
    "invalid page",
    "out of range",
    "failed to",
    "expected",
    "series raised",
    "no pages",
    "discontiguous",
    "invalid offset",
    "invalid or corrupted file",
    "does not match page",
    "do not match page",
)

#: Resolutions in dots per inch that programs write when they know none.
_PRINTED = (72.0, 96.0, 100.0, 150.0, 200.0, 300.0, 600.0)

#: Where an axis of a page lies in tifffile's five axes of every page.
_DEPTH, _ROWS, _COLUMNS = 1, 2, 3


def open_tiff(path: Path, selection: Selection) -> Source:
    """Open a series of pages of a TIFF file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    selection : Selection
        ``series``, ``level`` of its pyramid, ``channel``, ``time`` and ``component``.

    Returns
    -------
    Source

    Raises
    ------
    ValueError
        When the file is damaged, ends early, or holds no such series.
    """
    with _opened(path) as file:
        names = [_series_name(i, series) for i, series in enumerate(file.series)]
        if not names:
            raise ValueError(f"'{path}' holds no pictures")
        notes: list[str] = []
        number = choose(path, "series", selection.series, names, notes)
        finest = file.series[number]
        level = choose(path, "level", selection.level or 0, len(finest.levels))
        series = finest.levels[level]
        _check_pages(path, series)
        meta = _metadata(file, number)
        axes, shape = _named_axes(series), tuple(series.get_shape(False))
        layout = lay_out(path, axes, shape, selection, channels=meta.get("channels", ()))
        notes += layout.notes + meta.get("notes", ())
        ratios = layout.along(
            [a / b for a, b in zip(finest.get_shape(False), series.get_shape(False))]
        )
        steps = _coarser(meta.get("steps", {}), dict(zip("zyx", ratios)))
        page = series.keyframe
        missing = (page.nodata,) if "GDAL_NODATA" in page.tags else ()
        values = Values(np.dtype(series.dtype), missing=missing)
        geometry = place(steps, layout.shape, notes)
        about = Description(
            what=str(path),
            shape=layout.shape,
            dtype=values.dtype,
            components=layout.components,
            name=path.stem,
            geometry=geometry,
            chunks=_chunks(page, layout.shape),
            channels=layout.channels,
            times=layout.times,
            series=tuple(names) if len(names) > 1 else (),
            notes=tuple(notes),
        )
    return TiffSource(path, number, level, about, layout, values)


def first_page(path: Path) -> tuple[tuple[int, ...], np.dtype[Any], dict[str, Step]]:
    """Return the shape and type of a file's only page, and the steps that it tells.

    Raises
    ------
    ValueError
        When it has several pages.
    """
    with _opened(path) as file:
        if len(file.pages) != 1:
            raise ValueError(f"'{path}' has {len(file.pages)} pages, and is no slice")
        page = file.pages.first
        planes = page.axes.startswith("S")
        shape = (*page.shape[1:], page.shape[0]) if planes else page.shape
        return shape, np.dtype(page.dtype), _metadata(file, 0).get("steps", {})


class TiffSource(AxesSource):
    """A series of a TIFF file's pages."""

    def __init__(self, path: Path, series: int, level: int, *rest: Any) -> None:
        super().__init__(*rest)
        self._path, self._series, self._level = path, series, level

    def _open(self) -> _Pages:
        return _Pages(self._path, self._series, self._level)

    def _fetch(self, index: tuple[int | slice, ...]) -> Array:
        pages: _Pages = self.handle
        with _logged(self._path):
            return pages.read(index)


class _Pages:
    """An open file's series as an array that is read by index."""

    def __init__(self, path: Path, series: int, level: int) -> None:
        self._path = path
        with _logged(path):
            self._file = tifffile.TiffFile(path)
            self._series = self._file.series[series].levels[level]
            self._shape = tuple(self._series.get_shape(False))
        page = self._series.keyframe
        self._leading = _leading(self._path, self._series)
        self._places = _places(self._series.get_axes(False)[self._leading :], page)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def read(self, index: tuple[int | slice, ...]) -> Array:
        """Read part of the series; axes with an int as index fall away."""
        parts = [slice(i, i + 1) if isinstance(i, int) else i for i in index]
        single = tuple(0 if isinstance(i, int) else slice(None) for i in index)
        contiguous = self._contiguous()
        if contiguous is not None:
            return np.array(contiguous[tuple(parts)][single])
        counts = tuple(part.stop - part.start for part in parts)
        found = np.empty(counts, self._series.dtype)
        within = parts[self._leading :]
        leading = [range(part.start, part.stop) for part in parts[: self._leading]]
        pages = np.arange(len(self._series)).reshape(self._shape[: self._leading])
        for numbers in itertools.product(*leading):
            target = tuple(n - part.start for n, part in zip(numbers, parts))
            found[target] = self._read_page(int(pages[numbers]), within)
        return found[single]

    def _contiguous(self) -> Array | None:
        """Map the whole series where it lies in one piece; pages are dropped with the map."""
        series = self._series
        if series.is_multifile or series.dataoffset is None or not series.keyframe.is_final:
            return None
        dtype = np.dtype(series.dtype).newbyteorder(self._file.byteorder)
        return np.memmap(
            self._path, dtype=dtype, mode="r", offset=series.dataoffset, shape=self._shape
        )

    def _read_page(self, number: int, within: list[slice]) -> Array:
        """Read part of one page."""
        page = self._series[number]
        if page is None:
            raise ValueError(f"cannot read '{self._path}': page {number} of the series is missing")
        window = [slice(0, n) for n in page.keyframe.shaped]
        for place_, part in zip(self._places, within):
            window[place_] = part
        found = np.full([w.stop - w.start for w in window], page.keyframe.nodata, page.dtype)
        segments = _segments(page.keyframe, window)
        with _file_of(page) as file:
            for segment in segments:
                self._read_segment(page, number, segment, file, window, found)
        order = [place_ for place_ in self._places if place_ >= 0]
        rest = [axis for axis in range(5) if axis not in order]
        moved = found.transpose(order + rest)
        return moved.reshape([part.stop - part.start for part in within])

    def _read_segment(
        self, page: Any, number: int, segment: int, file: Any, window: list[slice], found: Array
    ) -> None:
        """Copy what lies in a window from a strip or tile; one that is not stored is "no data"."""
        where = f"strip or tile {segment} of page {number}"
        if segment >= len(page.dataoffsets):
            raise ValueError(f"cannot read '{self._path}': {where} is missing")
        offset, count = page.dataoffsets[segment], page.databytecounts[segment]
        if offset == 0 or count == 0:
            return
        file.seek(offset)
        data = file.read(count)
        if len(data) != count:
            raise ValueError(f"cannot read '{self._path}': it ends within {where}")
        try:
            decoded, start, shape = page.keyframe.decode(data, segment, jpegtables=page.jpegtables)
        except ImportError:
            raise
        except Exception as error:
            raise ValueError(f"cannot read '{self._path}': {where}: {error}") from error
        if decoded is None:
            return
        target, origin = [], []
        for first, length, part in zip(start, (1, *decoded.shape), window):
            low, high = max(first, part.start), min(first + length, part.stop)
            target.append(slice(low - part.start, high - part.start))
            origin.append(slice(low - first, high - first))
        found[tuple(target)] = decoded[np.newaxis][tuple(origin)]


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Open a file to look at its header."""
    with _logged(path), tifffile.TiffFile(path) as file:
        len(file.pages)  # finds a circle of pages, in which tifffile would go around for ever
        yield file


@contextmanager
def _logged(path: Path) -> Iterator[None]:
    """Raise what tifffile only logs, where it means that pages are lost."""
    heard = _Listener()
    logger = logging.getLogger("tifffile")
    logger.addHandler(heard)
    try:
        yield
    except Exception as error:
        if heard.lost and f"'{path}'" not in str(error):
            raise ValueError(f"cannot read '{path}': {error} ({heard.lost[0]})") from error
        raise
    finally:
        logger.removeHandler(heard)
    if heard.lost:
        raise ValueError(f"cannot read '{path}': {heard.lost[0]}")


class _Listener(logging.Handler):
    """Collects what tifffile logs in this thread of pages that are lost."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.lost: list[str] = []
        self._thread = threading.get_ident()

    def emit(self, record: logging.LogRecord) -> None:
        text = " ".join(record.getMessage().split())
        lost = record.levelno >= logging.ERROR or lost_data(text)
        lost = lost or any(word in text.lower() for word in _LOSSES)
        of_tag = any(word in text for word in ("TiffTag ", "tag #", "tifffile.read_"))
        if record.thread == self._thread and lost and not of_tag:
            self.lost.append(text)


@contextmanager
def _file_of(page: Any) -> Iterator[Any]:
    """Give the file that a page is in, which may be another one of the same data set."""
    file = page.parent.filehandle
    was_closed = file.closed
    if was_closed:
        file.open()
    try:
        yield file
    finally:
        if was_closed:
            file.close()


def _series_name(number: int, series: Any) -> str:
    sizes = "x".join(map(str, series.shape))
    return series.name or f"{series.kind or 'pages'} {number}: {sizes}"


def _named_axes(series: Any) -> list[str]:
    """Return the axes of a series; pages that are told to be nothing else are slices."""
    axes, shape = list(series.get_axes(False)), series.get_shape(False)
    used = [i for i, n in enumerate(shape) if n > 1]
    if "Z" in [axes[i] for i in used]:
        return axes
    pages = [i for i in used if axes[i] in "IQ"]
    if len(pages) == 1:
        axes = ["" if name == "Z" else name for name in axes]
        axes[pages[0]] = "Z"
    return axes


def _check_pages(path: Path, series: Any) -> None:
    """Raise where strips or tiles lie beyond the end of the file."""
    if series.transform is not None:
        raise ValueError(f"'{path}': samples of a {series.kind} series have to be read whole")
    page = series.keyframe
    size = page.parent.filehandle.size
    if series.dataoffset is not None and not series.is_multifile and page.is_final:
        needed = math.prod(series.get_shape(False)) * np.dtype(series.dtype).itemsize
        if series.dataoffset + needed > size:
            raise ValueError(f"'{path}' is truncated: {size} bytes, its pages need more")
        return
    _leading(path, series)
    for number in range(len(series)):
        page = series[number]
        if page is None:
            raise ValueError(f"cannot read '{path}': page {number} of the series is missing")
        ends = [a + n for a, n in zip(page.dataoffsets, page.databytecounts)]
        if max(ends, default=0) > page.parent.filehandle.size:
            raise ValueError(
                f"'{path}' is truncated: page {number} ends beyond the end of the file"
            )


def _leading(path: Path, series: Any) -> int:
    """Return how many axes of a series count pages; the others are those of each page."""
    shape, page = series.get_shape(False), math.prod(series.keyframe.shape)
    for leading in reversed(range(len(shape) + 1)):
        if math.prod(shape[:leading]) == len(series) and math.prod(shape[leading:]) == page:
            return leading
    raise ValueError(f"cannot read '{path}': {len(series)} pages make no array of {shape}")


def _places(axes: str, page: Any) -> list[int]:
    """Return which of tifffile's five axes of a page each axis is: samples, z, y, x, samples."""
    samples = 0 if page.shaped[0] > 1 else 4
    known = {"Y": _ROWS, "X": _COLUMNS, "S": samples, "C": samples}
    return [known.get(name, _DEPTH) for name in axes]


def _segments(page: Any, window: list[slice]) -> list[int]:
    """Return the numbers of the strips or tiles that a window of a page touches."""
    _, depth, rows, columns, _ = page.shaped
    tile = (1, page.rowsperstrip, page.imagewidth)
    if page.is_tiled:
        tile = (page.tiledepth, page.tilelength, page.tilewidth)
    counts = [math.ceil(n / size) for n, size in zip((depth, rows, columns), tile)]
    ranges = [range(window[0].start, window[0].stop)]
    for part, size in zip(window[1:4], tile):
        ranges.append(range(part.start // size, (part.stop - 1) // size + 1))
    return [
        ((sample * counts[0] + z) * counts[1] + y) * counts[2] + x
        for sample, z, y, x in itertools.product(*ranges)
    ]


def _chunks(page: Any, shape: Dimensions) -> Dimensions:
    """Return the shape of a strip or tile along z, y and x."""
    if page.is_tiled:
        return (page.tiledepth, min(page.tilelength, shape[1]), min(page.tilewidth, shape[2]))
    return (1, max(1, min(page.rowsperstrip, shape[1])), shape[2])


def _coarser(steps: Mapping[str, Step], ratios: Mapping[str, float]) -> dict[str, Step]:
    """Return the steps of a level of a pyramid whose samples are means of the finest's."""
    return {
        name: step._replace(
            size=step.size * ratios[name], start=step.start + (ratios[name] - 1) / 2 * step.size
        )
        if step.size
        else step
        for name, step in steps.items()
    }


def _metadata(file: Any, number: int) -> dict[str, Any]:
    """Return what a file tells of a series: "steps" by axis, names of "channels", "notes"."""
    if file.is_ome and file.series[number].kind == "ome":
        return _ome(file, number)
    page = file.series[number].keyframe
    if file.is_imagej and file.imagej_metadata:
        return _imagej(page, file.imagej_metadata)
    if file.is_lsm and file.lsm_metadata:
        return _lsm(file.lsm_metadata)
    if file.is_stk and file.stk_metadata:
        return _stk(file.stk_metadata)
    return _resolution(page)


def _ome(file: Any, number: int) -> dict[str, Any]:
    """Read OME-XML: physical sizes with their units, names of channels."""
    root = ElementTree.fromstring(file.ome_metadata)
    found = [
        pixels
        for image in root
        if image.tag.endswith("Image")
        for pixels in image
        if pixels.tag.endswith("Pixels")
    ]
    of_file = [series for series in file.series if series.kind == "ome"]
    if len(found) != len(of_file):
        return {"notes": ("the OME-XML tells of other images than the file holds",)}
    pixels = found[number]
    steps = {}
    for name in "XYZ":
        size = pixels.get(f"PhysicalSize{name}")
        unit = unit_of(pixels.get(f"PhysicalSize{name}Unit", "\u00b5m"))
        if size is not None and float(size) > 0:
            steps[name.lower()] = Step(float(size), 0.0, unit)
    channels = [child for child in pixels if child.tag.endswith("Channel")]
    names = [channel.get("Name") or str(i) for i, channel in enumerate(channels)]
    return {"steps": steps, "channels": names}


def _imagej(page: Any, meta: Mapping[str, Any]) -> dict[str, Any]:
    """Read ImageJ's description: spacing of slices and unit; pixels per unit are in the tags."""
    unit = unit_of(meta.get("unit"))
    steps = {name: step._replace(unit=unit) for name, step in _tag_steps(page, 1.0).items()}
    spacing = meta.get("spacing")
    if isinstance(spacing, (int, float)) and spacing:
        steps["z"] = Step(abs(float(spacing)), float(meta.get("zorigin", 0) or 0), unit)
    for name in ("x", "y", "z"):
        own = unit_of(meta.get(f"{name}unit"))
        if own and name in steps:
            steps[name] = steps[name]._replace(unit=own)
    return {"steps": {name: step for name, step in steps.items() if step.size}}


def _lsm(meta: Mapping[str, Any]) -> dict[str, Any]:
    """Read Zeiss' header, whose lengths are metres; they are told in micrometres."""
    steps = {
        name.lower(): Step(
            float(meta[f"VoxelSize{name}"]) * 1e6, float(meta.get(f"Origin{name}", 0)) * 1e6, "um"
        )
        for name in "XYZ"
        if meta.get(f"VoxelSize{name}")
    }
    colours = meta.get("ChannelColors") or {}
    return {"steps": steps, "channels": tuple(colours.get("ColorNames", ()))}


def _stk(meta: Mapping[str, Any]) -> dict[str, Any]:
    """Read MetaMorph's header: calibration and the distance of planes."""
    unit = unit_of(meta.get("CalibrationUnits"))
    steps = {}
    for name in "XY":
        size = meta.get(f"{name}Calibration")
        if isinstance(size, (int, float)) and size > 0 and unit:
            steps[name.lower()] = Step(float(size), 0.0, unit)
    distances = np.atleast_1d(np.asarray(meta.get("ZDistance", ()), np.float64))
    if distances.size and distances[0] > 0 and (distances == distances[0]).all():
        steps["z"] = Step(float(distances[0]), 0.0, unit)
    return {"steps": steps}


def _resolution(page: Any) -> dict[str, Any]:
    """Read the resolution of plain pages, unless it is one that programs write of no knowledge."""
    unit = int(page.tags.valueof("ResolutionUnit", default=2))
    steps = _tag_steps(page, {2: 25.4, 3: 10.0}.get(unit, 1.0))
    dots = [25.4 / step.size for step in steps.values() if step.size]
    if unit == 2 and all(any(abs(dot - n) < 0.5 for n in (1.0, *_PRINTED)) for dot in dots):
        return {}
    if all(step.size == 1 for step in steps.values()):
        return {}
    return {
        "steps": {k: s._replace(unit="mm" if unit in (2, 3) else None) for k, s in steps.items()}
    }


def _tag_steps(page: Any, unit: float) -> dict[str, Step]:
    """Return the steps along x and y of the tags for pixels per unit."""
    steps = {}
    for name, tag in (("x", "XResolution"), ("y", "YResolution")):
        value = page.tags.valueof(tag)
        if isinstance(value, tuple) and len(value) == 2 and all(value):
            steps[name] = Step(unit * value[1] / value[0])
    return steps
