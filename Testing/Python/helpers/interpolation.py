"""Interpolate samples otherwise than the caster does."""

import numpy as np


def interpolate(values, points):
    """Interpolate samples [z, y, x] trilinearly at points (x, y, z), corner by corner."""
    cell = np.clip(np.floor(points).astype(int), 0, np.array(values.shape[::-1]) - 2)
    local = points - cell
    total = np.zeros(points.shape[:-1])
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, local, 1 - local), axis=-1)
        x, y, z = np.moveaxis(cell + corner, -1, 0)
        total += weight * values[z, y, x]
    return total
