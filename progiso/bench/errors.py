"""Measure depth error against run time, for every way to the same image.

The reference is the double-precision caster over the *uncompressed* samples. The error of a ray
is how far off its depth is, in voxels along the ray, where both hit; a ray that hits where the
caster misses, or the other way round, is wrong. Pixels that a partial image has not finished have
no depth: they are wrong where the caster hits.

Times are medians of the view after the opposite side of the orbit was rendered, the view having
been rendered before: shaders are compiled, and what the peer keeps between frames is there. Passes
are timed with every one of them shown, on the same condition, and of the block cache: small volumes
too, which are else decoded when they are loaded and need one pass.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from ..geometry import samples_of
from ..io import compress
from ..measure.agreement import depth_error
from ..measure.isosurface import Isosurface
from ..measure.machine import available_bytes
from ..measure.mesh import Mesh, extract
from ..measure.view import View, opposite
from ..oracle.caster import Camera, Cast, Volume, cast
from .fields import Field, compressed, gib, plain
from .settings import Settings
from .volume_mapper import VolumeMapper

#: Bits per sample, and VTK's distances between samples in the smallest spacing.
RATES = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
SAMPLE_DISTANCES = (0.1, 0.25, 0.5, 1.0, 2.0)

#: Label of VTK's own choice of the distance.
DEFAULT_DISTANCE = "VTK's default"

#: How often an image is timed at least, unless that takes more than so many milliseconds.
_REPEAT, _ENOUGH_MS = 3, 5000.0

#: Main memory that this takes, in volumes of float32 samples.
_VOLUMES = 2.5


def measure_errors(
    field: Field,
    settings: Settings,
    rates: Sequence[float] = RATES,
    distances: Sequence[float] = SAMPLE_DISTANCES,
) -> dict[str, Any]:
    """Measure error and time of all peers for one image of a field.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        The image is that of the first isovalue from the first position.
    rates, distances : sequence of float
        Bits per sample of ProgIso's series, and VTK's sample distances in the smallest spacing.

    Returns
    -------
    dict
        ``isovalue``, ``oracle`` (``ms``, ``hits``), ``resolution`` ({peer: voxels} of the depths'
        source), and ``series``: {name: points}, each with ``label``, ``ms`` and `depth_error`'s
        figures. With ``left_out`` there is no image.
    """

    def measure() -> dict[str, Any]:
        return _Measurement(field, settings).run(rates, distances)

    return of_one_image(field, settings, measure)


def of_one_image(
    field: Field, settings: Settings, measure: Callable[[], dict[str, Any]]
) -> dict[str, Any]:
    """Measure the image of the first isovalue from the first position, if memory allows.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
    measure : callable
        Returns a dict.

    Returns
    -------
    dict
        The heading, with ``left_out`` or with what was measured.
    """
    needed, available = int(_VOLUMES * 4 * field.voxels), available_bytes()
    heading = {**settings.heading(field), "isovalues": settings.isovalues_of(field)[:1]}
    if needed > available:
        reason = f"takes {gib(needed)} of main memory, {gib(available)} are available"
        return {**heading, "left_out": reason}
    return {**heading, **measure()}


def cast_uncompressed(field: Field, settings: Settings) -> Cast:
    """Cast the uncompressed samples, within the clipping planes of ProgIso's view.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        The image is that of the first isovalue from the first position.

    Returns
    -------
    progiso.oracle.caster.Cast
    """
    image, isovalue = plain(field), settings.isovalues_of(field)[0]
    view = Isosurface(compressed(field), isovalue, settings.size)
    view.look(settings.cameras(image)[0])
    camera = view.renderer.GetActiveCamera()
    seen, clip = Camera.from_vtk(camera), camera.GetClippingRange()
    volume = Volume.from_image(samples_of(image), image)
    return cast(volume, isovalue, seen, settings.size, clip=clip)


class _Measurement:
    """Measures one image of one field by all peers."""

    def __init__(self, field: Field, settings: Settings) -> None:
        self._field, self._settings = field, settings
        self._image = plain(field)
        self._isovalue = settings.isovalues_of(field)[0]
        self._camera = settings.cameras(self._image)[0]
        self._repeat = max(_REPEAT, settings.repeat)
        self._resolution: dict[str, float] = {}
        start = perf_counter()
        self._expected = cast_uncompressed(field, settings)
        self._cast_ms = 1e3 * (perf_counter() - start)

    def run(self, rates: Sequence[float], distances: Sequence[float]) -> dict[str, Any]:
        hits = int(np.isfinite(self._expected.depth).sum())
        series = {
            "ProgIso, pass by pass": self._passes(),
            "ProgIso, rates": [self._rate(rate) for rate in rates],
            VolumeMapper.label: [self._mapper(d) for d in (None, *distances)],
            Mesh.label: self._mesh(),
        }
        return {
            "isovalue": self._isovalue,
            "oracle": {"ms": self._cast_ms, "hits": hits},
            "resolution": self._resolution,
            "series": series,
        }

    def _time(self, view: View) -> float:
        """Return the median milliseconds of the view, each after its opposite."""
        times: list[float] = []
        view.warm_up(self._camera)
        while not times or (len(times) < self._repeat and sum(times) < _ENOUGH_MS):
            view.render_from(opposite(self._camera))
            times.append(view.render_from(self._camera))
        return statistics.median(times)

    def _point(self, label: str, milliseconds: float, view: View) -> dict[str, Any]:
        """Make a point of a series, and record the resolution of the peer's depths."""
        depth, expected = view.depth(), self._expected
        self._resolution[view.label] = view.depth_resolution() * float(expected.voxels.max())
        return {
            "label": label,
            "ms": milliseconds,
            **depth_error(depth, expected.depth, expected.voxels),
        }

    def _passes(self) -> list[dict[str, Any]]:
        image = compressed(self._field)
        view = Isosurface(image, self._isovalue, self._settings.size, cached=True)
        view.warm_up(self._camera)
        view.render_from(opposite(self._camera))
        view.set_passes_per_render(1)
        view.look(self._camera)
        points: list[dict[str, Any]] = []
        elapsed = 0.0
        while not points or not view.converged():
            elapsed += view.render()
            points.append(self._point(f"pass {len(points) + 1}", elapsed, view))
        view.close()
        return points

    def _rate(self, rate: float) -> dict[str, Any]:
        view = Isosurface(compress(self._image, rate=rate), self._isovalue, self._settings.size)
        point = self._point(f"{rate:g} bits", self._time(view), view)
        view.close()
        return point

    def _mapper(self, distance: float | None) -> dict[str, Any]:
        view = VolumeMapper(self._image, self._isovalue, self._settings.size, distance)
        unit = "voxel" if distance == 1 else "voxels"
        label = DEFAULT_DISTANCE if distance is None else f"{distance:g} {unit}"
        point = self._point(label, self._time(view), view)
        view.close()
        return point

    def _mesh(self) -> list[dict[str, Any]]:
        mesh, extraction = extract(self._image, self._isovalue)
        view = Mesh(mesh, self._settings.size)
        first = extraction + view.render_from(self._camera)
        later = self._point("later frames", self._time(view), view)
        view.close()
        return [{**later, "label": "with extraction", "ms": first}, later]
