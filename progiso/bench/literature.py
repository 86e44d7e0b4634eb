"""List figures from the literature, which were not measured in the run at hand.

The paper's own implementation (WebGPU through Dawn on Vulkan), at our fields, three isovalues and
its orbit of 10 positions: milliseconds to the complete image. ``strong`` is the same with its two
radix sorts by block replaced by a counting sort, which leaves every image as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

GPU, SOFTWARE = "NVIDIA H200", "2 cores, Mesa lavapipe"

#: Bytes per second that a copy on the GPU's own memory moves, read and written, as measured there.
BANDWIDTH = {GPU: 4.3e12}

SOURCE = (
    "Usher, Dyken and Kumar (LDAV 2023), their public implementation, as measured beforehand: "
    f"means on an {GPU}, medians on {SOFTWARE}; in brackets with its sort replaced by a counting "
    "sort"
)


@dataclass(frozen=True)
class Figure:
    """Holds a time of the paper's implementation.

    Attributes
    ----------
    machine : str
        `GPU` or `SOFTWARE`.
    field : str
        See `fields.Field.name`.
    size : tuple of int
        Width and height in pixels.
    ms, strong_ms : float
        Milliseconds to the complete image, as published and with its sort replaced; the latter
        None where it was not measured.
    gpu_mib : float, optional
        GPU memory of the process in MiB.
    """

    machine: str
    field: str
    size: tuple[int, int]
    ms: float
    strong_ms: float | None
    gpu_mib: float | None = None


FIGURES = (
    Figure(GPU, "marschner-lobb-128-k6-r4", (1280, 720), 281, 34),
    Figure(GPU, "gyroid-256-k6-r2", (1280, 720), 580, 72, 803),
    Figure(GPU, "gyroid-256-k6-r2", (640, 360), 202, None),
    Figure(GPU, "gyroid-512-k12-r4", (1280, 720), 700, 143),
    Figure(GPU, "gyroid-1024-k24-r4", (1280, 720), 1174, 580, 2004),
    Figure(GPU, "gyroid-1024-k24-r2", (1280, 720), 1199, 495, 1740),
    Figure(GPU, "gyroid-1024-k6-r2", (1280, 720), 739, 318, 1662),
    Figure(SOFTWARE, "marschner-lobb-128-k6-r4", (640, 360), 2400, 350),
    Figure(SOFTWARE, "marschner-lobb-256-k6-r4", (640, 360), 3100, 890),
    Figure(SOFTWARE, "gyroid-256-k6-r2", (640, 360), 5600, 1700),
    Figure(SOFTWARE, "marschner-lobb-256-k6-r4", (1280, 720), 11500, 1700),
    Figure(SOFTWARE, "gyroid-256-k6-r2", (1280, 720), 19600, 3000),
)


def literature(machine: str | None, field: str, size: Sequence[int]) -> Figure | None:
    """Look up the figure for a kind of machine.

    Parameters
    ----------
    machine : str or None
        `GPU`, `SOFTWARE`, or None for a machine that is of neither kind.
    field : str
    size : sequence of int

    Returns
    -------
    Figure or None
    """
    wanted = (machine, field, tuple(size))
    return next((f for f in FIGURES if (f.machine, f.field, f.size) == wanted), None)
