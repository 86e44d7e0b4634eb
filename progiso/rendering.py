"""One image, rendered off screen with plain VTK: what the command line uses."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonColor import vtkNamedColors
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

from ._opengl import check_display
from ._typing import RGB, FilePath, ImageLike, Isovalues
from ._vtk import vtk_errors
from .appearance import as_list, is_color
from .camera import Camera, orbit_camera, view_camera
from .io.compressing import as_compressed
from .io.files import atomic_path
from .isosurface import style_isosurface
from .options import (
    CompressionKeywords,
    CompressionOptions,
    RenderOptions,
    SurfaceStyle,
    levels_to_make,
)
from .statistics import depth, statistics
from .vtkProgIsoKernels import vtkIsosurfaceVolume

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: A colour's name, ``#rrggbb``, or red, green and blue from 0 to 1.
_Color = str | Sequence[float]

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

    image: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.float32]
    statistics: dict[str, Any]


def render(
    image: ImageLike,
    isovalue: Isovalues,
    *,
    size: tuple[int, int] = (1280, 720),
    orbit: tuple[int, int] | None = None,
    camera: Camera | None = None,
    color: _Color | Sequence[_Color] = "oldlace",
    opacity: float | Sequence[float] = 1.0,
    background: _Color = "#20242b",
    speculation: bool | int = True,
    memory_budget: int = 0,
    level_of_detail: str = "off",
    pixel_tolerance: float = 1.0,
    detailed: bool = False,
    **compression: Unpack[CompressionKeywords],
) -> RenderResult:
    """Render isosurfaces off screen until the image is complete.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain, or a compressed volume. Arrays as in `compress`.
    isovalue : float or sequence of float
        In the units of the image's values; at most 256.
    size : tuple of int, default: (1280, 720)
        Width and height in pixels, 1 to 16384 each.
    orbit : tuple of int, optional
        Camera ``(i, n)`` of `orbit_camera`; not together with `camera`.
    camera : Camera, optional
        By default `view_camera` of the image.
    color, background : str or sequence of 3 float
        A colour's name, ``#rrggbb``, or red, green and blue from 0 to 1. A sequence of colours
        has one for each isovalue.
    opacity, speculation, memory_budget, level_of_detail, pixel_tolerance, detailed
        As in `make_isosurface`. A window off screen is still: for it "interactive" is "off".
    **compression
        A plain image is compressed first: ``rate``, ``tolerance``, ``array``, ``component``,
        ``mask_nan``, ``levels``, ``threads`` and ``progress`` as in `compress`, but with all levels
        of detail, unless `level_of_detail` is "off".

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

    From far off, where samples are nearer to each other than pixels:

    >>> image = progiso.read(fetch("sphere", size=96))
    >>> far = progiso.view_camera(image, zoom=0.1)
    >>> result = progiso.render(image, 0.5, size=(320, 240), camera=far, level_of_detail="on")
    >>> result.statistics["levels"][0], result.statistics["levels"][1] > 0
    (0, True)
    """
    check_display()
    width, height = _checked_size(size)
    if orbit is not None and camera is not None:
        raise ValueError("give either an orbit or a camera, not both")
    compression.setdefault("levels", levels_to_make(level_of_detail))
    image = as_compressed(image, CompressionOptions(**compression))
    if orbit is not None:
        camera = orbit_camera(image, *orbit)
    colors = [parse_color(each) for each in as_list(color, is_color)]
    prop = style_isosurface(
        image,
        isovalue,
        SurfaceStyle(color=colors, opacity=opacity),
        RenderOptions(
            speculation=speculation,
            memory_budget=memory_budget,
            level_of_detail=level_of_detail,
            pixel_tolerance=pixel_tolerance,
            detailed=detailed,
        ),
    )
    window, renderer = _scene(prop, width, height)
    renderer.SetBackground(parse_color(background))
    (camera or view_camera(image, aspect=width / height)).apply(renderer.GetActiveCamera())
    renderer.ResetCameraClippingRange()
    with vtk_errors("cannot render"):
        window.Render()
    _check_opengl(window)
    mapper = prop.GetMapper()
    result = RenderResult(
        window_pixels(window, width, height), depth(mapper), statistics(mapper, renderer)
    )
    window.Finalize()
    return result


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    width, height = (int(n) for n in size)
    if not (1 <= width <= MAX_SIZE and 1 <= height <= MAX_SIZE):
        raise ValueError(f"size {width}x{height}: width and height must be 1 to {MAX_SIZE} pixels")
    return width, height


def parse_color(color: _Color) -> RGB:
    """Make red, green and blue of a name, ``#rrggbb`` or three numbers from 0 to 1.

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
        rgb = [rgba[i] / 255 for i in range(3)]
    else:
        rgb = [float(c) for c in color]
        known = len(rgb) == 3 and all(0 <= c <= 1 for c in rgb)
    if not known:
        raise ValueError(f"unknown colour {color!r}: give a name, #rrggbb or 3 numbers from 0 to 1")
    red, green, blue = rgb
    return red, green, blue


def _scene(
    prop: vtkIsosurfaceVolume, width: int, height: int
) -> tuple[vtkRenderWindow, vtkRenderer]:
    """Make an off-screen window that shows one prop."""
    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.AddVolume(prop)
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    return window, renderer


def _check_opengl(window: vtkRenderWindow) -> None:
    """Raise where there is no context: VTK would go on and return a black picture."""
    if not window.SupportsOpenGL():
        raise RuntimeError(
            f"no usable OpenGL context ({window.GetClassName()}); install libosmesa6 or a GPU "
            "driver with EGL, or set DISPLAY or VTK_DEFAULT_OPENGL_WINDOW"
        )


def window_pixels(window: vtkRenderWindow, width: int, height: int) -> npt.NDArray[np.uint8]:
    """Read the colours of a window that has been rendered.

    Returns
    -------
    numpy.ndarray of uint8, shape (height, width, 3)
        Row 0 is the top.
    """
    pixels = vtkUnsignedCharArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 1, pixels, 0)
    return np.ascontiguousarray(vtk_to_numpy(pixels).reshape(height, width, 3)[::-1])


def write_png(pixels: npt.NDArray[np.uint8], path: FilePath) -> None:
    """Write an image as PNG.

    Parameters
    ----------
    pixels : numpy.ndarray of uint8, shape (height, width, 3)
        Row 0 is the top.
    path : str or os.PathLike
        Appears under its name only when it is complete.
    """
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    scalars = numpy_to_vtk(np.ascontiguousarray(pixels[::-1]).reshape(-1, 3))
    image.GetPointData().SetScalars(scalars)
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetWriteToMemory(True)  # to a file it does not tell that the disk is full
    with vtk_errors(f"cannot write '{path}'"):
        writer.Write()
    with atomic_path(path) as temporary:
        temporary.write_bytes(vtk_to_numpy(writer.GetResult()).tobytes())
