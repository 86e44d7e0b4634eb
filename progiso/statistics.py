"""The mapper's statistics and depth as Python values."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkRenderer

from ._vtk import vtk_errors
from .camera import Camera
from .vtkProgIsoKernels import vtkProgressiveIsosurfaceMapper, vtkProgressiveIsosurfaceStatistics


def _pass_keys() -> tuple[str, ...]:
    """Return the names of the columns that the mapper's statistics have for every pass."""
    table = vtkProgressiveIsosurfaceStatistics().GetPassTable()
    return tuple(table.GetColumnName(i) for i in range(table.GetNumberOfColumns()))


#: Names of the figures of a pass, in order: see `vtkProgressiveIsosurfaceStatistics`.
PASS_KEYS = _pass_keys()
_FRACTIONAL = ("completed", "elapsed_ms")


def statistics(
    mapper: vtkProgressiveIsosurfaceMapper, renderer: vtkRenderer | None = None
) -> dict[str, Any]:
    """Collect a mapper's statistics of its last image, ready for JSON.

    Parameters
    ----------
    mapper : vtkProgressiveIsosurfaceMapper
        After a render.
    renderer : vtkmodules.vtkRenderingCore.vtkRenderer, optional
        Adds the keys ``camera`` and ``size``.

    Returns
    -------
    dict
        ``passes``
            One dict for each pass, with the keys of `PASS_KEYS`: counts, ``completed`` from 0 to 1
            and ``elapsed_ms``. ``visible_blocks`` and ``active_blocks`` are None unless
            ``DetailedStatistics`` are on.
        ``total_ms``
            Milliseconds over all passes.
        ``loading``
            How the time before the volume's first image splits, in milliseconds: ``input_ms``
            (reading and compressing, as far as the mapper does it), ``upload_ms``,
            ``preparation_ms`` (on the GPU: decoding of a volume that is decoded whole, and finding
            ranges of values that do not come with it), ``decoded_blocks``, how many this decoded,
            and ``programs`` {stage: {``ms``, ``waited_ms``}}: from when a stage's program was asked
            for until it was compiled, and the wait for it.
        ``memory``
            GPU memory in bytes: ``buffers`` {name: bytes}, their ``total``, the part of it that is
            the ``compressed`` stream, the ``budget`` for the rest, and the ``least_budget`` that
            would be enough; and in the computer's own memory ``host``, what a plain image's
            compressed form takes.
        ``stages``, ``left_out``
            Names of the stages that ran, and of those that the scene did not need.
        ``stage_ms``
            Milliseconds of each stage over all passes; empty unless the mapper's
            ``DetailedStatistics`` are on.
        ``levels``
            {level: pixels}: for how many pixels the nearest surface is drawn from which level of
            detail, 0 being the volume itself; where two blend, it counts for the finer one. In
            JSON, where keys are strings, ``{"0": 9000, "1": 200}``.
        ``uncertain``
            Fraction of the pixels where levels of detail may hide something: their rays have
            passed coarser samples without a hit where the volume's own are on both sides of the
            isovalue.
        ``converged``
            Whether the image is complete.
        ``gl``
            The OpenGL implementation.
        ``camera``, ``size``
            See `Camera.to_dict`; width and height in pixels.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> result = progiso.render(progiso.read(fetch("sphere", size=32)), 0.8, size=(320, 240))
    >>> result.statistics["converged"], result.statistics["stages"][0]
    (True, 'MarkBlocks')
    """
    source = mapper.GetStatistics()
    names, stages = range(source.GetNumberOfBuffers()), range(source.GetNumberOfStages())
    values = {
        "passes": [_pass_values(source, i) for i in range(source.GetNumberOfPasses())],
        "total_ms": source.GetTotalMilliseconds(),
        "loading": _loading(source),
        "memory": {
            "buffers": {source.GetBufferName(i): source.GetBufferBytes(i) for i in names},
            "total": source.GetTotalBytes(),
            "compressed": source.GetCompressedBytes(),
            "budget": source.GetMemoryBudget(),
            "least_budget": source.GetLeastMemoryBudget(),
            "host": source.GetHostBytes(),
        },
        "stages": [source.GetStage(i) for i in stages],
        "left_out": [source.GetStageLeftOut(i) for i in range(source.GetNumberOfStagesLeftOut())],
        "stage_ms": _stage_milliseconds(source) if mapper.GetDetailedStatistics() else {},
        "levels": {i: source.GetLevelPixels(i) for i in range(source.GetNumberOfLevels())},
        "uncertain": source.GetUncertainFraction(),
        "converged": bool(source.GetConverged()),
        "gl": source.GetGLDescription(),
    }
    if renderer is not None:
        values["camera"] = Camera.from_vtk(renderer.GetActiveCamera()).to_dict()
        values["size"] = list(renderer.GetSize())
    return values


def _loading(source: vtkProgressiveIsosurfaceStatistics) -> dict[str, Any]:
    return {
        "input_ms": source.GetInputMilliseconds(),
        "upload_ms": source.GetUploadMilliseconds(),
        "preparation_ms": source.GetPreparationMilliseconds(),
        "decoded_blocks": int(source.GetBlocksDecodedAtFirst()),
        "programs": {
            source.GetProgram(i): {
                "ms": source.GetProgramMilliseconds(i),
                "waited_ms": source.GetProgramWaitMilliseconds(i),
            }
            for i in range(source.GetNumberOfPrograms())
        },
    }


def _pass_values(source: vtkProgressiveIsosurfaceStatistics, i: int) -> dict[str, Any]:
    values = {key: source.GetPassValue(i, key) for key in PASS_KEYS}
    return {key: v if key in _FRACTIONAL else _count(v) for key, v in values.items()}


def _count(value: float) -> int | None:
    """Return a whole number, or None where it was not counted."""
    return None if math.isnan(value) else int(value)


def _stage_milliseconds(source: vtkProgressiveIsosurfaceStatistics) -> dict[str, float]:
    stages = range(source.GetNumberOfStages())
    return {source.GetStage(i): source.GetStageMilliseconds(i) for i in stages}


def depth(mapper: vtkProgressiveIsosurfaceMapper) -> npt.NDArray[np.float32]:
    """Return the distances from the camera to the surface in a mapper's last image.

    Parameters
    ----------
    mapper : vtkProgressiveIsosurfaceMapper
        After a render.

    Returns
    -------
    numpy.ndarray of float32, shape (height, width)
        World units along the ray through each pixel's centre, from the camera's position (with
        parallel projection from the camera's plane); ``inf`` where nothing is hit. Row 0 is the
        top of the image.

    Raises
    ------
    RuntimeError
        When nothing has been rendered yet.

    Examples
    --------
    >>> import numpy as np, progiso, pyvista
    >>> from progiso.data import fetch
    >>> plotter = pyvista.Plotter(off_screen=True, window_size=(320, 240))
    >>> prop = plotter.progiso.add_isosurface(progiso.read(fetch("sphere", size=32)), 0.8)
    >>> plotter.show(auto_close=False)
    >>> distances = progiso.depth(prop.GetMapper())
    >>> distances.shape, bool(np.isfinite(distances).any())
    ((240, 320), True)
    """
    image = vtkImageData()
    with vtk_errors("no depth"):
        mapper.GetDepthImage(image)
    width, height, _ = image.GetDimensions()
    rows = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width)
    return np.ascontiguousarray(rows[::-1], np.float32)
