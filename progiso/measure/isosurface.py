"""Show a volume by ProgIso's mapper; all of its settings for benchmarks are here."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..isosurface import make_isosurface
from ..statistics import depth, statistics
from .view import View

#: Beginnings of the names of the buffers that make up the block cache.
CACHE_PREFIX = "cache_"


class Isosurface(View):
    """A compressed volume, rendered by ProgIso.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.
    isovalue : float
    size : tuple of int
        Width and height in pixels.
    speculation : bool, default: True
        Whether rays test several blocks ahead.
    detailed : bool, default: False
        Whether stages are timed and distinct blocks counted, which takes time.
    memory_budget : int, default: 0
        Bytes of GPU memory; 0 for the mapper's own choice.
    cached : bool, default: False
        Whether blocks are decoded as rays meet them even where the whole volume fits the budget.
    """

    label = "ProgIso"

    def __init__(
        self,
        image: vtkImageData,
        isovalue: float,
        size: tuple[int, int],
        *,
        speculation: bool = True,
        detailed: bool = False,
        memory_budget: int = 0,
        cached: bool = False,
    ) -> None:
        prop = make_isosurface(
            image, isovalue, speculation=speculation, memory_budget=memory_budget
        )
        super().__init__(prop, size)
        self.mapper = prop.GetMapper()
        self.mapper.SetDetailedStatistics(detailed)
        self.mapper.SetDecodeWholeVolume(not cached)

    def set_isovalue(self, isovalue: float) -> None:
        """Show another isovalue from the next render on."""
        self.prop.GetProperty().GetIsoSurfaceValues().SetValue(0, isovalue)

    def set_passes_per_render(self, count: int) -> None:
        """Show the image after every `count` passes; 0 for complete images only."""
        self.mapper.SetMaximumPassesPerRender(count)

    def converged(self) -> bool:
        """Tell whether the last image is complete."""
        return self.mapper.GetConverged()

    def statistics(self) -> dict[str, Any]:
        """Return `progiso.statistics` of the last image."""
        return statistics(self.mapper, self.renderer)

    def depth(self) -> np.ndarray:
        """Return `progiso.depth` of the last image."""
        return depth(self.mapper)

    def depth_resolution(self) -> float:
        """Return the resolution of the largest depth in world units, which is float32's."""
        distances = self.depth()
        return float(np.spacing(distances[np.isfinite(distances)].max(initial=0.0)))


def cache_bytes(memory: dict[str, Any]) -> int:
    """Sum the bytes of the block cache in ``statistics()["memory"]``."""
    buffers = memory["buffers"].items()
    return sum(count for name, count in buffers if name.startswith(CACHE_PREFIX))


def other_bytes(memory: dict[str, Any]) -> int:
    """Sum all but the stream and the block cache in ``statistics()["memory"]``."""
    return memory["total"] - memory["compressed"] - cache_bytes(memory)


def stage_times(about: dict[str, Any]) -> dict[str, float]:
    """Return the milliseconds of every stage of an image, from a ``detailed`` view's statistics.

    Returns
    -------
    dict
        {stage: milliseconds}.
    """
    return about["stage_ms"]
