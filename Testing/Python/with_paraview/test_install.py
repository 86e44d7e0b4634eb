"""The installation of the ParaView build works wherever it is moved to."""

import subprocess

import pytest

from helpers import REPOSITORY
from helpers.programs import under_x

pytestmark = pytest.mark.paraview


@pytest.fixture(scope="module")
def prefix(build, tmp_path_factory):
    """Return an installation that was moved after it was made."""
    folder = tmp_path_factory.mktemp("install")
    run("cmake", "--install", build, "--prefix", folder / "made")
    return (folder / "made").rename(folder / "moved")


def run(*command, **options):
    """Run a command; return what it prints."""
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, timeout=600, **options
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def cached(build, name):
    """Return a variable of the build's CMake cache."""
    lines = (build / "CMakeCache.txt").read_text().splitlines()
    (value,) = [line.split("=", 1)[1] for line in lines if line.startswith(f"{name}:")]
    return value


def test_nothing_points_back(prefix, build):
    """No file names the build tree or the folder it was installed to."""
    for file in prefix.rglob("*.cmake"):
        text = file.read_text()
        assert str(build) not in text and str(prefix.parent / "made") not in text, file


def test_find_package(prefix, build, tmp_path):
    """The example program configures, builds and runs on the moved installation."""
    settings = {
        name: cached(build, name) for name in ("ParaView_DIR", "VTK_DIR", "Python3_EXECUTABLE")
    }
    settings["ProgIso_DIR"] = prefix / "lib/cmake/ProgIso"
    source, made = REPOSITORY / "Testing/Cxx/Example", tmp_path / "example"
    options = [f"-D{name}={value}" for name, value in settings.items()]
    run("cmake", "-S", source, "-B", made, "-G", "Ninja", *options)
    run("cmake", "--build", made)
    under_x(made / "isosurface", tmp_path / "example.png")
    assert (tmp_path / "example.png").stat().st_size > 2000


def test_plugin_path(prefix, tmp_path):
    """ParaView finds the plugin by PV_PLUGIN_PATH, without being told to load it."""
    (plugins,) = prefix.glob("lib/paraview-*/plugins")
    script = tmp_path / "find.py"
    script.write_text(
        "from paraview.simple import *\n"
        "display = Show(Wavelet(), CreateView('RenderView'))\n"
        "assert 'Progressive Isosurface' in display.GetProperty('Representation').GetAvailable()\n"
        "assert ZFPCompress(Wavelet()) and ZFPContour\n"
        "print('found')\n"
    )
    assert under_x("pvpython", script, PV_PLUGIN_PATH=str(plugins)).strip().endswith("found")
