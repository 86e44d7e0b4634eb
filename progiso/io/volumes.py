"""Read, save and compress volumes in files of every kind, chosen by suffix."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData

from .._typing import FilePath, ImageLike, Progress
from ..compression import checked_rate, compress_with, is_compressed
from ..geometry import as_image
from ..options import CompressionKeywords, CompressionOptions
from .files import atomic_path, check_output
from .metaimage import metaimage_slabs, read_metaimage, write_metaimage
from .nifti import nifti_slabs, read_nifti, write_nifti
from .nrrd import nrrd_slabs, read_nrrd
from .others import read_other
from .raw import raw_slabs, read_raw, write_raw
from .slab_files import SlabFile
from .slabs import build
from .vtk_files import VTK_READERS, read_with, write_vti
from .zfp import read_zfp, write_zfp

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Format(NamedTuple):
    """What a module of this package does with files of one suffix.

    Attributes
    ----------
    read : callable
        Returns the image in a file.
    slabs : callable, optional
        Opens a file to be read some slices at a time; returns None where its samples do not allow
        it.
    write : callable, optional
        Writes an image with active point scalars.
    """

    read: Callable[[Path], vtkImageData]
    slabs: Callable[[Path], SlabFile | None] | None = None
    write: Callable[[vtkImageData, Path], None] | None = None


_METAIMAGE = Format(read_metaimage, metaimage_slabs, write_metaimage)
_NRRD = Format(read_nrrd, nrrd_slabs)
_NIFTI = Format(read_nifti, nifti_slabs, write_nifti)

#: Formats for plain images by suffix; VTK's own and zfp's, which also hold compressed volumes, are
#: handled apart.
FORMATS = {
    ".mha": _METAIMAGE,
    ".mhd": _METAIMAGE._replace(write=None),
    ".nrrd": _NRRD,
    ".nhdr": _NRRD,
    ".nii": _NIFTI,
    ".nii.gz": _NIFTI,
    ".raw": Format(read_raw, raw_slabs, write_raw),
}

_WRITERS = {suffix: kind.write for suffix, kind in FORMATS.items() if kind.write is not None}

#: Suffixes of files that hold compressed volumes, and plain ones.
COMPRESSED_SUFFIXES = (".vti", ".zfp")
PLAIN_SUFFIXES = (".vti", *_WRITERS)


def read(
    path: FilePath,
    *,
    dimensions: Sequence[int] | None = None,
    rate: float | None = None,
    progress: Progress | None = None,
) -> vtkImageData:
    """Read a volume from a file.

    Parameters
    ----------
    path : str or os.PathLike
        By its suffix: ``.vti .pvti .vtk .mha .mhd .nrrd .nhdr .nii .nii.gz .zfp``, ``.raw`` named
        ``name_WxHxD_type.raw``, other image formats that VTK reads, and those that nibabel reads.
    dimensions : sequence of int, optional
        Samples along x, y and z of a ``.zfp`` file without header.
    rate : float, optional
        Bits per sample of a ``.zfp`` file without header.
    progress : callable, optional
        Called with the fraction done, from 0 to 1, while VTK reads.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        Plain or compressed. Raw files are memory-mapped: do not write to their scalars.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError, RuntimeError
        When the file is damaged, of an unknown kind, or no image; the message names the file.
    ImportError
        When only nibabel can read it, and it is not installed.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> progiso.read(fetch("sphere", size=16)).GetDimensions()
    (16, 16, 16)
    """
    path = _existing(path)
    suffix = suffix_of(path)
    if suffix == ".zfp":
        found = read_zfp(path, dimensions, rate)
    elif suffix in VTK_READERS:
        found = read_with(VTK_READERS[suffix](), path, progress)
    elif suffix in FORMATS:
        found = FORMATS[suffix].read(path)
    else:
        found = read_other(path, (*VTK_READERS, *FORMATS, ".zfp"))
    return _checked(found, path)


def compress_file(path: FilePath, **options: Unpack[CompressionKeywords]) -> vtkImageData:
    """Compress a volume in a file, some slices at a time where the file allows it.

    The result is bit for bit that of `compress` on what `read` returns. ``.raw``, ``.nrrd``,
    ``.nhdr``, ``.nii``, ``.nii.gz``, ``.mha`` and ``.mhd`` are never in memory as a whole, whether
    their samples are compressed or not: memory holds the result and some tens of MiB, or 4 slices
    where these are larger. Other formats are read as a whole, as are these when their samples are
    text, lie in several files, or are compressed and begin with the last slice.

    Parameters
    ----------
    path : str or os.PathLike
        Of any kind that `read` knows.
    **options
        ``rate``, ``array``, ``component``, ``mask_nan``, ``threads`` and ``progress`` as in
        `compress`.

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
    path = _existing(path)
    chosen = CompressionOptions(**options)
    checked_rate(chosen.rate)
    kind = FORMATS.get(suffix_of(path))
    source = kind.slabs(path) if kind is not None and kind.slabs is not None else None
    if source is None:
        image = read(path, progress=_half(chosen.progress, 0))
        return compress_with(image, replace(chosen, progress=_half(chosen.progress, 1)))
    if chosen.array not in (None, source.name):
        raise ValueError(f"the image has no array {chosen.array!r}; it has: {source.name!r}")
    volume = build(source.vtk_arrays(), source.dimensions, source.name, chosen)
    source.place(volume)
    return volume


def _existing(path: FilePath) -> Path:
    """Return the path of a file that is there, or raise."""
    path = Path(path)
    if path.is_dir():
        raise IsADirectoryError(f"'{path}' is a folder: name a file")
    if not path.is_file():
        raise FileNotFoundError(f"there is no file '{path}'")
    return path


def _half(progress: Progress | None, number: int) -> Progress | None:
    """Return the progress of the first (0) or the second half (1) of the work."""
    return None if progress is None else lambda fraction: progress((number + fraction) / 2)


def suffix_of(path: FilePath) -> str:
    """Return the lower-case suffix of a path; ``.nii.gz`` counts as one.

    Examples
    --------
    >>> suffix_of("brain.NII.gz")
    '.nii.gz'
    """
    name = Path(path).name.lower()
    return ".nii.gz" if name.endswith(".nii.gz") else Path(name).suffix


def _checked(image: vtkDataObject | None, path: Path) -> vtkImageData:
    """Return an image that is not empty, or raise."""
    if not isinstance(image, vtkImageData):
        kind = "nothing" if image is None else f"a {image.GetClassName()}"
        raise ValueError(f"'{path}' holds {kind}, not an image (vtkImageData)")
    if image.GetNumberOfPoints() == 0:
        raise ValueError(f"'{path}' holds an empty image")
    return image


def save(
    image: ImageLike, path: FilePath, *, progress: Progress | None = None, appended: bool = False
) -> None:
    """Write a volume to a file, which appears under its name only when it is complete.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain, or compressed (for ``.vti`` and ``.zfp``). Arrays as in `compress`.
    path : str or os.PathLike
        ``.vti`` keeps everything. ``.zfp`` keeps a compressed volume's stream alone; reading it
        decodes the blocks once, on all cores, to find their range. ``.mha``, ``.nii`` and
        ``.nii.gz`` keep the active point scalars with the geometry, ``.raw`` (named
        ``name_WxHxD_type.raw``) the active point scalars alone.
    progress : callable, optional
        Called with the fraction done, from 0 to 1, while a ``.vti`` is written.
    appended : bool, default: False
        Append a ``.vti``'s data as raw bytes behind its XML: the file is a quarter smaller, and
        more than ten times faster to read than data in line, which VTK decodes from text on one
        core (seconds per GiB). Debian 12's ParaView cannot read such files.

    Raises
    ------
    ValueError
        When the suffix is unknown, the format cannot hold this image, or `appended` is given for
        another format than ``.vti``.
    FileNotFoundError
        When the folder does not exist.
    RuntimeError
        When writing fails; nothing is left behind.

    Examples
    --------
    >>> import os, tempfile, progiso
    >>> from progiso.data import fetch
    >>> volume = progiso.compress(progiso.read(fetch("sphere", size=32)), rate=4)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     progiso.save(volume, os.path.join(folder, "sphere.vti"))
    """
    check_output(path, (*COMPRESSED_SUFFIXES, *_WRITERS))
    suffix = suffix_of(path)
    image = as_image(image)
    _check_suits(image, path, suffix)
    if appended and suffix != ".vti":
        raise ValueError(f"'{path}': only a .vti file can have its data appended")
    with atomic_path(path) as temporary:
        if suffix == ".vti":
            write_vti(image, temporary, progress=progress, appended=appended)
        elif suffix == ".zfp":
            write_zfp(image, temporary)
        else:
            _WRITERS[suffix](image, temporary)


def _check_suits(image: vtkImageData, path: FilePath, suffix: str) -> None:
    """Raise where a format cannot hold an image."""
    compressed = is_compressed(image)
    if suffix == ".zfp" and not compressed:
        raise ValueError(
            f"'{path}': a .zfp file holds a compressed volume, compress the image first"
        )
    if suffix in COMPRESSED_SUFFIXES:
        return
    if compressed:
        raise ValueError(
            f"'{path}': only .vti and .zfp hold a compressed volume, decompress it first"
        )
    if image.GetPointData().GetScalars() is None:
        raise ValueError(
            f"'{path}': the image has no active point scalars; .vti holds other arrays"
        )
