"""Parse the options of ``progiso bench``, and run it."""

from __future__ import annotations

import argparse
import importlib.util
import shlex
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from ..measure.document import load_document, merge, new_document, save_document
from ..measure.machine import OtherProcesses, describe_machine, use_all_cores
from ..rendering import MAX_SIZE
from .goals import HD
from .processes import baseline_package
from .report import PAGE, write_markdown
from .sets import SETS, Defaults, steps
from .settings import FLIGHT_SIZES, IMAGE_SIZES, PEERS, Settings

#: How many frames a set renders by default, and of what.
_FRAMES = {"soak": 10_000, "interactive": 60}
_OF_WHAT = {"soak": "", "interactive": " of every movement"}


def add_bench(
    command: argparse.ArgumentParser, size_type: Callable[[str], tuple[int, int]]
) -> None:
    """Give the command ``bench`` its sets and ``report``.

    Parameters
    ----------
    command : argparse.ArgumentParser
    size_type : callable
        Makes a width and a height of text.
    """
    sets = command.add_subparsers(title="sets", metavar="SET", required=True)
    for name, defaults in SETS.items():
        _add_set(sets, name, defaults, size_type)
    description = "make Markdown and plots of results"
    report = sets.add_parser("report", help=description, description=f"{_sentence(description)}")
    report.add_argument(
        "results", nargs="+", type=Path, metavar="RESULTS.json",
        help="of runs on one machine; of two measurements of the same thing the later counts",
    )  # fmt: skip
    _add_output(report, ", or a Markdown file PAGE.md, whose plots go to a folder PAGE beside it")
    report.set_defaults(run=_report)


def _sentence(description: str) -> str:
    return f"{description[0].upper()}{description[1:]}."


def _add_set(
    sets: argparse._SubParsersAction[argparse.ArgumentParser],
    name: str,
    defaults: Defaults,
    size_type: Callable[[str], tuple[int, int]],
) -> None:
    """Add a set with its options."""
    one = sets.add_parser(
        name, help=defaults.description, description=_sentence(defaults.description)
    )
    _add_images(one, defaults)
    if name == "interactive":
        _add_sizes(one, size_type, FLIGHT_SIZES)
        one.set_defaults(size=HD)
    elif name == "bounds":
        _add_sizes(one, size_type, (), "1280x720 on a GPU, 640x360 without one")
        one.set_defaults(size=HD)
        one.add_argument(
            "--pictures", metavar="FOLDER", type=Path,
            help="draw a sheet of every view's pictures, with their differences from the "
            "reference, into a folder, made when it is missing",
        )  # fmt: skip
    else:
        one.add_argument(
            "--size", metavar="WxH", type=size_type, default=HD, help="pixels (default: 1280x720)"
        )
    if name == "scaling":
        _add_sizes(one, size_type, IMAGE_SIZES)
        one.add_argument(
            "--largest", metavar="N", type=_at_least(64), help="largest side of a volume"
        )
    if name == "interactive":
        one.add_argument(
            "--largest-plain", metavar="N", type=_at_least(2),
            help="largest side of the volumes that VTK's ways show (default: as memory allows)",
        )  # fmt: skip
    if name in ("interactive", "first-image"):
        one.add_argument(
            "--baseline", metavar="PATH", type=Path,
            help="an earlier commit, which is measured beside this one: a folder that has its "
            "built package in it, or an archive of one, as pack-bundle makes",
        )  # fmt: skip
    if name in ("quick", "paper", "peers", "interactive"):
        one.add_argument(
            "--largest-mesh", metavar="N", type=_at_least(2),
            help="largest side of the volumes that meshes are made of (default: as memory allows)",
        )  # fmt: skip
    if name in _FRAMES:
        one.add_argument(
            "--frames", metavar="N", type=_at_least(1), default=_FRAMES[name],
            help=f"how many are rendered{_OF_WHAT[name]} (default: %(default)s)",
        )  # fmt: skip
    one.add_argument(
        "--no-plots",
        action="store_true",
        help="leave the plots, which need matplotlib, to 'report'",
    )
    _add_output(one)
    one.set_defaults(run=_measure, set=name)


def _add_images(one: argparse.ArgumentParser, defaults: Defaults) -> None:
    """Add the options that say which images a set renders, and how often."""
    one.add_argument(
        "--fields", metavar="A,B", default=defaults.fields,
        type=lambda text: tuple(text.split(",")),
        help=f"NAME-SIZE-kK-rRATE each (default: {', '.join(defaults.fields)})",
    )  # fmt: skip
    one.add_argument(
        "--isovalues", metavar="N", type=_isovalues, default=defaults.isovalues,
        help="so many random ones of the range of interest, or 'peers' for the fixed ones "
        "(default: %(default)s)",
    )  # fmt: skip
    one.add_argument(
        "--positions", metavar="N", type=_at_least(2), default=defaults.positions,
        help="of the orbit, at least 2 (default: %(default)s)",
    )  # fmt: skip
    one.add_argument(
        "--seed", metavar="N", type=_at_least(0), default=0, help="of the random isovalues"
    )
    one.add_argument(
        "--repeat", metavar="N", type=_at_least(1), default=1, help="how often images are timed"
    )


def _add_sizes(
    one: argparse.ArgumentParser,
    size_type: Callable[[str], tuple[int, int]],
    default: Sequence[tuple[int, int]],
    in_words: str | None = None,
) -> None:
    """Add the option of several sizes of images."""
    listed = in_words or ",".join(f"{width}x{height}" for width, height in default)
    one.add_argument(
        "--images", metavar="WxH,WxH", default=tuple(default),
        type=lambda text: tuple(size_type(part) for part in text.split(",")),
        help=f"sizes of images (default: {listed})",
    )  # fmt: skip


def _add_output(command: argparse.ArgumentParser, more: str = "") -> None:
    command.add_argument(
        "--output", metavar="DIR", type=Path, default=Path("bench"),
        help=f"folder for the results, made when it is missing (default: %(default)s){more}",
    )  # fmt: skip


def _at_least(least: int) -> Callable[[str], int]:
    """Make a parser of whole numbers from `least` on."""

    def whole(text: str) -> int:
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError(f"'{text}' is no whole number of at least {least}")
        return int(text)

    return whole


def _isovalues(text: str) -> int | str:
    return PEERS if text == PEERS else _at_least(1)(text)


# ---- running


def _measure(parsed: argparse.Namespace) -> None:
    """Run a set, with the package of the earlier commit where there is one."""
    with baseline_package(getattr(parsed, "baseline", None)) as parsed.baseline:
        _run_set(parsed)


def _run_set(parsed: argparse.Namespace) -> None:
    """Run a set; results are saved after every measurement, so that an interrupted run counts."""
    given = {field.name: getattr(parsed, field.name, None) for field in fields(Settings)}
    settings = Settings(**{key: value for key, value in given.items() if value is not None})
    if max(max(size) for size in (settings.size, *settings.images)) > MAX_SIZE:
        raise ValueError(f"images must be at most {MAX_SIZE} pixels wide and high")
    measurements = steps(parsed.set, parsed.fields, settings)
    if not parsed.no_plots or settings.pictures is not None:
        _check_matplotlib()
    parsed.output.mkdir(parents=True, exist_ok=True)
    use_all_cores()
    command = shlex.join(["python", "-m", "progiso", *sys.argv[1:]])
    document = new_document(parsed.set, command, describe_machine())
    start = time.monotonic()
    for number, (kind, what, measure) in enumerate(measurements, 1):
        print(f"{number}/{len(measurements)} {kind} {what}", file=sys.stderr, flush=True)
        others = OtherProcesses()
        record = measure()
        record["others_cores"] = others.cores()
        document["measurements"].setdefault(kind, []).append(record)
        run = document["runs"][0]
        run["seconds"] = round(time.monotonic() - start, 1)
        run["complete"] = number == len(measurements)
        save_document(document, parsed.output)
    _write(document, parsed.output / PAGE, parsed.output, not parsed.no_plots)


def _report(parsed: argparse.Namespace) -> None:
    _check_matplotlib()
    documents = [load_document(path) for path in parsed.results]
    page, folder = parsed.output / PAGE, parsed.output
    if parsed.output.suffix == ".md":
        page, folder = parsed.output, parsed.output.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    try:
        _write(merge(documents), page, folder, True)
    except KeyError as error:
        raise ValueError(f"the results lack {error}: measure again") from None


def _check_matplotlib() -> None:
    if importlib.util.find_spec("matplotlib") is None:
        raise ImportError(
            "plots and pictures need matplotlib: install it, or give --no-plots where it is taken"
        )


def _write(document: dict[str, Any], page: Path, folder: Path, with_plots: bool) -> None:
    """Write plots to the folder and the Markdown page, and say where that is."""
    plots = {}
    if with_plots:
        from .plots import draw_plots  # only here, so that measuring needs no matplotlib

        plots = draw_plots(document, folder)
    beside = folder.relative_to(page.parent)
    links = {kind: [str(beside / name) for name in names] for kind, names in plots.items()}
    print(write_markdown(document, page, links))
