"""MetaImage (``.mha``, ``.mhd``), with all synonyms of its header's fields."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import FilePath
from ..geometry import axes_of
from .files import check_bytes
from .header_text import (
    LONGEST_HEADER,
    checked_geometry,
    data_file,
    decode,
    integers,
    misspelt_fields,
    numbered_files,
    reals,
    shortened,
)
from .source import Description, Geometry, Selection
from .stored import Layout, StoredSource

_ELEMENT_TYPES = {
    "int8": "MET_CHAR",
    "uint8": "MET_UCHAR",
    "int16": "MET_SHORT",
    "uint16": "MET_USHORT",
    "int32": "MET_INT",
    "uint32": "MET_UINT",
    "int64": "MET_LONG_LONG",
    "uint64": "MET_ULONG_LONG",
    "float32": "MET_FLOAT",
    "float64": "MET_DOUBLE",
}

#: What other names the format has for fields; the first one that a header has counts.
_SYNONYMS = {
    "origin": ("Origin", "Offset", "Position", "ImagePosition"),
    "direction": ("TransformMatrix", "Rotation", "Orientation"),
    "spacing": ("ElementSpacing", "ElementSize"),
    "big": ("ElementByteOrderMSB", "BinaryDataByteOrderMSB"),
}

#: Fields that are looked at, or that do not say where samples are or what they mean.
_KNOWN = {
    *(name for names in _SYNONYMS.values() for name in names),
    *"""ObjectType ObjectSubType ObjectSubTypeName TransformType NDims Name ID ParentID Comment
    Color AcquisitionDate CompressedData CompressedDataSize CompressionLevel BinaryData
    CenterOfRotation DistanceUnits AnatomicalOrientation DimSize HeaderSize Modality
    SequenceID ElementMin ElementMax
    ElementNumberOfChannels ElementNBits ElementToIntensityFunctionSlope
    ElementToIntensityFunctionOffset ElementType ElementDataFile""".split(),
}

#: As MetaIO has them on every machine: "long" is four bytes.
_DTYPES = {
    **{element: name for name, element in _ELEMENT_TYPES.items()},
    "MET_LONG": "int32",
    "MET_ULONG": "uint32",
    "MET_ASCII_CHAR": "int8",
}


def open_metaimage(path: Path, selection: Selection) -> StoredSource:
    """Open a MetaImage (``.mha``, ``.mhd``).

    Its world is left-posterior-superior, as ITK takes it. Of ``NDims = 4`` the last axis is time.
    The header is our own to read, as ITK's reader trusts ``CompressedDataSize``, inflates from the
    start for every region, and ends the process where some fields are malformed.
    """
    fields, header_bytes, listed = _header(path)
    sizes, dtype = _layout(path, fields)
    extra = sizes[3] if len(sizes) > 3 else 1
    width, height, depth = (*sizes, 1)[:3]
    files, offset = _data_files(path, fields, header_bytes, listed)
    binary = _flag(path, fields, "BinaryData", True)
    packed = _flag(path, fields, "CompressedData", False)
    layout = Layout(
        files=tuple(files),
        shape=(depth, height, width),
        dtype=dtype,
        encoding="zlib" if packed else "raw" if binary else "text",
        offset=offset,
        components=_integer(path, fields, "ElementNumberOfChannels", 1),
        volumes=extra,
    )
    about = Description(
        what=str(path),
        shape=layout.shape,
        dtype=dtype.newbyteorder("="),
        name="MetaImage",
        geometry=_geometry(path, fields, len(sizes)),
        notes=misspelt_fields(fields, _KNOWN) + _ignored(path, fields),
    )
    return StoredSource(about, layout, selection)


def _header(path: Path) -> tuple[dict[str, str], int, list[str]]:
    """Read the text header, its length, and the lines behind it if they list files.

    ``ElementDataFile`` is always the last field.
    """
    fields: dict[str, str] = {}
    with open(path, "rb") as file:
        while "ElementDataFile" not in fields:
            line = decode(file.readline(2**16))
            key, _, value = line.partition("=" if "=" in line else ":")
            foreign = not fields and key.strip() not in _KNOWN
            if not line or foreign or file.tell() > LONGEST_HEADER:
                lacking = "has no ElementDataFile" if fields else "is not a MetaImage"
                raise ValueError(f"'{path}' {lacking}")
            fields[key.strip()] = value.strip()
        header_bytes, names = file.tell(), b""
        if fields["ElementDataFile"].split()[:1] == ["LIST"]:
            names = file.read(LONGEST_HEADER)
    return (
        fields,
        header_bytes,
        [decode(line).strip() for line in names.splitlines() if line.strip()],
    )


def _layout(path: Path, fields: dict[str, str]) -> tuple[list[int], np.dtype[Any]]:
    """Return the sizes, fastest axis first, and the sample type with its byte order."""
    for key in ("NDims", "DimSize", "ElementType"):
        if key not in fields:
            raise ValueError(f"'{path}' lacks the field '{key}'")
    if fields.get("ObjectType", "Image").lower() != "image":
        raise ValueError(f"'{path}' holds a {shortened(fields['ObjectType'])}, not an image")
    count = _integer(path, fields, "NDims", 3)
    if count not in (2, 3, 4):
        raise ValueError(f"'{path}' is no volume: NDims = {count}")
    sizes = integers(path, "DimSize", fields["DimSize"], count)
    if min(sizes) < 1:
        raise ValueError(f"'{path}' holds no samples: DimSize = {fields['DimSize']}")
    if fields["ElementType"] not in _DTYPES:
        raise ValueError(
            f"'{path}': the ElementType '{shortened(fields['ElementType'])}' is not supported"
        )
    big = any(_flag(path, fields, key, False) for key in _SYNONYMS["big"])
    return sizes, np.dtype(_DTYPES[fields["ElementType"]]).newbyteorder(">" if big else "<")


def _data_files(
    path: Path, fields: dict[str, str], header_bytes: int, listed: list[str]
) -> tuple[list[Path], int]:
    """Return the files with the samples, and how many bytes come first in them."""
    name, offset = fields["ElementDataFile"], _integer(path, fields, "HeaderSize", 0)
    if offset < -1:
        raise ValueError(f"'{path}': HeaderSize = {offset}")
    if name.upper() == "LOCAL":
        return [path], offset or header_bytes
    words = name.split()
    if words[:1] == ["LIST"]:
        if not listed:
            raise ValueError(f"'{path}' lists no data files")
        return [data_file(path, line) for line in listed], offset
    if len(words) in (3, 4) and "%" in words[0]:
        first, last, step = (*integers(path, "ElementDataFile", " ".join(words[1:])), 1)[:3]
        return numbered_files(path, words[0], first, last, step), offset
    return [data_file(path, name)], offset


def _geometry(path: Path, fields: dict[str, str], count: int) -> Geometry:
    """Return the place of the first three axes."""
    spacing, origin, matrix = np.ones(3), np.zeros(3), np.eye(3)
    used = min(count, 3)
    for kind, target, values in (("spacing", spacing, count), ("origin", origin, count)):
        key = next((k for k in _SYNONYMS[kind] if k in fields), None)
        if key is not None:
            target[:used] = reals(path, key, fields[key], values)[:used]
    key = next((k for k in _SYNONYMS["direction"] if k in fields), None)
    if key is not None:
        # the file lists one axis after the other: its rows are the direction's columns
        rows = np.reshape(reals(path, key, fields[key], count * count), (count, count))
        matrix[:used, :used] = rows[:used, :used].T
    units = fields.get("DistanceUnits")
    return checked_geometry(
        path, matrix * spacing, origin, units=None if units in ("?", "") else units, space="LPS"
    )


def _ignored(path: Path, fields: dict[str, str]) -> tuple[str, ...]:
    """Tell of a scale of the samples, which ITK does not apply either."""
    for key, none in (("Slope", 1.0), ("Offset", 0.0)):
        key = "ElementToIntensityFunction" + key
        if key in fields and reals(path, key, fields[key], 1) != [none]:
            return (f"its {key}, {fields[key]}, is not applied",)
    return ()


def _flag(path: Path, fields: dict[str, str], key: str, default: bool) -> bool:
    """Read a field as true or false."""
    text = fields.get(key, str(default)).lower()
    if text not in ("true", "false", "1", "0", "t", "f"):
        raise ValueError(
            f"'{path}': the field '{key}' must be True or False, it is '{shortened(text)}'"
        )
    return text[0] in "t1"


def _integer(path: Path, fields: dict[str, str], key: str, default: int) -> int:
    return integers(path, key, fields[key], 1)[0] if key in fields else default


def write_metaimage(image: vtkImageData, path: FilePath) -> None:
    """Write the active scalars as an uncompressed ``.mha`` with the full geometry.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Its extent's offset is folded into the origin.
    path : str or os.PathLike
        The file to write.
    """
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    axes, extent = axes_of(image), image.GetExtent()
    origin = np.asarray(image.GetOrigin()) + axes @ np.asarray(extent[::2], float)
    components = values.shape[1] if values.ndim > 1 else 1
    header = {
        "ObjectType": "Image",
        "NDims": 3,
        "BinaryData": True,
        "BinaryDataByteOrderMSB": False,
        "CompressedData": False,
        "TransformMatrix": _numbers((axes / np.asarray(image.GetSpacing())).T),
        "Offset": _numbers(origin),
        "ElementSpacing": _numbers(image.GetSpacing()),
        "DimSize": " ".join(map(str, image.GetDimensions())),
        "ElementNumberOfChannels": components,
        "ElementType": _ELEMENT_TYPES[values.dtype.name],
        "ElementDataFile": "LOCAL",
    }
    text = "".join(f"{key} = {value}\n" for key, value in header.items()).encode()
    with open(path, "wb") as file:
        file.write(text)
        values.astype(values.dtype.newbyteorder("<"), copy=False).tofile(file)
    check_bytes(Path(path), len(text) + values.nbytes)


def _numbers(values: npt.ArrayLike) -> str:
    return " ".join(repr(float(v)) for v in np.ravel(values))
