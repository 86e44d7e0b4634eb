"""Checks that every source of volumes has to pass."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor
from itertools import product

import numpy as np

from progiso.io.formats import open_source
from progiso.io.source import Selection

#: Samples along z, y and x, all different and none a multiple of a block.
SHAPE = (7, 9, 11)


def ramp(shape=SHAPE, dtype="u2", seed=0):
    """Return samples that are all different along every axis."""
    values = np.random.default_rng(seed).permutation(int(np.prod(shape)))
    return values.reshape(shape).astype(dtype)


def opened(path, **selection):
    """Open a source with keywords of `Selection`."""
    return open_source(path, Selection(**selection))


def check(source, expected, spacing=None, origin=(0, 0, 0), units=None):
    """Compare a source with what a library read: whole, by region, in threads, after pickling."""
    assert source.shape == expected.shape[:3]
    assert source.dtype.isnative
    np.testing.assert_array_equal(source.read(), expected)
    depth, height, width = source.shape
    regions = [
        (slice(depth // 2, depth // 2 + 1), slice(None), slice(None)),
        (slice(None), slice(height // 3, height), slice(width - 1, width)),
        (slice(depth - 1, depth), slice(0, 1), slice(width // 2, width)),
    ]
    for region in regions:
        np.testing.assert_array_equal(source.read(region), expected[region])
    with ThreadPoolExecutor(3) as pool:
        for region, found in zip(regions * 2, pool.map(source.read, regions * 2)):
            np.testing.assert_array_equal(found, expected[region])
    with pickle.loads(pickle.dumps(source)) as copy:
        np.testing.assert_array_equal(copy.read(regions[0]), expected[regions[0]])
    whole = np.ma.getdata(np.ma.concatenate(list(source.slabs())))
    np.testing.assert_array_equal(whole, expected)
    if spacing is not None:
        corners = np.array(list(product(*((0, n - 1) for n in source.about.dimensions))))
        geometry = source.about.geometry
        placed = geometry.origin + corners @ geometry.axes.T
        np.testing.assert_allclose(
            placed, np.array(origin) + corners * np.array(spacing), rtol=1e-6
        )
    assert source.about.geometry.units == units
