"""Compress whatever may stand for a volume: images, arrays, sources, files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, FilePath, ImageLike, Progress, Rate
from ..compression import check_array, compress_image, is_compressed
from ..options import CompressionKeywords, CompressionOptions, rate_choice
from .arrays import as_image, source_of
from .formats import open_source
from .slabs import compress_passes
from .source import Selection, Source

if TYPE_CHECKING:
    from typing_extensions import Unpack


def compress(
    image: ImageLike,
    *,
    rate: Rate = None,
    tolerance: float | None = None,
    array: str | None = None,
    component: int = 0,
    axes: str | None = None,
    mask_nan: bool = True,
    levels: int = 0,
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
    rate : float or "auto", optional
        Bits per sample, in (0, 32]; zfp rounds it to whole bits per block of 64 samples, at
        least 9 of them. By default 8, and more for labels and masks (whole numbers, few of them in
        one place, and few in all or far apart): the least rate that leaves every sample on its side
        of every half-integer. "auto" takes the least rate that keeps the tolerance.
    tolerance : float, optional
        Largest error of a sample, above 0, in the units of the image's values. It takes the place
        of a rate.
    array : str, optional
        Point or cell array to compress; by default the active point scalars, else the first
        point array, else the active cell scalars, else the first cell array.
    component : int, default: 0
        Component of that array; -1: the magnitude of its vectors.
    axes : str, optional
        Order of an array's dimensions: "zyx" where slices come first; by default "xyz", or what
        the names of an xarray's dimensions say.
    mask_nan : bool, default: True
        Whether NaN and infinite samples are hidden, too; otherwise they are an error.
    levels : int, default: 0
        Most levels of detail to make beside the volume, up to 11: coarser copies for far views.
        Each has half of the samples along the axes whose samples lie nearest to each other; the
        last one has at most 64 along each axis, and a volume that has no more gets none. They take
        20 % of the volume's bits at 8 bits per sample, 26 % at 4; `describe` lists them, and
        `decompress` decodes them.
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
        When there is no such array, the rate is out of range, or no rate keeps the tolerance.
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
        tolerance=tolerance,
        array=array,
        component=component,
        axes=axes,
        mask_nan=mask_nan,
        levels=levels,
        threads=threads,
        progress=progress,
    )
    return compress_with(image, options)


def compress_with(volume: ImageLike, options: CompressionOptions) -> vtkImageData:
    """Compress an image or an array; options, result and errors as in `compress`."""
    if not isinstance(volume, (vtkImageData, np.ndarray)):
        source = source_of(volume, options.axes)
        if source is not None:
            source.tell_notes(3)
            return compress_source(source, options)
    return compress_image(as_image(volume, options.axes), options)


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


def compress_file(
    path: FilePath,
    *,
    selection: Selection | None = None,
    **options: Unpack[CompressionKeywords],
) -> vtkImageData:
    """Compress a volume in a file, some slices at a time where the format allows it.

    The result is bit for bit that of `compress` on what `read` returns. Memory holds the result and
    some tens of MiB, or 4 slices, or a layer of the file's chunks where these are larger; the page
    on formats (``docs/formats.md``) tells which formats are read as a whole.

    Parameters
    ----------
    path : str or os.PathLike
        Of any kind that `read` knows.
    selection : progiso.io.Selection, optional
        What of the file is wanted, where it holds more than one volume.
    **options
        ``rate``, ``tolerance``, ``array``, ``component``, ``mask_nan``, ``levels``, ``threads`` and
        ``progress`` as in `compress`.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError
        When the file is damaged or no image, there is no such array, or the rate is out of range.
    RuntimeError
        When the image cannot be compressed, see `compress`.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> volume = progiso.compress_file(fetch("sphere", size=32), rate=4)
    >>> progiso.describe(volume)["samples"]
    [32, 32, 32]
    """
    chosen = CompressionOptions(**options)
    selection = selection or Selection()
    if chosen.array is not None:
        selection = replace(selection, array=chosen.array)
    with open_source(path, selection) as source:
        source.tell_notes()
        return compress_source(source, chosen)


def compress_source(source: Source, options: CompressionOptions) -> vtkImageData:
    """Compress a source, some slices at a time unless it holds more than samples.

    The samples are read twice where float32 may not hold them, the first time to choose units, and
    several times where they are labels, or are to be within a tolerance. The array has been chosen
    when the source was opened.
    """
    rate_choice(options.rate, options.tolerance)
    if source.more_than_samples:
        image = source.image(_half(options.progress, 0))
        return compress_image(image, replace(options, progress=_half(options.progress, 1)))
    about, count = source.about, source.about.components
    volume = compress_passes(
        lambda: _slabs(source),
        about.dimensions,
        about.name,
        options,
        components=count,
        spacing=about.geometry.spacing,
    )
    source.place(volume)
    return volume


def _slabs(source: Source) -> Iterator[Array | vtkDataArray]:
    """Yield a source's slabs, as VTK arrays where NumPy's type does not tell VTK's."""
    components = source.about.components
    for slab in source.slabs():
        if source.vtk_type is None:
            yield slab
        else:
            flat = np.ascontiguousarray(slab).reshape(-1, components)
            yield numpy_to_vtk(flat if components > 1 else flat[:, 0], array_type=source.vtk_type)
            del flat
        del slab  # before the next is read


def _half(progress: Progress | None, number: int) -> Progress | None:
    """Return the progress of the first (0) or the second half (1) of the work."""
    return None if progress is None else lambda fraction: progress((number + fraction) / 2)
