"""Render thousands of random changes, and measure the memory that they leave behind.

Every frame moves the camera and changes the isovalue; now and then the size of the image, what the
surface looks like, the memory budget, the volume or its colours change, the cache is emptied, the
graphics resources are given back, or a new mapper takes the old one's place. All images are
complete. Another mapper in the window, hidden, keeps the shaders that they share compiled.

Memory is told of one and the same scene, the one at *rest*, to which the view returns for every
sample: what grows there was left behind by the frames in between.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from ..appearance import set_colors, set_opacities
from ..camera import Camera, orbit_camera
from ..isosurface import make_isosurface
from ..measure.isosurface import Isosurface
from ..measure.machine import gpu_bytes, resident_bytes
from .fields import Field, compressed, decompressed
from .settings import Settings

#: Samples of a run, and the part of it after which they count: until then shaders are compiled.
SAMPLES, WARM_UP = 400, 0.25

#: Largest volume that the mapper also gets uncompressed, to compress it itself.
LARGEST_PLAIN = 128**3

#: Probabilities that a frame changes something beside camera and isovalue.
CHANCES = {
    "size": 0.1,
    "look": 0.05,
    "speculation": 0.02,
    "budget": 0.02,
    "whole": 0.02,
    "empty": 0.02,
    "volume": 0.01,
    "release": 0.002,
    "mapper": 0.002,
}

#: What the surfaces look like: {name: (isovalues, opacity, lit, of another volume's colours, cut)}.
_LOOKS = {
    "plain": (1, 1.0, False, False, False),
    "lit": (1, 1.0, True, False, False),
    "several": (3, 1.0, True, False, False),
    "translucent": (3, 0.4, True, False, False),
    "cut": (1, 1.0, True, False, True),
    "colored": (1, 1.0, True, True, False),
    "everything": (3, 0.4, True, True, True),
}
_COLORS = ((0.9, 0.3, 0.2), (0.3, 0.8, 0.4), (0.3, 0.4, 0.9))
_REST = "several"


def measure_soak(field: Field, settings: Settings) -> dict[str, Any]:
    """Render frames of random changes, and watch the memory.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        ``frames`` are rendered, at most as large as ``size``.

    Returns
    -------
    dict
        ``frames``; ``samples``, lists of the same length: ``frame``, ``rss`` (main memory),
        ``mapper`` (what the mapper says that it holds on the GPU) and ``gpu`` (memory in use by
        nvidia-smi; None without), all at rest and in bytes, and ``peak``, the mapper's largest
        since the sample before; ``warm_up``, the first frame that counts; ``growth``: {``rss``,
        ``mapper``, ``gpu``: bytes a frame}; ``changes`` {what: how often}; ``gl_errors``.
    """
    every = max(1, settings.frames // SAMPLES)
    with _gl_errors_counted():
        walk = _Walk(field, settings.size, settings.seed)
        samples = [walk.sample(0)]
        for frame in range(1, settings.frames + 1):
            walk.step()
            if frame % every == 0:
                samples.append(walk.sample(frame))
        errors = walk.close()
    columns = {key: [sample[key] for sample in samples] for key in samples[0]}
    warm_up = int(WARM_UP * settings.frames)
    return {
        **settings.heading(field),
        "frames": settings.frames,
        "samples": columns,
        "warm_up": warm_up,
        "growth": {key: growth(columns, key, warm_up) for key in ("rss", "mapper", "gpu")},
        "changes": walk.changes,
        "gl_errors": errors,
    }


def growth(samples: dict[str, Any], key: str, warm_up: int) -> float | None:
    """Return the median slope between all pairs of samples after the warm-up.

    Parameters
    ----------
    samples : dict
        Of `measure_soak`.
    key : str
    warm_up : int
        The first frame that counts.

    Returns
    -------
    float or None
        Bytes a frame; None where there are no two samples, or no figures.

    Examples
    --------
    >>> growth({"frame": [0, 10, 20, 30], "rss": [0, 100, 120, 140]}, "rss", 10)
    2.0
    """
    pairs = zip(samples["frame"], samples[key])
    counted = [(frame, value) for frame, value in pairs if frame >= warm_up and value is not None]
    if len(counted) < 2:
        return None
    frames, values = np.array(counted, float).T
    first, second = np.triu_indices(len(frames), 1)
    slopes = (values[second] - values[first]) / (frames[second] - frames[first])
    return float(np.median(slopes))


@contextmanager
def _gl_errors_counted() -> Iterator[None]:
    """Let mappers that are made meanwhile count OpenGL errors."""
    before = os.environ.get("PROGISO_GL_DEBUG")
    os.environ["PROGISO_GL_DEBUG"] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ["PROGISO_GL_DEBUG"]
        else:
            os.environ["PROGISO_GL_DEBUG"] = before


class _Walk:
    """Makes random changes to a view."""

    def __init__(self, field: Field, size: tuple[int, int], seed: int) -> None:
        self._random = np.random.default_rng(seed)
        self._low, self._high = min(field.isovalues), max(field.isovalues)
        self._size = size
        half = replace(field, rate=field.rate / 2)
        self._volumes = [compressed(field), compressed(half)]
        if field.voxels <= LARGEST_PLAIN:
            self._volumes.append(decompressed(half))
        self._rest = orbit_camera(self._volumes[0], 1, 5)
        self._obstacle = self._make_obstacle()
        self._errors = self._peak = 0
        self.changes = dict.fromkeys(CHANCES, 0)
        self.view = Isosurface(self._volumes[0], self._low, self._size)
        self.view.renderer.AddActor(self._obstacle)
        self._keeper = make_isosurface(self._volumes[0], self._low)
        self.view.renderer.AddViewProp(self._keeper)
        self.view.render_from(self._rest)
        self._keeper.VisibilityOff()
        self._least = 0
        self._warm_up()

    def _make_obstacle(self) -> vtkActor:
        """Make a ball in the middle of the volume."""
        source, mapper, actor = vtkSphereSource(), vtkPolyDataMapper(), vtkActor()
        radius = np.linalg.norm(np.subtract(self._rest.position, self._rest.focal_point))
        source.SetCenter(self._rest.focal_point)
        source.SetRadius(0.1 * radius)
        mapper.SetInputConnection(source.GetOutputPort())
        actor.SetMapper(mapper)
        return actor

    def _warm_up(self) -> None:
        """Render every look once, at full size: decoded as a whole, with a cache, and within the
        least memory that any of them can be rendered with."""
        for whole, limited in ((True, False), (False, False), (False, True)):
            self.view.mapper.SetDecodeWholeVolume(whole)
            self.view.mapper.SetMemoryBudget(self._least if limited else 0)
            for name in _LOOKS:
                self._look(name)
                self.view.render_from(self._rest)
                least = self.view.statistics()["memory"]["least_budget"]
                self._least = max(self._least, least)
        self.view.mapper.SetMemoryBudget(0)

    # ---- a frame

    def step(self) -> None:
        """Change at random, and render."""
        for what, chance in CHANCES.items():
            if self._random.random() < chance:
                getattr(self, f"_change_{what}")()
                self.changes[what] += 1
        isovalues = self.view.prop.GetProperty().GetIsoSurfaceValues()
        for i in range(isovalues.GetNumberOfContours()):
            isovalues.SetValue(i, self._random.uniform(self._low, self._high))
        self.view.render_from(self._random_camera())
        if not self.view.converged():
            raise RuntimeError("an image is not complete")
        self._peak = max(self._peak, self.view.mapper.GetStatistics().GetTotalBytes())

    def sample(self, frame: int) -> dict[str, Any]:
        """Return to rest, and measure the memory: a row of `measure_soak`'s samples."""
        self._change_rest()
        self.view.render_from(self._rest)
        resting = self.view.mapper.GetStatistics().GetTotalBytes()
        peak, self._peak = max(self._peak, resting), 0
        gc.collect()
        return {
            "frame": frame,
            "rss": resident_bytes(),
            "mapper": resting,
            "gpu": gpu_bytes(),
            "peak": peak,
        }

    def close(self) -> int:
        """Free everything; return the OpenGL errors of all mappers."""
        for prop in (self.view.prop, self._keeper):
            self._errors += prop.GetMapper().GetNumberOfGLErrors()
        self.view.close()
        return self._errors

    def _random_camera(self) -> Camera:
        """Place a camera around the volume, or in it."""
        direction = self._random.normal(size=3)
        offset = np.subtract(self._rest.position, self._rest.focal_point)
        distance = np.linalg.norm(offset) * self._random.uniform(0.1, 1.5)
        position = self._rest.focal_point + distance * direction / np.linalg.norm(direction)
        up = tuple(np.roll(np.cross(direction, (0.3, 0.5, 0.8)), 1).tolist())
        angle = self._random.uniform(10, 90)
        return Camera(tuple(position.tolist()), self._rest.focal_point, up, view_angle=float(angle))

    # ---- changes

    def _change_rest(self) -> None:
        self.view.window.SetSize(*self._size)
        self.view.mapper.SetInputData(self._volumes[0])
        self.view.mapper.SetMemoryBudget(0)
        self.view.mapper.SetDecodeWholeVolume(True)
        self._look(_REST)

    def _change_size(self) -> None:
        parts = self._random.uniform(0.1, 1.0, 2)
        self.view.window.SetSize(*(max(1, int(n * part)) for n, part in zip(self._size, parts)))

    def _change_look(self) -> None:
        self._look(self._random.choice(list(_LOOKS)))

    def _change_speculation(self) -> None:
        self.view.mapper.SetSpeculationLimit(int(self._random.choice([1, 8, 64])))

    def _change_budget(self) -> None:
        budget = int(self._least * self._random.uniform(1, 3))
        self.view.mapper.SetMemoryBudget(budget if self._random.random() < 0.7 else 0)

    def _change_whole(self) -> None:
        self.view.mapper.SetDecodeWholeVolume(not self.view.mapper.GetDecodeWholeVolume())

    def _change_empty(self) -> None:
        self.view.mapper.EmptyCache()

    def _change_volume(self) -> None:
        number = self._random.integers(len(self._volumes))
        self.view.mapper.SetInputData(self._volumes[number])

    def _change_release(self) -> None:
        self.view.prop.ReleaseGraphicsResources(self.view.window)

    def _change_mapper(self) -> None:
        self._errors += self.view.mapper.GetNumberOfGLErrors()
        self.view.renderer.RemoveViewProp(self.view.prop)
        self.view.prop = make_isosurface(self._volumes[0], self._low)
        self.view.mapper = self.view.prop.GetMapper()
        self.view.renderer.AddViewProp(self.view.prop)
        self._look(_REST)

    def _look(self, name: str) -> None:
        count, opacity, lit, colored, cut = _LOOKS[name]
        property_, mapper = self.view.prop.GetProperty(), self.view.mapper
        property_.GetIsoSurfaceValues().SetNumberOfContours(count)
        for i, value in enumerate(np.linspace(self._low, self._high, count + 2)[1:-1]):
            property_.GetIsoSurfaceValues().SetValue(i, value)
        self.view.prop.RemoveObservers("StartEvent")  # of the look before
        set_colors(self.view.prop, _COLORS[:count])
        set_opacities(self.view.prop, [opacity])
        property_.SetShade(lit)
        mapper.SetColorInputData(self._volumes[1] if colored else None)
        self._obstacle.SetVisibility(opacity < 1)
        mapper.RemoveAllClippingPlanes()
        mapper.SetCropping(cut)
        if cut:
            plane = vtkPlane()
            plane.SetOrigin(self._rest.focal_point)
            plane.SetNormal(self._random.normal(size=3))
            mapper.AddClippingPlane(plane)
            bounds = np.reshape(self._volumes[0].GetBounds(), (3, 2))
            third = (bounds @ [[2, 1], [1, 2]] / 3).ravel()
            mapper.SetCroppingRegionPlanes(third.tolist())
            mapper.SetCroppingRegionFlagsToFence()
