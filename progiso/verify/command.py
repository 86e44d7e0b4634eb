"""Parse the options of ``progiso verify``, and run it."""

from __future__ import annotations

import argparse
import shlex
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..io.files import atomic_path, check_output, check_outputs
from ..measure.document import new_document, write_json
from ..measure.machine import OtherProcesses, describe_machine
from .case import FAILED, QUICK, Case, Settings
from .page import markdown, print_table
from .table import Started, cases, measure


def add_verify(command: argparse.ArgumentParser) -> None:
    """Give the command ``verify`` its options.

    Parameters
    ----------
    command : argparse.ArgumentParser
    """
    command.add_argument(
        "--quick", action="store_true", help="fewer cases and smaller images: half a minute"
    )
    command.add_argument(
        "--cases", metavar="TEXT", default="", help="only those with this text in their names"
    )
    command.add_argument(
        "--rays", metavar="N", type=_count,
        help=f"to be cast at closed surfaces, 1e8 say (default: {Settings.rays:.0e}, "
        f"quick: {QUICK.rays:.0e})",
    )  # fmt: skip
    command.add_argument(
        "--jobs", metavar="N", type=_count, default=1,
        help="processes that measure side by side: sooner done, but times may suffer (default: 1)",
    )  # fmt: skip
    command.add_argument("--json", metavar="FILE", type=Path, help="write the rows as JSON")
    command.add_argument(
        "--output", metavar="PAGE.md", type=Path, help="write the table as Markdown"
    )
    command.set_defaults(run=_verify)


def _count(text: str) -> int:
    """Parse a whole number that may be written with an exponent."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 1 <= value <= 1e12:
        raise argparse.ArgumentTypeError(f"'{text}' is no number from 1 to 1e12")
    return int(value)


def _verify(parsed: argparse.Namespace) -> None:
    check_outputs((parsed.json, parsed.output))
    if parsed.output is not None:
        check_output(parsed.output, (".md",))
    listed = cases(parsed.quick, parsed.cases)
    if not listed:
        raise ValueError(f"no case has '{parsed.cases}' in its name")
    settings = QUICK if parsed.quick else Settings()
    if parsed.rays is not None:
        settings = replace(settings, rays=parsed.rays)
    document = verify(listed, settings, _say(len(listed)), parsed.jobs)
    print_table(document["rows"])
    if parsed.json is not None:
        write_json(document, parsed.json)
    if parsed.output is not None:
        with atomic_path(parsed.output) as temporary:
            temporary.write_text(markdown(document), encoding="utf-8")
    failed = [row["case"] for row in document["rows"] if row["verdict"] == FAILED]
    if failed:
        raise RuntimeError(f"{len(failed)} of {len(listed)} cases failed: {', '.join(failed)}")


def verify(
    listed: Sequence[tuple[str, Case]],
    settings: Settings,
    started: Started | None = None,
    jobs: int = 1,
) -> dict[str, Any]:
    """Measure cases; parameters as `table.measure` has them.

    Returns
    -------
    dict
        ``schema``, ``machine``, ``runs`` (one) as of the benchmarks, and ``rows``.
    """
    command = shlex.join(["python", "-m", "progiso", *sys.argv[1:]])
    document = new_document("verify", command, describe_machine())
    del document["measurements"]
    start, others = time.monotonic(), OtherProcesses()
    document["rows"] = measure(listed, settings, started, jobs)
    document["runs"][0].update(
        seconds=round(time.monotonic() - start, 1), complete=True, others_cores=others.cores()
    )
    return document


def _say(count: int) -> Started:
    """Make a function that tells on standard error which of `count` cases is measured."""

    def say(number: int, section: str, case: Case) -> None:
        print(f"{number}/{count} {section}: {case.name}", file=sys.stderr, flush=True)

    return say
