"""Measure what explicit extraction from the same compressed volume takes (the paper's BCMC).

It decodes every block that holds the isovalue, with the neighbours that the block's dual grid
reaches into, and makes the whole mesh, seen or not.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..measure.machine import PeakMemory
from ..measure.mesh import extract, mesh_bytes

#: Bytes of a decoded block: 4³ float32.
BLOCK_BYTES = 256

_SIDE = 4


class BlockRanges:
    """Holds the value range of every block's dual grid.

    Parameters
    ----------
    values : numpy.ndarray, shape (depth, height, width)
        The decompressed samples.
    """

    def __init__(self, values: np.ndarray) -> None:
        layers = range(0, values.shape[0], _SIDE)
        slabs = [values[z : z + _SIDE + 1] for z in layers]
        self._low = np.stack([_over_blocks(slab.min(axis=0), np.minimum) for slab in slabs])
        self._high = np.stack([_over_blocks(slab.max(axis=0), np.maximum) for slab in slabs])
        # a last layer of one sample has no cells of its own
        cells = tuple(slice(-(-(n - 1) // _SIDE)) for n in values.shape)
        self._has_cells = np.zeros(self._low.shape, bool)
        self._has_cells[cells] = True

    def count(self, isovalue: float) -> dict[str, int]:
        """Count the blocks that extraction of an isovalue decodes.

        Parameters
        ----------
        isovalue : float

        Returns
        -------
        dict
            ``blocks`` of the volume, those that ``held`` the isovalue, and those ``active``: with
            their neighbours.
        """
        held = (self._low < isovalue) & (isovalue <= self._high) & self._has_cells
        active = np.zeros_like(held)
        for offset in product((0, 1), repeat=3):
            to = tuple(slice(o, None) for o in offset)
            start = tuple(slice(n - o) for n, o in zip(held.shape, offset))
            active[to] |= held[start]
        return {"blocks": held.size, "held": int(held.sum()), "active": int(active.sum())}


def _over_blocks(plane: np.ndarray, pick: np.ufunc) -> np.ndarray:
    """Reduce a plane to extremes over its blocks and the samples one beyond."""
    for axis in range(2):
        starts = np.arange(0, plane.shape[axis], _SIDE)
        blocks = pick.reduceat(plane, starts, axis=axis)
        beyond = plane.take(starts[1:], axis=axis)
        inner = tuple(slice(len(starts) - 1) if a == axis else slice(None) for a in range(2))
        blocks[inner] = pick(blocks[inner], beyond)
        plane = blocks
    return plane


def measure_mesh(image: vtkImageData, isovalue: float) -> dict[str, Any]:
    """Extract the mesh, and measure time and memory.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        The decompressed volume.
    isovalue : float

    Returns
    -------
    dict
        ``isovalue``, ``ms``, ``triangles``, ``bytes`` of the mesh, and ``peak_bytes`` of main
        memory beside the volume while it was made (None where that cannot be measured).
    """
    peak = PeakMemory()
    mesh, milliseconds = extract(image, isovalue)
    return {
        "isovalue": isovalue,
        "ms": milliseconds,
        "triangles": mesh.GetNumberOfPolys(),
        "bytes": mesh_bytes(mesh),
        "peak_bytes": peak.bytes(),
    }
