"""The table of formats: which module reads a file, and what it needs installed."""

from __future__ import annotations

import glob
import importlib
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from .._typing import FilePath
from .errors import header_warnings, reading
from .source import Selection, Source


class Format(NamedTuple):
    """Where a format's reader is.

    Attributes
    ----------
    module : str
        Module of this package with a function ``open_NAME(path, selection) -> Source``.
    opener : str
        That function's name.
    extra : str or None
        Optional dependencies of the package (``pip install progiso[extra]``) that it needs.
    title : str
        For lists and messages.
    arrays : bool
        Whether a file may hold several arrays, of which `Selection.array` chooses.
    """

    module: str
    opener: str
    title: str
    extra: str | None = None
    arrays: bool = False


_VTK = Format("vtk_files", "open_vtk", "VTK", arrays=True)
_ZFP = Format("zfp", "open_zfp", "zfp")
_RAW = Format("raw", "open_raw", "raw samples")
_METAIMAGE = Format("metaimage", "open_metaimage", "MetaImage")
_NRRD = Format("nrrd", "open_nrrd", "NRRD")
_NIFTI = Format("neuroimages", "open_neuroimage", "NIfTI", "medical")
_NEURO = Format("neuroimages", "open_neuroimage", "Analyze, MGH, AFNI, PAR/REC, MINC", "medical")
_GIPL = Format("gipl", "open_gipl", "GIPL")
_DICOM = Format("dicom", "open_dicom", "DICOM", "medical")
_TIFF = Format("tiff", "open_tiff", "TIFF", "tiff")
_HDF5 = Format("hdf5", "open_hdf5", "HDF5", "hdf5", arrays=True)
_PICTURE = Format("folders", "open_picture", "pictures", "pictures")
_ZARR = Format("zarr_files", "open_zarr", "Zarr", "zarr", arrays=True)

#: Formats by suffix, in lower case; the longest that fits is taken.
FORMATS: dict[str, Format] = {
    ".vti": _VTK,
    ".pvti": _VTK,
    ".vtk": _VTK,
    ".vtkhdf": _VTK,
    ".mha": _METAIMAGE,
    ".mhd": _METAIMAGE,
    ".nrrd": _NRRD,
    ".nhdr": _NRRD,
    ".nii": _NIFTI,
    ".nii.gz": _NIFTI,
    **dict.fromkeys(
        ".hdr .hdr.gz .img .img.gz .mgh .mgh.gz .mgz .head .brik .brik.gz .par .rec .mnc".split(),
        _NEURO,
    ),
    **dict.fromkeys((".dcm", ".dicom", ".ima"), _DICOM),
    ".gipl": _GIPL,
    ".gipl.gz": _GIPL,
    ".gii": _NEURO,  # surfaces: refused with the reason
    ".zfp": _ZFP,
    ".raw": _RAW,
    ".tif": _TIFF,
    ".tiff": _TIFF,
    ".btf": _TIFF,
    ".tf8": _TIFF,
    ".lsm": _TIFF,
    ".stk": _TIFF,
    ".h5": _HDF5,
    ".hdf5": _HDF5,
    ".hdf": _HDF5,
    ".nxs": _HDF5,
    ".he5": _HDF5,
    ".ims": _HDF5,
    ".nc": _HDF5,
    ".nc4": _HDF5,
    ".png": _PICTURE,
    ".jpg": _PICTURE,
    ".jpeg": _PICTURE,
    ".bmp": _PICTURE,
    ".jp2": _PICTURE,
    ".zarr": _ZARR,
    ".zarr.zip": _ZARR,
    ".npy": Format("arrays", "open_npy", "NumPy"),
}

#: What reads a file of another suffix.
OTHER = Format("others", "open_other", "other images")

#: What reads a folder that has none of the suffixes above.
FOLDER = Format("folders", "open_folder", "folders of DICOM files or numbered slices")

#: What stands for the magnitude of vectors among their components.
MAGNITUDE = -1

#: What reads files that a pattern of names stands for.
PATTERN = Format("folders", "open_pattern", "numbered slices")


def open_source(path: FilePath, selection: Selection | None = None) -> Source:
    """Open a volume in a file or folder: read its header, and no samples.

    Parameters
    ----------
    path : str or os.PathLike
        A file or folder of a known format. ``file.h5:/group/array`` names an array inside a file,
        ``scan/slice_*.tif`` slices in files of their own.
    selection : Selection, optional
        What of it is wanted, where it holds more than one volume.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError, RuntimeError
        When it is damaged, of an unknown kind, or no volume; the message names it.
    ImportError
        When the format needs a package that is not installed; the message names the extra.
    """
    file, selection = _split(path, selection or Selection())
    kind = format_of(file)
    if kind is not PATTERN and not file.exists():
        raise FileNotFoundError(f"there is no file '{file}'")
    if selection.component == MAGNITUDE:
        raise ValueError(
            f"'{file}' holds no magnitudes (component {MAGNITUDE}), they are computed when samples "
            "are compressed: read it without a component, and give that to `compress` or `render`"
        )
    opener = opener_of(kind, file)
    with reading(file), header_warnings(file):
        source = opener(file, selection)
        if not kind.arrays and selection.array not in (None, source.about.name):
            raise ValueError(
                f"'{file}' has no array {selection.array!r}; it has: {source.about.name!r}"
            )
        if selection.space is not None:
            geometry = source.about.geometry.in_space(selection.space)
            source.about = replace(source.about, geometry=geometry)
        return source


def opener_of(kind: Format, path: Path) -> Callable[[Path, Selection], Source]:
    """Import a format's reader, or raise `ImportError` that names what is missing."""
    try:
        module = importlib.import_module(f".{kind.module}", __package__)
        opener: Callable[[Path, Selection], Source] = getattr(module, kind.opener)
    except ImportError as error:
        if kind.extra is None or (error.name or "").startswith(__package__.split(".")[0]):
            raise
        raise ImportError(
            f"reading '{path}' needs {error.name}: pip install 'progiso[{kind.extra}]'"
        ) from None
    return opener


def format_of(path: Path) -> Format:
    """Return the format of a file or folder, or of files that a pattern names."""
    if glob.has_magic(str(path)) and not path.exists():
        return PATTERN
    suffix = suffix_of(path)
    if suffix in FORMATS:
        return FORMATS[suffix]
    if path.is_dir():
        return FOLDER
    return _DICOM if _is_dicom(path) else OTHER


def _is_dicom(path: Path) -> bool:
    """Tell whether a file is DICOM, whose names often have no suffix."""
    if not path.is_file():
        return False
    with open(path, "rb") as file:
        return file.read(132)[128:] == b"DICM"


def suffix_of(path: FilePath) -> str:
    """Return the longest known suffix of a path, else its last one, in lower case.

    Examples
    --------
    >>> suffix_of("brain.NII.gz"), suffix_of("x.unknown")
    ('.nii.gz', '.unknown')
    """
    name = Path(path).name.lower()
    known = [suffix for suffix in FORMATS if name.endswith(suffix)]
    return max(known, key=len, default=Path(name).suffix)


def _split(path: FilePath, selection: Selection) -> tuple[Path, Selection]:
    """Split ``file.h5:/group/array`` into the file and the array."""
    text = os.fspath(path)
    file, colon, inner = text.partition(":/")
    if colon and not os.path.exists(text) and os.path.exists(file):
        return Path(file), replace(selection, array=inner)
    return Path(text), selection
