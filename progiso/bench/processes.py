"""Measure in processes of their own, with this package or with one of an earlier commit."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import progiso

_DRIVER = Path(__file__).with_name("driver.py")


@contextmanager
def baseline_package(given: Path | None) -> Iterator[Path | None]:
    """Find the package of an earlier commit; one that is packed is unpacked for that long.

    Parameters
    ----------
    given : pathlib.Path or None
        A folder that progiso is in at any depth: of Python's packages, of a build, or what
        ``cmake --install`` made; or an archive of such a folder, as ``pack-bundle`` makes.

    Yields
    ------
    pathlib.Path or None
        The folder to be imported from; None where none is given.

    Raises
    ------
    ValueError
        When there is no package in it.
    """
    if given is None or given.is_dir():
        yield None if given is None else _package_in(given, given)
        return
    if not given.is_file():
        raise FileNotFoundError(f"there is no file '{given}'")
    with tempfile.TemporaryDirectory(prefix="progiso-baseline-") as folder:
        try:
            with tarfile.open(given) as archive:
                # Pythons that know the filter warn without it
                safe: Any = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}
                archive.extractall(folder, **safe)
        except tarfile.TarError as error:
            raise ValueError(f"'{given}' is no archive of a package") from error
        yield _package_in(Path(folder), given)


def _package_in(folder: Path, given: Path) -> Path:
    """Return the folder from which progiso can be imported, by its compiled modules."""
    at_once = folder / "progiso" / "_built.py"
    built = at_once if at_once.is_file() else next(folder.rglob("progiso/_built.py"), None)
    if built is None:
        raise ValueError(f"'{given}' holds no built progiso: name where its Python packages are")
    return built.parent.parent.resolve()


def run_job(
    package: Path | None, task: str, environment: Mapping[str, str] | None = None, **job: Any
) -> dict[str, Any]:
    """Have the driver do a task in a new process.

    Parameters
    ----------
    package : pathlib.Path or None
        Where it imports progiso from; None for this package.
    task : str
        Of `driver`.
    environment : mapping, optional
        What is added to the process's variables.
    **job
        The task's arguments.

    Returns
    -------
    dict
        The task's result, with ``commit``: what the package was built of.

    Raises
    ------
    RuntimeError
        With the last line that the process complained with.
    """
    # PYTHONSAFEPATH: the driver's own folder, of this commit, is not to be imported from
    variables = {
        **os.environ,
        "PYTHONPATH": _own_path() if package is None else str(package),
        "PYTHONSAFEPATH": "1",
        **(environment or {}),
    }
    with tempfile.TemporaryDirectory(prefix="progiso-job-") as folder:
        asked, answer = Path(folder) / "job.json", Path(folder) / "result.json"
        asked.write_text(json.dumps({"task": task, **job}), encoding="utf-8")
        done = subprocess.run(
            [sys.executable, _DRIVER, asked, answer],
            cwd=folder,
            env=variables,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            lines = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
            raise RuntimeError(lines[-1])
        result: dict[str, Any] = json.loads(answer.read_text(encoding="utf-8"))
    return result


def _own_path() -> str:
    """Return what Python has to look in to find this package, whose parts may be apart."""
    others = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    folders = [str(Path(progiso.__file__).parent.parent), *filter(None, others)]
    return os.pathsep.join(folders)
