"""DICOM: series in folders, single files and files of several frames, by pydicom."""

from __future__ import annotations

import io
import json
import logging
import os
import subprocess
import sys
import warnings
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pydicom
from pydicom.errors import InvalidDicomError
from pydicom.pixels import iter_pixels
from pydicom.uid import MediaStorageDirectoryStorage, RLELossless

from .._typing import Array
from .errors import reason_of
from .header_text import checked_geometry, shortened
from .source import Description, Geometry, Region, Selection, Source
from .stored import checked_index, chosen

# what pydicom logs would be printed where nobody handles it
logging.getLogger("pydicom").addHandler(logging.NullHandler())

#: What of a header is read.
_TAGS = """SOPClassUID SOPInstanceUID SeriesInstanceUID SeriesDescription SeriesNumber Modality
    InstanceNumber Rows Columns SamplesPerPixel BitsAllocated BitsStored PixelRepresentation
    NumberOfFrames PhotometricInterpretation ImagePositionPatient ImageOrientationPatient
    PixelSpacing ImagerPixelSpacing SliceThickness SpacingBetweenSlices GridFrameOffsetVector
    RescaleSlope RescaleIntercept TemporalPositionIdentifier AcquisitionNumber EchoNumbers
    TriggerTime AcquisitionTime SharedFunctionalGroupsSequence PerFrameFunctionalGroupsSequence
    DoseGridScaling""".split()

#: How far a slice may be from its place in an even row, in steps.
_UNEVEN = 0.1

#: How many things a message lists.
_LISTED = 12


@dataclass(frozen=True)
class _Frame:
    """A slice: where its samples are, and where it lies."""

    file: Path
    index: int
    position: tuple[float, ...] | None
    orientation: tuple[float, ...] | None
    spacing: tuple[float, ...]
    thickness: float
    slope: float
    intercept: float
    order: tuple[float, ...]
    apart: bool


@dataclass(frozen=True)
class _Kind:
    """What slices of one volume have in common."""

    series: str
    rows: int
    columns: int
    samples: int
    bits: int
    stored: int
    signed: bool
    real: str
    modality: str
    orientation: tuple[float, ...]


@dataclass
class _Series:
    """Slices of one kind, and what they are called."""

    kind: _Kind
    description: str
    frames: list[_Frame]

    def title(self) -> str:
        """Return its UID and what people know it by."""
        about = f"{self.kind.columns}x{self.kind.rows}, {len(self.frames)} slices"
        return f"{self.kind.series} ({self.description or self.kind.modality}, {about})"


class DicomSource(Source):
    """Slices in DICOM files, each decoded when it is read.

    Parameters
    ----------
    about : Description
        What the headers tell.
    frames : sequence of _Frame
        One for each slice.
    component : int or None
        What is chosen of colours.
    """

    concurrent = True

    def __init__(self, about: Description, frames: Sequence[_Frame], component: int | None) -> None:
        super().__init__(about)
        self._frames, self._component = tuple(frames), component

    def _read(self, region: Region) -> Array:
        slices, rows, columns = region
        wanted = self._frames[slices]
        shape: tuple[int, ...] = (
            len(wanted),
            rows.stop - rows.start,
            columns.stop - columns.start,
        )
        if self.about.components > 1:
            shape += (self.about.components,)
        found: Array = np.empty(shape, self.dtype)
        files: dict[Path, list[int]] = {}
        for place, frame in enumerate(wanted):
            files.setdefault(frame.file, []).append(place)
        for places in files.values():
            places.sort(key=lambda place: wanted[place].index)
        jobs = [(file, [wanted[p].index for p in places]) for file, places in files.items()]
        order = [place for places in files.values() for place in places]
        with closing(_decoded_apart(jobs) if wanted[0].apart else _decoded(jobs)) as decoded:
            for place in order:
                part = self._next(decoded, wanted[place].file)[rows, columns]
                if self._component is not None:
                    part = part[..., self._component]
                found[place] = self._scaled(part, wanted[place])
        return found

    def _next(self, decoded: Iterator[Array], file: Path) -> Array:
        """Return the next frame, which is one of a file."""
        try:
            pixels = next(decoded, None)
            if pixels is None:
                raise ValueError("frames are missing")
            if pixels.shape[:2] != self.shape[1:]:
                raise ValueError(f"its pixels are {pixels.shape}, not {self.shape[1:]}")
        except Exception as error:
            raise ValueError(
                f"'{self.about.what}': cannot decode '{file.name}': {reason_of(error)}"
            ) from error
        return pixels

    def _scaled(self, pixels: Array, frame: _Frame) -> Array:
        """Apply a slice's slope and intercept."""
        plain = (frame.slope, frame.intercept) == (1, 0)
        if plain and np.can_cast(pixels.dtype, self.dtype, "safe"):
            return pixels
        if self.dtype.kind == "f":
            return (pixels * np.float64(frame.slope) + frame.intercept).astype(self.dtype)
        shifted = pixels.astype(np.int64) + int(frame.intercept)
        limits = np.iinfo(self.dtype)
        if shifted.min() < limits.min or shifted.max() > limits.max:
            raise ValueError(
                f"'{self.about.what}': samples of '{frame.file.name}' are longer than its header "
                "says (BitsStored)"
            )
        return shifted.astype(self.dtype)


def _decoded(jobs: list[tuple[Path, list[int]]]) -> Generator[Array, None, None]:
    """Decode frames of files, in ascending order."""
    for file, indices in jobs:
        yield from iter_pixels(file, indices=indices)


def _decoded_apart(jobs: list[tuple[Path, list[int]]]) -> Generator[Array, None, None]:
    """Decode frames in a process of its own: GDCM ends it on some damaged files."""
    lines = "".join(json.dumps([os.path.abspath(f), i]) + "\n" for f, i in jobs)
    script = Path(__file__).with_name("dicom_decoder.py").read_text("utf-8")
    command = [sys.executable, "-c", script]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        assert process.stdin is not None and process.stdout is not None
        try:
            with suppress(BrokenPipeError), process.stdin as stdin:
                stdin.write(lines.encode())
            for _ in range(sum(len(indices) for _, indices in jobs)):
                length = int.from_bytes(process.stdout.read(8), "little")
                packed = process.stdout.read(length)
                if not packed or len(packed) < length:
                    raise ValueError("the decoder (GDCM) failed")
                found = np.load(io.BytesIO(packed), allow_pickle=False)
                if found.dtype.kind == "U":
                    raise ValueError(str(found))
                yield found
        finally:
            process.kill()


def open_dicom(path: Path, selection: Selection) -> DicomSource:
    """Open a DICOM file, or the series in a folder and the folders in it.

    Slices are put in order by their positions; their world is left-posterior-superior. A slope and
    an intercept are applied. Where several slices share every position, they are time points.

    Raises
    ------
    ValueError
        When there are several series, of which `selection.series` chooses one by its number or UID,
        slices are missing or lie unevenly, or there are no images; the message lists what there is.
    """
    notes: list[str] = []
    with warnings.catch_warnings(record=True) as unusual:
        warnings.simplefilter("always")
        found = _scan(path, notes)
    if unusual:
        first = shortened(" ".join(str(unusual[0].message).split()))
        notes.append(f"headers are unusual, {len(unusual)} times: {first}")
    if not found:
        raise ValueError(f"'{path}' holds no DICOM images{_aside(notes)}")
    series = _chosen_series(path, found, selection.series)
    return _source(path, series, [s.title() for s in found], selection, notes)


# --- headers --------------------------------------------------------------------------------------


def _scan(path: Path, notes: list[str]) -> list[_Series]:
    """Read all headers; what is no image is told in the notes."""
    alone = path.is_file()
    files = [path] if alone else sorted(_files(path))
    found: dict[_Kind, _Series] = {}
    others: list[str] = []
    seen: set[str] = set()
    for file in files:
        header = _header(file, alone)
        if header is None or header.get("Rows") is None or header.get("Columns") is None:
            others.append(file.name)
            continue
        instance = str(header.get("SOPInstanceUID", file))
        if instance in seen:
            notes.append(f"'{file.name}' is there twice")
            continue
        seen.add(instance)
        try:
            _add(found, file, header)
        except (TypeError, ValueError, AttributeError, IndexError, OverflowError) as error:
            raise ValueError(
                f"'{path}': the header of '{file.name}': {reason_of(error)}"
            ) from error
    if others:
        notes.append(f"{len(others)} files are no images and left out: {_list(others)}")
    return sorted(found.values(), key=lambda s: (s.kind.series, -len(s.frames)))


def _files(folder: Path) -> Iterable[Path]:
    for inner, _, names in os.walk(folder):
        for name in names:
            if not name.startswith(".") and (Path(inner) / name).is_file():
                yield Path(inner) / name


def _header(file: Path, alone: bool) -> Any:
    """Read a header up to the pixels; None where the file is not DICOM, or lists other files."""
    try:
        header = pydicom.dcmread(file, stop_before_pixels=True, specific_tags=_TAGS)
    except InvalidDicomError:
        if alone:
            raise ValueError(f"'{file}' is not a DICOM file") from None
        return None
    except Exception as error:
        raise ValueError(f"cannot read '{file}': {reason_of(error)}") from error
    kind = header.file_meta.get("MediaStorageSOPClassUID", header.get("SOPClassUID"))
    if kind == MediaStorageDirectoryStorage:
        if alone:
            raise ValueError(f"'{file}' only lists other files: name its folder")
        return None
    return header


def _add(found: dict[_Kind, _Series], file: Path, header: Any) -> None:
    """Add a file's frames to the series that they belong to."""
    count = int(header.get("NumberOfFrames") or 1)
    rows, columns = int(header.Rows), int(header.Columns)
    samples = int(header.get("SamplesPerPixel") or 1)
    bits = int(header.get("BitsAllocated") or 0)
    if min(count, rows, columns, samples) < 1 or bits not in (1, 8, 16, 32, 64):
        raise ValueError(f"{columns}x{rows} pixels of {bits} bits, {count} frames")
    _check_size(file, header, count * rows * columns * samples * bits // 8)
    modality = str(header.get("Modality", ""))
    for index in range(count):
        frame = _frame(file, header, index, modality)
        kind = _Kind(
            series=str(header.get("SeriesInstanceUID", "")),
            rows=rows,
            columns=columns,
            samples=samples,
            bits=bits,
            stored=int(header.get("BitsStored") or bits),
            signed=bool(header.get("PixelRepresentation")),
            real=_real(file, header),
            modality=modality,
            orientation=tuple(np.round(frame.orientation or (), 3).tolist()),
        )
        series = found.setdefault(kind, _Series(kind, str(header.get("SeriesDescription", "")), []))
        series.frames.append(frame)


def _check_size(file: Path, header: Any, expected: int) -> None:
    """Raise where a file without compression is too short for its pixels."""
    syntax = header.file_meta.get("TransferSyntaxUID")
    if syntax is None or not syntax.is_transfer_syntax or syntax.is_compressed:
        return
    if header.get("PhotometricInterpretation") == "YBR_FULL_422":
        expected = expected * 2 // 3
    size = file.stat().st_size
    if not syntax.is_deflated and size < expected:
        raise ValueError(f"truncated: {size} bytes, of which {expected} should be pixels")


def _real(file: Path, header: Any) -> str:
    """Return NumPy's type of pixels that are real numbers, which few files have."""
    if header.get("BitsAllocated") not in (32, 64) or "BitsStored" in header:
        return ""
    return "f4" if header.BitsAllocated == 32 else "f8"


def _frame(file: Path, header: Any, index: int, modality: str) -> _Frame:
    """Gather what a header says about one frame, for itself or for all."""
    groups = [
        sequence[number]
        for sequence, number in (
            (header.get("PerFrameFunctionalGroupsSequence"), index),
            (header.get("SharedFunctionalGroupsSequence"), 0),
        )
        if sequence and len(sequence) > number
    ]

    def tell(group: str, key: str) -> Any:
        for item in groups:
            inner = item.get(group)
            if inner and inner[0].get(key) is not None:
                return inner[0].get(key)
        return header.get(key)

    position = _numbers(tell("PlanePositionSequence", "ImagePositionPatient"), 3)
    orientation = _numbers(tell("PlaneOrientationSequence", "ImageOrientationPatient"), 6)
    offsets = header.get("GridFrameOffsetVector")
    if position and orientation and offsets and not groups:
        normal = np.cross(orientation[:3], orientation[3:])
        start = float(offsets[0]) if float(offsets[0]) == 0 else 0.0
        position = tuple(np.array(position) + normal * (float(offsets[index]) - start))
    elif position and orientation and index and not groups and header.get("SpacingBetweenSlices"):
        normal = np.cross(orientation[:3], orientation[3:])
        position = tuple(np.array(position) + normal * float(header.SpacingBetweenSlices) * index)
    measures = "PixelMeasuresSequence"
    spacing = _numbers(tell(measures, "PixelSpacing") or header.get("ImagerPixelSpacing"), 2)
    thickness = tell(measures, "SpacingBetweenSlices") or tell(measures, "SliceThickness")
    values = "PixelValueTransformationSequence"
    slope, intercept = tell(values, "RescaleSlope"), tell(values, "RescaleIntercept")
    if slope is None and modality == "RTDOSE":
        slope = header.get("DoseGridScaling")
    times = [tell("TemporalPositionSequence", "TemporalPositionTimeOffset")]
    times += [header.get(k) for k in ("TemporalPositionIdentifier", "AcquisitionNumber")]
    times += [header.get(k) for k in ("EchoNumbers", "TriggerTime", "AcquisitionTime")]
    return _Frame(
        file=file,
        index=index,
        position=position,
        orientation=orientation,
        spacing=spacing or (1.0, 1.0),
        thickness=float(thickness or 1),
        slope=1.0 if slope is None else float(slope),
        intercept=float(intercept or 0),
        order=(*map(_order, times), _order(header.get("InstanceNumber")), float(index)),
        apart=_needs_gdcm(header),
    )


def _needs_gdcm(header: Any) -> bool:
    """Tell whether pixels are compressed in a way that pydicom itself does not decode."""
    syntax = header.file_meta.get("TransferSyntaxUID")
    known = syntax is not None and syntax.is_transfer_syntax
    return bool(known and syntax.is_encapsulated and syntax != RLELossless)


def _numbers(value: Any, count: int) -> tuple[float, ...] | None:
    if value is None or value == "" or len(value) == 0:
        return None
    if len(value) != count:
        raise ValueError(f"{value} should be {count} numbers")
    return tuple(float(v) for v in value)


def _order(value: Any) -> float:
    """Return a number to sort by."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return 0.0


# --- series ---------------------------------------------------------------------------------------


def _chosen_series(path: Path, found: list[_Series], wanted: int | str | None) -> _Series:
    """Return the one series, or that which is chosen by number, UID or description."""
    listed = "; ".join(f"{i}: {s.title()}" for i, s in enumerate(found[:_LISTED]))
    listed += "; …" if len(found) > _LISTED else ""
    if isinstance(wanted, str) and wanted.isdigit() and len(wanted) < 6:
        wanted = int(wanted)
    if wanted is None and len(found) == 1:
        return found[0]
    if wanted is None:
        raise ValueError(
            f"'{path}' holds {len(found)} series: choose one by --series, by its number or UID: "
            f"{listed}"
        )
    if isinstance(wanted, int):
        fitting = found[wanted : wanted + 1] if wanted >= 0 else []
    else:
        fitting = [s for s in found if wanted in (s.kind.series, s.description, s.title())]
    if len(fitting) != 1:
        count = f"{len(fitting)} series" if fitting else "no series"
        raise ValueError(f"'{path}' has {count} {wanted!r}; it has {listed}")
    return fitting[0]


def _source(
    path: Path, series: _Series, titles: list[str], selection: Selection, notes: list[str]
) -> DicomSource:
    """Put a series' slices in order."""
    kind = series.kind
    rounds, geometry = _in_order(path, series.frames, notes)
    time, told = chosen(str(path), "time point", selection.time, len(rounds))
    component = checked_index(str(path), "component", selection.component, kind.samples)
    component = None if kind.samples == 1 else component
    frames = rounds[time]
    if path.is_file() and len(frames) == 1:
        notes.append("it is one slice: name its folder to read the series")
    about = Description(
        what=str(path),
        shape=(len(frames), kind.rows, kind.columns),
        dtype=_dtype(kind, [f for r in rounds for f in r]),
        components=kind.samples if component is None else 1,
        geometry=geometry,
        chunks=(1, kind.rows, kind.columns),
        times=len(rounds),
        series=tuple(titles) if len(titles) > 1 else (),
        labels=True if kind.modality == "SEG" else None,
        notes=(*notes, *told),
    )
    return DicomSource(about, frames, component)


def _in_order(
    path: Path, frames: list[_Frame], notes: list[str]
) -> tuple[list[list[_Frame]], Geometry]:
    """Return the slices of each time point along the normal, and where they lie."""
    first = frames[0]
    if any(f.position is None or f.orientation is None for f in frames):
        notes.append("its slices tell no positions: they are in the order of their numbers")
        rows, columns = first.spacing
        axes = np.diag([columns, rows, first.thickness])
        ordered = sorted(frames, key=lambda f: f.order[-2:])
        return [ordered], checked_geometry(path, axes, np.zeros(3), units="mm")
    directions: Array = np.reshape(np.array(first.orientation, float), (2, 3))
    across, down = directions
    normal = np.cross(across, down)
    normal /= np.linalg.norm(normal) or 1
    places: dict[float, list[_Frame]] = {}
    for frame in frames:
        places.setdefault(round(float(normal @ np.array(frame.position)), 4), []).append(frame)
    depths = sorted(places)
    counts = {len(places[d]) for d in depths}
    if len(counts) > 1:
        most = max(counts)
        lacking = [f"{d:g}" for d in depths if len(places[d]) < most]
        raise ValueError(
            f"'{path}': slices are missing or there twice: {most} at most places, fewer at "
            f"{_list(lacking)} mm{_aside(notes)}"
        )
    _check_gaps(path, depths, notes)
    slices = [sorted(places[d], key=lambda f: f.order) for d in depths]
    rounds = [[s[time] for s in slices] for time in range(counts.pop())]
    start = np.array(rounds[0][0].position, float)
    step = normal * first.thickness
    if len(depths) > 1:  # of a tilted gantry, not along the normal
        step = (np.array(rounds[0][-1].position, float) - start) / (len(depths) - 1)
    axes = np.column_stack([across * first.spacing[1], down * first.spacing[0], step])
    return rounds, checked_geometry(path, axes, start, units="mm", space="LPS")


def _check_gaps(path: Path, depths: list[float], notes: list[str]) -> None:
    """Raise where slices do not lie evenly, and tell where."""
    if len(depths) < 3:
        return
    steps = np.diff(depths)
    usual = float(np.median(steps))
    gaps = [
        f"{a:g} to {b:g}" for a, b, step in zip(depths, depths[1:], steps) if step > 1.5 * usual
    ]
    if gaps:
        raise ValueError(
            f"'{path}': slices are missing, which are {usual:g} mm apart: {_list(gaps)} mm"
            f"{_aside(notes)}"
        )
    even = np.linspace(depths[0], depths[-1], len(depths))
    if np.abs(np.array(depths) - even).max() > _UNEVEN * usual:
        raise ValueError(
            f"'{path}': slices are unevenly spaced, {steps.min():g} to {steps.max():g} mm apart: "
            "resample them first"
        )


def _dtype(kind: _Kind, frames: list[_Frame]) -> np.dtype[Any]:
    """Return the type that samples get by slopes and intercepts."""
    if kind.real:
        return np.dtype(kind.real)
    bits = max(8, kind.bits)
    slopes = {f.slope for f in frames}
    intercepts = {f.intercept for f in frames}
    if slopes == {1.0} and intercepts == {0.0}:
        return np.dtype(f"{'i' if kind.signed else 'u'}{bits // 8}")
    if slopes != {1.0} or not all(float(i).is_integer() for i in intercepts):
        return np.dtype(np.float32 if bits <= 16 else np.float64)
    stored = min(kind.stored, bits)
    lowest = -(2 ** (stored - 1)) if kind.signed else 0
    highest = lowest + 2**stored - 1
    for name in ("i2", "i4", "i8"):
        limits = np.iinfo(name)
        if limits.min <= lowest + min(intercepts) and highest + max(intercepts) <= limits.max:
            return np.dtype(name)
    return np.dtype(np.float64)


def _aside(notes: list[str]) -> str:
    return f" ({'; '.join(notes)})" if notes else ""


def _list(names: Sequence[str]) -> str:
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return ", ".join(names[:_LISTED]) + more
