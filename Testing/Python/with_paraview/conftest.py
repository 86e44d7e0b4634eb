"""The ParaView stack's build, which PROGISO_PARAVIEW_BUILD names."""

import os
import pathlib

import pytest


@pytest.fixture(scope="session")
def build(lacking):
    """Return the build of the plugin; without one fail in continuous integration, else skip."""
    folder = os.environ.get("PROGISO_PARAVIEW_BUILD")
    if not folder:
        lacking("PROGISO_PARAVIEW_BUILD does not name a build for ParaView")
    return pathlib.Path(folder)
