"""Reading and writing volumes of every kind under one name each: `read` and `save`."""

from __future__ import annotations

from pathlib import Path

from vtkmodules.vtkIOImage import vtkImageReader2Factory
from vtkmodules.vtkIOLegacy import vtkDataSetReader
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader,
    vtkXMLImageDataWriter,
    vtkXMLPImageDataReader,
)

from .._vtk import captured_output, observe_progress, vtk_errors
from ..compression import compress, is_compressed
from ..geometry import as_image
from ..vtkProgIsoFilters import vtkZFPReader, vtkZFPWriter
from .files import atomic_path, check_output
from .metaimage import metaimage_slabs, read_metaimage, write_metaimage
from .nifti import nifti_slabs, read_nibabel, read_nifti, write_nifti
from .nrrd import nrrd_slabs, read_nrrd
from .raw import raw_slabs, read_raw, write_raw
from .slabs import build


def read(path, dimensions=None, rate=None, progress=None):
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
        return _read_zfp(path, dimensions, rate)
    if suffix in _VTK_READERS:
        image = _read_with(_VTK_READERS[suffix](), path, progress)
    else:
        image = _READERS.get(suffix, _read_other)(path)
    return _checked(image, path)


def compress_file(
    path, rate=8.0, array=None, component=0, threads=0, progress=None, mask_nan=False
):
    """Compress a volume in a file, some slices at a time where the file allows it.

    The result is bit for bit that of `compress` on what `read` gives. ``.raw``, ``.nrrd``,
    ``.nhdr``, ``.nii``, ``.nii.gz``, ``.mha`` and ``.mhd`` are never in memory as a whole, whether
    their samples are compressed or not: what is held is the result and some tens of MiB, or 4
    slices where these are more. Other formats are read as a whole, as are these when their samples
    are text, lie in several files, or are compressed and begin with the last slice.

    Parameters
    ----------
    path : str or os.PathLike
        Of any kind that `read` knows.
    rate, array, component, threads
        As in `compress`.
    progress : callable, optional
        Called with the fraction done, from 0 to 1.
    mask_nan : bool, default: False
        Whether NaN and infinite samples are hidden, as in `compress`.

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
    if not 0 < rate <= 32:
        raise ValueError(f"rate must be in (0, 32] bits per sample, got {rate:g}")
    source = _SLABS.get(suffix_of(path), lambda path: None)(path)
    if source is None:
        image = read(path, progress=_part(progress, 0.0))
        return compress(
            image,
            rate=rate,
            array=array,
            component=component,
            threads=threads,
            progress=_part(progress, 0.5),
            mask_nan=mask_nan,
        )
    if array not in (None, source.name):
        raise ValueError(f"the image has no array {array!r}; it has: {source.name!r}")
    volume = build(
        source.vtk_arrays(),
        source.dimensions,
        rate,
        source.name,
        component,
        threads,
        progress,
        mask_nan,
    )
    source.place(volume)
    return volume


def _existing(path):
    """The path of a file that is there."""
    path = Path(path)
    if path.is_dir():
        raise IsADirectoryError(f"'{path}' is a folder: name a file")
    if not path.is_file():
        raise FileNotFoundError(f"there is no file '{path}'")
    return path


def _part(progress, start):
    """Progress of one half of the work."""
    return None if progress is None else lambda fraction: progress(start + 0.5 * fraction)


def suffix_of(path):
    """Lower-case suffix of a path, ``.nii.gz`` counting as one.

    Examples
    --------
    >>> suffix_of("brain.NII.gz")
    '.nii.gz'
    """
    name = Path(path).name.lower()
    return ".nii.gz" if name.endswith(".nii.gz") else Path(name).suffix


def _read_with(reader, path, progress=None):
    """Run a VTK reader on a file."""
    observe_progress(reader, progress)
    with vtk_errors(f"cannot read '{path}'"):
        reader.SetFileName(str(path))
        reader.Update()
    return reader.GetOutputDataObject(0)


def _read_zfp(path, dimensions, rate):
    """Read zfp's own format; without header it cannot be told apart from anything else."""
    reader = vtkZFPReader()
    if dimensions is not None:
        reader.SetDataDimensions([int(n) for n in dimensions])
        reader.SetRate(8.0 if rate is None else rate)
    elif not reader.CanReadFile(str(path)):
        raise ValueError(
            f"'{path}' has no zfp header of a fixed-rate 3-D float32 array; give dimensions and "
            "rate of a file without header"
        )
    reader.SetArrayName(path.stem)
    return _read_with(reader, path)


def _read_other(path):
    """Ask nibabel, then VTK's readers of picture formats."""
    try:
        return read_nibabel(path)
    except (ImportError, ValueError) as error:
        with captured_output():  # readers that find nothing of theirs say so
            reader = vtkImageReader2Factory.CreateImageReader2(str(path))
        # one of them takes any file for its own, and crashes on it
        if reader is not None and suffix_of(path) in reader.GetFileExtensions().lower().split():
            return _read_with(reader, path)
        known = ", ".join((*_VTK_READERS, *_READERS, ".zfp"))
        more = "; with nibabel also what that reads" if isinstance(error, ImportError) else ""
        raise ValueError(f"do not know how to read '{path}' (known: {known}{more})") from None


def _checked(image, path):
    """Refuse what is no volume, with the file's name."""
    if image is None or not image.IsA("vtkImageData"):
        kind = "nothing" if image is None else f"a {image.GetClassName()}"
        raise ValueError(f"'{path}' holds {kind}, not an image (vtkImageData)")
    if image.GetNumberOfPoints() == 0:
        raise ValueError(f"'{path}' holds an empty image")
    return image


_VTK_READERS = {
    ".vti": vtkXMLImageDataReader,
    ".pvti": vtkXMLPImageDataReader,
    ".vtk": vtkDataSetReader,
}
_READERS = {
    ".mha": read_metaimage,
    ".mhd": read_metaimage,
    ".nrrd": read_nrrd,
    ".nhdr": read_nrrd,
    ".nii": read_nifti,
    ".nii.gz": read_nifti,
    ".raw": read_raw,
}
_SLABS = {
    ".mha": metaimage_slabs,
    ".mhd": metaimage_slabs,
    ".nrrd": nrrd_slabs,
    ".nhdr": nrrd_slabs,
    ".nii": nifti_slabs,
    ".nii.gz": nifti_slabs,
    ".raw": raw_slabs,
}


def save(image, path, progress=None, appended=False):
    """Write a volume to a file, which appears under its name only when it is complete.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData or numpy.ndarray
        Plain, or compressed (for ``.vti`` and ``.zfp``). Arrays as in `compress`.
    path : str or os.PathLike
        ``.vti`` keeps everything. ``.zfp`` keeps a compressed volume's stream alone; reading it
        decodes the blocks once, in all cores, to find their range. ``.mha``, ``.nii`` and
        ``.nii.gz`` keep the active point scalars with the geometry, ``.raw`` (named
        ``name_WxHxD_type.raw``) the active point scalars alone.
    progress : callable, optional
        Called with the fraction done, from 0 to 1, while a ``.vti`` is written.
    appended : bool, default: False
        Append a ``.vti``'s data as raw bytes behind its XML: a quarter smaller, and more than ten
        times faster to read than data in line, which VTK decodes from text on one core (seconds
        per GiB). But Debian 12's ParaView cannot read such files; all others do.

    Raises
    ------
    ValueError
        When the suffix is unknown, the format cannot hold this image, or `appended` is asked of
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
    check_output(path, _WRITERS)
    suffix = suffix_of(path)
    image = as_image(image)
    compressed = is_compressed(image)
    if suffix == ".zfp" and not compressed:
        raise ValueError(
            f"'{path}': a .zfp file holds a compressed volume, compress the image first"
        )
    if suffix not in COMPRESSED_SUFFIXES:
        _check_plain(image, path, compressed)
    if appended and suffix != ".vti":
        raise ValueError(f"'{path}': only a .vti file can have its data appended")
    with atomic_path(path) as temporary:
        if suffix == ".vti":
            _write_vti(image, temporary, progress, appended)
        else:
            _WRITERS[suffix](image, temporary)


def _check_plain(image, path, compressed):
    """Formats for plain scalars need them at the points."""
    if compressed:
        raise ValueError(
            f"'{path}': only .vti and .zfp hold a compressed volume, decompress it first"
        )
    if image.GetPointData().GetScalars() is None:
        raise ValueError(
            f"'{path}': the image has no active point scalars; .vti holds other arrays"
        )


def _write_vti(image, path, progress=None, appended=False):
    """Data not squeezed a second time when it is a compressed stream.

    In line unless asked otherwise: Debian 12's ParaView cannot read appended data since a security
    update of its XML parser (libexpat1 2.5.0-1+deb12u2).
    """
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    if appended:
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
    else:
        writer.SetDataModeToBinary()
    writer.SetHeaderTypeToUInt64()
    if is_compressed(image):
        writer.SetCompressorTypeToNone()
    observe_progress(writer, progress)
    _write_with(writer, path)


def _write_with(writer, path):
    """Run a VTK writer that reports failure by an error or by returning 0."""
    with vtk_errors(f"cannot write '{path.name}'"):
        writer.SetFileName(str(path))
        written = writer.Write()
    if not written:
        raise RuntimeError(f"cannot write '{path.name}'")


def _write_zfp(image, path):
    writer = vtkZFPWriter()
    writer.SetInputData(image)
    _write_with(writer, path)


#: Formats for compressed volumes, and for plain ones.
COMPRESSED_SUFFIXES = (".vti", ".zfp")
PLAIN_SUFFIXES = (".vti", ".mha", ".nii", ".nii.gz", ".raw")

_WRITERS = {
    ".vti": _write_vti,
    ".zfp": _write_zfp,
    ".mha": write_metaimage,
    ".nii": write_nifti,
    ".nii.gz": write_nifti,
    ".raw": write_raw,
}
