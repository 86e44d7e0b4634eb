"""The command line's arguments; `commands` has what they make progiso do."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn, TypeAlias

import progiso

from ..bench.command import add_bench
from ..data import GENERATORS, SCANS
from ..io.formats import FORMATS
from ..io.source import SPACES
from ..io.volumes import PLAIN_SUFFIXES
from ..mesh import SURFACE_SUFFIXES
from ..options import LEVELS_OF_DETAIL
from ..verify.command import add_verify
from . import commands
from .arguments import (
    bits_per_sample,
    byte_count,
    number_or_name,
    orbit,
    sides,
    size,
    vector,
    zfp_header,
)
from .commands import about_scan

_Run: TypeAlias = Callable[[argparse.Namespace], None]
_Subparsers: TypeAlias = "argparse._SubParsersAction[_Parser]"

_READABLE = "a file of a known format, a folder of slices, file.h5:/array, or name_WxHxD_type.raw"


class _Parser(argparse.ArgumentParser):
    """Reports a wrong argument in one line, without repeating the usage.

    What begins as a negative number is a value: -1e-3, -.5 and -1,0,0.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: error: {message} (see {self.prog} --help)\n")


def make_parser() -> argparse.ArgumentParser:
    """Make the parser of ``progiso COMMAND``; what it parses has a function ``run``."""
    parser = _Parser(
        prog="progiso",
        description="Progressive isosurfaces of compressed volumes.",
        epilog=f"FILE is {_READABLE}; known are {' '.join(FORMATS)}.",
    )
    parser.add_argument("--version", action="version", version=f"progiso {progiso.__version__}")
    subparsers: _Subparsers = parser.add_subparsers(
        title="commands", metavar="COMMAND", required=True
    )
    _add_compress(subparsers)
    _add_rate(subparsers)
    _add_decompress(subparsers)
    _add_info(subparsers)
    _add_contour(subparsers)
    _add_render(subparsers)
    _add_data(subparsers)
    bench = _add_command(
        subparsers, "bench", None, "measure time, memory and error beside VTK's own"
    )
    add_bench(bench, size)
    about = (
        "measure error and time on extreme fields and views, beside a caster in double precision"
    )
    add_verify(_add_command(subparsers, "verify", None, about))
    return parser


def _add_command(
    subparsers: _Subparsers, name: str, run: _Run | None, description: str
) -> argparse.ArgumentParser:
    sentence = f"{description[0].upper()}{description[1:]}."
    command = subparsers.add_parser(name, help=description, description=sentence)
    command.set_defaults(run=run)
    return command


def _add_input(command: argparse.ArgumentParser, name: str = "file") -> None:
    """Add a file to read, and the header that a zfp file may lack."""
    command.add_argument(name, metavar=name.upper(), type=Path, help=_READABLE)
    command.add_argument(
        "--zfp-header", metavar="WxHxD:RATE", type=zfp_header, default=(None, None),
        help="dimensions and rate of a .zfp file without header",
    )  # fmt: skip
    choice = command.add_argument_group("where a file holds more than one volume")
    choice.add_argument("--channel", type=number_or_name, help="number or name of a channel")
    choice.add_argument("--time", type=int, metavar="T", help="number of a time point")
    choice.add_argument(
        "--series", type=number_or_name, help="number or name of an image or series"
    )
    choice.add_argument("--level", type=int, help="level of a pyramid (default: 0, the finest)")
    choice.add_argument(
        "--space", choices=tuple(SPACES), help="world coordinates to place the volume in"
    )
    choice.add_argument("--axes", metavar="XYZ", help="order of a .npy array's axes: xyz or zyx")


def _add_compression(
    command: argparse.ArgumentParser,
    rate: str = "bits per sample, in (0, 32], or auto (default: 8, and more for labels)",
) -> None:
    """Add the choice of a plain image's samples, and their rate."""
    command.add_argument("--rate", type=bits_per_sample, metavar="BITS", help=rate)
    command.add_argument(
        "--tolerance", type=float, metavar="T",
        help="in place of a rate: largest error of a sample, in the image's units",
    )  # fmt: skip
    _add_samples(command)


def _add_samples(command: argparse.ArgumentParser) -> None:
    """Add the choice of a plain image's samples."""
    command.add_argument("--array", help="name of the array (default: the active scalars)")
    command.add_argument("--component", type=int, help="component of the array (default: 0)")
    command.add_argument(
        "--mask-nan", action=argparse.BooleanOptionalAction, default=True,
        help="leave holes where samples are NaN or infinite, which are an error otherwise",
    )  # fmt: skip


def _add_isovalues(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--isovalue", type=float, required=True, action="append",
        help="in the image's units; may be given several times",
    )  # fmt: skip


def _add_threads(command: argparse.ArgumentParser) -> None:
    command.add_argument("--threads", type=int, default=0, help="0 (default) for one per core")


def _add_compress(subparsers: _Subparsers) -> None:
    command = _add_command(
        subparsers, "compress", commands.compress, "compress an image with fixed-rate ZFP"
    )
    _add_input(command, "in")
    command.add_argument("out", metavar="OUT", type=Path, help="a .vti or .zfp file")
    _add_compression(command)
    command.add_argument(
        "--levels", type=int, metavar="N",
        help="most levels of detail to make beside the volume (default: 0)",
    )  # fmt: skip
    _add_threads(command)
    command.add_argument(
        "--appended", action="store_true",
        help="a .vti that reads ten times faster, though not in Debian 12's ParaView",
    )  # fmt: skip


def _add_rate(subparsers: _Subparsers) -> None:
    description = "find the least rate at which no sample is off by more than a tolerance"
    command = _add_command(subparsers, "rate", commands.rate, description)
    _add_input(command)
    command.add_argument(
        "--tolerance", type=float, required=True, metavar="T",
        help="largest error of a sample, above 0, in the image's units",
    )  # fmt: skip
    command.add_argument(
        "--relative", action="store_true",
        help="the tolerance is a part of the values' range, 0.001 of it, say",
    )  # fmt: skip
    _add_samples(command)


def _add_decompress(subparsers: _Subparsers) -> None:
    command = _add_command(
        subparsers, "decompress", commands.decompress, "decompress into float32 scalars"
    )
    _add_input(command, "in")
    command.add_argument(
        "out",
        metavar="OUT",
        type=Path,
        help=f"{' '.join(PLAIN_SUFFIXES)}, the latter named name_WxHxD_float32.raw",
    )


def _add_info(subparsers: _Subparsers) -> None:
    command = _add_command(subparsers, "info", commands.info, "tell what a volume holds")
    _add_input(command)
    command.add_argument("--json", action="store_true", help="as JSON")
    command.add_argument(
        "--verify", action="store_true",
        help="check all checksums and decode all blocks; exit status 1 where a file is damaged",
    )  # fmt: skip


def _add_contour(subparsers: _Subparsers) -> None:
    command = _add_command(
        subparsers, "contour", commands.contour, "extract isosurfaces as triangles"
    )
    _add_input(command, "in")
    suffixes = " ".join(SURFACE_SUFFIXES)
    command.add_argument("out", metavar="OUT", type=Path, help=f"a file to write: {suffixes}")
    _add_isovalues(command)
    _add_compression(
        command, "compress a plain image first, to this many bits per sample, in (0, 32]"
    )
    command.add_argument("--no-normals", action="store_true", help="points and triangles alone")
    _add_threads(command)


def _add_render(subparsers: _Subparsers) -> None:
    command = _add_command(subparsers, "render", commands.render, "render isosurfaces off screen")
    _add_input(command)
    _add_isovalues(command)
    command.add_argument(
        "--size", type=size, default=(1280, 720), metavar="WxH", help="pixels (default: 1280x720)"
    )
    _add_compression(command)
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
        "--memory-budget", type=byte_count, default=0, metavar="BYTES",
        help="bound on the GPU memory beside the compressed volume, as 200000000, 200M or 1.5G; "
        "0 (default): automatic",
    )  # fmt: skip
    command.add_argument(
        "--level-of-detail", choices=LEVELS_OF_DETAIL, default="off",
        help="on: coarser copies of the volume draw what is far, where they are fine enough for "
        "the pixels; conservative: so that no ray misses what is thin (off, the default, is "
        "exact, and so is interactive: off screen nothing moves)",
    )  # fmt: skip
    command.add_argument(
        "--pixel-tolerance", type=float, default=1.0, metavar="P",
        help="pixels that samples of such copies may be apart, 1/16 to 64 (default: 1)",
    )  # fmt: skip
    command.add_argument(
        "--no-speculation",
        dest="speculation",
        action="store_false",
        help="ask for one block per ray and pass only",
    )


def _add_camera(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--orbit", type=orbit, metavar="I/N", help="camera I of N around the volume, I from 0"
    )
    command.add_argument(
        "--view", type=vector, metavar="X,Y,Z",
        help="from the volume to the camera, without --orbit (default: 0.45,1,0.3)",
    )  # fmt: skip
    command.add_argument(
        "--up", type=vector, metavar="X,Y,Z",
        help="what is up, without --orbit (default: 0,0,1)",
    )  # fmt: skip
    command.add_argument("--zoom", type=float, help="without --orbit (default: 1)")
    command.add_argument(
        "--parallel", action="store_true", help="parallel projection, without --orbit"
    )


def _add_data(subparsers: _Subparsers) -> None:
    description = "print the path of a volume, fetched or generated when it is not cached yet"
    command = _add_command(subparsers, "data", commands.list_data, description)
    names = command.add_subparsers(title="volumes", metavar="NAME")
    for scan in SCANS.values():
        volume = names.add_parser(scan.name, help=scan.description, description=about_scan(scan))
        volume.set_defaults(run=commands.data, name=scan.name, options=(), rate=None)
    for generator in GENERATORS.values():
        volume = names.add_parser(generator.name, help=generator.description)
        volume.set_defaults(
            run=commands.data, name=generator.name, options=("size", *generator.options)
        )
        volume.add_argument(
            "--size", type=sides, default=128, metavar="N[xNxN]", help="samples (default: 128)"
        )
        volume.add_argument(
            "--rate", type=float, metavar="BITS",
            help="a compressed file, at this many bits per sample; never holds all samples",
        )  # fmt: skip
        for key, option in generator.options.items():
            default = "" if option.default is None else f" (default: {option.default:g})"
            volume.add_argument(f"--{key}", type=option.kind, default=option.default,
                                help=option.description + default)  # fmt: skip
