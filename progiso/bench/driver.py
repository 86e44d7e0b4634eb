"""Measure one way to an image in a process of its own: ``python driver.py JOB.json RESULT.json``.

The script runs with any progiso package from commit 9de4cd9 on, so that an earlier commit can be
measured beside this one: of progiso it uses what both have. `processes` starts it.

A job has a ``task``, which is the name of a function below, and that function's arguments.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import progiso
from progiso import _built
from progiso._vtk import vtk_errors

try:  # where 9de4cd9 has them
    from progiso.benchmarks.ours import Isosurface  # type: ignore[import-not-found]
    from progiso.benchmarks.view import turned  # type: ignore[import-not-found]
except ImportError:
    from progiso.measure.isosurface import Isosurface
    from progiso.measure.view import turned

#: Degrees between the frames of an orbit.
STEP = 2.0

#: Distances of a dolly's ends and of the far view, in those of the orbit's camera: the nearest one
#: is about a diagonal's quarter away from the volume's border.
NEAREST, FARTHEST, FAR = 0.5, 4.0, 8.0

#: Most frames of a sweep of isovalues for which meshes are extracted.
MESH_SWEEP = 10


@dataclass(frozen=True)
class Frame:
    """What a frame shows.

    Attributes
    ----------
    camera : progiso.Camera
    isovalue : float
    counted : bool, default: True
        Whether it is timed; the others lead to where a movement begins.
    emptied : bool, default: False
        Whether the block cache is emptied before.
    """

    camera: Any
    isovalue: float
    counted: bool = True
    emptied: bool = False


# ---- movements


def _orbit(cameras: list[Any], isovalues: list[float], frames: int) -> list[Frame]:
    """Move by two degrees a frame."""
    return _led([turned(cameras[0], STEP * i) for i in range(frames + 1)], isovalues[0])


def _dolly_in(cameras: list[Any], isovalues: list[float], frames: int) -> list[Frame]:
    """Come nearer by the same factor in every frame, from where the orbit ended."""
    return _dolly(turned(cameras[0], STEP * frames), 1.0, NEAREST, isovalues[0], frames)


def _dolly_out(cameras: list[Any], isovalues: list[float], frames: int) -> list[Frame]:
    """Go away by the same factor in every frame, from where the dolly in ended."""
    return _dolly(turned(cameras[0], STEP * frames), NEAREST, FARTHEST, isovalues[0], frames)


def _far_view(cameras: list[Any], isovalues: list[float], frames: int) -> list[Frame]:
    """Orbit where the volume is small on the screen."""
    far = _at_distance(cameras[0], FAR)
    return _led([turned(far, STEP * i) for i in range(frames + 1)], isovalues[0])


def _sweep(cameras: list[Any], isovalues: list[float], frames: int) -> list[Frame]:
    """Go through the isovalues' range."""
    low, high = min(isovalues), max(isovalues)
    values = [low + (high - low) * i / frames for i in range(frames + 1)]
    shown = [Frame(cameras[0], value) for value in values]
    return [replace(shown[0], counted=False), *shown[1:]]


def _next_view(cameras: list[Any], isovalues: list[float], frames: int) -> list[Frame]:
    """Jump around the volume, at every isovalue."""
    del frames
    return [Frame(camera, isovalue) for isovalue in isovalues for camera in cameras]


def _moved(cameras: list[Any], isovalues: list[float], frames: int) -> list[Frame]:
    """Move by two degrees from an image whose blocks alone are decoded."""
    del frames
    pairs = (
        (Frame(camera, isovalues[0], counted=False, emptied=True),
         Frame(turned(camera, STEP), isovalues[0]))
        for camera in cameras
    )  # fmt: skip
    return [frame for pair in pairs for frame in pair]


#: In the order in which they are made, each with the cache that the one before has left: the
#: fly-through first, so that all growth of the cache after the first image falls into it.
MOVEMENTS = {
    "orbit": _orbit,
    "dolly in": _dolly_in,
    "dolly out": _dolly_out,
    "far view": _far_view,
    "isovalue sweep": _sweep,
    "next view": _next_view,
    "moved by 2°": _moved,
}


def _dolly(camera: Any, start: float, end: float, isovalue: float, frames: int) -> list[Frame]:
    factors = [start * (end / start) ** (i / frames) for i in range(frames + 1)]
    return _led([_at_distance(camera, factor) for factor in factors], isovalue)


def _led(cameras: list[Any], isovalue: float) -> list[Frame]:
    """Show an isovalue from cameras, of which the first is where the movement begins."""
    shown = [Frame(camera, isovalue) for camera in cameras]
    return [replace(shown[0], counted=False), *shown[1:]]


def _at_distance(camera: Any, factor: float) -> Any:
    """Move a camera along its line of sight to so many times its distance."""
    pairs = zip(camera.focal_point, camera.position)
    return replace(camera, position=tuple(f + factor * (p - f) for f, p in pairs))


# ---- ways to an image


class _Way:
    """A way from a compressed volume to images of it."""

    image: Any
    view: Any

    def set_isovalue(self, isovalue: float) -> None:
        """Show another isovalue."""
        self.view.set_isovalue(isovalue)

    def empty_cache(self) -> None:
        """Forget what is decoded; VTK's ways have nothing decoded to forget."""

    def check(self) -> None:
        """Complain where an image is not complete, which VTK's always are."""


def _read(path: str) -> Any:
    """Read a compressed volume; its version is at most the newest one that the package knows.

    Versions differ in what they have beside the stream, of which an earlier commit's mapper needs
    nothing.
    """
    from progiso.vtkProgIsoFilters import vtkCompressedVolume

    image = progiso.read(path)
    version = image.GetFieldData().GetArray("ProgIso.ZFP.Version")
    version.SetValue(0, min(version.GetValue(0), int(vtkCompressedVolume.FormatVersion)))
    return image


class _Ours(_Way):
    """ProgIso's mapper."""

    def __init__(self, path: str, isovalue: float, size: tuple[int, int]) -> None:
        self.image = _read(path)
        self.view = Isosurface(self.image, isovalue, size)

    def empty_cache(self) -> None:
        self.view.mapper.EmptyCache()

    def check(self) -> None:
        if not self.view.converged():
            raise RuntimeError("a frame is not complete")


class _Mapper(_Way):
    """VTK's mapper at its default steps, of the decompressed volume."""

    def __init__(self, path: str, isovalue: float, size: tuple[int, int]) -> None:
        from progiso.bench.volume_mapper import VolumeMapper

        self.image = progiso.decompress(_read(path))
        self.view = VolumeMapper(self.image, isovalue, size)


class _Mesh(_Way):
    """FlyingEdges' mesh of the decompressed volume; a new isovalue means a new mesh."""

    def __init__(self, path: str, isovalue: float, size: tuple[int, int]) -> None:
        from progiso.measure.mesh import Mesh, extract

        self.image = progiso.decompress(_read(path))
        self._extract, self._isovalue = extract, isovalue
        self.view = Mesh(extract(self.image, isovalue)[0], size)

    def set_isovalue(self, isovalue: float) -> None:
        if isovalue != self._isovalue:
            self._isovalue = isovalue
            self.view.mapper.SetInputData(self._extract(self.image, isovalue)[0])


_WAYS: dict[str, Callable[[str, float, tuple[int, int]], _Way]] = {
    "ours": _Ours,
    "mapper": _Mapper,
    "mesh": _Mesh,
}


# ---- tasks


def interactive(
    path: str, peer: str, size: list[int], isovalues: list[float], positions: int, frames: int
) -> dict[str, Any]:
    """Time the frames of every movement.

    Parameters
    ----------
    path : str
        A compressed volume.
    peer : str
        ``ours``, ``mapper`` or ``mesh``.
    size : list of int
        Width and height in pixels.
    isovalues : list of float
        The first one is seen but in the sweep through their range and from view to view.
    positions : int
        Of the orbit that the next views are taken from.
    frames : int
        Of each of the other movements.

    Returns
    -------
    dict
        ``first_ms``; ``movements``: {name: {``ms`` and ``cpu_ms``, a list each}}.
    """
    use_all_cores()
    way = _WAYS[peer](path, isovalues[0], (size[0], size[1]))
    cameras = [progiso.orbit_camera(way.image, i, positions) for i in range(positions)]
    first = way.view.warm_up(cameras[0])
    movements = {}
    for name, frames_of in MOVEMENTS.items():
        count = min(frames, MESH_SWEEP) if peer == "mesh" and name == "isovalue sweep" else frames
        movements[name] = _time_frames(way, frames_of(cameras, isovalues, count))
    way.view.close()
    return {"first_ms": first, "movements": movements}


def use_all_cores() -> None:
    """Let VTK's filters use all cores, as in ParaView."""
    from vtkmodules.vtkCommonCore import vtkSMPTools

    if vtkSMPTools.GetBackend() == "Sequential":
        vtkSMPTools.SetBackend("STDThread")


def _time_frames(way: _Way, shown: list[Frame]) -> dict[str, list[float]]:
    """Render frames, and return milliseconds of wall clock and of the processor's cores."""
    wall, cores = [], []
    for frame in shown:
        if frame.emptied:
            way.empty_cache()
        way.view.look(frame.camera)
        busy, start = time.process_time(), time.perf_counter()
        way.set_isovalue(frame.isovalue)
        way.view.render()
        elapsed, used = time.perf_counter() - start, time.process_time() - busy
        way.check()
        if frame.counted:
            wall.append(round(1e3 * elapsed, 4))
            cores.append(round(1e3 * used, 4))
    return {"ms": wall, "cpu_ms": cores}


def first_image(path: str, size: list[int], isovalue: float, images: int) -> dict[str, Any]:
    """Open a file and show it, in a window that is there already, as an application's is.

    Parameters
    ----------
    path : str
        A compressed volume.
    size : list of int
        Width and height in pixels.
    isovalue : float
    images : int
        How many more are timed, two degrees apart.

    Returns
    -------
    dict
        ``window_ms``: until the empty window is there. From opening the file: ``read_ms``,
        ``first_ms`` until a progressive picture is there, ``complete_ms``. Then ``next_ms``, of
        each further image, and ``statistics``: what the mapper says of the complete one.
    """
    window = _Window((size[0], size[1]))
    window_ms = window.show()
    start = time.perf_counter()
    image = _read(path)
    read_ms = _since(start)
    prop = progiso.make_isosurface(image, isovalue)
    mapper = prop.GetMapper()
    mapper.SetMaximumPassesPerRender(1)
    window.renderer.AddVolume(prop)
    camera = progiso.orbit_camera(image, 0, 10)
    window.look(camera)
    first_ms = None
    for completed in _completed(window, mapper):
        if first_ms is None and completed > 0.0:
            first_ms = _since(start)
    complete_ms = _since(start)
    statistics = progiso.statistics(mapper)
    mapper.SetMaximumPassesPerRender(0)
    next_ms = []
    for i in range(1, images + 1):
        window.look(turned(camera, STEP * i))
        next_ms.append(window.show())
        if not mapper.GetConverged():
            raise RuntimeError("a frame is not complete")
    return {
        "window_ms": window_ms,
        "read_ms": read_ms,
        "first_ms": first_ms,
        "complete_ms": complete_ms,
        "next_ms": next_ms,
        "statistics": {key: value for key, value in statistics.items() if key != "passes"},
    }


class _Window:
    """An off-screen window, empty at first."""

    def __init__(self, size: tuple[int, int]) -> None:
        from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

        self.renderer, self.window = vtkRenderer(), vtkRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)

    def look(self, camera: Any) -> None:
        """Move to a camera."""
        camera.apply(self.renderer.GetActiveCamera())
        self.renderer.ResetCameraClippingRange()

    def show(self) -> float:
        """Render, and return the milliseconds that it took."""
        with vtk_errors("cannot render"):
            start = time.perf_counter()
            self.window.Render()
            self.window.WaitForCompletion()
            return _since(start)


def _since(start: float) -> float:
    return 1e3 * (time.perf_counter() - start)


def _completed(window: _Window, mapper: Any) -> Iterator[float]:
    """Render until the image is complete, and tell after each render how much of it is."""
    while True:
        window.show()
        if mapper.GetNumberOfGLErrors():
            raise RuntimeError("OpenGL reports errors")
        completed = mapper.GetCompletedFraction()
        yield 0.0 if math.isnan(completed) else completed
        if mapper.GetConverged():
            return


_TASKS: dict[str, Callable[..., dict[str, Any]]] = {
    "interactive": interactive,
    "first_image": first_image,
}


def main() -> None:
    """Do the job of the first argument's file, and write the result to the second's."""
    job = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    result = _TASKS[job.pop("task")](**job)
    result["commit"] = _built.COMMIT or None
    Path(sys.argv[2]).write_text(json.dumps(result), encoding="utf-8")


if __name__ == "__main__":
    main()
