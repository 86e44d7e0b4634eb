"""What every test shares: a window system, hypothesis's profiles, and fixtures."""

import os

import pytest
from hypothesis import HealthCheck, settings

# Tests render without a display unless they start one themselves; a caller may ask for another
# window, as one on a GPU does.
if not os.environ.get("DISPLAY"):
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
os.environ.setdefault("PROGISO_GL_DEBUG", "1")

# Property-based tests take the same examples every time, unless pytest is called with
# `--hypothesis-profile long`.
settings.register_profile(
    "progiso",
    max_examples=25,
    derandomize=True,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
settings.register_profile(
    "long",
    settings.get_profile("progiso"),
    max_examples=int(os.environ.get("PROGISO_EXAMPLES", 2000)),
    derandomize=False,
)
settings.load_profile("progiso")


def pytest_addoption(parser):
    parser.addoption(
        "--write-baselines", action="store_true", help="store what is rendered as the new baselines"
    )


@pytest.fixture(scope="session")
def lacking():
    """Return a function that skips a test for want of something.

    In continuous integration, where nothing may be wanting, it fails the test.
    """

    def missing(reason):
        (pytest.fail if os.environ.get("CI") else pytest.skip)(reason)

    return missing
