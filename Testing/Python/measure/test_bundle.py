"""The bundle for bare machines: its launcher, and what the packer says when it cannot pack."""

import json
import os
import shutil
import stat
import subprocess
import sys

import pytest

from helpers import REPOSITORY

BENCHMARKS = REPOSITORY / "Testing" / "Benchmarks"


@pytest.fixture
def bundle(tmp_path):
    """Return a bundle whose Python prints its environment and arguments.

    It has a library that every machine has, and one that none has.
    """
    python = tmp_path / "python/bin/python3"
    python.parent.mkdir(parents=True)
    python.write_text(
        f"#!{sys.executable}\nimport json, os, sys\n"
        "print(json.dumps([dict(os.environ), sys.argv[1:]]))\n"
    )
    python.chmod(python.stat().st_mode | stat.S_IXUSR)
    for name in ("libc.so.6", "libnobodyhasthis.so.1"):
        (tmp_path / "libraries" / name).mkdir(parents=True)
    shutil.copy(BENCHMARKS / "bundle/run", tmp_path)
    return tmp_path


def launch(bundle, *arguments, **environment):
    """Run the launcher; return the environment and the arguments that Python got."""
    done = subprocess.run(
        [bundle / "run", *arguments],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


def test_arguments_pass_through(bundle):
    assert launch(bundle, "-c", "a b", "*")[1] == ["-c", "a b", "*"]


def test_nothing_of_the_machines_python_comes_in(bundle):
    environment, _ = launch(bundle, PYTHONPATH="/elsewhere", PYTHONSTARTUP="/elsewhere")
    assert not any("elsewhere" in value for value in environment.values())


def test_libraries_stand_in_where_they_lack(bundle):
    """What the caller had set comes after them."""
    folders = launch(bundle, LD_LIBRARY_PATH="/driver")[0]["LD_LIBRARY_PATH"].split(":")
    assert folders == [
        str(bundle / "python/lib"),
        str(bundle / "libraries/libnobodyhasthis.so.1"),
        "/driver",
    ]


def test_the_callers_window_stays(bundle):
    assert (
        launch(bundle, VTK_DEFAULT_OPENGL_WINDOW="mine")[0]["VTK_DEFAULT_OPENGL_WINDOW"] == "mine"
    )


def test_packer_wants_a_prefix_with_a_package(tmp_path):
    packer = [sys.executable, BENCHMARKS / "pack-bundle"]
    done = subprocess.run(
        [*packer, "--prefix", tmp_path, "--out", tmp_path / "out"], capture_output=True, text=True
    )
    assert done.returncode == 2 and f"{tmp_path}" in done.stderr and "no progiso" in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "arguments, words",
    [(["--with", "no-such-file"], "no-such-file"), ([], "run without --package-only once")],
)
def test_packer_says_what_is_wrong(tmp_path, arguments, words):
    packer = [sys.executable, BENCHMARKS / "pack-bundle"]
    done = subprocess.run(
        [*packer, "--package-only", "--out", tmp_path, *arguments], capture_output=True, text=True
    )
    assert done.returncode == 1 and not done.stdout
    assert len(done.stderr.splitlines()) == 1 and words in done.stderr
