"""The source distribution: complete, small, and enough to install and render in a fresh venv."""

import os
import re
import subprocess
import sys
import sysconfig
import tarfile

import numpy as np
import pytest

from helpers import REPOSITORY as ROOT
from helpers.pictures import read_png

pytest.importorskip("scikit_build_core")
pytest.importorskip("vtk_sdk")


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    """The source distribution of this checkout."""
    folder = tmp_path_factory.mktemp("sdist")
    program = f"from scikit_build_core.build import build_sdist; build_sdist({str(folder)!r})"
    run(sys.executable, "-c", program, cwd=ROOT)
    (file,) = folder.iterdir()
    return file


@pytest.fixture(scope="module")
def installed(archive, tmp_path_factory):
    """The folder of programs of an environment whose progiso is built from the archive.

    Other packages are those of the running interpreter, and zfp's sources those of an earlier
    build: nothing is fetched where they are there.
    """
    environment = tmp_path_factory.mktemp("fresh") / "env"
    run(sys.executable, "-m", "venv", environment)
    paths = {"base": str(environment), "platbase": str(environment)}
    site = sysconfig.get_path("purelib", scheme="venv", vars=paths)
    with open(os.path.join(site, "others.pth"), "w") as file:
        file.write(sysconfig.get_path("purelib") + "\n")
    sources = sorted(ROOT.glob("build/*/zfp/zfpy-*/include"))
    zfp = [f"-Ccmake.define.PROGISO_ZFP_SOURCE_DIR={sources[0].parent}"] if sources else []
    options = ["--no-build-isolation", "--no-deps", "--no-index", "--force-reinstall", *zfp]
    run(environment / "bin/python", "-m", "pip", "install", "-q", *options, archive)
    return environment / "bin"


def run(*command, cwd=None):
    """Run a command without the paths of this build; return what it prints."""
    clean = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    done = subprocess.run(
        [str(part) for part in command], cwd=cwd, env=clean, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.strip()


def names_in(archive):
    """Names of the archive's files, below its one folder."""
    with tarfile.open(archive) as packed:
        return {name.split("/", 1)[1] for name in packed.getnames()}


def test_nothing_is_lacking(archive):
    """Every source that git knows is there, and every file that CMake names."""
    tracked = run("git", "ls-files", "Filters", "Kernels", "Plugin", "cmake", "progiso", cwd=ROOT)
    lacking = set(tracked.splitlines()) - names_in(archive)
    assert not lacking
    assert {"CMakeLists.txt", "pyproject.toml", "README.md", "LICENSE"} <= names_in(archive)


def test_nothing_is_too_much(archive):
    """No fuzz corpus, no pictures, no tests, nothing compiled."""
    names = names_in(archive)
    assert not [name for name in names if name.startswith(("Testing", "Data", "build", "."))]
    assert not [name for name in names if re.search(r"\.(png|pyc|so|vti)$", name)]
    assert archive.stat().st_size < 2**20


def test_version_is_that_of_cmake(archive):
    (version,) = re.findall(
        r"project\(ProgIso VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()
    )
    assert archive.name == f"progiso-{version}.tar.gz"
    with tarfile.open(archive) as packed:
        text = packed.extractfile(f"progiso-{version}/PKG-INFO").read().decode()
    assert f"\nVersion: {version}\n" in text


@pytest.mark.slow
def test_it_installs_and_renders(installed, tmp_path):
    """By the console script, in a folder where there are no sources."""
    version = run(installed / "progiso", "--version", cwd=tmp_path)
    where = run(installed / "python", "-c", "import progiso; print(progiso.__file__)", cwd=tmp_path)
    assert version.startswith("progiso ") and where.startswith(str(installed.parent))
    volume = run(installed / "progiso", "data", "sphere", "--size", 32, cwd=tmp_path)
    picture = tmp_path / "sphere.png"
    options = ["--isovalue", 0.8, "--size", "64x48", "--output", picture]
    run(installed / "progiso", "render", volume, *options, cwd=tmp_path)
    assert 0.1 < np.mean(read_png(picture).max(axis=2) > 100) < 0.9


@pytest.mark.slow
def test_pyvista_finds_it(installed, tmp_path):
    """An image and a plotter have `progiso` without an import of it."""
    program = (
        "import pyvista as pv; image = pv.ImageData(dimensions=(8, 8, 8));"
        "image['z'] = image.points[:, 2]; plotter = pv.Plotter(off_screen=True);"
        "plotter.progiso.add_isosurface(image.progiso.compress(), 3.5)"
    )
    run(installed / "python", "-c", program, cwd=tmp_path)
