"""The command line: ``python -m progiso COMMAND``; see its ``--help``."""

from __future__ import annotations

import argparse
import json
import re
import sys
from pathlib import Path

import numpy as np

import progiso

from ..bench.command import add_bench
from ..data import GENERATORS, SCANS, compressed, fetch
from ..io.files import atomic_path, check_output
from ..io.volumes import COMPRESSED_SUFFIXES, PLAIN_SUFFIXES
from ..mesh import SURFACE_SUFFIXES
from ..verify.command import add_verify
from .progress import progress_bar

_COMPRESSIBLE = ".vti .mha .mhd .nrrd .nii .nii.gz .vtk, name_WxHxD_type.raw"
_READABLE = ".vti .mha .mhd .nrrd .nii .nii.gz .vtk .zfp, name_WxHxD_type.raw"


def main(arguments=None):
    """Run a command.

    Parameters
    ----------
    arguments : sequence of str, optional
        By default those of the process.

    Returns
    -------
    int
        Exit status: 0, 1 when the command failed, 130 when it was interrupted. Wrong usage exits
        with 2 from within.

    Examples
    --------
    >>> main(["data", "sphere", "--size", "16"])  # doctest: +ELLIPSIS
    /.../progiso/sphere_16x16x16_float32.raw
    0
    """
    parsed = _parser().parse_args(arguments)
    try:
        parsed.run(parsed)
    except (OSError, ValueError, RuntimeError, TypeError, ImportError, MemoryError) as error:
        message = " ".join(str(error).split()) or type(error).__name__
        print(f"progiso: error: {message}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("progiso: interrupted", file=sys.stderr)
        return 130
    return 0


# ---- arguments


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, without repeating the usage."""

    def error(self, message):
        self.exit(2, f"{self.prog}: error: {message} (see {self.prog} --help)\n")


def _parser():
    parser = _Parser(
        prog="progiso",
        description="Progressive isosurfaces of compressed volumes.",
        epilog=f"FILE is anything VTK or nibabel reads as an image: {_READABLE}.",
    )
    parser.add_argument("--version", action="version", version=f"progiso {progiso.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    _add_compress(commands)
    _add_rate(commands)
    _add_decompress(commands)
    _add_info(commands)
    _add_contour(commands)
    _add_render(commands)
    _add_data(commands)
    bench = _add_command(commands, "bench", None, "measure time, memory and error beside VTK's own")
    add_bench(bench, _size)
    about = (
        "measure error and time on extreme fields and views, beside a caster in double precision"
    )
    add_verify(_add_command(commands, "verify", None, about))
    return parser


def _add_command(commands, name, run, description):
    sentence = f"{description[0].upper()}{description[1:]}."
    command = commands.add_parser(name, help=description, description=sentence)
    command.set_defaults(run=run)
    return command


def _add_input(command, name="file"):
    """A file to read, with what a zfp file without header does not say."""
    command.add_argument(name, metavar=name.upper(), type=Path, help=_READABLE)
    command.add_argument(
        "--zfp-header", metavar="WxHxD:RATE", type=_zfp_header, default=(None, None),
        help="dimensions and rate of a .zfp file without header",
    )  # fmt: skip


def _add_array(command, rate="bits per sample, in (0, 32] (default: 8)"):
    """What to compress of a plain image, and what the rate does."""
    command.add_argument("--rate", type=float, help=rate)
    _add_choice(command)


def _add_choice(command):
    """What of a plain image."""
    command.add_argument("--array", help="name of the array (default: the active scalars)")
    command.add_argument("--component", type=int, help="component of the array (default: 0)")
    command.add_argument(
        "--mask-nan", action="store_true",
        help="leave holes where samples are NaN or infinite, which are an error otherwise",
    )  # fmt: skip


def _add_isovalues(command):
    command.add_argument(
        "--isovalue", type=float, required=True, action="append",
        help="in the image's units; may be given several times",
    )  # fmt: skip


def _add_threads(command):
    command.add_argument("--threads", type=int, default=0, help="0 (default) for one per core")


def _add_compress(commands):
    command = _add_command(commands, "compress", _compress, "compress an image with fixed-rate ZFP")
    command.add_argument("in", metavar="IN", type=Path, help=_COMPRESSIBLE)
    command.add_argument("out", metavar="OUT", type=Path, help="a .vti or .zfp file")
    _add_array(command)
    _add_threads(command)
    command.add_argument(
        "--appended", action="store_true",
        help="a .vti that reads ten times faster, though not in Debian 12's ParaView",
    )  # fmt: skip


def _add_rate(commands):
    description = "find the least rate at which no sample is off by more than a tolerance"
    command = _add_command(commands, "rate", _rate, description)
    _add_input(command)
    command.add_argument(
        "--tolerance", type=float, required=True, metavar="T",
        help="largest error of a sample, above 0, in the image's units",
    )  # fmt: skip
    command.add_argument(
        "--relative", action="store_true",
        help="the tolerance is a part of the values' range, 0.001 of it, say",
    )  # fmt: skip
    _add_choice(command)


def _add_decompress(commands):
    command = _add_command(commands, "decompress", _decompress, "decompress into float32 scalars")
    _add_input(command, "in")
    command.add_argument(
        "out",
        metavar="OUT",
        type=Path,
        help=f"{' '.join(PLAIN_SUFFIXES)}, the latter named name_WxHxD_float32.raw",
    )


def _add_info(commands):
    command = _add_command(commands, "info", _info, "tell what a volume holds")
    _add_input(command)
    command.add_argument("--json", action="store_true", help="as JSON")


def _add_contour(commands):
    command = _add_command(commands, "contour", _contour, "extract isosurfaces as triangles")
    _add_input(command, "in")
    suffixes = " ".join(SURFACE_SUFFIXES)
    command.add_argument("out", metavar="OUT", type=Path, help=f"a file to write: {suffixes}")
    _add_isovalues(command)
    _add_array(command, "compress a plain image first, to this many bits per sample, in (0, 32]")
    command.add_argument("--no-normals", action="store_true", help="points and triangles alone")
    _add_threads(command)


def _add_render(commands):
    command = _add_command(commands, "render", _render, "render isosurfaces off screen")
    _add_input(command)
    _add_isovalues(command)
    command.add_argument(
        "--size", type=_size, default=(1280, 720), metavar="WxH", help="pixels (default: 1280x720)"
    )
    _add_array(command)
    _add_camera(command)
    command.add_argument(
        "--color", action="append",
        help="name or #rrggbb (default: oldlace); once, or once for each isovalue",
    )  # fmt: skip
    command.add_argument(
        "--opacity", type=float, action="append",
        help="0 to 1 (default: 1); once, or once for each isovalue",
    )  # fmt: skip
    command.add_argument("--background", default="#20242b", help="name or #rrggbb")
    command.add_argument("--output", type=Path, metavar="PNG", help="write the image")
    command.add_argument(
        "--depth", type=Path, metavar="NPY",
        help="write float32 distances along the rays in world units, inf where nothing is hit",
    )  # fmt: skip
    command.add_argument("--stats", type=Path, metavar="JSON", help="write the statistics")
    command.add_argument(
        "--detailed", action="store_true",
        help="count distinct blocks and time every stage, which takes time itself",
    )  # fmt: skip
    command.add_argument(
        "--memory-budget", type=_bytes, default=0, metavar="BYTES",
        help="bound on the GPU memory beside the compressed volume, as 200000000, 200M or 1.5G; "
        "0 (default): automatic",
    )  # fmt: skip
    command.add_argument(
        "--no-speculation", action="store_true", help="ask for one block per ray and pass only"
    )


def _add_camera(command):
    command.add_argument(
        "--orbit", type=_orbit, metavar="I/N", help="camera I of N around the volume, I from 0"
    )
    command.add_argument(
        "--view", type=_vector, metavar="X,Y,Z",
        help="from the volume to the camera, without --orbit (default: 0.45,1,0.3); --view=-1,0,0",
    )  # fmt: skip
    command.add_argument(
        "--up", type=_vector, metavar="X,Y,Z",
        help="what is up, without --orbit (default: 0,0,1)",
    )  # fmt: skip
    command.add_argument("--zoom", type=float, help="without --orbit (default: 1)")
    command.add_argument(
        "--parallel", action="store_true", help="parallel projection, without --orbit"
    )


def _add_data(commands):
    description = "print the path of a volume, fetched or generated when it is not cached yet"
    command = _add_command(commands, "data", _list_data, description)
    names = command.add_subparsers(title="volumes", metavar="NAME")
    for scan in SCANS.values():
        volume = names.add_parser(scan.name, help=scan.description, description=_about_scan(scan))
        volume.set_defaults(run=_data, name=scan.name, options=(), rate=None)
    for generator in GENERATORS.values():
        volume = names.add_parser(generator.name, help=generator.description)
        volume.set_defaults(run=_data, name=generator.name, options=("size", *generator.options))
        volume.add_argument(
            "--size", type=_sides, default=128, metavar="N[xNxN]", help="samples (default: 128)"
        )
        volume.add_argument(
            "--rate", type=float, metavar="BITS",
            help="a compressed file, at this many bits per sample; never holds all samples",
        )  # fmt: skip
        for key, option in generator.options.items():
            default = "" if option.default is None else f" (default: {option.default:g})"
            volume.add_argument(f"--{key}", type=option.kind, default=option.default,
                                help=option.description + default)  # fmt: skip


def _about_scan(scan):
    isovalues = ", ".join(f"{value:g} ({what})" for what, value in scan.isovalues.items())
    return (
        f"{scan.description}. {'x'.join(map(str, scan.dimensions))} {scan.dtype}. "
        f"Isovalues: {isovalues}. Source: {scan.source}. Licence: {scan.licence}. "
        f"From the Debian package {scan.package}."
    )


def _pattern(text, pattern, example):
    match = re.fullmatch(pattern, text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' does not look like {example}")
    return match.groups()


def _size(text):
    return tuple(map(int, _pattern(text, r"([1-9]\d*)x([1-9]\d*)", "1280x720")))


def _sides(text):
    if text.isdecimal():
        return int(text)
    return tuple(map(int, _pattern(text, r"(\d+)x(\d+)x(\d+)", "256 or 256x128x64")))


def _orbit(text):
    return tuple(map(int, _pattern(text, r"(\d+)/(\d+)", "0/10")))


def _vector(text):
    number = r"\s*([-+.\deE]+)\s*"
    parts = _pattern(text, ",".join([number] * 3), "0.5,-1,0.25")
    try:
        return tuple(map(float, parts))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' does not look like 0.5,-1,0.25") from None


def _bytes(text):
    number, unit = _pattern(text, r"(\d+(?:\.\d+)?)([KMG]?)", "200000000, 200M or 1.5G")
    return int(float(number) * 1024 ** " KMG".index(unit or " "))


def _zfp_header(text):
    *sides, rate = _pattern(text, r"(\d+)x(\d+)x(\d+):([.\d]+)", "256x256x108:8")
    return tuple(map(int, sides)), float(rate)


# ---- commands


def _read(parsed, name="file"):
    path = getattr(parsed, name)
    if parsed.zfp_header[0] and path.suffix.lower() != ".zfp":
        raise ValueError(f"--zfp-header is for .zfp files, it does not go with '{path}'")
    with progress_bar(f"Reading {path.name}") as progress:
        return progiso.read(path, *parsed.zfp_header, progress=progress)


def _save(image, path, appended=False):
    with progress_bar(f"Writing {path.name}") as progress:
        progiso.save(image, path, progress=progress, appended=appended)


def _remark(text):
    """Say something beside the results."""
    print(f"progiso: note: {text}", file=sys.stderr)


def _remark_on_compressed(image, parsed):
    """Say what is ignored of what was asked for, where nothing is to be compressed."""
    if not progiso.is_compressed(image):
        return
    about = progiso.describe(image)
    for name in ("rate", "component"):
        given, held = getattr(parsed, name), about[name]
        if given not in (None, held):
            _remark(
                f"--{name} {given:g} is ignored: the file is compressed, its {name} is {held:g}"
            )


def _compress(parsed):
    check_output(parsed.out, (".vti",) if parsed.appended else COMPRESSED_SUFFIXES)
    source = getattr(parsed, "in")
    with progress_bar(f"Compressing {source.name}") as progress:
        volume = progiso.compress_file(
            source,
            rate=_given(parsed.rate, 8.0),
            array=parsed.array,
            component=parsed.component or 0,
            threads=parsed.threads,
            progress=progress,
            mask_nan=parsed.mask_nan,
        )
    _save(volume, parsed.out, parsed.appended)
    if parsed.out.suffix.lower() == ".zfp":
        _remark("a .zfp file keeps the samples alone: no origin, no spacing, no array's name")
    about = progiso.describe(volume)
    print(
        f"{parsed.out}: {parsed.out.stat().st_size} bytes, {about['stream_bytes']} of compressed "
        f"samples, {about['rate']:g} bits per sample"
    )


def _given(value, default):
    return default if value is None else value


def _rate(parsed):
    image = _read(parsed)
    with progress_bar("Trying rates") as progress:
        rate = progiso.least_rate(
            image,
            parsed.tolerance,
            relative=parsed.relative,
            array=parsed.array,
            component=_given(parsed.component, 0),
            progress=progress,
            mask_nan=parsed.mask_nan,
        )
    print(f"{rate:.9g}")  # of 64ths all digits, for `compress --rate`


def _decompress(parsed):
    check_output(parsed.out, PLAIN_SUFFIXES)
    image = _read(parsed, "in")
    with progress_bar("Decompressing") as progress:
        image = progiso.decompress(image, progress=progress)
    _save(image, parsed.out)
    print(parsed.out)


def _info(parsed):
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


def _text(value):
    """A value for people: short numbers, lists without brackets, arrays on one line."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(v)}" for key, v in value.items())
    if isinstance(value, list):
        return " ".join(_text(v) for v in value)
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _describe(image):
    """Geometry, arrays and, of a compressed volume, its metadata."""
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


def _describe_arrays(attributes):
    """Type, components and range of every array, by name."""
    arrays = (attributes.GetAbstractArray(i) for i in range(attributes.GetNumberOfArrays()))
    return {
        array.GetName() or "(unnamed)": {
            "type": array.GetDataTypeAsString(),
            "components": array.GetNumberOfComponents(),
            **({"range": list(array.GetRange())} if hasattr(array, "GetRange") else {}),
        }
        for array in arrays
    }


def _contour(parsed):
    check_output(parsed.out, SURFACE_SUFFIXES)
    image = _read(parsed, "in")
    _remark_on_compressed(image, parsed)
    with progress_bar("Contouring") as progress:
        surface = progiso.contour(
            image,
            parsed.isovalue,
            rate=parsed.rate,
            array=parsed.array,
            component=parsed.component or 0,
            normals=not parsed.no_normals,
            threads=parsed.threads,
            progress=progress,
            mask_nan=parsed.mask_nan,
        )
    with progress_bar(f"Writing {parsed.out.name}") as progress:
        progiso.save_surface(surface, parsed.out, progress=progress)
    points, triangles = surface.GetNumberOfPoints(), surface.GetNumberOfPolys()
    if points == 0:
        _remark("the volume has no such values: `progiso info` tells their range")
    print(f"{parsed.out}: {points} points, {triangles} triangles")


def _render(parsed):
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
    camera = None
    if parsed.orbit is None:
        camera = progiso.view_camera(
            image,
            direction=parsed.view or (0.45, 1.0, 0.3),
            view_up=parsed.up or (0.0, 0.0, 1.0),
            parallel=parsed.parallel,
            aspect=parsed.size[0] / max(1, parsed.size[1]),
            zoom=_given(parsed.zoom, 1.0),
        )
    with progress_bar("Rendering") as progress:
        result = progiso.render(
            image,
            parsed.isovalue,
            size=parsed.size,
            orbit=parsed.orbit,
            camera=camera,
            rate=_given(parsed.rate, 8.0),
            array=parsed.array,
            component=parsed.component or 0,
            speculation=not parsed.no_speculation,
            color=parsed.color or "oldlace",
            background=parsed.background,
            progress=progress,
            memory_budget=parsed.memory_budget,
            detailed=parsed.detailed,
            opacity=parsed.opacity or 1.0,
            mask_nan=parsed.mask_nan,
        )
    _write_results(result, parsed)
    _print_summary(result)


def _write_results(result, parsed):
    if parsed.output is not None:
        progiso.write_png(result.image, parsed.output)
    if parsed.depth is not None:
        with atomic_path(parsed.depth) as temporary, open(temporary, "wb") as file:
            np.save(file, result.depth)
    if parsed.stats is not None:
        with atomic_path(parsed.stats) as temporary:
            text = json.dumps(result.statistics, indent=2, allow_nan=False)
            temporary.write_text(text + "\n", encoding="utf-8")


def _print_summary(result):
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


def _data(parsed):
    options = {key: getattr(parsed, key) for key in parsed.options}
    given = {key: value for key, value in options.items() if value is not None}
    with progress_bar(f"Getting {parsed.name}") as progress:
        if parsed.rate is None:
            path = fetch(parsed.name, progress=progress, **given)
        else:
            path = compressed(parsed.name, rate=parsed.rate, progress=progress, **given)
    print(path)


def _list_data(_parsed):
    for scan in SCANS.values():
        print(f"{scan.name:16}{_about_scan(scan)}")
    for generator in GENERATORS.values():
        options = " ".join(f"--{key}" for key in ("size", "rate", *generator.options))
        isovalues = ", ".join(f"{value:g}" for value in generator.isovalues)
        print(f"{generator.name:16}{generator.description}. Isovalues: {isovalues}. {options}")
