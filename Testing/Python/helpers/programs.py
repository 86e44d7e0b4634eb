"""Programs that tests start: the command line, and whatever wants a display."""

import itertools
import os
import pathlib
import shutil
import subprocess
import sys

from helpers import TESTS

#: Source of a function for programs that measure their own memory. Not resource.getrusage: a
#: process starts with its parent's peak there, and a large parent's hides its own.
PEAK = """
def peak():
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM:"))
"""

#: What tells in ParaView's output that something went wrong.
WARNINGS = ("ERR|", "( ERR", "ERROR", "Traceback", "Segmentation")

#: Where the programs are that run in ParaView's Python.
SCRIPTS = TESTS / "with_paraview" / "scripts"

#: Numbers of X displays that no other process of the tests uses.
displays = itertools.count(2000 + os.getpid() % 20000)


def run_progiso(folder, *arguments):
    """Run `python -m progiso` in a folder."""
    command = [sys.executable, "-m", "progiso", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=os.environ)


def call_progiso(folder, *arguments, succeeds=True):
    """Run `python -m progiso` in a folder; return what it prints, on stderr if it is to fail."""
    done = run_progiso(folder, *arguments)
    assert (done.returncode == 0) == succeeds, done.stdout + done.stderr
    return done.stdout if succeeds else done.stderr


def compress_command(source, target, rate=1):
    """Return the command that compresses a file."""
    files = [str(source), str(target)]
    return [sys.executable, "-m", "progiso", "compress", *files, "--rate", str(rate)]


def under_x(*command, python_path=(), timeout=600, cwd=None, **variables):
    """Run a command in a virtual display of its own; return its output.

    `variables` are added to its environment.
    """
    assert shutil.which("xvfb-run"), "the tests of the plugin need xvfb-run (Debian: xvfb, xauth)"
    environment = {
        k: v
        for k, v in os.environ.items()
        if k not in ("VTK_DEFAULT_OPENGL_WINDOW", "PYTHONPATH", "VIRTUAL_ENV", "DISPLAY")
    }
    environment["PYTHONPATH"] = os.pathsep.join(map(str, python_path))
    environment["PROGISO_GL_DEBUG"] = "1"
    build = pathlib.Path(os.environ.get("PROGISO_PARAVIEW_BUILD", "."))
    for library in build.resolve().glob("lib*/libEagerExpat.so"):  # as README tells users to
        environment["LD_PRELOAD"] = str(library)
    environment.update(variables)
    # -noreset: the server must not restart, and refuse a connection meanwhile, when its only client
    # closes one to open the next
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
