"""The ParaView stack: the plugin in pvpython and pvbatch, and other folders' tests on its VTK."""

import json
import os

import numpy as np
import pytest

from helpers import TESTS, pictures
from helpers.images import make_image, marschner_lobb
from helpers.programs import SCRIPTS, WARNINGS, under_x

pytestmark = pytest.mark.paraview


@pytest.fixture(scope="module")
def packages(build):
    found = list(build.glob("lib/**/site-packages"))
    assert found, f"no Python packages below {build}/lib"
    return found[0]


@pytest.fixture(scope="module", params=["pvpython", "pvbatch"])
def shown(request, build, packages, tmp_path_factory):
    """Run the script that shows everything; return the folder with its pictures and figures."""
    import progiso

    folder = tmp_path_factory.mktemp(request.param)
    progiso.save(progiso.compress(make_image(marschner_lobb(64)), rate=8), folder / "volume.vti")
    output = under_x(request.param, SCRIPTS / "show.py", build, folder, python_path=[packages])
    assert not any(word in output for word in WARNINGS), output[-6000:]
    (facts,) = [line for line in output.splitlines() if line.startswith("{")]
    (folder / "facts.json").write_text(facts)
    return folder


@pytest.mark.parametrize("name", ["paraview-plain", "paraview-among-meshes", "paraview-file"])
def test_pictures(shown, name, request, tmp_path):
    pictures.check_picture(pictures.read_png(shown / f"{name}.png"), name, request.config, tmp_path)


def test_facts(shown):
    facts = json.loads((shown / "facts.json").read_text())
    low, high = facts.pop("restored")
    assert 30 < low < 60 and 250 < high < 300
    for name, values in facts.items():
        assert values["CompletedFraction"] == 1, name
        assert values["NumberOfPasses"] > 0 and values["TotalMilliseconds"] > 0, name
        assert values["GPUBytes"] > values["CompressedBytes"] >= 0, name
    # what fits is decoded as a whole, and then not there compressed
    whole, budget, plain = (
        facts[f"paraview-{name}"] for name in ("whole", "budget", "no-speculation")
    )
    assert whole["NumberOfPasses"] == 1 and whole["CompressedBytes"] == 0
    assert plain["NumberOfPasses"] > budget["NumberOfPasses"] > 1
    for values in (budget, plain):
        assert values["CompressedBytes"] == pytest.approx(
            26**3 * 64, abs=64
        )  # blocks, at 8 bits a voxel
        assert values["GPUBytes"] - values["CompressedBytes"] <= 5 * 2**20 < whole["GPUBytes"]


def test_ways_to_the_same_picture(shown):
    """Compressed on the fly or before, within a budget, with and without speculation, no pixel
    differs."""
    for ways in (("plain", "compressed"), ("whole", "budget", "no-speculation")):
        first, *others = (pictures.read_png(shown / f"paraview-{way}.png") for way in ways)
        assert np.ptp(first) > 100
        assert all(np.array_equal(first, other) for other in others)


# --- the other tests, with ParaView's VTK and Python ----------------------------------------------

CORE = {
    "filters": [
        *(f"compression/test_{name}.py" for name in ("filters", "filter_errors", "volume_files")),
        "compression/test_pieces.py",
    ],
    "contour": [
        *(f"compression/test_contour{name}.py" for name in ("", "_bricks", "_files")),
        "-k",
        "not mri-brain",
    ],
    "files": [
        *(f"compression/test_{name}.py" for name in ("compress_file", "large_files")),
        "-k",
        "not nii and not memory",
    ],
    "decoder": ["rendering/test_decode.py", "-k", "all_rates or extreme or random_streams"],
    "depth": [
        "rendering/test_depth.py",
        "-k",
        "white_noise or geometry or user_matrix or camera_inside or ct-cranium",
    ],
    "invariance": [
        *(f"rendering/test_{name}.py" for name in ("invariance", "statistics", "progressive")),
        "-k",
        "not nobody_waits and not mapped_buffer",  # they hook functions of VTK's glad
    ],
    "scenes": ["rendering/test_scene.py", "with_pyvista/test_pyvista.py"],
}


@pytest.mark.parametrize("part", CORE)
def test_core_on_paraviews_vtk(part, tmp_path, build):
    python = os.environ.get("PROGISO_PARAVIEW_PYTHON")
    assert python, (
        "PROGISO_PARAVIEW_PYTHON names no Python with pytest, pyvista and the build's package"
    )
    arguments = [str(TESTS / a) if a.endswith(".py") else a for a in CORE[part]]
    output = under_x(
        python,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        *arguments,
        cwd=tmp_path,
        timeout=900,
    )
    assert " passed" in output and "failed" not in output and "skipped" not in output, output[
        -3000:
    ]
