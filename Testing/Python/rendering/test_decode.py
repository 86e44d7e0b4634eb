"""The shaders' decoder against libzfp, bit for bit."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy

import progiso
from helpers.decoding import check_decoding, small_window
from helpers.images import blobs, make_image, marschner_lobb, noise

EXTREMES = np.array(
    [0.0, -0.0, 1.0, -1.0, 3.4e38, -3.4e38, 1.2e-38, 1e-45, -1e-45, 1e-40, 255, 65535, 1e10, np.pi],
    np.float32,
)

#: Bits a block, most of them no whole number of bytes.
BITS = [9, 10, 11, 12, 15, 17, 31, 32, 33, 50, 63, 65, 77, 100, 127, 129, 257, 333, 511, 513, 1001]
BITS += [1999, 2047]


@pytest.fixture(scope="module")
def window():
    with small_window() as window:
        yield window


def of(values, rate):
    return progiso.compress(make_image(values), rate=rate)


@pytest.mark.parametrize("rate", range(1, 33))
def test_all_rates(window, rate):
    check_decoding(window, of(noise((9, 13, 10), rate), rate))
    check_decoding(window, of(marschner_lobb(14), rate))


@pytest.mark.parametrize("bits", BITS)
def test_any_bits_per_block(window, bits):
    """Blocks may start and end anywhere within a word."""
    image = of(noise((9, 10, 11), bits), bits / 64)
    check_decoding(window, image)
    check_decoding(window, of(blobs((9, 10, 11), bits), bits / 64))


@pytest.mark.parametrize("x", range(2, 10))
def test_all_partial_blocks(window, x):
    for y in (2, 4, 5, 6, 7):
        for z in (3, 4, 5, 6, 7):
            check_decoding(window, of(noise((z, y, x), x * 100 + y * 10 + z), 7.5))


@pytest.mark.parametrize("seed", range(8))
def test_extreme_values(window, seed):
    """Blocks hold zeros, one exponent or all, denormals, or values close to overflow."""
    rng = np.random.default_rng(seed)
    values = rng.choice(EXTREMES, (16, 16, 16))
    values[:4] = 0
    values[4:8, 4:8, 4:8] = rng.choice(EXTREMES)
    values[8:12] *= rng.uniform(0.5, 1, (4, 16, 16)).astype(np.float32)
    values[12:] = (rng.normal(size=(4, 16, 16)) * 10.0 ** rng.uniform(-44, 37, (4, 16, 16))).astype(
        np.float32
    )
    for rate in (1, 4, 9.25, 16, 32):
        check_decoding(window, of(values, rate))


@pytest.mark.parametrize("rate", [0.5, 4, 31])
def test_random_streams(window, rate):
    """Any bits at all decode as libzfp decodes them."""
    image = of(noise((16, 16, 16)), rate)
    stream = vtk_to_numpy(image.GetFieldData().GetAbstractArray("ProgIso.ZFP.Stream"))
    for seed in range(4):
        # In place: the array is the image's own.
        stream[:] = np.random.default_rng(seed).integers(0, 256, len(stream), np.uint8)
        check_decoding(window, image)


@pytest.mark.parametrize("rate", [1, 2, 4, 8])
def test_scan(window, rate):
    from progiso.data import fetch

    check_decoding(window, progiso.compress(progiso.read(fetch("ct-cranium")), rate=rate))
