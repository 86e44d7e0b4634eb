"""The choice of VTK's OpenGL window where there is no display."""

from __future__ import annotations

import ctypes
import os
import sys
from glob import glob

from vtkmodules.vtkCommonCore import vtkVersion


def choose_window() -> None:
    """Set ``VTK_DEFAULT_OPENGL_WINDOW`` where VTK's own choice would not find the best device.

    Changes nothing on a machine with a display, when the variable is set already, on systems other
    than Linux, and with a VTK before 9.4, which supports X11 only. Otherwise VTK gets EGL where
    there is a usable GPU, and OSMesa, a software renderer, where there is none. Where neither
    library is found, VTK's own choice stands.
    """
    if not sys.platform.startswith("linux") or _needs_display():
        return
    if os.environ.get("DISPLAY") or os.environ.get("VTK_DEFAULT_OPENGL_WINDOW"):
        return
    if _has_gpu() and _loads("libEGL.so.1"):
        os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkEGLRenderWindow"
    elif _loads("libOSMesa.so.8") or _loads("libOSMesa.so"):
        os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkOSOpenGLRenderWindow"


def check_display() -> None:
    """Raise where VTK would abort the process.

    Raises
    ------
    RuntimeError
        With a VTK that supports X11 only, when no display is set.
    """
    if _needs_display() and not os.environ.get("DISPLAY"):
        raise RuntimeError(
            f"VTK {vtkVersion.GetVTKVersion()} draws on X11 displays only and DISPLAY is not set; "
            "start one, or run under xvfb-run"
        )


def _needs_display() -> bool:
    """Tell whether this VTK opens X11 windows only: on Linux, before 9.4."""
    version = (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion())
    return sys.platform.startswith("linux") and version < (9, 4)


def _has_gpu() -> bool:
    """Tell whether this user has a GPU: NVIDIA's node with its EGL driver, or a render node."""
    if glob("/dev/nvidia[0-9]*") and _loads("libEGL_nvidia.so.0"):
        return True
    return any(os.access(node, os.R_OK | os.W_OK) for node in glob("/dev/dri/renderD*"))


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
