"""Isosurfaces as triangles: extracted by `contour`, written by `save_surface`."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
from vtkmodules.vtkIOPLY import vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from ._numbers import finite_list
from ._typing import FilePath, ImageLike, Isovalues, Progress, Rate
from ._vtk import observe_progress, vtk_errors
from ._warnings import warn_user
from .compression import check_array, doubts, find_array, is_compressed
from .geometry import GHOSTS, cell_centres
from .io.arrays import as_image
from .io.compressing import as_compressed
from .io.files import DISK_FULL, atomic_path, check_bytes, check_output
from .io.vtk_files import write_with
from .options import CompressionOptions, checked_levels
from .vtkProgIsoFilters import vtkZFPContour


def contour(
    image: ImageLike,
    isovalues: Isovalues,
    *,
    normals: bool = True,
    gradients: bool = False,
    scalars: bool = True,
    rate: Rate = None,
    tolerance: float | None = None,
    array: str | None = None,
    component: int = 0,
    mask_nan: bool = True,
    level: int = 0,
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
    rate : float or "auto", optional
        Compress a plain image first, to this many bits per sample, in (0, 32].
    tolerance : float, optional
        Compress a plain image first, at the least rate that keeps every sample within it.
    array : str, optional
        Point or cell array of a plain image, by default as in `compress`; the samples of cells lie
        in their centres.
    component : int, default: 0
        Component of that array; -1: the magnitude of its vectors.
    mask_nan : bool, default: True
        Whether NaN and infinite samples are hidden where a plain image is compressed first.
    level : int, default: 0
        Level of detail of a compressed volume whose surface is extracted; 0 is the volume itself.
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
        When a compressed volume is damaged, a plain image cannot be compressed, or samples are NaN
        or infinite, and not hidden.

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
    level = checked_levels(level, "level")
    image = as_image(image)
    compresses = rate is not None or tolerance is not None
    if compresses:
        options = CompressionOptions(
            rate=rate,
            tolerance=tolerance,
            array=array,
            component=component,
            mask_nan=mask_nan,
            levels=level,
        )
        image = as_compressed(image, options)
    if is_compressed(image):
        check_array(image, array)
        doubt = doubts(image, values)
        if doubt is not None:
            warn_user(doubt)
        extractor = vtkZFPContour()
        extractor.SetLevel(level)
        extractor.SetNumberOfThreads(threads)
        extractor.SetInputData(image)
    elif level > 0:
        raise ValueError(
            f"a plain image has no level {level}: compress it with levels, or give a rate"
        )
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
    surface = extractor.GetOutput()
    if not is_compressed(image):
        vtkZFPContour.TurnOutward(image, surface)
    return surface


def _isovalues(isovalues: Isovalues) -> list[float]:
    """Return one or several isovalues as a list, or raise where one is no finite number."""
    values = finite_list("isovalue", isovalues)
    if not values:
        raise ValueError("there are no isovalues: give at least one")
    return values


def _plain_contour(image: vtkImageData, array: str | None, component: int) -> vtkFlyingEdges3D:
    """Set up VTK's own extractor for an array of a plain image."""
    chosen, of_cells = find_array(image, array)
    samples = vtkImageData()
    samples.CopyStructure(cell_centres(image) if of_cells else image)
    if min(samples.GetDimensions()) < 2:
        sides = " x ".join(map(str, samples.GetDimensions()))
        raise ValueError(f"only volumes have isosurfaces, the image has {sides} samples")
    if chosen.GetNumberOfTuples() != samples.GetNumberOfPoints():  # VTK would read beyond it
        raise RuntimeError(
            f"cannot contour: array '{chosen.GetName()}' has {chosen.GetNumberOfTuples()} tuples, "
            f"the image needs {samples.GetNumberOfPoints()}"
        )
    components = chosen.GetNumberOfComponents()
    if not -1 <= component < components:
        raise ValueError(f"component is {component}, but the array has {components}")
    if components > 1:  # VTK 9.2's extractor always takes the first component
        vectors = vtk_to_numpy(chosen)
        lengths = component < 0
        values = np.linalg.norm(vectors, axis=1) if lengths else vectors[:, component].copy()
        name, chosen = chosen.GetName(), numpy_to_vtk(values)
        chosen.SetName(name)
    _check_shown(image)
    _check_finite(chosen)
    samples.GetPointData().SetScalars(chosen)
    extractor = vtkFlyingEdges3D()
    extractor.SetInputData(samples)
    return extractor


def _check_shown(image: vtkImageData) -> None:
    """Raise where samples or cells are hidden: VTK's extractor would go through them."""
    flags = vtkDataSetAttributes
    for data, name, hiding in (
        (image.GetPointData(), "points", flags.HIDDENPOINT),
        (image.GetCellData(), "cells", flags.HIDDENCELL | flags.REFINEDCELL),
    ):
        ghosts = data.GetArray(GHOSTS)
        hidden = 0 if ghosts is None else int(np.count_nonzero(vtk_to_numpy(ghosts) & hiding))
        if hidden:
            raise RuntimeError(
                f"cannot contour: the image hides {hidden} {name}: give a rate to leave holes there"
            )


def _check_finite(array: vtkDataArray) -> None:
    """Raise where samples are NaN or infinite: the surface would have points at NaN."""
    values = vtk_to_numpy(array)
    bad = 0
    if values.dtype.kind == "f":
        flat = values.reshape(-1)
        parts = range(0, flat.size, 2**24)
        bad = sum(int(np.count_nonzero(~np.isfinite(flat[i : i + 2**24]))) for i in parts)
    if bad:
        raise RuntimeError(
            f"cannot contour: array '{array.GetName()}' has {bad} samples that are NaN or "
            "infinite: give a rate to leave holes there (mask_nan, --mask-nan)"
        )


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
        suffix = temporary.suffix.lower()
        writer = _WRITERS[suffix]()
        writer.SetInputData(surface)
        observe_progress(writer, progress)
        if suffix == ".vtp":
            _write_vtp(writer, temporary)
        else:
            write_with(writer, temporary)
            _CHECKS[suffix](temporary, surface)


def _write_vtp(writer: vtkXMLPolyDataWriter, path: Path) -> None:
    """Write by way of memory: on a full disk VTK's writer of surfaces crashes."""
    writer.WriteToOutputStringOn()
    with vtk_errors(f"cannot write '{path}'"):
        writer.Write()
    with open(path, "w", encoding="utf-8") as file:
        file.write(writer.GetOutputString())


def _check_stl(path: Path, _surface: vtkPolyData) -> None:
    """Compare the size with the number of triangles that the file announces."""
    with open(path, "rb") as file:
        (triangles,) = struct.unpack("<80xI", file.read(84).ljust(84, b"\0"))
    check_bytes(path, 84 + 50 * triangles)


_PLY_SIZES = {"char": 1, "uchar": 1, "short": 2, "ushort": 2, "int": 4, "uint": 4, "float": 4}


def _check_ply(path: Path, surface: vtkPolyData) -> None:
    """Compare the size with what the header announces; VTK's writer tells of no full disk."""
    with open(path, "rb") as file:
        lines = list(iter(lambda: file.readline(4096).decode("ascii", "replace"), ""))[:64]
    if "end_header\n" not in lines:
        raise RuntimeError(f"cannot write '{path}': {DISK_FULL}")
    header = [line.split() for line in lines[: lines.index("end_header\n") + 1]]
    length = sum(len(line) for line in lines[: len(header)])
    of_point = sum(
        _PLY_SIZES[words[1]] for words in header if words[:1] == ["property"] and len(words) == 3
    )
    polygons = surface.GetPolys()
    corners = polygons.GetNumberOfConnectivityIds()
    points = surface.GetNumberOfPoints()
    check_bytes(path, length + points * of_point + polygons.GetNumberOfCells() + 4 * corners)


def _check_obj(path: Path, surface: vtkPolyData) -> None:
    """Count points and triangles; VTK's writer tells of no full disk."""
    found, last = {b"v ": 0, b"f ": 0}, b""
    with open(path, "rb") as file:
        for line in file:
            last = line
            if line[:2] in found:
                found[line[:2]] += 1
    expected = {b"v ": surface.GetNumberOfPoints(), b"f ": surface.GetNumberOfPolys()}
    if found != expected or not last.endswith(b"\n"):
        raise RuntimeError(f"cannot write '{path}': {DISK_FULL}")


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

#: Raise `RuntimeError` where a file lacks a part of its surface.
_CHECKS: dict[str, Callable[[Path, vtkPolyData], None]] = {
    ".stl": _check_stl,
    ".ply": _check_ply,
    ".obj": _check_obj,
}

#: Formats for surfaces.
SURFACE_SUFFIXES = tuple(_WRITERS)
