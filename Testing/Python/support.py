"""Images to test with, what the references say of them, and scenes that show them."""

import contextlib

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

from progiso.geometry import samples_of  # noqa: F401 (for all tests)
from progiso.oracle import zfp_reference
from progiso.oracle.caster import Volume
from progiso.verify.fields import blobs, make_image, marschner_lobb, noise  # noqa: F401 (for all tests)

PREFIX = "ProgIso.ZFP."

# Source of a function for programs that measure their own memory. Not resource.getrusage: a process starts with its parent's
# peak there, and a large parent's hides its own.
PEAK = """
def peak():
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM:"))
"""

# --- images ------------------------------------------------------------------------------------------------------------------


def metadata(compressed, name):
    """Return one of a compressed volume's metadata arrays as numbers."""
    return vtk_to_numpy(compressed.GetFieldData().GetAbstractArray(PREFIX + name))


def stream_of(compressed):
    """Return a compressed volume's stream as bytes."""
    return metadata(compressed, "Stream").tobytes()


def reference_values(compressed):
    """Decode a compressed volume by libzfp."""
    bits = int(metadata(compressed, "BlockBits")[0])
    return zfp_reference.decode(stream_of(compressed), metadata(compressed, "Dimensions"), bits)


def reference_volume(compressed, user_matrix=None):
    """Give the caster what a compressed volume holds, decoded by libzfp, and where it is."""
    shift = 0.5 if metadata(compressed, "Association")[0] == 1 else 0.0
    user = np.eye(4) if user_matrix is None else user_matrix
    return Volume.from_image(reference_values(compressed), compressed, user, shift)


def same_bits(a, b):
    """Tell whether two float32 arrays agree in every bit, signs of zero included."""
    return a.shape == b.shape and np.array_equal(a.view(np.uint32), b.view(np.uint32))


@contextlib.contextmanager
def vtk_messages():
    """Collect what VTK reports meanwhile, as a list that is filled at the end."""
    window, messages = vtkStringOutputWindow(), []
    before = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        yield messages
    finally:
        vtkOutputWindow.SetInstance(before)
        messages.extend(part.strip() for part in window.GetOutput().split("\n\n") if part.strip())
