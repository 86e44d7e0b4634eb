"""What is rendered while something fails."""

import pytest

import progiso
from helpers.images import blobs, make_image
from helpers.scenes import CACHED

MODES = {"whole": {}, "cached": CACHED}


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((48, 56, 52), 12, waves=3)), rate=8)


@pytest.fixture(params=MODES)
def settings(request):
    return MODES[request.param]


@pytest.fixture
def uncounted(monkeypatch):
    """Have provoked errors not counted as the mapper's."""
    monkeypatch.setenv("PROGISO_GL_DEBUG", "0")
