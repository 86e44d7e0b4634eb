"""What the tests of plotters share."""

import numpy as np
import pytest


@pytest.fixture(scope="module")
def ball():
    """Return distances from the centre: isosurfaces are spheres, the isovalue is their radius."""
    import pyvista

    image = pyvista.ImageData(dimensions=(33, 33, 33), origin=(-16, -16, -16))
    image["distance"] = np.linalg.norm(image.points, axis=1).astype(np.float32)
    return image.progiso.compress(rate=16)


@pytest.fixture
def plotter():
    """Yield a plotter without a display, on black."""
    from helpers.plotters import new_plotter

    plotter = new_plotter()
    yield plotter
    plotter.close()
