"""Make the measured volumes from names that say all: ``gyroid-512-k12-r4``, ``ct-cranium``."""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..compression import decompress
from ..data import GENERATORS, SCANS, cache_folder, fetch
from ..data import compressed as fetch_compressed
from ..data.generators import checked_dimensions
from ..io import compress, read, save

_NAME = re.compile(
    r"(?P<volume>[a-z]+(?:-[a-z]+)*)(?:-(?P<size>\d+(?:x\d+x\d+)?))?"
    r"(?:-k(?P<k>\d+(?:\.\d+)?))?(?:-r(?P<rate>\d+(?:\.\d+)?))?"
)

#: Bits per sample where a name does not say.
SCAN_RATE, GENERATED_RATE = 8.0, 4.0


class TooLarge(RuntimeError):
    """A volume cannot be made or held on this machine; the message says what it would take."""


@dataclass(frozen=True)
class Field:
    """A volume and the rate it is compressed at.

    Attributes
    ----------
    volume : str
        One of `progiso.data.SCANS` or `progiso.data.GENERATORS`.
    dimensions : tuple of int
        Samples along x, y and z.
    rate : float
        Bits per sample.
    k : float, optional
        Frequency of a generated field that has one.
    """

    volume: str
    dimensions: tuple[int, int, int]
    rate: float
    k: float | None = None

    @property
    def name(self) -> str:
        """Return the name that asks for the field and reports it."""
        if self.volume in SCANS:
            return f"{self.volume}-r{self.rate:g}"
        x, y, z = self.dimensions
        size = f"{x}" if x == y == z else f"{x}x{y}x{z}"
        k = "" if self.k is None else f"-k{self.k:g}"
        return f"{self.volume}-{size}{k}-r{self.rate:g}"

    @property
    def voxels(self) -> int:
        """Return the number of samples."""
        return int(np.prod(self.dimensions, dtype=object))

    @property
    def blocks(self) -> int:
        """Return the number of 4³ blocks."""
        return int(np.prod([-(-n // 4) for n in self.dimensions], dtype=object))

    @property
    def isovalues(self) -> tuple[float, ...]:
        """Return the fixed isovalues, the most interesting first."""
        if self.volume in SCANS:
            return tuple(map(float, SCANS[self.volume].isovalues.values()))
        return tuple(map(float, GENERATORS[self.volume].isovalues))

    def random_isovalues(self, count: int, seed: int) -> list[float]:
        """Draw isovalues from the range of interest, which the fixed ones span.

        Parameters
        ----------
        count : int
            How many.
        seed : int
            Of the random numbers: the same gives the same isovalues.

        Returns
        -------
        list of float
        """
        low, high = min(self.isovalues), max(self.isovalues)
        return np.random.default_rng(seed).uniform(low, high, count).tolist()


def parse_field(name: str) -> Field:
    """Make a field of its name.

    Parameters
    ----------
    name : str
        ``SCAN[-rRATE]`` or ``GENERATOR[-SIZE][-kK][-rRATE]``; by default 128 samples a side, the
        generator's own frequency, and 8 bits per sample for scans, 4 for generated fields.

    Returns
    -------
    Field

    Raises
    ------
    ValueError
        When there is no such volume, or it does not take what the name says.

    Examples
    --------
    >>> parse_field("gyroid-256-r2").name
    'gyroid-256-k6-r2'
    """
    match = _NAME.fullmatch(name)
    volume = match["volume"] if match else name
    if match is None or volume not in SCANS and volume not in GENERATORS:
        known = ", ".join((*SCANS, *GENERATORS))
        raise ValueError(f"no field '{name}': write NAME-SIZE-kK-rRATE, NAME one of {known}")
    rate = float(match["rate"]) if match["rate"] else None
    if rate is not None and not 0 < rate <= 32:
        raise ValueError(f"no field '{name}': the rate must be in (0, 32] bits per sample")
    if volume in SCANS:
        if match["size"] or match["k"]:
            raise ValueError(f"no field '{name}': a scan takes a rate only, as in {volume}-r8")
        return Field(volume, SCANS[volume].dimensions, rate or SCAN_RATE)
    sides = [int(n) for n in (match["size"] or "128").split("x")]
    dimensions = checked_dimensions(sides[0] if len(sides) == 1 else sides)
    return Field(volume, dimensions, rate or GENERATED_RATE, _frequency(name, volume, match["k"]))


def _frequency(name: str, volume: str, text: str | None) -> float | None:
    """Parse and check the parameter k of a generator."""
    option = GENERATORS[volume].options.get("k")
    if text is None:
        return option.default if option else None
    if option is None:
        raise ValueError(f"no field '{name}': {volume} has no k")
    if not option.low <= float(text) <= option.high:
        raise ValueError(f"no field '{name}': k must be from {option.low:g} to {option.high:g}")
    return float(text)


def plain_path(field: Field) -> Path:
    """Return the file of the uncompressed volume; fetch or generate it if it is not cached.

    Parameters
    ----------
    field : Field

    Returns
    -------
    pathlib.Path

    Raises
    ------
    TooLarge
        When there is no room on the disk for the samples.
    """
    if field.volume in SCANS:
        return fetch(field.volume)
    _check_disk(4 * field.voxels, "samples")
    return fetch(field.volume, size=field.dimensions, **_options(field))


def _options(field: Field) -> dict[str, Any]:
    """Return the options of the field's generator."""
    return {} if field.k is None else {"k": field.k}


def _check_disk(needed: int, what: str) -> None:
    free = shutil.disk_usage(cache_folder()).free
    if needed > free:
        raise TooLarge(f"its {what} take {gib(needed)} of disk, {gib(free)} are free")


@lru_cache(maxsize=1)
def plain(field: Field) -> vtkImageData:
    """Read the uncompressed volume; a generated one is a memory map, not to be written to.

    Parameters
    ----------
    field : Field

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData

    Raises
    ------
    TooLarge
        As `plain_path`.
    """
    return read(plain_path(field))


@lru_cache(maxsize=1)
def compressed(field: Field) -> vtkImageData:
    """The compressed volume; a generated one is made without its samples ever being there as a
    whole.

    Parameters
    ----------
    field : Field

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData

    Raises
    ------
    TooLarge
        When there is no room on the disk.
    """
    if field.volume in SCANS:
        return compress(plain(field), rate=field.rate)
    _check_disk(int(field.voxels * field.rate / 8), "bits")
    return read(
        fetch_compressed(field.volume, size=field.dimensions, rate=field.rate, **_options(field))
    )


def save_compressed(field: Field, folder: str | os.PathLike[str]) -> Path:
    """Write the compressed volume in the format that loads fastest.

    Parameters
    ----------
    field : Field
    folder : str or os.PathLike

    Returns
    -------
    pathlib.Path
        A ``.vti`` with its data appended.
    """
    path = Path(folder) / f"{field.name}.vti"
    save(compressed(field), path, appended=True)
    return path


def decompressed(field: Field) -> vtkImageData:
    """Decompress the compressed volume to float32 samples.

    Parameters
    ----------
    field : Field

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
    """
    return decompress(compressed(field))


def gib(count: int) -> str:
    """Format a number of bytes in GiB.

    Examples
    --------
    >>> gib(3 * 2**29)
    '1.5 GiB'
    """
    return f"{count / 2**30:.1f} GiB"
