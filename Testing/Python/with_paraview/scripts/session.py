"""A session of ParaView with the plugin: what the scripts here share.

Every script runs as `pvpython SCRIPT BUILD OUTPUT`: BUILD is the build directory that holds the
plugin, OUTPUT the folder for images and files. A script fails with an exception; its last line is
one JSON object.
"""

import contextlib
import json
import math
import pathlib
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    vtkOutputWindow,
    vtkStringOutputWindow,
    vtkUnsignedCharArray,
)
from vtkmodules.vtkIOImage import vtkPNGReader

BUILD = pathlib.Path(sys.argv[1])
OUTPUT = pathlib.Path(sys.argv[2])
PROGRESSIVE_ISOSURFACE = "Progressive Isosurface"
SIZE = [320, 240]


def start(size=SIZE):
    """Load the plugin and return a view to draw in."""
    load_plugin()
    return make_view(size)


def load_plugin(remote=False):
    """Load the plugin, with `remote` into the server too; its filters then are in `simple`."""
    found = sorted(BUILD.glob("lib*/**/plugins/ProgIso/ProgIso.so"))
    if len(found) != 1:
        raise FileNotFoundError(f"one ProgIso.so expected under {BUILD}, found {len(found)}")
    for there in (False, True)[: 1 + remote]:
        simple.LoadPlugin(str(found[0]), remote=there, ns=vars(simple))
    OUTPUT.mkdir(parents=True, exist_ok=True)


def make_view(size=SIZE):
    """Return a view of fixed size and plain background, undecorated, pixels not blended."""
    return undecorate(simple.CreateView("RenderView"), size)


def undecorate(view, size=SIZE):
    """Make a view such as `make_view` returns; return it."""
    view.ViewSize = list(size)
    view.OrientationAxesVisibility = 0
    view.UseFXAA = 0  # a pixel's colour is then its own
    view.UseColorPaletteForBackground = 0
    view.Background = [0.1, 0.1, 0.15]
    return view


def make_wavelet(half=24):
    """Make ParaView's own test image, with 2 * half + 1 samples per axis."""
    return simple.Wavelet(WholeExtent=[-half, half] * 3)


def show_isosurface(source, view, **properties):
    """Show `source` as a progressive isosurface; return its display."""
    display = simple.Show(source, view)
    display.SetRepresentationType(PROGRESSIVE_ISOSURFACE)
    for name, value in properties.items():
        setattr(display, name, value)
    return display


def look(view, azimuth=30, elevation=20):
    """Show all of the scene from a fixed direction."""
    camera = view.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(0, 0, 1)
    camera.SetViewUp(0, 1, 0)
    camera.Azimuth(azimuth)
    camera.Elevation(elevation)
    simple.ResetCamera(view)


def information(display):
    """Return the representation's information properties."""
    display.SMProxy.UpdatePropertyInformation()
    names = {
        "passes": "NumberOfPasses",
        "completed": "CompletedFraction",
        "total_ms": "TotalMilliseconds",
        "bytes": "GPUBytes",
        "compressed": "CompressedBytes",
        "budget": "BudgetBytes",
        "processes": "NumberOfProcesses",
    }
    # vtkSMPropertyHelper reads them whatever Python makes of an information property
    return {
        key: servermanager.vtkSMPropertyHelper(display.SMProxy, name).GetAsDouble()
        for key, name in names.items()
    }


def figures(display, name):
    """Return the values of one of the representation's information properties."""
    display.SMProxy.UpdatePropertyInformation()
    helper = servermanager.vtkSMPropertyHelper(display.SMProxy, name)
    return [helper.GetAsDouble(i) for i in range(helper.GetNumberOfElements())]


def move(display, position):
    """Move what a display shows, by the property that ParaView has called Translation since
    5.13."""
    name = "Translation" if display.GetProperty("Translation") else "Position"
    setattr(display, name, position)


def check_converged(display):
    """Return the figures of a complete image; fail if it is not complete or a figure is missing."""
    info = information(display)
    assert info["completed"] == 1.0, info
    assert info["passes"] >= 1 and info["total_ms"] > 0, info
    assert info["bytes"] > info["compressed"] >= 0, info
    assert 0 < info["bytes"] - info["compressed"] <= info["budget"], info
    assert info["processes"] >= 1, info
    return info


def screenshot(view, name):
    """Save a screenshot in OUTPUT and return its pixels, (height, width, 3)."""
    path = str(OUTPUT / name)
    simple.SaveScreenshot(path, view, ImageResolution=list(view.ViewSize))
    return read_png(path)


@contextlib.contextmanager
def messages():
    """Collect what VTK reports meanwhile; yield the window whose `GetOutput` has it."""
    usual, listener = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(listener)
    try:
        yield listener
    finally:
        vtkOutputWindow.SetInstance(usual)


def read_png(path):
    """Return the pixels of a PNG file, (height, width, 3), row 0 at the bottom."""
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars())
    return pixels.reshape(height, width, -1)[:, :, :3].astype(int)


def moving_picture(view, display):
    """Return the pixels that a moving camera draws, when they are complete, as `read_png` does."""
    view.SMProxy.InteractiveRender()
    while information(display)["completed"] < 1.0:
        view.SMProxy.InteractiveRender()
    data = vtkUnsignedCharArray()
    window = view.SMProxy.GetRenderWindow()
    width, height = window.GetSize()
    window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 1, data)
    return vtk_to_numpy(data).reshape(height, width, 4)[:, :, :3].astype(int)


def covered(pixels):
    """Return the share of pixels that differ from the background, which the lower left corner
    shows."""
    return float((abs(pixels - pixels[0, 0]).max(axis=2) > 8).mean())


def check_same(first, second, tolerance=0):
    """Check that two images agree to within `tolerance` grey levels in every pixel."""
    difference = int(abs(first - second).max())
    assert difference <= tolerance, (
        f"images differ by {difference} grey levels, {tolerance} allowed"
    )


def check_close(actual, expected, what):
    """Check that two numbers agree to single precision."""
    assert math.isclose(actual, expected, rel_tol=1e-6, abs_tol=1e-6), (
        f"{what}: {actual} in place of {expected}"
    )


def pick(view, x, y, *, snap):
    """Return the place that ParaView finds at a pixel, on a mesh point or not; None: none."""
    position, normal = [0.0] * 3, [0.0] * 3
    found = view.SMProxy.ConvertDisplayToPointOnSurface([x, y], position, normal, snap)
    return numpy.array(position) if found else None


def middle(values):
    """Return the middle of a range."""
    return 0.5 * (values[0] + values[1])


def finish(**results):
    """Print the closing line."""
    print(json.dumps(results, default=lambda value: numpy.asarray(value).tolist()))
