"""Generated volumes of any size, made some slices at a time so that memory stays bounded.

Every field is a sum of products of functions of x, y and z alone, up to a pointwise function and
noise: a slice of it is one matrix product. That is fast enough for billions of samples, and
exact: no interpolation from a coarser grid. Slices are computed in threads, in double precision,
and rounded to float32.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np

from .._typing import Progress
from ..compression import checked_rate
from ..io import save
from ..io.files import atomic_path, check_output
from ..io.raw import raw_name
from ..io.slabs import compress_slabs, compute_slabs

#: Coordinates of the samples along x, y and z.
Axes = Sequence[np.ndarray]

#: Computes the slice of a number, an array of shape (height, width).
Slices = Callable[[int], np.ndarray]


@dataclass(frozen=True)
class Option:
    """A parameter of a generator.

    Attributes
    ----------
    default : int or float or None
        Used when it is not given; None when it follows from the size.
    kind : type
        int or float.
    low, high : float
        Valid range, ends included.
    description : str
        What it does.
    """

    default: float | None
    kind: type[int] | type[float]
    low: float
    high: float
    description: str


@dataclass(frozen=True)
class Generator:
    """A field that can be sampled at any size.

    Attributes
    ----------
    name : str
        What it is asked for by.
    description : str
        What it is.
    isovalues : tuple of float
        Interesting isovalues.
    make : callable
        ``make(axes, **options)``, `axes` being the coordinates of the samples along x, y and z,
        from -1 to 1; returns a function of the slice's number that computes the slice, an array
        of shape (height, width), in several threads at once.
    options : dict of str to Option
        Its parameters.
    """

    name: str
    description: str
    isovalues: tuple[float, ...]
    make: Callable[..., Slices]
    options: dict[str, Option]


def generate(
    generator: Generator,
    folder: str | os.PathLike[str],
    *,
    size: int | Sequence[int] = 128,
    progress: Progress | None = None,
    **options: float,
) -> Path:
    """Sample a field into a raw float32 file, unless it is there already.

    Parameters
    ----------
    generator : Generator
        One of `GENERATORS`.
    folder : str or os.PathLike
        Where the file is kept.
    size : int or tuple of int, default: 128
        Samples along every side, or along x, y and z; at least 2.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.
    **options
        Of the generator.

    Returns
    -------
    pathlib.Path
        A file in the naming convention of the Open SciVis data sets, see `progiso.raw`.

    Raises
    ------
    ValueError
        When the size or an option is unknown or out of range.
    """
    name, dimensions, make = _sampled(generator, size, options)
    path = Path(folder) / raw_name(name, dimensions, "float32")
    if path.is_file():
        return path
    check_output(path, needed=4 * math.prod(dimensions))
    with atomic_path(path) as temporary, open(temporary, "wb") as file:
        for slab in compute_slabs(make(), dimensions):
            slab.astype("<f4", copy=False).tofile(file)
            if progress is not None:
                progress(file.tell() / (4 * math.prod(dimensions)))
    return path


def generate_compressed(
    generator: Generator,
    folder: str | os.PathLike[str],
    *,
    size: int | Sequence[int] = 128,
    rate: float = 8.0,
    progress: Progress | None = None,
    **options: float,
) -> Path:
    """Sample a field into a compressed ``.zfp`` file, unless it is there already.

    The samples are compressed a few slices at a time: neither memory nor disk ever holds them all.

    Parameters
    ----------
    rate : float, default: 8
        Bits per sample, in (0, 32].
    generator, folder, size, progress, **options
        See `generate`.

    Returns
    -------
    pathlib.Path
        A ``.zfp`` file with header, named after the field, its dimensions and the rate.

    Raises
    ------
    ValueError
        When the size, the rate or an option is unknown or out of range.
    """
    digits = _digits(checked_rate(rate))
    name, dimensions, make = _sampled(generator, size, options)
    path = Path(folder) / f"{name}_{'x'.join(map(str, dimensions))}_rate{digits}.zfp"
    if not path.is_file():
        check_output(path, needed=int(checked_rate(rate) / 8 * math.prod(dimensions)))
        volume = compress_slabs(
            compute_slabs(make(), dimensions),
            dimensions,
            rate=rate,
            name=name,
            units=(0.0, 1.0),
            progress=progress,
        )
        save(volume, path)
    return path


def _sampled(
    generator: Generator, size: int | Sequence[int], options: dict[str, float]
) -> tuple[str, tuple[int, int, int], Callable[[], Slices]]:
    """Return a field's name with its options, its dimensions, and what makes its slices."""
    dimensions = checked_dimensions(size)
    options = _checked_options(generator, options)
    given = (f"{key}{_digits(v)}" for key, v in sorted(options.items()) if v is not None)
    name = "-".join((generator.name, *given))
    axes = (np.linspace(-1, 1, n) for n in dimensions)
    return name, dimensions, lambda: generator.make(list(axes), **options)


def checked_dimensions(size: int | Sequence[int]) -> tuple[int, int, int]:
    """Return three sides, each at least 2, from one number or three.

    Examples
    --------
    >>> checked_dimensions(64)
    (64, 64, 64)
    """
    dimensions = tuple(size) if isinstance(size, (tuple, list)) else (size,) * 3
    if len(dimensions) != 3 or any(int(n) != n or n < 2 for n in dimensions):
        raise ValueError(f"size must be one or three whole numbers of at least 2, got {size}")
    x, y, z = (int(n) for n in dimensions)
    return x, y, z


def _digits(value: float) -> str:
    """Format a number in the fewest characters that identify it."""
    short = f"{value:g}"
    return short if float(short) == value else repr(value)


def _checked_options(generator: Generator, given: dict[str, float]) -> dict[str, Any]:
    """Fill in defaults and check ranges."""
    values = {key: option.default for key, option in generator.options.items()}
    for key, value in given.items():
        if key not in values:
            known = ", ".join(values) or "none"
            raise ValueError(f"{generator.name} has no option '{key}'; it has: {known}")
        option = generator.options[key]
        if not option.low <= value <= option.high:
            raise ValueError(f"{key} must be from {option.low:g} to {option.high:g}, got {value}")
        values[key] = option.kind(value)
    return values


# ---- closed forms


def _sphere(axes: Axes) -> Slices:
    """Compute the distance from the centre."""
    x, y, z = axes
    plane = x[None, :] ** 2 + y[:, None] ** 2
    return lambda k: np.sqrt(plane + z[k] ** 2)


def _marschner_lobb(axes: Axes, k: float, alpha: float) -> Slices:
    """Compute the signal of Marschner and Lobb (1994); `k` is its frequency f_M."""
    x, y, z = axes
    radius = np.sqrt(x[None, :] ** 2 + y[:, None] ** 2)
    ripple = alpha * (1 + np.cos(2 * np.pi * k * np.cos(np.pi * radius / 2)))
    return lambda i: (1 - math.sin(np.pi * z[i] / 2) + ripple) / (2 * (1 + alpha))


# ---- gyroid with value noise


def _gyroid(axes: Axes, k: float, seed: int) -> Slices:
    """Compute a gyroid of angular frequency πk plus 0.35 (N16 + N32/2 + N64/4) of noise."""
    x, y, z = (np.pi * k * a for a in axes)
    sin_x, cos_x, sin_y, cos_y = np.sin(x), np.cos(x), np.sin(y), np.cos(y)
    noise = _value_noise(axes, ((16, 0.35), (32, 0.175), (64, 0.0875)), seed)

    def slice_at(i: int) -> np.ndarray:
        field = np.outer(cos_y, sin_x)
        field += (math.cos(z[i]) * sin_y)[:, None]
        field += math.sin(z[i]) * cos_x
        field += noise(i)  # in place: as much time would go into fresh memory as into arithmetic
        return field

    return slice_at


def _value_noise(axes: Axes, octaves: Sequence[tuple[int, float]], seed: int) -> Slices:
    """Sum weighted value noise on lattices of (cells + 1)³ standard normals.

    The lattices are drawn one after the other, z slowest. Interpolation along an axis is a sparse
    product, so a slice takes one dense product of what is left of all octaves.
    """
    random = np.random.default_rng(seed)
    lattices = [weight * random.standard_normal((c + 1,) * 3) for c, weight in octaves]
    weights = [[_fade_weights(axis, c) for axis in axes] for c, _ in octaves]
    along_x = np.vstack([w[0].T for w in weights])

    def slice_at(i: int) -> np.ndarray:
        rows = [w[1] @ np.tensordot(w[2][i], lattice, 1) for w, lattice in zip(weights, lattices)]
        return np.hstack(rows) @ along_x

    return slice_at


def _fade_weights(axis: np.ndarray, cells: int) -> np.ndarray:
    """Make the matrix that interpolates from cell corners to coordinates by a quintic fade."""
    position = (axis + 1) / 2 * cells
    cell = np.minimum(position.astype(int), cells - 1)
    t = position - cell
    fade = t * t * t * (t * (6 * t - 15) + 10)
    weights, rows = np.zeros((len(axis), cells + 1)), np.arange(len(axis))
    weights[rows, cell], weights[rows, cell + 1] = 1 - fade, fade
    return weights


# ---- random waves


def _waves(
    axes: Axes, vectors: np.ndarray, amplitudes: np.ndarray, random: np.random.Generator
) -> Slices:
    """Sum cosine waves of random phase; `vectors` are in periods per volume side."""
    x, y, z = (np.pi * np.outer(a, v) for a, v in zip(axes, vectors.T))
    phases = random.uniform(0, 2 * np.pi, len(vectors))
    along_x = np.vstack([np.cos(x).T, np.sin(x).T])

    def slice_at(i: int) -> np.ndarray:
        angle = y + z[i] + phases
        return np.hstack([amplitudes * np.cos(angle), -amplitudes * np.sin(angle)]) @ along_x

    return slice_at


def _directions(random: np.random.Generator, count: int) -> np.ndarray:
    """Draw unit vectors, uniform on the sphere."""
    vectors = random.standard_normal((count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _turbulence(axes: Axes, k: float | None, exponent: float, modes: int, seed: int) -> Slices:
    """Sum random waves of energy spectrum E(k) ~ k^-exponent, in standard deviations.

    As in Kraichnan's synthetic turbulence: the wave numbers are spaced evenly in log k from one
    period per side to `k`, each with the energy E(k) dk of its share.
    """
    random = np.random.default_rng(seed)
    highest = k if k is not None else max(2, min(map(len, axes)) // 8)
    numbers = highest ** ((np.arange(modes) + random.uniform(size=modes)) / modes)
    energy = numbers ** (1 - exponent)  # E(k) dk = k^-exponent * k d(log k)
    amplitudes = np.sqrt(2 * energy / energy.sum())
    return _waves(axes, numbers[:, None] * _directions(random, modes), amplitudes, random)


def _porous(axes: Axes, k: float, porosity: float, noise: float, modes: int, seed: int) -> Slices:
    """Imitate a scan of a porous solid: grey levels 0 and 1, soft edges, noise everywhere.

    The pores are where random waves of about `k` periods per side stay below a threshold.
    """
    random = np.random.default_rng(seed)
    numbers = k * random.uniform(0.8, 1.2, modes)
    vectors = numbers[:, None] * _directions(random, modes)
    wave = _waves(axes, vectors, np.full(modes, math.sqrt(2 / modes)), random)
    threshold = _normal_quantile(porosity)
    # Edges about 1.5 samples wide, as a detector blurs them: the waves' slope is about π k.
    sharpness = min(map(len, axes)) / (1.5 * np.pi * k)

    def slice_at(i: int) -> np.ndarray:
        solid = 0.5 + 0.5 * np.tanh(sharpness * (wave(i) - threshold))
        grain = np.random.default_rng([seed, i]).standard_normal(solid.shape, np.float32)
        return solid + noise * grain

    return slice_at


def _normal_quantile(fraction: float) -> float:
    """Return where the standard normal distribution reaches a fraction."""
    return NormalDist().inv_cdf(fraction)


_SEED = Option(7, int, 0, 2**32 - 1, "seed of the random numbers")

GENERATORS = {
    generator.name: generator
    for generator in (
        Generator(
            "sphere",
            "distance from the centre; half a side is 1",
            (0.5, 0.9, 1.2),
            _sphere,
            {},
        ),
        Generator(
            "marschner-lobb",
            "the test signal of Marschner and Lobb",
            (0.5, 0.25, 0.75),
            _marschner_lobb,
            {
                "k": Option(6, float, 0, 1e4, "frequency of the ripples"),
                "alpha": Option(0.25, float, 0, 100, "height of the ripples"),
            },
        ),
        Generator(
            "gyroid",
            "gyroid with three octaves of value noise",
            (0.0, 0.8, 1.6),
            _gyroid,
            {"k": Option(6, float, 0, 1e5, "periods per side"), "seed": _SEED},
        ),
        Generator(
            "turbulence",
            "random waves with a power-law spectrum, in standard deviations",
            (0.0, 1.0, 2.0),
            _turbulence,
            {
                "k": Option(None, float, 1, 1e5, "highest wave number (default: size / 8)"),
                "exponent": Option(1.6667, float, 0, 10, "of the energy spectrum"),
                "modes": Option(256, int, 1, 65536, "number of waves"),
                "seed": _SEED,
            },
        ),
        Generator(
            "porous",
            "noisy scan of a porous solid, pores at 0 and solid at 1",
            (0.5, 0.35),
            _porous,
            {
                "k": Option(8, float, 0.1, 1e4, "pores per side"),
                "porosity": Option(0.4, float, 0.01, 0.99, "fraction of pores"),
                "noise": Option(0.05, float, 0, 10, "standard deviation of the noise"),
                "modes": Option(96, int, 1, 65536, "number of waves"),
                "seed": _SEED,
            },
        ),
    )
}
