"""The commands: each takes the parsed arguments, and prints its results."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

import progiso

from .._typing import Progress
from ..data import GENERATORS, SCANS, compressed, fetch
from ..data.catalogue import Scan
from ..io import Selection, Source, open_source
from ..io.compressing import as_compressed, compress_source
from ..io.files import atomic_path, check_output, check_outputs
from ..io.volumes import COMPRESSED_SUFFIXES, PLAIN_SUFFIXES
from ..mesh import SURFACE_SUFFIXES
from ..options import (
    DEFAULT_RATE,
    CompressionOptions,
    RenderOptions,
    SurfaceStyle,
    levels_to_make,
)
from .info import describe_source, file_bytes, verify_source
from .progress import progress_bar


def _open(parsed: argparse.Namespace, name: str = "file") -> Source:
    """Open the input, as the options choose of it."""
    path = getattr(parsed, name)
    dimensions, rate = getattr(parsed, "zfp_header", (None, None))
    if dimensions and Path(path).suffix.lower() != ".zfp":
        raise ValueError(f"--zfp-header is for .zfp files, it does not go with '{path}'")
    given = _given(parsed, Selection) | {"component": None}  # compression takes a component
    source = open_source(path, Selection(**given | {"dimensions": dimensions, "rate": rate}))
    for note in source.about.notes:
        _remark(f"'{path}': {note}")
    return source


def _read(parsed: argparse.Namespace, name: str = "file") -> vtkImageData:
    """Read the input as a whole."""
    with _open(parsed, name) as source, _reading(parsed, name) as progress:
        image = source.image(progress)
    if not source.gives_all_arrays and hasattr(parsed, "array"):
        parsed.array = None  # it has chosen the samples, which have a name of their own
    return image


def _read_compressed(parsed: argparse.Namespace, name: str = "file") -> vtkImageData:
    """Read the input to draw it, and compress it unless it is compressed."""
    levels = levels_to_make(parsed.level_of_detail)
    given = {"levels": levels, **_given(parsed, CompressionOptions)}
    with _open(parsed, name) as source, _naming(source.about.what):
        if source.more_than_samples:
            with _reading(parsed, name) as progress:
                image = source.image(progress)
            _remark_on_compressed(image, parsed)
            return as_compressed(image, CompressionOptions(**given))
        with progress_bar(f"Compressing {Path(source.about.what).name}") as progress:
            return compress_source(source, CompressionOptions(progress=progress, **given))


@contextmanager
def _naming(path: str) -> Iterator[None]:
    """Put a file's name before errors that lack it."""
    try:
        yield
    except RuntimeError as error:
        if path in str(error):
            raise
        raise RuntimeError(f"'{path}': {error}") from None


def _reading(parsed: argparse.Namespace, name: str) -> AbstractContextManager[Progress | None]:
    return progress_bar(f"Reading {Path(getattr(parsed, name)).name}")


def _save(image: vtkImageData, path: Path, *, appended: bool = False) -> None:
    with progress_bar(f"Writing {path.name}") as progress:
        progiso.save(image, path, progress=progress, appended=appended)


def _given(parsed: argparse.Namespace, kind: type) -> dict[str, Any]:
    """Return the options of a kind that were given, as keywords."""
    found = {field.name: getattr(parsed, field.name, None) for field in fields(kind)}
    return {name: value for name, value in found.items() if value is not None}


def _remark(text: str) -> None:
    """Print a note on standard error, apart from the results."""
    print(f"progiso: note: {text}", file=sys.stderr)


def _remark_on_compressed(image: vtkImageData, parsed: argparse.Namespace) -> None:
    """Print which options a compressed volume makes meaningless."""
    if not progiso.is_compressed(image):
        return
    about = progiso.describe(image)
    for name, kept in (("rate", "rate"), ("tolerance", "rate"), ("component", "component")):
        given, held = getattr(parsed, name), about[kept]
        if given not in (None, held):
            text = given if isinstance(given, str) else f"{given:g}"
            _remark(f"--{name} {text} is ignored: the file is compressed, its {kept} is {held:g}")


def compress(parsed: argparse.Namespace) -> None:
    suffixes = (".vti",) if parsed.appended else COMPRESSED_SUFFIXES
    check_output(parsed.out, suffixes, inputs=[getattr(parsed, "in")])
    with (
        _open(parsed, "in") as source,
        _naming(source.about.what),
        progress_bar(f"Compressing {Path(source.about.what).name}") as progress,
    ):
        options = CompressionOptions(progress=progress, **_given(parsed, CompressionOptions))
        volume = compress_source(source, options)
    _save(volume, parsed.out, appended=parsed.appended)
    if parsed.out.suffix.lower() == ".zfp":
        _remark("a .zfp file keeps the samples alone: no origin, no spacing, no array's name")
    about = progiso.describe(volume)
    levels = about["levels"]
    if parsed.levels and not levels:
        _remark("no levels of detail: the volume has at most 64 samples along each axis")
    print(
        f"{parsed.out}: {parsed.out.stat().st_size} bytes, {about['stream_bytes']} of compressed "
        f"samples, {about['rate']:g} bits per sample, errors up to {about['largest_error']:.3g}"
        + (
            f", {sum(level['stream_bytes'] for level in levels)} of {_levels(levels)}"
            * bool(levels)
        )
    )
    if parsed.rate is None and parsed.tolerance is None and about["rate"] != DEFAULT_RATE:
        _remark(f"these are labels, which {about['rate']:g} bits per sample keep apart")


def _levels(levels: list[dict[str, Any]]) -> str:
    sizes = ", ".join("x".join(map(str, level["samples"])) for level in levels)
    return f"{len(levels)} level{'s' * (len(levels) > 1)} of detail ({sizes})"


def rate(parsed: argparse.Namespace) -> None:
    image = _read(parsed)
    given = _given(parsed, CompressionOptions)
    tolerance = given.pop("tolerance")
    with progress_bar("Trying rates") as progress:
        least = progiso.least_rate(
            image, tolerance, relative=parsed.relative, progress=progress, **given
        )
    print(f"{least:.9g}")  # all digits of a 64th, for `compress --rate`


def decompress(parsed: argparse.Namespace) -> None:
    check_output(parsed.out, PLAIN_SUFFIXES, inputs=[getattr(parsed, "in")])
    level, parsed.level = parsed.level, None  # of the compressed volume, not of a file of images
    image = _read(parsed, "in")
    with progress_bar("Decompressing") as progress:
        image = progiso.decompress(image, level=level or 0, progress=progress)
    _save(image, parsed.out)
    print(parsed.out)


def info(parsed: argparse.Namespace) -> None:
    with _open(parsed) as source, _reading(parsed, "file") as progress:
        about = {
            "file bytes": file_bytes(Path(source.about.what)),
            **describe_source(source, progress),
        }
        if parsed.verify:
            about["verified"] = verify_source(source, Path(source.about.what))
    if parsed.json:
        print(json.dumps(about, indent=2))
        return
    for key, value in about.items():
        if isinstance(value, dict):
            print(f"{key}:")
            levels = value.pop("levels", [])
            for inner, detail in value.items():
                print(f"  {inner}: {_text(detail)}")
            for number, level in enumerate(levels, 1):
                print(f"  level {number}: {_text(level)}")
        else:
            print(f"{key}: {_text(value)}")


def _text(value: object) -> str:
    """Format a value: short numbers, lists without brackets, arrays on one line."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(v)}" for key, v in value.items())
    if isinstance(value, list):
        return " ".join(_text(v) for v in value)
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def contour(parsed: argparse.Namespace) -> None:
    check_output(parsed.out, SURFACE_SUFFIXES, inputs=[getattr(parsed, "in")])
    image = _read(parsed, "in")
    _remark_on_compressed(image, parsed)
    with progress_bar("Contouring") as progress:
        surface = progiso.contour(
            image,
            parsed.isovalue,
            normals=not parsed.no_normals,
            progress=progress,
            **_given(parsed, CompressionOptions),
        )
    with progress_bar(f"Writing {parsed.out.name}") as progress:
        progiso.save_surface(surface, parsed.out, progress=progress)
    points, triangles = surface.GetNumberOfPoints(), surface.GetNumberOfPolys()
    if points == 0:
        _remark("the volume has no such values: `progiso info` tells their range")
    print(f"{parsed.out}: {points} points, {triangles} triangles")


def render(parsed: argparse.Namespace) -> None:
    if parsed.output is not None:
        check_output(parsed.output, (".png",))
    check_outputs((parsed.output, parsed.depth, parsed.stats), inputs=[parsed.file])
    if parsed.orbit is not None:
        for name in ("view", "up", "zoom", "parallel"):
            if getattr(parsed, name):
                raise ValueError(f"--orbit is a whole camera, it does not go with --{name}")
    image = _read_compressed(parsed)
    with progress_bar("Rendering") as progress:
        result = progiso.render(
            image,
            parsed.isovalue,
            size=parsed.size,
            orbit=parsed.orbit,
            camera=_camera(image, parsed) if parsed.orbit is None else None,
            background=parsed.background,
            progress=progress,
            **_given(parsed, SurfaceStyle),
            **_given(parsed, RenderOptions),
        )
    _write_results(result, parsed)
    _print_summary(result)


def _camera(image: vtkImageData, parsed: argparse.Namespace) -> progiso.Camera:
    width, height = parsed.size
    options = {"direction": parsed.view, "view_up": parsed.up, "zoom": parsed.zoom}
    given = {name: value for name, value in options.items() if value is not None}
    return progiso.view_camera(
        image, parallel=parsed.parallel, aspect=width / max(1, height), **given
    )


def _write_results(result: progiso.RenderResult, parsed: argparse.Namespace) -> None:
    if parsed.output is not None:
        progiso.write_png(result.image, parsed.output)
    if parsed.depth is not None:
        with atomic_path(parsed.depth) as temporary, open(temporary, "wb") as file:
            np.save(file, result.depth)
    if parsed.stats is not None:
        with atomic_path(parsed.stats) as temporary:
            text = json.dumps(result.statistics, indent=2, allow_nan=False)
            temporary.write_text(text + "\n", encoding="utf-8")


def _print_summary(result: progiso.RenderResult) -> None:
    about = result.statistics
    width, height = about["size"]
    hits = int(np.isfinite(result.depth).sum())
    count = len(about["passes"])
    passes = "1 pass" if count == 1 else f"{count} passes"
    if hits == 0:
        _remark("no surface is seen: `progiso info` tells the values' range")
    print(
        f"{width}x{height}, {passes}, {about['total_ms']:.1f} ms, "
        f"{hits} pixels hit, {about['memory']['total'] / 2**20:.1f} MiB of GPU memory"
        + ("" if about["converged"] else ", NOT COMPLETE")
    )


def data(parsed: argparse.Namespace) -> None:
    options = {key: getattr(parsed, key) for key in parsed.options}
    given = {key: value for key, value in options.items() if value is not None}
    with progress_bar(f"Getting {parsed.name}") as progress:
        if parsed.rate is None:
            path = fetch(parsed.name, progress=progress, **given)
        else:
            path = compressed(parsed.name, rate=parsed.rate, progress=progress, **given)
    print(path)


def list_data(_parsed: argparse.Namespace) -> None:
    for scan in SCANS.values():
        print(f"{scan.name:16}{about_scan(scan)}")
    for generator in GENERATORS.values():
        options = " ".join(f"--{key}" for key in ("size", "rate", *generator.options))
        isovalues = ", ".join(f"{value:g}" for value in generator.isovalues)
        print(f"{generator.name:16}{generator.description}. Isovalues: {isovalues}. {options}")


def about_scan(scan: Scan) -> str:
    """Describe a scan in a few sentences."""
    isovalues = ", ".join(f"{value:g} ({what})" for what, value in scan.isovalues.items())
    return (
        f"{scan.description}. {'x'.join(map(str, scan.dimensions))} {scan.dtype}. "
        f"Isovalues: {isovalues}. Source: {scan.source}. Licence: {scan.licence}. "
        f"From the Debian package {scan.package}."
    )
