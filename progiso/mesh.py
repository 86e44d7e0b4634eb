"""Isosurfaces as triangles: extracted by `contour`, written by `save_surface`."""

from __future__ import annotations

import math
from collections.abc import Callable
from numbers import Real
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
from vtkmodules.vtkIOPLY import vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from ._typing import FilePath, ImageLike, Isovalues, Progress
from ._vtk import observe_progress, vtk_errors
from .appearance import as_list
from .compression import as_compressed, check_array, find_array, is_compressed
from .geometry import as_image, cell_centres
from .io.files import atomic_path, check_output
from .options import CompressionOptions
from .vtkProgIsoFilters import vtkZFPContour


def contour(
    image: ImageLike,
    isovalues: Isovalues,
    *,
    normals: bool = True,
    gradients: bool = False,
    scalars: bool = True,
    rate: float | None = None,
    array: str | None = None,
    component: int = 0,
    mask_nan: bool = False,
    threads: int = 0,
    progress: Progress | None = None,
) -> vtkPolyData:
    """Extract isosurfaces as triangles.

    Of a compressed volume only a few bricks are decoded at a time; the surface is bit for bit the
    one that `vtkFlyingEdges3D` makes of the decoded image. A plain image is given to
    `vtkFlyingEdges3D` itself, unless it is to be compressed first.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain, or a compressed volume; at least 2 samples along every axis. Arrays as in `compress`.
    isovalues : float or sequence of float
        In the units of the image's values.
    normals, gradients : bool, default: True, False
        Whether to compute the point arrays ``Normals``, of unit length, and ``Gradients``.
    scalars : bool, default: True
        Whether to store the isovalue at every point, under the array's name.
    rate : float, optional
        Compress a plain image first, to this many bits per sample, in (0, 32].
    array : str, optional
        Point or cell array of a plain image, by default as in `compress`; the samples of cells lie
        in their centres.
    component : int, default: 0
        Component of that array.
    mask_nan : bool, default: False
        Whether NaN and infinite samples are hidden where a plain image is compressed first.
    threads : int, default: 0
        Threads that decode and contour a compressed volume; 0 for one per core.
    progress : callable, optional
        Called with the fraction done, from 0 to 1, for a compressed volume.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkPolyData
        In the image's world coordinates. Empty where the image has no such values.

    Raises
    ------
    TypeError
        When `image` is neither an image nor an array, or an isovalue is no number.
    ValueError
        When there is no isovalue, one is not finite, there is no such array or component, the image
        is flat, the rate is out of range, or missing where NaN is to be hidden.
    RuntimeError
        When a compressed volume is damaged, or a plain image cannot be compressed, as with NaN.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> volume = progiso.compress(progiso.read(fetch("sphere", size=32)), rate=8)
    >>> surface = progiso.contour(volume, 0.8)
    >>> surface.GetNumberOfPolys() > 1000
    True
    """
    values = _isovalues(isovalues)
    image = as_image(image)
    if mask_nan and rate is None and not is_compressed(image):
        raise ValueError("mask_nan takes a rate: the contour of a plain image hides nothing")
    if rate is not None:
        options = CompressionOptions(rate=rate, array=array, component=component, mask_nan=mask_nan)
        image = as_compressed(image, options)
    if is_compressed(image):
        check_array(image, array)
        extractor = vtkZFPContour()
        extractor.SetNumberOfThreads(threads)
        extractor.SetInputData(image)
    else:
        extractor = _plain_contour(image, array, component)
    for i, value in enumerate(values):
        extractor.SetValue(i, value)
    extractor.SetComputeNormals(normals)
    extractor.SetComputeGradients(gradients)
    extractor.SetComputeScalars(scalars)
    observe_progress(extractor, progress)
    with vtk_errors("cannot contour"):
        extractor.Update()
    return extractor.GetOutput()


def _isovalues(isovalues: Isovalues) -> list[float]:
    """Return one or several isovalues as a list, or raise where one is no finite number."""
    values = as_list(isovalues, lambda given: isinstance(given, Real))
    for value in values:
        if not isinstance(value, Real):
            raise TypeError(f"an isovalue must be a number, got {value!r}")
        if not math.isfinite(value):
            raise ValueError(f"an isovalue must be finite, got {value:g}")
    if not values:
        raise ValueError("there are no isovalues: give at least one")
    return [float(value) for value in values]


def _plain_contour(image: vtkImageData, array: str | None, component: int) -> vtkFlyingEdges3D:
    """Set up VTK's own extractor for an array of a plain image."""
    chosen, of_cells = find_array(image, array)
    samples = vtkImageData()
    samples.CopyStructure(cell_centres(image) if of_cells else image)
    if min(samples.GetDimensions()) < 2:
        sides = " x ".join(map(str, samples.GetDimensions()))
        raise ValueError(f"only volumes have isosurfaces, the image has {sides} samples")
    components = chosen.GetNumberOfComponents()
    if not 0 <= component < components:
        raise ValueError(f"component is {component}, but the array has {components}")
    if components > 1:  # VTK 9.2's extractor always takes the first component
        values = np.ascontiguousarray(vtk_to_numpy(chosen)[:, component])
        name, chosen = chosen.GetName(), numpy_to_vtk(values)
        chosen.SetName(name)
    samples.GetPointData().SetScalars(chosen)
    extractor = vtkFlyingEdges3D()
    extractor.SetInputData(samples)
    return extractor


def save_surface(surface: vtkPolyData, path: FilePath, *, progress: Progress | None = None) -> None:
    """Write a surface to a file, which appears under its name only when it is complete.

    Parameters
    ----------
    surface : vtkmodules.vtkCommonDataModel.vtkPolyData
        What `contour` returns.
    path : str or os.PathLike
        ``.vtp`` keeps everything. ``.ply`` (binary) and ``.obj`` (text) keep points, triangles and
        normals, ``.stl`` (binary) triangles alone.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Raises
    ------
    ValueError
        When the suffix is unknown.
    FileNotFoundError
        When the folder does not exist.
    RuntimeError
        When writing fails, for example an empty surface in a format that cannot hold one; nothing
        is left behind.

    Examples
    --------
    >>> import os, tempfile, progiso
    >>> from progiso.data import fetch
    >>> surface = progiso.contour(progiso.read(fetch("sphere", size=32)), 0.8)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     progiso.save_surface(surface, os.path.join(folder, "sphere.ply"))
    """
    check_output(path, SURFACE_SUFFIXES)
    with atomic_path(path) as temporary:
        writer = _WRITERS[temporary.suffix.lower()]()
        writer.SetInputData(surface)
        writer.SetFileName(str(temporary))
        observe_progress(writer, progress)
        with vtk_errors(f"cannot write '{temporary.name}'"):
            written = writer.Write()
        if not written or not temporary.is_file():
            raise RuntimeError(f"cannot write '{temporary.name}'")


def _vtp_writer() -> vtkXMLPolyDataWriter:
    """Make a writer that puts data in line: Debian 12's ParaView cannot read appended data."""
    writer = vtkXMLPolyDataWriter()
    writer.SetDataModeToBinary()
    writer.SetHeaderTypeToUInt64()
    return writer


def _stl_writer() -> vtkSTLWriter:
    writer = vtkSTLWriter()
    writer.SetFileTypeToBinary()
    return writer


_WRITERS: dict[str, Callable[[], Any]] = {
    ".vtp": _vtp_writer,
    ".stl": _stl_writer,
    ".ply": vtkPLYWriter,
    ".obj": vtkOBJWriter,
}

#: Formats for surfaces.
SURFACE_SUFFIXES = tuple(_WRITERS)
