"""ParaView's own parallelism: a volume in pieces on several processes looks as on one."""

import json

import numpy as np
import pytest

from helpers import pictures
from helpers.images import blobs, make_image
from helpers.programs import SCRIPTS, WARNINGS, under_x
from progiso.measure import tolerances

pytestmark = pytest.mark.paraview

CASES = "plain compressed decompressed cells cells-compressed".split()
CASES += "file-compressed file-plain file-zfp pieces several translucent contour".split()
CASES += ["among-meshes", "translucent-among-meshes"]

#: Open MPI in a container; processes that share few cores should each take one.
MPI = dict.fromkeys(("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"), "1")
MPI |= dict.fromkeys(("OMP_NUM_THREADS", "LP_NUM_THREADS"), "1")


def mpiexec(processes, *command):
    """Run a command on several processes; return its output."""
    return under_x("mpiexec", "--oversubscribe", "-n", processes, *command, **MPI)


@pytest.fixture(scope="module")
def shown(build, tmp_path_factory):
    """Return pictures by number of processes and case."""
    import progiso

    folder = tmp_path_factory.mktemp("parallel")
    image = make_image(150 + 80 * blobs((45, 38, 51)), origin=(-22, -20, -18))
    compressed = progiso.compress(image, rate=5)
    progiso.save(image, folder / "file-plain.vti")
    progiso.save(compressed, folder / "file-compressed.vti")
    progiso.save(compressed, folder / "file.zfp")
    found, areas = {}, []
    for processes in (1, 2, 4):
        output = mpiexec(
            processes, "pvbatch", SCRIPTS / "parallel.py", build, folder / str(processes)
        )
        assert not any(word in output for word in WARNINGS), output[-6000:]
        (report,) = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
        assert report["processes"] == processes
        areas.append(report["area"])
        found[processes] = {
            case: pictures.read_png(folder / str(processes) / f"{case}.png").astype(int)
            for case in CASES
        }
    assert np.allclose(areas, areas[0], rtol=tolerances.PROCESSES_AREA, atol=0), areas
    return found


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("processes", [2, 4])
def test_seams(shown, processes, case):
    one, several = shown[1][case], shown[processes][case]
    assert np.ptp(one) > 100, "nothing to see"
    differing = np.abs(one - several).max(axis=2) > tolerances.PROCESSES_LEVELS
    assert differing.mean() <= tolerances.PROCESSES_PIXELS, f"{differing.sum()} pixels differ"


def test_server(build, tmp_path):
    """The server's processes draw; the client shows the same picture as without them, and all
    figures."""
    under_x("pvpython", SCRIPTS / "remote.py", build, tmp_path, **MPI)


@pytest.mark.parametrize(
    "name", ["remote_changes", "remote_blocks", "remote_errors", "cropping", "cutting"]
)
def test_same_as_on_a_server(name, build, tmp_path):
    """Whatever is changed, the server's processes show what one process does."""
    under_x("pvpython", SCRIPTS / f"{name}.py", build, tmp_path, **MPI)


def test_compressed_before_or_by_the_mapper(shown):
    """A piece is compressed to the same blocks by the filter and by the mapper."""
    for plain, compressed in (("plain", "compressed"), ("cells", "cells-compressed")):
        assert np.array_equal(shown[4][plain], shown[4][compressed])
