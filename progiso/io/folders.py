"""Folders: of DICOM files, or of numbered slices, each in a picture of its own."""

from __future__ import annotations

import glob
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._typing import Array
from .axes import Values, choose, place
from .errors import reading
from .formats import Format, opener_of
from .source import Description, Region, Selection, Source

_TIFF = (".tif", ".tiff")
_PILLOW = (".png", ".jpg", ".jpeg", ".bmp", ".jp2")
#: Suffixes of the pictures that may be slices.
PICTURES = _TIFF + _PILLOW

_DICOM = Format("dicom", "open_dicom", "DICOM", "medical")
_ZARR = Format("zarr_files", "open_zarr", "Zarr", "zarr")
_PICTURES = {
    **dict.fromkeys(_TIFF, Format("tiff_slices", "TiffSlice", "TIFF", "tiff")),
    **dict.fromkeys(_PILLOW, Format("pillow_slices", "PillowSlice", "pictures", "pictures")),
}

#: How many names a message lists.
_LISTED = 12


@dataclass(frozen=True)
class Series:
    """Pictures whose names differ by one number.

    Attributes
    ----------
    name : str
        The names' pattern, with "#" for the number.
    files : tuple of pathlib.Path
        In the order of the numbers.
    numbers : tuple of int
        Of the files; empty where the name has none.
    """

    name: str
    files: tuple[Path, ...]
    numbers: tuple[int, ...]


def open_folder(path: Path, selection: Selection) -> Source:
    """Open a folder of DICOM files or of numbered slices.

    Parameters
    ----------
    path : pathlib.Path
        The folder. Zarr's need not be called ``.zarr``.
    selection : Selection
        ``series`` is one of several series of names, ``component`` one of colours.

    Raises
    ------
    ValueError
        When there are no slices, several series, gaps in the numbers, or pictures of different
        sizes or types; the message lists them.
    """
    files = sorted(file for file in path.iterdir() if file.is_file())
    if any((path / name).is_file() for name in ("zarr.json", ".zgroup", ".zarray")):
        return opener_of(_ZARR, path)(path, selection)
    if any(_is_dicom(file) for file in files):
        return opener_of(_DICOM, path)(path, selection)
    pictures = [file for file in files if _is_picture(file)]
    if not pictures:
        raise ValueError(
            f"'{path}' is a folder without DICOM files and pictures ({' '.join(PICTURES)})"
        )
    return _open_slices(path, pictures, selection)


def open_pattern(path: Path, selection: Selection) -> Source:
    """Open the numbered slices whose names match a pattern, such as ``scan/slice_*.tif``.

    Raises
    ------
    FileNotFoundError
        When there are none.
    ValueError
        As `open_folder` does.
    """
    files = [Path(name) for name in sorted(glob.glob(str(path)))]
    pictures = [file for file in files if _is_picture(file)]
    if not files:
        raise FileNotFoundError(f"there are no files '{path}'")
    if not pictures:
        raise ValueError(f"'{path}' are no pictures ({' '.join(PICTURES)}): {_names(files)}")
    return _open_slices(path, pictures, selection)


def open_picture(path: Path, selection: Selection) -> Source:
    """Open a picture as a volume of one slice; its first row is the first along y."""
    return _open_slices(path, [path], selection)


class SliceSource(Source):
    """Slices in pictures of their own; each is opened when it is read."""

    concurrent = True

    def __init__(
        self, about: Description, files: Sequence[Path], component: int | None, values: Values
    ) -> None:
        super().__init__(about)
        self._files, self._component, self._values = tuple(files), component, values

    def _read(self, region: Region) -> Array:
        slices, rows, columns = region
        shape = [part.stop - part.start for part in region]
        if self.about.components > 1:
            shape.append(self.about.components)
        found = np.ma.MaskedArray(np.empty(shape, self.dtype))
        for place_, file in enumerate(self._files[slices]):
            with reading(file):
                samples = _picture(file).read(rows, columns)
            if self._component is not None and samples.ndim == 3:
                samples = samples[..., self._component]
            found[place_] = self._values.decode(samples)
        return found if np.ma.is_masked(found) else found.data


def series_of(files: Sequence[Path]) -> list[Series]:
    """Sort pictures into series whose names differ by one number, the last one that varies.

    Examples
    --------
    >>> [series.name for series in series_of([Path("a_c0_z9.png"), Path("a_c0_z10.png")])]
    ['a_c0_z#.png']
    """
    alike: dict[tuple[str, ...], list[tuple[list[str], Path]]] = {}
    for file in files:
        parts = re.split(r"(\d+)", file.stem)
        key = (str(file.parent), *parts[::2], file.suffix.lower())
        alike.setdefault(key, []).append((parts, file))
    found: list[Series] = []
    for group in alike.values():
        found += _split(group)
    return sorted(found, key=lambda series: _natural(series.name))


def _split(group: Sequence[tuple[list[str], Path]]) -> list[Series]:
    """Split names of the same words by all numbers but the last one that varies."""
    count = len(group[0][0])
    varying = [i for i in range(1, count, 2) if len({int(parts[i]) for parts, _ in group}) > 1]
    counted = varying[-1] if varying else count - 2
    if counted < 1:
        return [Series(file.name, (file,), ()) for _, file in group]
    series: dict[tuple[str, ...], list[tuple[int, Path]]] = {}
    for parts, file in group:
        rest = (*parts[:counted], "#", *parts[counted + 1 :], file.suffix)
        key = tuple(str(int(part)) if part.isdigit() else part for part in rest)
        series.setdefault(key, []).append((int(parts[counted]), file))
    return [
        Series("".join(key), tuple(f for _, f in pairs), tuple(n for n, _ in pairs))
        for key, pairs in ((key, sorted(pairs)) for key, pairs in series.items())
    ]


def _open_slices(path: Path, files: Sequence[Path], selection: Selection) -> Source:
    """Open the slices of one series."""
    notes: list[str] = []
    several = series_of(files)
    names = [series.name for series in several]
    if len(several) > 1 and selection.series is None:
        listed = ", ".join(f"{s.name!r} ({len(s.files)})" for s in several[:_LISTED])
        more = f" and {len(several) - _LISTED} more" if len(several) > _LISTED else ""
        raise ValueError(
            f"'{path}' holds several series of pictures: {listed}{more}; choose by --series, or by "
            "a pattern of names"
        )
    series = several[choose(path, "series", selection.series, names)]
    _check_numbers(path, series, notes)
    for kind in ("channel", "time", "level"):
        choose(path, kind, getattr(selection, kind) or 0, 1)
    first = _picture(series.files[0])
    for file in series.files[1:]:
        picture = _picture(file)
        if (picture.shape, picture.dtype) != (first.shape, first.dtype):
            raise ValueError(
                f"'{file}' is {_told(picture)}, but '{series.files[0].name}' is {_told(first)}"
            )
    components = first.shape[2] if len(first.shape) == 3 else 1
    component = selection.component
    if component is not None:
        component = choose(path, "component", component, components)
        components = 1
    values = Values(first.dtype)
    shape = (len(series.files), first.shape[0], first.shape[1])
    notes += first.notes
    about = Description(
        what=str(path),
        shape=shape,
        dtype=values.dtype,
        components=components,
        name=series.name.split("#")[0].rstrip("_-. ") or path.stem,
        geometry=place(first.steps, shape, notes),
        chunks=(1, *shape[1:]),
        series=tuple(names) if len(names) > 1 else (),
        notes=tuple(notes),
    )
    return SliceSource(about, series.files, component, values)


def _check_numbers(path: Path, series: Series, notes: list[str]) -> None:
    """Raise where numbers of slices are missing, or there twice."""
    steps = np.diff(series.numbers)
    if (steps == 0).any():
        place_ = int(np.flatnonzero(steps == 0)[0])
        twice = _names(series.files[place_ : place_ + 2])
        raise ValueError(f"'{path}' holds two slices of one number: {twice}")
    if len(steps) > 1 and (steps == steps[0]).all() and steps[0] > 1:
        notes.append(f"the numbers of slices rise by {steps[0]}")
    elif (steps != 1).any():
        gaps = [
            f"{a + 1}" if b - a == 2 else f"{a + 1} to {b - 1}"
            for a, b in zip(series.numbers, series.numbers[1:])
            if b - a > 1
        ]
        more = f" and {len(gaps) - _LISTED} more" if len(gaps) > _LISTED else ""
        raise ValueError(
            f"'{path}' lacks slices of {series.name!r}: {', '.join(gaps[:_LISTED])}{more}"
        )


def _picture(file: Path) -> Any:
    """Return what reads a picture: it has shape, dtype, steps, notes and ``read``."""
    make: Callable[..., Any] = opener_of(_PICTURES[file.suffix.lower()], file)
    with reading(file):
        return make(file)


def _is_picture(file: Path) -> bool:
    return file.suffix.lower() in PICTURES and not file.name.startswith(".") and file.is_file()


def _is_dicom(file: Path) -> bool:
    """Tell whether a file is DICOM by its name, or by the letters after its preamble."""
    if file.suffix.lower() in (".dcm", ".dicom", ".ima") or file.name.upper() == "DICOMDIR":
        return True
    if file.suffix.lower() in PICTURES:
        return False
    with open(file, "rb") as opened:
        return opened.read(132)[128:] == b"DICM"


def _natural(name: str) -> list[tuple[int, str]]:
    """Return a key that sorts numbers in names by their values."""
    return [(int(p), "") if p.isdigit() else (-1, p) for p in re.split(r"(\d+)", name)]


def _names(files: Sequence[Path]) -> str:
    more = f" and {len(files) - _LISTED} more" if len(files) > _LISTED else ""
    return ", ".join(file.name for file in files[:_LISTED]) + more


def _told(picture: Any) -> str:
    return (
        f"{picture.shape[1]}x{picture.shape[0]} of {picture.dtype}, {picture.shape[2:] or 'grey'}"
    )
