"""Measure the first image of a file in a new process, whose driver has compiled nothing yet.

Every process opens an empty window first, as an application does. Then the clock starts: the file,
which is in the system's file cache, is read and shown, pass by pass, until the image is complete,
and some more images are rendered, two degrees apart. *Emptied*: the driver's cache of compiled
shaders is a new, empty folder; *kept*: the one that such a process has left.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from .fields import Field, save_compressed
from .interactive import packages_of
from .processes import run_job
from .settings import Settings
from .timing import summary

#: Images after the first one.
NEXT = 10

#: The times of a process, and the keys of the driver's statistics that say how they split.
TIMES = ("window_ms", "read_ms", "first_ms", "complete_ms")


def measure_first_image(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure first images, with the driver's cache emptied and kept.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        ``repeat``: how many processes of each kind.

    Returns
    -------
    dict
        ``rows``, one for each package and cache: ``peer``, ``cache`` (``emptied`` or ``kept``),
        ``commit``, a `timing.summary` for each of `TIMES`, ``next_ms`` (of each next image, the
        median over the processes), ``next`` (the summary of all of them) and ``statistics``, of
        the last process: what the mapper says beside the passes.
    """
    isovalue = settings.isovalues_of(field)[0]
    with tempfile.TemporaryDirectory() as folder:
        job = {
            "path": str(save_compressed(field, folder)),
            "size": list(settings.size),
            "isovalue": isovalue,
            "images": NEXT,
        }
        runs: dict[tuple[str, str], list[dict[str, Any]]] = {}
        for _ in range(settings.repeat):
            for label, package in packages_of(settings).items():
                emptied, kept = _with_and_without_cache(package, job)
                runs.setdefault((label, "emptied"), []).append(emptied)
                runs.setdefault((label, "kept"), []).append(kept)
    rows = [_row(label, cache, results) for (label, cache), results in runs.items()]
    return {**settings.heading(field), "isovalues": [isovalue], "rows": rows}


def _with_and_without_cache(
    package: Path | None, job: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Run a process with an empty cache of shaders, then one with what it has left."""
    with tempfile.TemporaryDirectory(prefix="progiso-shaders-") as cache:
        # NVIDIA's, Mesa's, and that of Mesa before 22.1
        variables = {
            "__GL_SHADER_DISK_CACHE": "1",
            "__GL_SHADER_DISK_CACHE_PATH": cache,
            "MESA_SHADER_CACHE_DISABLE": "false",
            "MESA_SHADER_CACHE_DIR": cache,
            "MESA_GLSL_CACHE_DIR": cache,
        }
        first, second = (run_job(package, "first_image", variables, **job) for _ in range(2))
    return first, second


def _row(label: str, cache: str, runs: list[dict[str, Any]]) -> dict[str, Any]:
    """Put the processes of a package and a cache together."""
    following = [run["next_ms"] for run in runs]
    return {
        "peer": label,
        "cache": cache,
        "commit": runs[0]["commit"],
        **{key: summary([run[key] for run in runs]) for key in TIMES},
        "next_ms": [summary(times)["median"] for times in zip(*following)],
        "next": summary([ms for times in following for ms in times]),
        "statistics": runs[-1]["statistics"],
    }
