"""The ParaView stack: the plugin in pvpython and pvbatch, and this folder's other tests on ParaView's own VTK."""

import itertools
import json
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pictures
import pytest
from support import make_image, marschner_lobb

pytestmark = pytest.mark.paraview

HERE = pathlib.Path(__file__).resolve().parent
displays = itertools.count(2000 + os.getpid() % 20000)
WARNINGS = ("ERR|", "( ERR", "ERROR", "Traceback", "Segmentation")


@pytest.fixture(scope="module")
def build():
    """Find the build of the plugin; without one fail in continuous integration, and skip elsewhere."""
    folder = os.environ.get("PROGISO_PARAVIEW_BUILD")
    if not folder:
        (pytest.fail if os.environ.get("CI") else pytest.skip)(
            "PROGISO_PARAVIEW_BUILD does not name a build for ParaView"
        )
    return pathlib.Path(folder)


@pytest.fixture(scope="module")
def packages(build):
    found = list(build.glob("lib/**/site-packages"))
    assert found, f"no Python packages below {build}/lib"
    return found[0]


@pytest.fixture(scope="module")
def plugin(build):
    found = [p for p in build.glob("lib/**/ProgIso.so") if "plugins" in str(p)]
    assert found, f"no plugin below {build}/lib"
    return found[0]


def under_x(*command, python_path=(), timeout=600, cwd=None, **variables):
    """Run a command in a virtual display of its own, with more environment variables; return its output."""
    assert shutil.which("xvfb-run"), "the tests of the plugin need xvfb-run (Debian: xvfb, xauth)"
    environment = {
        k: v
        for k, v in os.environ.items()
        if k not in ("VTK_DEFAULT_OPENGL_WINDOW", "PYTHONPATH", "VIRTUAL_ENV", "DISPLAY")
    }
    environment["PYTHONPATH"] = os.pathsep.join(map(str, python_path))
    environment["PROGISO_GL_DEBUG"] = "1"
    environment.update(variables)
    # -noreset: the server must not restart, and refuse a connection meanwhile, when its only client closes one to open the next
    display = ["xvfb-run", "-n", str(next(displays)), "-s", "-screen 0 1280x1024x24 -noreset"]
    done = subprocess.run(
        [*display, *map(str, command)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=timeout,
        cwd=cwd,
    )
    output = done.stdout + done.stderr
    assert done.returncode == 0, output[-6000:]
    return output


@pytest.fixture(scope="module", params=["pvpython", "pvbatch"])
def shown(request, build, plugin, packages, tmp_path_factory):
    """Run the script that shows everything; return the folder with its pictures."""
    import progiso

    folder = tmp_path_factory.mktemp(request.param)
    progiso.save(progiso.compress(make_image(marschner_lobb(64)), 8), folder / "volume.vti")
    script = HERE / "paraview_scripts" / "show.py"
    output = under_x(
        request.param, script, plugin, folder / "volume.vti", folder, python_path=[packages]
    )
    assert "done" in output and not any(word in output for word in WARNINGS), output[-6000:]
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
    """Compressed on the fly or before, within a budget, with and without speculation: not one pixel differs."""
    for ways in (("plain", "compressed"), ("whole", "budget", "no-speculation")):
        first, *others = (pictures.read_png(shown / f"paraview-{way}.png") for way in ways)
        assert np.ptp(first) > 100
        assert all(np.array_equal(first, other) for other in others)


# --- the other tests, with ParaView's VTK and Python ------------------------------------------------------------------------------

CORE = {
    "filters": ["test_filters.py"],
    "contour": ["test_contour.py", "-k", "not mri-brain"],
    "files": ["test_compress_file.py", "-k", "not nii and not memory"],
    "decoder": ["test_decode.py", "-k", "all_rates or extreme or random_streams"],
    "depth": [
        "test_depth.py",
        "-k",
        "white_noise or geometry or user_matrix or camera_inside or ct-cranium",
    ],
    "invariance": ["test_invariance.py", "test_statistics.py", "test_progressive.py"],
    "scenes": ["test_scene.py", "test_pyvista.py"],
}


@pytest.mark.parametrize("part", CORE)
def test_core_on_paraviews_vtk(part, tmp_path, build):
    python = os.environ.get("PROGISO_PARAVIEW_PYTHON")
    assert python, (
        "PROGISO_PARAVIEW_PYTHON does not name a Python with pytest, pyvista and the package of the build"
    )
    arguments = [str(HERE / a) if a.endswith(".py") else a for a in CORE[part]]
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
