"""Read and save volumes in files of every kind, chosen by suffix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import FilePath, ImageLike, Progress
from ..compression import is_compressed
from .arrays import as_image
from .files import atomic_path, check_output
from .formats import open_source, suffix_of
from .metaimage import write_metaimage
from .nifti import write_nifti
from .raw import write_raw
from .source import Selection
from .vtk_files import write_vti
from .zfp import write_zfp

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .source import SelectionKeywords

#: Writers of plain images with active point scalars; VTK's own and zfp's formats, which also hold
#: compressed volumes, are handled apart.
_WRITERS = {
    ".mha": write_metaimage,
    ".nii": write_nifti,
    ".nii.gz": write_nifti,
    ".raw": write_raw,
}

#: Suffixes of files that hold compressed volumes, and plain ones.
COMPRESSED_SUFFIXES = (".vti", ".zfp")
PLAIN_SUFFIXES = (".vti", *_WRITERS)


def read(
    path: FilePath,
    *,
    dimensions: Sequence[int] | None = None,
    rate: float | None = None,
    progress: Progress | None = None,
    **selection: Unpack[SelectionKeywords],
) -> vtkImageData:
    """Read a volume from a file or folder.

    Parameters
    ----------
    path : str or os.PathLike
        Of a format in ``docs/formats.md``, by its suffix. ``file.h5:/group/array`` names an array
        inside a file. Raw files are named ``name_WxHxD_type.raw``.
    dimensions : sequence of int, optional
        Samples along x, y and z of a ``.zfp`` file without header.
    rate : float, optional
        Bits per sample of a ``.zfp`` file without header.
    progress : callable, optional
        Called with the fraction done, from 0 to 1, while VTK reads.
    **selection
        ``array``, ``component``, ``channel``, ``time``, ``series``, ``level`` and ``space``: what
        of the file is wanted, see `progiso.io.Selection`.

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
        When the format needs a package that is not installed; the message names it.

    Warns
    -----
    UserWarning
        Where the file holds more than one volume, and what was chosen.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> progiso.read(fetch("sphere", size=16)).GetDimensions()
    (16, 16, 16)
    """
    chosen = Selection(dimensions=dimensions, rate=rate, **selection)
    with open_source(path, chosen) as source:
        source.tell_notes()
        return source.image(progress)


def save(
    image: ImageLike, path: FilePath, *, progress: Progress | None = None, appended: bool = False
) -> None:
    """Write a volume to a file, which appears under its name only when it is complete.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain, or compressed (for ``.vti`` and ``.zfp``). Arrays as in `compress`.
    path : str or os.PathLike
        ``.vti`` keeps everything, and ends in a line with checksums of the file. ``.zfp`` keeps a
        compressed volume's stream alone, without any; reading it decodes the blocks once, on all
        cores, to find their range. ``.mha``, ``.nii`` and
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
        When writing fails, as on a full disk; nothing is left behind.

    Notes
    -----
    Of a link, the file that it leads to is replaced; a device or a pipe is written to.

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
