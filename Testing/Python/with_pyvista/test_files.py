"""`pyvista.read` and `save` find progiso's formats without an import of progiso."""

import subprocess
import sys

import numpy as np
import pytest

pyvista = pytest.importorskip("pyvista")

ALONE = """
import sys
import numpy as np
import pyvista
np.save("a.npy", np.arange(60.0).reshape(5, 4, 3))
image = pyvista.read("a.npy")
assert "progiso" in sys.modules and image.dimensions == (5, 4, 3), image
image.save("a.mha")
assert np.array_equal(pyvista.read("a.mha").active_scalars, image.active_scalars)
image.progiso.compress(rate=9).save("a.zfp")
assert pyvista.read("a.zfp").progiso.is_compressed
"""


def test_without_an_import(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", ALONE], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def test_only_formats_that_pyvista_lacks():
    """A reader for a format of pyvista's own would be an error there."""
    from importlib.metadata import distribution

    from pyvista.core.utilities.reader import CLASS_READERS

    from progiso.io.formats import FORMATS

    declared = {
        point.name
        for point in distribution("progiso").entry_points
        if point.group == "pyvista.readers"
    }
    assert declared.isdisjoint(CLASS_READERS)
    assert declared - set(FORMATS) <= {".mgh", ".mgz", ".gipl"}


def test_keywords(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros((5, 4, 3)))
    assert pyvista.read(tmp_path / "a.npy", axes="zyx").dimensions == (3, 4, 5)
