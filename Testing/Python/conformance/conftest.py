"""Scenes of VTK's tests of its GPU volume mapper, as isosurfaces: our picture beside VTK's. See
Testing/conformance.md."""

import pytest

import progiso
from helpers.geometry import SHAPE
from helpers.images import blobs, make_image


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs(SHAPE, 12, waves=2)), 16)


@pytest.fixture(scope="module")
def cube():
    """What is lit has as many samples along each axis: VTK's mapper stretches normals by their
    ratios, where a light is in the scene, and reaches for their differences one part in so many too
    far."""
    return progiso.compress(make_image(blobs((48, 48, 48), 12, waves=1)), 16)
