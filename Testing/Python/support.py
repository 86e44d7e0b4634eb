"""Images to test with, what the references say of them, and scenes that show them."""

import contextlib

import numpy as np
from oracle import zfp_reference
from oracle.caster import Volume
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkImageData

PREFIX = "ProgIso.ZFP."

# Source of a function for programs that measure their own memory. Not resource.getrusage: a process starts with its parent's
# peak there, and a large parent's hides its own.
PEAK = """
def peak():
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM:"))
"""

# --- fields ------------------------------------------------------------------------------------------------------------------


def noise(shape, seed=0):
    """White noise [z, y, x]: every cell crosses zero, many rays find several roots in one."""
    return np.random.default_rng(seed).normal(size=shape).astype(np.float32)


def marschner_lobb(n, frequency=6.0, alpha=0.25):
    """The signal of Marschner and Lobb (1994), which everyone's resampling is judged by."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, n)] * 3, indexing="ij")
    ring = np.cos(2 * np.pi * frequency * np.cos(np.pi * np.hypot(x, y) / 2))
    return ((1 - np.sin(np.pi * z / 2) + alpha * (1 + ring)) / (2 * (1 + alpha))).astype(np.float32)


def blobs(shape, seed=0, waves=3):
    """A smooth random field, periodic waves along each axis, about -1 to 1."""
    rng = np.random.default_rng(seed)
    axes = np.meshgrid(*[np.linspace(0, 2 * np.pi, n) for n in shape], indexing="ij")
    field = np.zeros(shape)
    for _ in range(6):
        frequency, phase = rng.uniform(-waves, waves, 3), rng.uniform(0, 2 * np.pi)
        field += np.cos(sum(f * a for f, a in zip(frequency, axes)) + phase)
    return (field / 3).astype(np.float32)


# --- images ------------------------------------------------------------------------------------------------------------------


def make_image(
    values, name="field", cells=False, origin=(0, 0, 0), spacing=(1, 1, 1), direction=None, extent_start=(0, 0, 0)
):
    """Place values [z, y, x] or [z, y, x, component] in a ``vtkImageData``."""
    values = np.asarray(values)
    size = np.array(values.shape[:3][::-1]) + bool(cells)
    image = vtkImageData()
    image.SetExtent(*(int(v) for s, n in zip(extent_start, size) for v in (s, s + n - 1)))
    image.SetOrigin(origin)
    image.SetSpacing(spacing)
    if direction is not None:
        image.SetDirectionMatrix(np.asarray(direction, float).ravel())
    flat = values.reshape(-1) if values.ndim == 3 else values.reshape(-1, values.shape[3])
    array = numpy_to_vtk(np.ascontiguousarray(flat), deep=True)
    array.SetName(name)
    (image.GetCellData() if cells else image.GetPointData()).SetScalars(array)
    return image


def values_of(image):
    """Return an image's scalars [z, y, x], of points or else of cells."""
    points = image.GetPointData().GetScalars()
    size = np.array(image.GetDimensions()) - (0 if points else 1)
    return vtk_to_numpy(points or image.GetCellData().GetScalars()).reshape(size[::-1])


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
    direction = compressed.GetDirectionMatrix()
    extent = compressed.GetExtent()
    return Volume.from_geometry(
        reference_values(compressed),
        compressed.GetOrigin(),
        compressed.GetSpacing(),
        [[direction.GetElement(r, c) for c in range(3)] for r in range(3)],
        extent[::2],
        np.eye(4) if user_matrix is None else user_matrix,
        0.5 if metadata(compressed, "Association")[0] == 1 else 0.0,
    )


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
