"""Measure ProgIso beside VTK's mapper and meshes, in one process and one run.

Each peer opens its own window, renders, and closes it before the next one. ``first_ms`` is the
first frame of a new window: upload, shaders, acceleration structures. ``later`` are the frames
from the orbit's positions, at every isovalue; FlyingEdges extracts anew at every isovalue, which
is told apart as ``extraction``. ``file_ms`` is from opening the file, which is in the system's file
cache, to the end of the first frame: for ProgIso a compressed ``.vti`` with appended data, for VTK
the plain file.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkImageData

from ..io import read
from ..measure.isosurface import Isosurface
from ..measure.machine import PeakMemory, available_bytes, gpu_bytes
from ..measure.mesh import Mesh, extract, mesh_bytes
from .fields import Field, gib, plain_path, save_compressed
from .settings import Settings
from .timing import summary
from .volume_mapper import VolumeMapper

#: Main memory that a peer may take, in volumes of float32 samples.
_PEER_VOLUMES = 2.5


def measure_peers(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure all peers on a field.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings

    Returns
    -------
    dict
        ``rows``, one a peer: ``peer``, ``first_ms``, ``later`` (a `timing.summary`), ``file_ms``,
        ``rss_bytes`` and ``gpu_bytes`` (peaks above what was in use before, None where they
        cannot be measured); of ProgIso also ``mapper_bytes``, of FlyingEdges ``extraction``,
        ``triangles`` and ``mesh_bytes``. A row with ``failed`` has nothing else.
    """
    needed, available = int(_PEER_VOLUMES * 4 * field.voxels), available_bytes()
    with tempfile.TemporaryDirectory() as folder:
        path = save_compressed(field, folder)
        rows = [_measure(Isosurface.label, _measure_ours, path, field, settings)]
    for label, peer in ((VolumeMapper.label, _measure_mapper), (Mesh.label, _measure_mesh)):
        if peer is _measure_mesh and settings.no_mesh_of(field):
            rows.append({"peer": label, "failed": settings.no_mesh_of(field)})
            continue
        if needed > available:
            reason = f"takes {gib(needed)} of main memory, {gib(available)} are available"
            rows.append({"peer": label, "failed": reason})
            continue
        try:
            rows.append(_measure(label, peer, plain_path(field), field, settings))
        except RuntimeError as error:  # VTK's own limits are a result, too
            rows.append({"peer": label, "failed": str(error)})
    return {**settings.heading(field), "rows": rows}


def _measure(
    label: str, peer: Callable[..., dict[str, Any]], path: Path, field: Field, settings: Settings
) -> dict[str, Any]:
    """Make a peer's row: its own figures and the memory it took."""
    gpu, peak = _Gpu(), PeakMemory()
    figures = peer(path, field, settings, gpu)
    return {"peer": label, **figures, "rss_bytes": peak.bytes(), "gpu_bytes": gpu.peak}


class _Gpu:
    """Measures the most GPU memory in use, above what was in use at first."""

    def __init__(self) -> None:
        self._before = gpu_bytes()
        self.peak = None if self._before is None else 0

    def look(self) -> None:
        """Look once; it takes some milliseconds, so do not call it while something is timed."""
        used = gpu_bytes()
        if self.peak is not None and self._before is not None and used is not None:
            self.peak = max(self.peak, used - self._before)


def _read(path: Path) -> tuple[vtkImageData, float]:
    """Read a file, and return the image and the milliseconds it took."""
    start = perf_counter()
    image = read(path)
    return image, 1e3 * (perf_counter() - start)


def _measure_ours(path: Path, field: Field, settings: Settings, gpu: _Gpu) -> dict[str, Any]:
    image, reading = _read(path)
    view = Isosurface(image, settings.isovalues_of(field)[0], settings.size)
    figures = _measure_frames(view, image, field, settings, gpu)
    held = view.statistics()["memory"]["total"]
    return {"file_ms": reading + figures["first_ms"], **figures, "mapper_bytes": held}


def _measure_mapper(path: Path, field: Field, settings: Settings, gpu: _Gpu) -> dict[str, Any]:
    image, reading = _read(path)
    view = VolumeMapper(image, settings.isovalues_of(field)[0], settings.size)
    figures = _measure_frames(view, image, field, settings, gpu)
    return {"file_ms": reading + figures["first_ms"], **figures}


def _measure_frames(
    view: Isosurface | VolumeMapper,
    image: vtkImageData,
    field: Field,
    settings: Settings,
    gpu: _Gpu,
) -> dict[str, Any]:
    """Time the first frame and all later ones, then close the view."""
    cameras = settings.cameras(image)
    first, later = view.warm_up(cameras[-1]), []
    gpu.look()
    for isovalue in settings.isovalues_of(field):
        view.set_isovalue(isovalue)
        later += [view.render_from(camera) for camera in cameras * settings.repeat]
    gpu.look()
    view.close()
    return {"first_ms": first, "later": summary(later)}


def _measure_mesh(path: Path, field: Field, settings: Settings, gpu: _Gpu) -> dict[str, Any]:
    image, reading = _read(path)
    cameras = settings.cameras(image)
    extraction, first, later, triangles, sizes = [], [], [], [], []
    for isovalue in settings.isovalues_of(field):
        mesh, milliseconds = extract(image, isovalue)
        extraction.append(milliseconds)
        triangles.append(mesh.GetNumberOfPolys())
        sizes.append(mesh_bytes(mesh))
        view = Mesh(mesh, settings.size)
        first.append(view.warm_up(cameras[-1]))
        later += [view.render_from(camera) for camera in cameras * settings.repeat]
        gpu.look()
        view.close()
        del view, mesh  # so that the next one does not add to it
    return {
        "file_ms": reading + extraction[0] + first[0],
        "first_ms": first[0],
        "later": summary(later),
        "extraction": summary(extraction),
        "triangles": max(triangles),
        "mesh_bytes": max(sizes),
    }
