"""Compressed volumes at the run time of a simulation: extracts, on any number of processes."""

import pytest

from helpers.programs import SCRIPTS, WARNINGS, under_x

pytestmark = pytest.mark.paraview

#: Open MPI in a container; processes that share few cores should each take one.
MPI = dict.fromkeys(("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"), "1")
MPI |= dict.fromkeys(("OMP_NUM_THREADS", "LP_NUM_THREADS"), "1")


@pytest.fixture(scope="module")
def script(build, tmp_path_factory):
    """Return a Catalyst script that ParaView has exported from a pipeline with the extractor."""
    folder = tmp_path_factory.mktemp("extracts")
    under_x("pvpython", SCRIPTS / "extracts.py", build, folder)
    return folder / "pipeline.py"


def simulate(script, build, folder, processes):
    """Run the simulation with a script; return the bytes of its extracts by name."""
    folder.mkdir()
    output = under_x(
        *("mpiexec", "--oversubscribe", "-n", processes, "pvbatch", "--symmetric"),
        *(SCRIPTS / "simulation.py", script),
        cwd=folder,
        PV_PLUGIN_PATH=str(next(build.glob("lib*/**/plugins"))),
        **MPI,
    )
    assert output.count(f"done on {processes}") == processes, output
    assert not any(word in output for word in WARNINGS), output[-4000:]
    return {file.name: file.read_bytes() for file in (folder / "extracts").iterdir()}


def test_a_simulation_writes_the_same_files_on_any_number_of_processes(script, build, tmp_path):
    one = simulate(script, build, tmp_path / "1", 1)
    assert sorted(one) == ["volume_0000.vti", "volume_0001.vti"]
    assert one["volume_0000.vti"] != one["volume_0001.vti"], "steps differ"
    assert simulate(script, build, tmp_path / "3", 3) == one
