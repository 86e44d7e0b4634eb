"""What the scenes of VTK's tests of its GPU volume mapper show; see Testing/conformance.md."""

import pytest

import progiso
from helpers.geometry import SHAPE
from helpers.images import blobs, make_image


@pytest.fixture(scope="module")
def image():
    """Return a volume of three different sizes."""
    return progiso.compress(make_image(blobs(SHAPE, 12, waves=2)), rate=16)


@pytest.fixture(scope="module")
def cube():
    """Return a volume for lit scenes, with as many samples along each axis.

    Where a light is in the scene VTK's mapper stretches normals by the ratios of the sizes, and
    reaches one part in so many too far for their differences.
    """
    return progiso.compress(make_image(blobs((48, 48, 48), 12, waves=1)), rate=16)
