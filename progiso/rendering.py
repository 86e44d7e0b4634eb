"""Rendering one image off screen with plain VTK: what the command line and the tests use."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonColor import vtkNamedColors
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

from ._opengl import check_display
from ._vtk import vtk_errors
from .appearance import as_list, is_color
from .camera import orbit_camera, view_camera
from .compression import as_compressed
from .geometry import as_image
from .io.files import atomic_path
from .isosurface import make_isosurface
from .statistics import depth, statistics

_HEX = re.compile("#[0-9a-fA-F]{6}")

#: Largest width and height of an image in pixels.
MAX_SIZE = 16384


@dataclass(frozen=True)
class RenderResult:
    """A rendered isosurface.

    Attributes
    ----------
    image : numpy.ndarray of uint8, shape (height, width, 3)
        Row 0 is the top.
    depth : numpy.ndarray of float32, shape (height, width)
        See `progiso.depth`.
    statistics : dict
        See `progiso.statistics`, with ``camera`` and ``size``.
    """

    image: np.ndarray
    depth: np.ndarray
    statistics: dict


def render(
    image,
    isovalue,
    size=(1280, 720),
    orbit=None,
    camera=None,
    rate=8.0,
    array=None,
    component=0,
    speculation=True,
    color="oldlace",
    background="#20242b",
    progress=None,
    memory_budget=0,
    detailed=False,
    opacity=1.0,
    mask_nan=False,
):
    """Render isosurfaces off screen until the image is complete.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain, or a compressed volume. Arrays as in `compress`.
    isovalue : float or sequence of float
        In the units of the image's values; at most 16.
    size : tuple of int, default: (1280, 720)
        Width and height in pixels, 1 to 16384 each.
    orbit : tuple of int, optional
        Camera ``(i, n)`` of `orbit_camera`; not together with `camera`.
    camera : Camera, optional
        By default `view_camera` of the image.
    rate : float, default: 8
        Bits per sample for a plain image, which is compressed first.
    array, component : str, int
        What to compress of a plain image, see `compress`.
    speculation : bool or int, default: True
        Whether rays test several blocks ahead in one pass, or how many at most (1 to 64).
    color, background : str or sequence of 3 float
        A colour's name, ``#rrggbb``, or red, green and blue from 0 to 1. A sequence of colours
        has one for each isovalue.
    progress : callable, optional
        Called with the fraction done, from 0 to 1, while a plain image is compressed.
    memory_budget : int, default: 0
        Bound in bytes on the GPU memory beside the compressed volume; 0 for the mapper's own
        choice.
    detailed : bool, default: False
        Whether the statistics tell the time of each stage and the distinct blocks of each pass,
        which costs time itself.
    opacity : float or sequence of float, default: 1
        One for all isovalues, or one for each; below 1 what lies behind shines through.
    mask_nan : bool, default: False
        Whether NaN and infinite samples of a plain image are hidden, as in `compress`.

    Returns
    -------
    RenderResult

    Raises
    ------
    ValueError
        When an argument is out of its range.
    RuntimeError
        When there is no usable OpenGL 4.3, or VTK reports an error.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> result = progiso.render(progiso.read(fetch("sphere", size=64)), 0.5, size=(320, 240))
    >>> result.image.shape, result.statistics["converged"]
    ((240, 320, 3), True)
    """
    check_display()
    width, height = _checked_size(size)
    if orbit is not None and camera is not None:
        raise ValueError("give either an orbit or a camera, not both")
    image = as_image(image)
    if orbit is not None:
        camera = orbit_camera(image, *orbit)
    image = as_compressed(image, rate, array, component, progress, mask_nan)
    volume = make_isosurface(
        image,
        isovalue,
        color=[parse_color(each) for each in as_list(color, is_color)],
        speculation=speculation,
        memory_budget=memory_budget,
        opacity=opacity,
    )
    volume.GetMapper().SetDetailedStatistics(bool(detailed))
    window, renderer = _scene(volume, width, height, parse_color(background))
    (camera or view_camera(image, aspect=width / height)).apply(renderer.GetActiveCamera())
    renderer.ResetCameraClippingRange()
    with vtk_errors("cannot render"):
        window.Render()
    _check_opengl(window)
    mapper = volume.GetMapper()
    result = RenderResult(
        window_pixels(window, width, height), depth(mapper), statistics(mapper, renderer)
    )
    window.Finalize()
    return result


def _checked_size(size):
    width, height = (int(n) for n in size)
    if not (1 <= width <= MAX_SIZE and 1 <= height <= MAX_SIZE):
        raise ValueError(f"size {width}x{height}: width and height must be 1 to {MAX_SIZE} pixels")
    return width, height


def parse_color(color):
    """Red, green and blue from a name, ``#rrggbb`` or three numbers from 0 to 1.

    Raises
    ------
    ValueError
        When it is none of these.

    Examples
    --------
    >>> parse_color("#ff0000")
    (1.0, 0.0, 0.0)
    """
    if isinstance(color, str):
        known = bool(_HEX.fullmatch(color)) or vtkNamedColors().ColorExists(color)
        rgba = vtkNamedColors().HTMLColorToRGBA(color) if known else (0, 0, 0)
        rgb = tuple(rgba[i] / 255 for i in range(3))
    else:
        rgb = tuple(float(c) for c in color)
        known = len(rgb) == 3 and all(0 <= c <= 1 for c in rgb)
    if not known:
        raise ValueError(f"unknown colour {color!r}: give a name, #rrggbb or 3 numbers from 0 to 1")
    return rgb


def _scene(volume, width, height, background):
    """An off-screen window with one volume in it."""
    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.SetBackground(background)
    renderer.AddVolume(volume)
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    return window, renderer


def _check_opengl(window):
    """VTK goes on without a context; say so instead of returning a black picture."""
    if not window.SupportsOpenGL():
        raise RuntimeError(
            f"no usable OpenGL context ({window.GetClassName()}); install libosmesa6 or a GPU "
            "driver with EGL, or set DISPLAY or VTK_DEFAULT_OPENGL_WINDOW"
        )


def window_pixels(window, width, height):
    """Colours of a window that has been rendered.

    Returns
    -------
    numpy.ndarray of uint8, shape (height, width, 3)
        Row 0 is the top.
    """
    pixels = vtkUnsignedCharArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 1, pixels, 0)
    return np.ascontiguousarray(vtk_to_numpy(pixels).reshape(height, width, 3)[::-1])


def write_png(pixels, path):
    """Write an image as PNG.

    Parameters
    ----------
    pixels : numpy.ndarray of uint8, shape (height, width, 3)
        Row 0 is the top.
    path : str or os.PathLike
        Replaced at once when the file is complete.
    """
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    scalars = numpy_to_vtk(np.ascontiguousarray(pixels[::-1]).reshape(-1, 3))
    image.GetPointData().SetScalars(scalars)
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    with atomic_path(path) as temporary, vtk_errors(f"cannot write '{path}'"):
        writer.SetFileName(str(temporary))
        writer.Write()
