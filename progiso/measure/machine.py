"""Describe the machine, and tell how much memory is in use and how busy others are."""

from __future__ import annotations

import ctypes
import gc
import os
import platform
import shutil
import subprocess
import time
from pathlib import Path
from typing import Any

from vtkmodules.vtkCommonCore import vtkSMPTools, vtkVersion
from vtkmodules.vtkRenderingCore import vtkRenderWindow

import progiso

from .._built import COMMIT
from .text import bytes_

_STATUS = Path("/proc/self/status")
_CLEAR_REFS = Path("/proc/self/clear_refs")
_PROCESSORS = Path("/proc/stat")
_RESET_PEAK = "5"  # to clear_refs: the peak of the resident set starts anew


def use_all_cores() -> None:
    """Let VTK's filters use all cores, as in ParaView; PyPI's wheel uses one by default."""
    if vtkSMPTools.GetBackend() == "Sequential":
        vtkSMPTools.SetBackend("STDThread")


def describe_machine() -> dict[str, Any]:
    """Describe hardware and software, ready for JSON.

    Returns
    -------
    dict
        ``cpu``, ``cores`` (that this process may use), ``memory_bytes``, ``gl`` (renderer and
        version), ``window`` (VTK's class), ``gpu`` (as nvidia-smi names it, else None), ``vtk``,
        ``smp`` (what VTK's filters run on), ``python``, ``progiso``, and ``commit``, which it was
        built of (None outside a git checkout; a trailing ``+`` tells of changes since).
    """
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(16, 16)
    window.Render()
    capabilities = window.ReportCapabilities()
    about = {
        "cpu": _cpu(),
        "cores": len(os.sched_getaffinity(0)),
        "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
        "gl": _capability(capabilities, "OpenGL renderer string"),
        "gl_version": _capability(capabilities, "OpenGL version string"),
        "window": window.GetClassName(),
        "gpu": _nvidia_smi("name"),
        "vtk": vtkVersion.GetVTKVersion(),
        "smp": f"{vtkSMPTools.GetBackend()}, {vtkSMPTools.GetEstimatedNumberOfThreads()} threads",
        "python": platform.python_version(),
        "progiso": progiso.__version__,
        "commit": COMMIT or None,
    }
    window.Finalize()
    return about


def machine_in_words(machine: dict[str, Any]) -> str:
    """Describe a machine in a sentence, for a page of results.

    Parameters
    ----------
    machine : dict
        See `describe_machine`.

    Returns
    -------
    str
    """
    gpu = f" ({machine['gpu']})" if machine["gpu"] else ""
    return (
        f"{machine['cpu']}, {machine['cores']} cores, {bytes_(machine['memory_bytes'])}; "
        f"OpenGL {machine['gl_version']}{gpu} through {machine['window']}; VTK {machine['vtk']}, "
        f"its filters on {machine['smp']}; Python {machine['python']}; ProgIso "
        f"{machine['progiso']}."
    )


def _cpu() -> str:
    """Return the processor's model."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor() or platform.machine()


def _capability(report: str, key: str) -> str:
    """Return the value of a line in VTK's report of an OpenGL context."""
    values = [line.split(":", 1)[1].strip() for line in report.splitlines() if line.startswith(key)]
    if not values:
        raise RuntimeError(
            "no usable OpenGL context; install libosmesa6 or a GPU driver with EGL, or set DISPLAY "
            "or VTK_DEFAULT_OPENGL_WINDOW"
        )
    return values[0]


def _output(*command: str) -> str | None:
    """Return what a command prints; None where it is missing or fails."""
    if shutil.which(command[0]) is None:
        return None
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return None if done.returncode else done.stdout.strip()


def _nvidia_smi(query: str) -> str | None:
    """Ask for a property of the first GPU, which EGL windows use; None without nvidia-smi."""
    text = _output("nvidia-smi", f"--query-gpu={query}", "--format=csv,noheader,nounits", "--id=0")
    return text or None


def gpu_bytes() -> int | None:
    """Return the GPU memory in use by all processes.

    Returns
    -------
    int or None
        Bytes, by nvidia-smi; None where that command does not exist.
    """
    used = _nvidia_smi("memory.used")
    return None if used is None else int(used) * 2**20


def resident_bytes() -> int:
    """Free what can be freed, then return the main memory that this process holds.

    Returns
    -------
    int
    """
    ctypes.CDLL(None).malloc_trim(0)
    return _status("VmRSS")


def available_bytes() -> int:
    """Return the main memory that is free or can be freed.

    Returns
    -------
    int
    """
    for line in Path("/proc/meminfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("MemAvailable:"):
            return int(line.split()[1]) * 1024
    raise RuntimeError("this system does not tell how much memory is available")


class PeakMemory:
    """Measures the peak of the process's resident memory above what it held at first.

    Examples
    --------
    >>> peak = PeakMemory()
    >>> block = bytearray(64 * 2**20)
    >>> peak.bytes() is None or peak.bytes() > 60 * 2**20
    True
    """

    def __init__(self) -> None:
        gc.collect()
        ctypes.CDLL(None).malloc_trim(0)
        try:
            _CLEAR_REFS.write_text(_RESET_PEAK, encoding="ascii")
        except OSError:  # a container may forbid it
            self._before = None
        else:
            self._before = _status("VmRSS")

    def bytes(self) -> int | None:
        """Return the peak so far; None where the system does not let it be measured."""
        return None if self._before is None else _status("VmHWM") - self._before


def _status(key: str) -> int:
    """Return a line of this process's status, in bytes."""
    lines = _STATUS.read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith(f"{key}:"))


class OtherProcesses:
    """Measures how busy other processes keep the machine, which makes times longer.

    Counted are other processes, and what a virtual machine's host takes from it.

    Examples
    --------
    >>> OtherProcesses().cores() is None or OtherProcesses().cores() >= 0
    True
    """

    def __init__(self) -> None:
        self._start, self._before = time.monotonic(), _seconds_of_others()

    def cores(self) -> float | None:
        """Return how many cores others kept busy on average; None where that is unknown."""
        elapsed = time.monotonic() - self._start
        busy = _seconds_of_others()
        if self._before is None or busy is None or elapsed <= 0:
            return None
        # both are counted in ticks, which need not fall together
        return max(0.0, (busy - self._before) / elapsed)


def _seconds_of_others() -> float | None:
    """Return the processor time of other processes; None where it cannot be read."""
    try:
        line = _PROCESSORS.read_text(encoding="ascii").splitlines()[0]
    except OSError:
        return None
    user, nice, system, _idle, _waiting, interrupts, soft, stolen = map(int, line.split()[1:9])
    busy = user + nice + system + interrupts + soft + stolen
    own = os.times()
    return busy / os.sysconf("SC_CLK_TCK") - sum(own[:4])
