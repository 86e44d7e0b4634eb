"""Compression and decompression of images: plain functions over the VTK filters."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import reference, vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData

from ._numbers import finite_list
from ._typing import Isovalues, Progress
from ._vtk import image_data, observe_progress, vtk_errors
from .geometry import GHOSTS, hide_points, plain_samples
from .options import CompressionOptions, checked_levels, rate_choice
from .vtkProgIsoFilters import vtkCompressedVolume, vtkImageZFPCompress, vtkImageZFPDecompress

_POINTS, _CELLS = 0, 1  # vtkDataObject::FieldAssociations


def compress_image(image: vtkImageData, options: CompressionOptions) -> vtkImageData:
    """Compress an image in memory; options, result and errors as in `progiso.compress`."""
    if is_compressed(image):
        raise RuntimeError("cannot compress: the image is a compressed volume already")
    if options.array is not None:
        image, place, name = _with_array(image, options.array)
    compressor = vtkImageZFPCompress()
    compressor.SetInputData(image)
    choice = rate_choice(options.rate, options.tolerance)
    compressor.SetRate(choice.rate)
    compressor.SetKeepLabels(choice.keep_labels)
    compressor.SetTolerance(choice.tolerance)
    compressor.SetComponent(options.component)
    compressor.SetNumberOfThreads(options.threads)
    compressor.SetMaskNonFinite(bool(options.mask_nan))
    compressor.SetLevels(checked_levels(options.levels))
    if options.array is not None:
        compressor.SetInputArrayToProcess(0, 0, 0, place, name)
    observe_progress(compressor, options.progress)
    try:
        with vtk_errors("cannot compress"):
            compressor.Update()
    except RuntimeError as error:
        reason = str(error).removeprefix("cannot compress: ").rstrip(".")
        if choice.tolerance and reason.startswith("No rate keeps"):
            raise ValueError(f"n{reason[1:]}") from None
        raise
    return compressor.GetOutput()


def checked_rate(rate: float) -> float:
    """Return a rate in bits per sample, or raise when it is no number or out of range."""
    return rate_choice(rate).rate


def find_array(image: vtkImageData, array: Any = None) -> tuple[vtkDataArray, bool]:
    """Find an array of a plain image.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        With the array.
    array : str or array, optional
        Its name, or the array itself, VTK's or pyvista's view of it; by default the active point
        scalars, else the active cell scalars, else the first point array, else the first cell
        array.

    Returns
    -------
    found : vtkmodules.vtkCommonCore.vtkDataArray
        The array.
    of_cells : bool
        Whether its values belong to cells, not points.

    Raises
    ------
    TypeError
        When the array is asked for by something else.
    ValueError
        When there is none; the message lists those that there are.
    """
    data = (image.GetPointData(), image.GetCellData())
    if array is None:
        association = reference(_POINTS)
        found = vtkImageZFPCompress.FindDefaultArray(image, association)
        if found is not None:
            return found, association.get() == _CELLS
    else:
        for of_cells, attributes in enumerate(data):
            for found in (attributes.GetScalars(), *_numeric_arrays(attributes)):
                if found is not None and _is_array(found, array):
                    return found, bool(of_cells)
    names = [found.GetName() for attributes in data for found in _numeric_arrays(attributes)]
    listed = ", ".join(repr(name) for name in names) or "none"
    if array is None:
        raise ValueError("the image has no array of numbers")
    if not isinstance(array, str):
        raise ValueError(f"the array given is none of the image's; it has: {listed}")
    other = any(attributes.GetAbstractArray(array) is not None for attributes in data)
    wanted = f"{'numbers in array' if other else 'array'} {array!r}"
    raise ValueError(f"the image has no {wanted}; it has: {listed}")


def _with_array(image: vtkImageData, array: Any) -> tuple[vtkImageData, int, str]:
    """Return an image that has an array, the place of the array, and its name.

    An array that is none of the image's, but has one value for each point or cell, is added to a
    copy that shares all else.
    """
    if isinstance(array, (np.ndarray, vtkDataArray)) and not _holds(image, array):
        return _added(image, array)
    found, of_cells = find_array(image, array)
    if not found.GetName():
        return _added(image, found)
    return image, _CELLS if of_cells else _POINTS, found.GetName()


def _holds(image: vtkImageData, array: Any) -> bool:
    data = (image.GetPointData(), image.GetCellData())
    return any(_is_array(found, array) for each in data for found in _numeric_arrays(each))


def _added(image: vtkImageData, array: Any) -> tuple[vtkImageData, int, str]:
    hidden, name = None, "scalars"
    if isinstance(array, vtkDataArray):
        added = array.NewInstance()
        added.ShallowCopy(array)
    else:
        values, hidden = plain_samples(array)
        added = numpy_to_vtk(np.ascontiguousarray(values))
    counts = (image.GetNumberOfPoints(), image.GetNumberOfCells())
    if added.GetNumberOfTuples() not in counts:
        raise ValueError(
            f"the array has {added.GetNumberOfTuples()} values, the image {counts[0]} points and "
            f"{counts[1]} cells"
        )
    place = counts.index(added.GetNumberOfTuples())
    added.SetName(name)
    copy = vtkImageData()
    copy.ShallowCopy(image)
    (copy.GetPointData(), copy.GetCellData())[place].AddArray(added)
    if hidden is not None and place == _POINTS:
        hide_points(copy, hidden)
    return copy, place, name


def _numeric_arrays(attributes: Any) -> list[vtkDataArray]:
    """Return the arrays that can be compressed: numbers, and no flags that hide."""
    arrays = (attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays()))
    return [found for found in arrays if found is not None and found.GetName() != GHOSTS]


def _is_array(found: vtkDataArray, wanted: Any) -> bool:
    """Tell whether an array is the one that is asked for by its name, or by itself."""
    if isinstance(wanted, str):
        return found.GetName() == wanted
    if wanted is found or getattr(wanted, "VTKObject", None) is found:
        return True
    if isinstance(wanted, vtkDataArray):
        return False
    if not isinstance(wanted, np.ndarray):
        raise TypeError(f"an array's name or the array itself is wanted, got {wanted!r:.60}")
    values = vtk_to_numpy(found)
    return wanted.size == values.size and np.may_share_memory(values, wanted)


def decompress(
    image: vtkImageData, *, level: int = 0, threads: int = 0, progress: Progress | None = None
) -> vtkImageData:
    """Decompress a compressed volume into scalars.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.
    level : int, default: 0
        Level of detail; 0 is the volume itself.
    threads : int, default: 0
        Threads that decode; 0 for one per core.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        The same geometry, with the values under the original array's name as point or cell
        scalars: float32, or float64 where the stream has custom units. Hidden samples are NaN and
        marked in a ghost array, as hidden cells are. A level has its samples where those of the
        volume are of which it has every second, fourth, ... one: the spacing is so many times
        wider, the first sample is in the same place.

    Raises
    ------
    TypeError
        When `image` is no image, or the level no whole number.
    ValueError
        When the level is out of range.
    RuntimeError
        When it is not a (valid) compressed volume, or has no such level.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> image = progiso.image_from_array(np.arange(512.0), (8, 8, 8), name="ramp")
    >>> progiso.decompress(progiso.compress(image)).GetPointData().GetScalars().GetName()
    'ramp'
    """
    decompressor = vtkImageZFPDecompress()
    decompressor.SetInputData(image_data(image))
    decompressor.SetLevel(checked_levels(level, "level"))
    decompressor.SetNumberOfThreads(threads)
    observe_progress(decompressor, progress)
    with vtk_errors("cannot decompress"):
        decompressor.Update()
    return decompressor.GetOutput()


def check_array(volume: vtkImageData, array: Any) -> None:
    """Raise `ValueError` unless an array, if named, is the one that a compressed volume holds."""
    held = describe(volume)["array"]
    if array is not None and not (isinstance(array, str) and array == held):
        array = array if isinstance(array, str) else f"(an array of {type(array).__name__})"
        raise ValueError(f"the compressed volume has no array {array!r}; it has: {held!r}")


def is_compressed(image: object) -> bool:
    """Tell whether a data object claims to be a compressed volume.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> progiso.is_compressed(progiso.image_from_array(np.arange(512.0), (8, 8, 8)))
    False
    """
    return isinstance(image, vtkDataObject) and bool(vtkCompressedVolume.IsCompressed(image))


def describe(image: vtkImageData) -> dict[str, Any]:
    """Describe a compressed volume by its metadata.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.

    Returns
    -------
    dict
        ``rate`` (bits per sample), ``block_bits``, ``samples`` per axis, ``blocks`` in total,
        ``stream_bytes``, ``range``, ``offset`` and ``scale`` (the stream's units: a value is
        offset + scale times the stream's), ``largest_error`` and ``mean_error`` (how far samples
        are off, in the units of the values; None where a file does not tell), ``array``,
        ``component``, ``association`` ("point" or "cell") and ``scalar_type`` (VTK's number of the
        original type). ``levels`` has a dict for each level of detail, from level 1 on:
        ``samples``, ``steps`` (samples of the volume from one of the level to the next, along x, y
        and z), ``rate``, ``block_bits``, ``stream_bytes``, ``range``, ``largest_error`` and
        ``mean_error`` (of the level's own samples), and ``largest_distance``: no sample of the
        original is farther from the level's interpolant, except where something is hidden.

    Raises
    ------
    ValueError
        When the metadata is missing, inconsistent or truncated; the message says what.
    """
    volume = vtkCompressedVolume()
    if not volume.Read(image_data(image)):
        raise ValueError(f"not a valid compressed volume: {volume.GetErrorMessage()}")
    return {
        "rate": volume.GetRate(),
        "block_bits": volume.GetBlockBits(),
        "samples": list(volume.GetDimensions()),
        "blocks": volume.GetNumberOfBlocks(),
        "stream_bytes": volume.GetStream().GetNumberOfValues(),
        "range": list(volume.GetRange()),
        "offset": volume.GetOffset(),
        "scale": volume.GetScale(),
        "largest_error": _known(volume.GetLargestError()),
        "mean_error": _known(volume.GetMeanError()),
        "array": volume.GetArrayName(),
        "component": volume.GetComponent(),
        "association": "cell" if volume.GetAssociation() else "point",
        "scalar_type": volume.GetScalarType(),
        "levels": [
            _describe_level(volume.GetLevel(number))
            for number in range(1, volume.GetNumberOfLevels() + 1)
        ],
    }


def _describe_level(level: vtkCompressedVolume) -> dict[str, Any]:
    return {
        "samples": list(level.GetDimensions()),
        "steps": list(level.GetSteps()),
        "rate": level.GetRate(),
        "block_bits": level.GetBlockBits(),
        "stream_bytes": level.GetStream().GetNumberOfValues(),
        "range": list(level.GetRange()),
        "largest_error": level.GetLargestError(),
        "mean_error": level.GetMeanError(),
        "largest_distance": level.GetLargestDistance(),
    }


def _known(error: float) -> float | None:
    return None if error < 0 else error


def doubts(image: vtkImageData, isovalues: Isovalues) -> str | None:
    """Say whether a compressed volume's surface is probably not that of the original.

    That is so where most parts of the surface run past samples that are nearer to the isovalue than
    they are off, as in labels and masks at a low rate.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.
    isovalues : float or sequence of float
        In the units of the image's values.

    Returns
    -------
    str or None
        One sentence, with the rate that would do; None where nothing is wrong.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> ball = np.where((np.mgrid[-8:8, -8:8, -8:8] ** 2).sum(0) < 36, 4000, 0)
    >>> print(doubts(progiso.compress(ball), 0.5))
    None
    >>> "Compress at" in doubts(progiso.compress(ball, rate=8), 0.5)
    True
    """
    volume = vtkCompressedVolume()
    if not volume.Read(image_data(image)):
        return None  # whoever uses the volume says what is wrong with it
    values = numpy_to_vtk(np.array(finite_list("isovalue", isovalues)), deep=True)
    return volume.DescribeDoubts(values) or None
