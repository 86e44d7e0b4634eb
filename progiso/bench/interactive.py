"""Measure the frames of a fly-through: ProgIso, an earlier commit, VTK's mapper and FlyingEdges.

Every way to an image runs in a process of its own, see `driver`, where the movements follow each
other: an orbit by two degrees a frame, a dolly in and out, an orbit far away, a sweep through the
isovalues, views from all around at every isovalue, and moves by two degrees from views with an
empty cache. Every frame is complete. A process that compiles shaders draws slowly for some seconds:
another one, which is not counted, fills the driver's cache before. This commit and the earlier one
take turns.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from ..measure.isosurface import Isosurface
from ..measure.machine import available_bytes
from ..measure.mesh import Mesh
from .driver import MOVEMENTS
from .fields import Field, gib, save_compressed
from .processes import run_job
from .settings import Settings
from .timing import summary
from .volume_mapper import VolumeMapper

#: Name of the earlier commit's rows.
BASELINE = "ProgIso, baseline"

#: Main memory that VTK's ways take, in volumes of float32 samples.
_VTK_VOLUMES = 2.5

#: Frames of a movement in the process that fills the driver's cache.
_WARM_UP_FRAMES = 2


def measure_interactive(field: Field, settings: Settings) -> dict[str, Any]:
    """Time all frames of all ways.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings

    Returns
    -------
    dict
        ``frames`` and ``rows``, one a way: ``peer``, ``commit``, ``processes`` (how many),
        ``first_ms`` (tells whether shaders were compiled) and ``movements``: {name: {``ms``: of
        every frame, process after process, ``time``: their `timing.summary`, ``cpu_ms``: of all
        cores, mean}}. A row with ``failed`` has nothing else.
    """
    with tempfile.TemporaryDirectory() as folder:
        job = {
            "path": str(save_compressed(field, folder)),
            "size": list(settings.size),
            "isovalues": settings.isovalues_of(field),
            "positions": settings.positions,
        }
        rows = [
            *_our_rows(job, settings),
            _vtk_row(VolumeMapper.label, "mapper", job, field, settings),
            _vtk_row(Mesh.label, "mesh", job, field, settings),
        ]
    return {**settings.heading(field), "frames": settings.frames, "rows": rows}


def _run(
    package: Path | None, peer: str, frames: int, job: dict[str, Any], warm_up: bool = False
) -> dict[str, Any]:
    """Run a process, or one that fills the driver's cache of shaders and is not counted."""
    count = min(frames, _WARM_UP_FRAMES) if warm_up else frames
    return run_job(package, "interactive", peer=peer, frames=count, **job)


def _our_rows(job: dict[str, Any], settings: Settings) -> list[dict[str, Any]]:
    """Measure this commit and the earlier one in turns."""
    packages = packages_of(settings)
    for package in packages.values():
        _run(package, "ours", settings.frames, job, warm_up=True)
    runs: dict[str, list[dict[str, Any]]] = {label: [] for label in packages}
    for _ in range(settings.repeat):
        for label, package in packages.items():
            runs[label].append(_run(package, "ours", settings.frames, job))
    return [_row(label, results) for label, results in runs.items()]


def _vtk_row(
    label: str, peer: str, job: dict[str, Any], field: Field, settings: Settings
) -> dict[str, Any]:
    """Measure one of VTK's ways, or tell why it is left out."""
    reason = _reason_against(peer, field, settings)
    if reason:
        return {"peer": label, "failed": reason}
    try:
        if peer == "mapper":  # a mesh's shaders are small
            _run(None, peer, settings.frames, job, warm_up=True)
        return _row(label, [_run(None, peer, settings.frames, job)])
    except RuntimeError as error:  # VTK's own limits are a result, too
        return {"peer": label, "failed": str(error)}


def packages_of(settings: Settings) -> dict[str, Path | None]:
    """Return what is measured of ProgIso, as `processes.run_job` takes it, by label."""
    packages: dict[str, Path | None] = {Isosurface.label: None}
    return packages if settings.baseline is None else {**packages, BASELINE: settings.baseline}


def _reason_against(peer: str, field: Field, settings: Settings) -> str | None:
    """Tell why one of VTK's ways is not measured; None where it is."""
    left_out = settings.not_plain(field) or (peer == "mesh" and settings.no_mesh_of(field))
    if left_out:
        return left_out
    needed, available = int(_VTK_VOLUMES * 4 * field.voxels), available_bytes()
    if needed > available:
        return f"takes {gib(needed)} of main memory, {gib(available)} are available"
    return None


def _row(label: str, runs: list[dict[str, Any]]) -> dict[str, Any]:
    """Put the frames of a way's processes together."""
    return {
        "peer": label,
        "commit": runs[0]["commit"],
        "processes": len(runs),
        "first_ms": runs[0]["first_ms"],
        "movements": {name: _frames(name, runs) for name in MOVEMENTS},
    }


def _frames(name: str, runs: list[dict[str, Any]]) -> dict[str, Any]:
    """Collect the frames of a movement."""
    ms = [value for run in runs for value in run["movements"][name]["ms"]]
    cpu = [value for run in runs for value in run["movements"][name]["cpu_ms"]]
    return {"ms": ms, "time": summary(ms), "cpu_ms": sum(cpu) / len(cpu)}
