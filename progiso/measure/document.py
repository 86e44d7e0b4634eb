"""Make, save, read and merge results, as JSON."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..io.files import atomic_path

#: Changes whenever a reader of older files would misread newer ones, or the other way round.
SCHEMA = 1

FILE = "results.json"

#: What must be equal for results to be merged.
_SAME = ("cpu", "cores", "gl", "gl_version", "vtk", "smp")


def new_document(name: str, command: str, machine: dict[str, Any]) -> dict[str, Any]:
    """Begin a run's results.

    Parameters
    ----------
    name : str
        Of the set that is measured.
    command : str
        The command line.
    machine : dict
        See `machine.describe_machine`.

    Returns
    -------
    dict
        ``schema``, ``machine``, ``runs`` (one) and ``measurements``: {kind: records}.
    """
    run = {
        "set": name,
        "command": command,
        "commit": machine["commit"],
        "started": time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime()),
        "seconds": 0.0,
        "complete": False,
    }
    about = {key: value for key, value in machine.items() if key != "commit"}
    return {"schema": SCHEMA, "machine": about, "runs": [run], "measurements": {}}


def save_document(document: dict[str, Any], folder: str | os.PathLike[str]) -> Path:
    """Write the results into a folder, replacing what an earlier run left there.

    Parameters
    ----------
    document : dict
    folder : str or os.PathLike

    Returns
    -------
    pathlib.Path
    """
    path = Path(folder) / FILE
    write_json(document, path)
    return path


def write_json(document: dict[str, Any], path: str | os.PathLike[str]) -> None:
    """Write a document into a file, replacing what was there.

    Parameters
    ----------
    document : dict
    path : str or os.PathLike
    """
    with atomic_path(path) as temporary:
        text = json.dumps(document, indent=1, allow_nan=False)
        temporary.write_text(text + "\n", encoding="utf-8")


def load_document(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read results.

    Parameters
    ----------
    path : str or os.PathLike

    Returns
    -------
    dict

    Raises
    ------
    FileNotFoundError, ValueError
        When there is no such file, or it holds something else.
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"there is no file '{path}'")
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"'{path}' is not JSON: {error}") from None
    schema = document.get("schema") if isinstance(document, dict) else None
    if schema != SCHEMA:
        raise ValueError(
            f"'{path}' does not hold results of this version (schema {SCHEMA}, found {schema}): "
            "measure again"
        )
    return document


def merge(documents: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Put the results of several runs on one machine together.

    Parameters
    ----------
    documents : sequence of dict
        Of two records of the same thing the later one counts.

    Returns
    -------
    dict

    Raises
    ------
    ValueError
        When the machines differ.
    """
    first = documents[0]
    measurements: dict[str, dict[str, dict[str, Any]]] = {}
    for document in documents:
        ours, other = first["machine"], document["machine"]
        differing = [key for key in _SAME if ours[key] != other[key]]
        if differing:
            raise ValueError(
                f"the results are of different machines ({', '.join(differing)} differ): "
                "make a report of each"
            )
        for kind, records in document["measurements"].items():
            kept = measurements.setdefault(kind, {})
            kept.update((_identity(record), record) for record in records)
    runs = [run for document in documents for run in document["runs"]]
    records = {kind: list(kept.values()) for kind, kept in measurements.items()}
    return {**first, "runs": runs, "measurements": records}


def _identity(record: dict[str, Any]) -> str:
    """Return a key that is equal for two measurements of the same thing."""
    keys = ("field", "size", "fixed_isovalues", "grows")
    return json.dumps([record.get(key) for key in keys])
