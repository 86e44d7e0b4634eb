"""Compression and decompression of images: plain functions over the VTK filters."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.vtkCommonCore import reference, vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkImageData

from ._typing import ImageLike, Progress
from ._vtk import image_data, observe_progress, vtk_errors
from .geometry import as_image
from .options import CompressionOptions
from .vtkProgIsoFilters import vtkCompressedVolume, vtkImageZFPCompress, vtkImageZFPDecompress

_POINTS, _CELLS = 0, 1  # vtkDataObject::FieldAssociations


def compress(
    image: ImageLike,
    *,
    rate: float = 8.0,
    array: str | None = None,
    component: int = 0,
    axes: str | None = None,
    mask_nan: bool = False,
    threads: int = 0,
    progress: Progress | None = None,
) -> vtkImageData:
    """Compress one array of an image with fixed-rate ZFP.

    Points and cells that a ghost array of the image hides (``vtkGhostType``) stay hidden: an
    isosurface has a hole there.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData, numpy.ndarray, or like one
        At least 2 samples along every axis. An array is indexed [x, y, z], as pyvista's ``wrap``
        takes it, and has unit spacing. Arrays of dask, zarr and h5py are read some slices at a
        time; an ``xarray.DataArray`` lies where its coordinates say, an image of SimpleITK or
        nibabel where it says itself.
    rate : float, default: 8
        Bits per sample, in (0, 32]; zfp rounds it to whole bits per block of 64 samples, at
        least 9 of them.
    array : str, optional
        Point or cell array to compress; by default the active point scalars, else the first
        point array, else the active cell scalars, else the first cell array.
    component : int, default: 0
        Component of that array.
    axes : str, optional
        Order of an array's dimensions: "zyx" where slices come first; by default "xyz", or what
        the names of an xarray's dimensions say.
    mask_nan : bool, default: False
        Whether NaN and infinite samples are hidden, too; otherwise they are an error.
    threads : int, default: 0
        Threads that encode; 0 for one per core.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume: the same geometry and no scalars, the stream in the field data.
        Any VTI writer stores it. Where float32 cannot hold the values (small differences on a large
        value, 1e300, denormals) the stream has custom units, see `describe`.

    Raises
    ------
    TypeError
        When `image` is neither an image nor a three-dimensional array.
    ValueError
        When there is no such array or the rate is out of range.
    RuntimeError
        When there is no such component, the image is flat or compressed already, or a sample is
        NaN or infinite.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> volume = progiso.compress(np.random.default_rng(1).random((8, 8, 8)), rate=4)
    >>> progiso.is_compressed(volume)
    True
    """
    options = CompressionOptions(
        rate=rate,
        array=array,
        component=component,
        axes=axes,
        mask_nan=mask_nan,
        threads=threads,
        progress=progress,
    )
    return compress_with(image, options)


def compress_with(image: ImageLike, options: CompressionOptions) -> vtkImageData:
    """Compress an image; options, result and errors as in `compress`."""
    if not isinstance(image, (vtkImageData, np.ndarray)):
        from .io.arrays import source_of  # which needs this module
        from .io.volumes import compress_source

        source = source_of(image, options.axes)
        if source is not None:
            source.tell_notes(3)
            return compress_source(source, options)
    image = as_image(image, options.axes)
    if is_compressed(image):
        raise RuntimeError("cannot compress: the image is a compressed volume already")
    compressor = vtkImageZFPCompress()
    compressor.SetInputData(image)
    compressor.SetRate(checked_rate(options.rate))
    compressor.SetComponent(options.component)
    compressor.SetNumberOfThreads(options.threads)
    compressor.SetMaskNonFinite(bool(options.mask_nan))
    if options.array is not None:
        _, of_cells = find_array(image, options.array)
        compressor.SetInputArrayToProcess(0, 0, 0, _CELLS if of_cells else _POINTS, options.array)
    observe_progress(compressor, options.progress)
    with vtk_errors("cannot compress"):
        compressor.Update()
    return compressor.GetOutput()


def checked_rate(rate: float) -> float:
    """Return a rate, or raise `ValueError` when it is out of range."""
    if not 0 < rate <= 32:
        raise ValueError(f"rate must be in (0, 32] bits per sample, got {rate:g}")
    return rate


def find_array(image: vtkImageData, array: str | None = None) -> tuple[vtkDataArray, bool]:
    """Find an array of a plain image.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        With the array.
    array : str, optional
        Its name; by default the active point scalars, else the active cell scalars, else the first
        point array, else the first cell array.

    Returns
    -------
    found : vtkmodules.vtkCommonCore.vtkDataArray
        The array.
    of_cells : bool
        Whether its values belong to cells, not points.

    Raises
    ------
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
            arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
            for found in (attributes.GetScalars(), *arrays):
                if found is not None and found.GetName() == array:
                    return found, bool(of_cells)
    names = [d.GetArrayName(i) for d in data for i in range(d.GetNumberOfArrays())]
    listed = ", ".join(repr(name) for name in names) or "none"
    wanted = "array" if array is None else f"array {array!r}"
    raise ValueError(f"the image has no {wanted}; it has: {listed}")


def decompress(
    image: vtkImageData, *, threads: int = 0, progress: Progress | None = None
) -> vtkImageData:
    """Decompress a compressed volume into scalars.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.
    threads : int, default: 0
        Threads that decode; 0 for one per core.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        The same geometry, with the values under the original array's name as point or cell
        scalars: float32, or float64 where the stream has custom units. Hidden samples are NaN and
        marked in a ghost array, as hidden cells are.

    Raises
    ------
    TypeError
        When `image` is no image.
    RuntimeError
        When it is not a (valid) compressed volume.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> image = progiso.image_from_array(np.arange(512.0), (8, 8, 8), name="ramp")
    >>> progiso.decompress(progiso.compress(image)).GetPointData().GetScalars().GetName()
    'ramp'
    """
    decompressor = vtkImageZFPDecompress()
    decompressor.SetInputData(image_data(image))
    decompressor.SetNumberOfThreads(threads)
    observe_progress(decompressor, progress)
    with vtk_errors("cannot decompress"):
        decompressor.Update()
    return decompressor.GetOutput()


def as_compressed(image: ImageLike, options: CompressionOptions) -> vtkImageData:
    """Compress an image unless it is a compressed volume already; options as in `compress`.

    Raises
    ------
    ValueError
        When the image is a compressed volume of another array than the one asked for.
    """
    if not is_compressed(image):
        return compress_with(image, options)
    image = as_image(image)
    check_array(image, options.array)
    return image


def check_array(volume: vtkImageData, array: str | None) -> None:
    """Raise `ValueError` unless an array, if named, is the one that a compressed volume holds."""
    held = describe(volume)["array"]
    if array not in (None, held):
        raise ValueError(f"the compressed volume has no array {array!r}; it has: {held!r}")


def is_compressed(image: object) -> bool:
    """Tell whether a data object claims to be a compressed volume.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> progiso.is_compressed(progiso.image_from_array(np.arange(512.0), (8, 8, 8)))
    False
    """
    return bool(vtkCompressedVolume.IsCompressed(image))


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
        offset + scale times the stream's), ``array``, ``component``, ``association`` ("point" or
        "cell") and ``scalar_type`` (VTK's number of the original type).

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
        "array": volume.GetArrayName(),
        "component": volume.GetComponent(),
        "association": "cell" if volume.GetAssociation() else "point",
        "scalar_type": volume.GetScalarType(),
    }
