"""The least rate that keeps every sample within a tolerance."""

from __future__ import annotations

from dataclasses import replace

from ._typing import ImageLike, Progress
from .compression import describe
from .io.compressing import compress_with
from .options import CompressionOptions, checked_tolerance

#: Bits per sample at the lowest rate.
LEAST_RATE = 9 / 64


def least_rate(
    image: ImageLike,
    tolerance: float,
    *,
    relative: bool = False,
    array: str | None = None,
    component: int = 0,
    mask_nan: bool = True,
    progress: Progress | None = None,
) -> float:
    """Find the least rate at which no sample is off by more than a tolerance.

    At the returned rate every sample has been compressed, decompressed and compared with the
    original. A lower rate may keep them all by chance: rates are a 64th of a bit apart, errors do
    not fall at every step, and not all rates are tried. The search takes about three times as long
    as compressing the image. `compress` takes a tolerance, too, and keeps what it compressed.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain, at least 2 samples along every axis.
    tolerance : float
        Largest error of a sample, above 0, in the units of the image's values. Hidden samples
        do not count.
    relative : bool, default: False
        Whether the tolerance is in units of the values' range, their maximum less their minimum.
    array, component, mask_nan : str, int, bool
        What is compressed of the image, as in `compress`.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.

    Returns
    -------
    float
        Bits per sample, a multiple of 1/64 from 9/64 to 32, as `compress` takes it.

    Raises
    ------
    TypeError
        When `image` is no image.
    ValueError
        When the tolerance is not positive, or finer than 32 bits per sample can keep; the message
        tells what they can. When there is no such array.
    RuntimeError
        When `compress` cannot compress the image.

    Examples
    --------
    >>> import numpy as np, progiso
    >>> image = progiso.image_from_array(np.arange(512.0), (8, 8, 8))
    >>> rate = progiso.least_rate(image, 0.5)
    >>> decoded = progiso.decompress(progiso.compress(image, rate=rate)).GetPointData().GetScalars()
    >>> max(abs(decoded.GetValue(i) - i) for i in range(512)) <= 0.5
    True
    """
    tolerance = checked_tolerance(tolerance)
    options = CompressionOptions(
        rate=LEAST_RATE, array=array, component=component, mask_nan=mask_nan
    )
    if relative:
        low, high = describe(compress_with(image, options))["range"]
        if low == high:
            raise ValueError(f"all samples are {low:g}: give a tolerance in their own units")
        tolerance = tolerance * (high - low)
    options = replace(options, rate=None, tolerance=tolerance, progress=progress)
    return describe(compress_with(image, options))["rate"]
