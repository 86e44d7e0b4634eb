"""Define once, for tests and tables, how well depths agree with the caster's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..oracle.caster import Cast
from . import tolerances


@dataclass(frozen=True)
class Agreement:
    """Depths held against a `Cast`; every array has the shape of the image.

    Attributes
    ----------
    error : numpy.ndarray
        Voxels along the ray: off the caster's hit where the slack leaves no room, else outside
        what lies between the first possible and the first certain crossing. Infinite at a hit
        where none is possible, and at a miss where one is certain.
    allowed : numpy.ndarray
        What is granted, in voxels: `tolerances.DEPTH_VOXELS`, and the rounding of a float32 depth.
    grazing : float
        Part of the rays that can hit for which rounding decides where, or whether.
    differing : float
        Part of them for which it has decided otherwise than in the caster's own arithmetic.
    hits : int
    """

    error: np.ndarray
    allowed: np.ndarray
    grazing: float
    differing: float
    hits: int

    @property
    def wrong(self) -> np.ndarray:
        """Mark the rays whose depths are off by more than is allowed."""
        return ~(self.error <= self.allowed)

    @property
    def worst(self) -> tuple[float, float]:
        """Return the error and the allowed error of the ray with the largest ratio of the two."""
        at = np.argmax(self.error / self.allowed)
        return float(self.error.flat[at]), float(self.allowed.flat[at])


def compare(depth: np.ndarray, expected: Cast) -> Agreement:
    """Compare depths with the caster's, given what rounding may do.

    A depth must lie between the first possible and the first certain crossing, and be a hit if one
    is certain. Where the two are close it must be the caster's hit.

    Parameters
    ----------
    depth : numpy.ndarray
        Distances along the rays, ``inf`` where there is no hit.
    expected : progiso.oracle.caster.Cast
        Of the same rays, with `tolerances.SLACK`.

    Returns
    -------
    Agreement
    """
    depth = np.asarray(depth, float)
    certain, possible, hit = map(np.isfinite, (expected.late, expected.early, depth))
    before = np.where(hit, _difference(expected.early, depth, hit), 0.0)
    behind = np.where(certain, _difference(depth, expected.late, certain), 0.0)
    room = _difference(expected.late, expected.early, certain)
    close = certain & (room * expected.voxels <= tolerances.CLEAR_VOXELS)
    off = np.abs(_difference(depth, expected.depth, close))
    error = np.maximum(np.maximum(before, behind), np.maximum(off, 0.0)) * expected.voxels
    rounding = tolerances.DEPTH_RELATIVE * np.where(hit, depth, 0.0) * expected.voxels
    place = tolerances.PLACE_VOXELS * expected.spacing * expected.voxels
    allowed = tolerances.DEPTH_VOXELS + rounding + place
    both = hit & np.isfinite(expected.depth)
    same = (hit == np.isfinite(expected.depth)) & (
        np.abs(_difference(depth, expected.depth, both)) * expected.voxels <= allowed
    )
    return Agreement(
        error, allowed, _part(~close, possible), _part(~same, possible), int(hit.sum())
    )


def _part(chosen: np.ndarray, among: np.ndarray) -> float:
    """Return the fraction of some rays that is chosen; 0 of no rays."""
    return float(np.mean(chosen[among])) if among.any() else 0.0


def _difference(a: np.ndarray, b: np.ndarray, where: np.ndarray) -> np.ndarray:
    """Return a - b, and zero elsewhere, so that no infinities are subtracted there."""
    return np.subtract(a, b, out=np.zeros(np.shape(a)), where=where)


def depth_error(
    depth: np.ndarray, expected: np.ndarray, voxels: np.ndarray
) -> dict[str, float | None]:
    """Summarize the differences from the caster's depths.

    Parameters
    ----------
    depth, expected : numpy.ndarray, shape (height, width)
        Distances along the rays, ``inf`` where there is no hit.
    voxels : numpy.ndarray, shape (height, width)
        Voxels that a ray goes in one unit of distance.

    Returns
    -------
    dict
        ``mean``, ``median`` and ``p99`` in voxels over the rays that both hit (None where there
        are none); ``missed`` and ``invented``, the fractions of all rays that do not hit where they
        should, and that hit where they should not; and ``wrong``, that of both.

    Examples
    --------
    >>> depth_error(np.array([[1.5, np.inf]]), np.array([[1.0, 2.0]]), np.full((1, 2), 2.0))
    {'mean': 1.0, 'median': 1.0, 'p99': 1.0, 'missed': 0.5, 'invented': 0.0, 'wrong': 0.5}
    """
    hit, due = np.isfinite(depth), np.isfinite(expected)
    both = hit & due
    off = np.abs(depth[both] - expected[both]) * voxels[both]
    return {
        "mean": float(off.mean()) if off.size else None,
        "median": float(np.median(off)) if off.size else None,
        "p99": float(np.quantile(off, 0.99)) if off.size else None,
        "missed": float(np.mean(due & ~hit)),
        "invented": float(np.mean(hit & ~due)),
        "wrong": float(np.mean(hit != due)),
    }
