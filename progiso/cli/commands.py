"""The commands: each takes the parsed arguments, and prints its results."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkImageData

import progiso

from ..data import GENERATORS, SCANS, compressed, fetch
from ..data.catalogue import Scan
from ..io.files import atomic_path, check_output
from ..io.volumes import COMPRESSED_SUFFIXES, PLAIN_SUFFIXES
from ..mesh import SURFACE_SUFFIXES
from ..options import CompressionOptions, RenderOptions, SurfaceStyle
from .progress import progress_bar


def _read(parsed: argparse.Namespace, name: str = "file") -> vtkImageData:
    path = getattr(parsed, name)
    dimensions, rate = parsed.zfp_header
    if dimensions and path.suffix.lower() != ".zfp":
        raise ValueError(f"--zfp-header is for .zfp files, it does not go with '{path}'")
    with progress_bar(f"Reading {path.name}") as progress:
        return progiso.read(path, dimensions=dimensions, rate=rate, progress=progress)


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
    for name in ("rate", "component"):
        given, held = getattr(parsed, name), about[name]
        if given not in (None, held):
            _remark(
                f"--{name} {given:g} is ignored: the file is compressed, its {name} is {held:g}"
            )


def compress(parsed: argparse.Namespace) -> None:
    check_output(parsed.out, (".vti",) if parsed.appended else COMPRESSED_SUFFIXES)
    source = getattr(parsed, "in")
    with progress_bar(f"Compressing {source.name}") as progress:
        options = _given(parsed, CompressionOptions)
        volume = progiso.compress_file(source, progress=progress, **options)
    _save(volume, parsed.out, appended=parsed.appended)
    if parsed.out.suffix.lower() == ".zfp":
        _remark("a .zfp file keeps the samples alone: no origin, no spacing, no array's name")
    about = progiso.describe(volume)
    print(
        f"{parsed.out}: {parsed.out.stat().st_size} bytes, {about['stream_bytes']} of compressed "
        f"samples, {about['rate']:g} bits per sample"
    )


def rate(parsed: argparse.Namespace) -> None:
    image = _read(parsed)
    with progress_bar("Trying rates") as progress:
        least = progiso.least_rate(
            image,
            parsed.tolerance,
            relative=parsed.relative,
            progress=progress,
            **_given(parsed, CompressionOptions),
        )
    print(f"{least:.9g}")  # all digits of a 64th, for `compress --rate`


def decompress(parsed: argparse.Namespace) -> None:
    check_output(parsed.out, PLAIN_SUFFIXES)
    image = _read(parsed, "in")
    with progress_bar("Decompressing") as progress:
        image = progiso.decompress(image, progress=progress)
    _save(image, parsed.out)
    print(parsed.out)


def info(parsed: argparse.Namespace) -> None:
    image = _read(parsed)
    about = {"file bytes": parsed.file.stat().st_size, **_describe(image)}
    if parsed.json:
        print(json.dumps(about, indent=2))
        return
    for key, value in about.items():
        if isinstance(value, dict):
            print(f"{key}:")
            for inner, detail in value.items():
                print(f"  {inner}: {_text(detail)}")
        else:
            print(f"{key}: {_text(value)}")


def _text(value: object) -> str:
    """Format a value: short numbers, lists without brackets, arrays on one line."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(v)}" for key, v in value.items())
    if isinstance(value, list):
        return " ".join(_text(v) for v in value)
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _describe(image: vtkImageData) -> dict[str, Any]:
    """Collect geometry, arrays and, of a compressed volume, its metadata."""
    matrix = image.GetDirectionMatrix()
    about = {
        "dimensions": list(image.GetDimensions()),
        "extent": list(image.GetExtent()),
        "spacing": list(image.GetSpacing()),
        "origin": list(image.GetOrigin()),
        "direction": [matrix.GetElement(i, j) for i in range(3) for j in range(3)],
        "bounds": list(image.GetBounds()),
        "point arrays": _describe_arrays(image.GetPointData()),
        "cell arrays": _describe_arrays(image.GetCellData()),
    }
    if progiso.is_compressed(image):
        about["compressed"] = progiso.describe(image)
    return {key: value for key, value in about.items() if value != {}}


def _describe_arrays(attributes: vtkDataSetAttributes) -> dict[str, Any]:
    """Collect type, components and range of every array, by name."""
    arrays = (attributes.GetAbstractArray(i) for i in range(attributes.GetNumberOfArrays()))
    return {
        array.GetName() or "(unnamed)": {
            "type": array.GetDataTypeAsString(),
            "components": array.GetNumberOfComponents(),
            **({"range": list(array.GetRange())} if hasattr(array, "GetRange") else {}),
        }
        for array in arrays
    }


def contour(parsed: argparse.Namespace) -> None:
    check_output(parsed.out, SURFACE_SUFFIXES)
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
    for path in filter(None, (parsed.depth, parsed.stats)):
        check_output(path)
    if parsed.output is not None:
        check_output(parsed.output, (".png",))
    if parsed.orbit is not None:
        for name in ("view", "up", "zoom", "parallel"):
            if getattr(parsed, name):
                raise ValueError(f"--orbit is a whole camera, it does not go with --{name}")
    image = _read(parsed)
    _remark_on_compressed(image, parsed)
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
            **_given(parsed, CompressionOptions),
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
