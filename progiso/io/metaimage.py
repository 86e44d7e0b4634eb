"""MetaImage (``.mha``, ``.mhd``): VTK reads the samples but ignores the orientation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import get_vtk_to_numpy_typemap, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkMetaImageReader

from .._typing import FilePath
from .._vtk import dimensions_of, place_as_read, vtk_errors
from ..geometry import axes_of, set_axes
from .slab_files import Inflated, SlabFile, opened_at

#: The text header.
_Fields = dict[str, str]

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


def read_metaimage(path: FilePath) -> vtkImageData:
    """Read a MetaImage with its ``TransformMatrix`` as the direction matrix.

    Parameters
    ----------
    path : str or os.PathLike
        A ``.mha`` or ``.mhd`` file.

    Returns
    -------
    vtkmodules.vtkCommonDataModel.vtkImageData
        In the file's own world coordinates (usually left-posterior-superior).
    """
    reader = _reader(path)
    with vtk_errors(f"cannot read '{path}'"):
        reader.Update()
    image = reader.GetOutput()
    _set_direction(image, _header(path)[0])
    return image


def _set_direction(image: vtkImageData, fields: _Fields) -> None:
    """Set the direction that VTK ignores."""
    transform = fields.get("TransformMatrix")
    if transform and len(transform.split()) == 9:
        # The file lists one axis after the other: its rows are the direction's columns.
        direction = np.array(transform.split(), float).reshape(3, 3).T
        set_axes(image, direction * np.asarray(image.GetSpacing()), image.GetOrigin())


def metaimage_slabs(path: FilePath) -> SlabFile | None:
    """Open a MetaImage to be read some slices at a time; errors as in `read_metaimage`.

    Returns
    -------
    SlabFile or None
        None when its samples are text, in several files, not three-dimensional, or of a type whose
        size depends on the machine.
    """
    path = Path(path)
    fields, header_bytes = _header(path)
    data = fields.get("ElementDataFile", "")
    plain = _flag(fields, "BinaryData") and data.split()[:1] != ["LIST"] and "%" not in data
    long = fields.get("ElementType", "").endswith("LONG")
    if fields.get("NDims") != "3" or not plain or long:
        return None
    reader = _reader(path)
    with vtk_errors(f"cannot read '{path}'"):
        reader.UpdateInformation()
    kind = reader.GetDataScalarType()
    big = _flag(fields, "BinaryDataByteOrderMSB") or _flag(fields, "ElementByteOrderMSB")
    dtype = np.dtype(get_vtk_to_numpy_typemap()[kind]).newbyteorder(">" if big else "<")
    dimensions, components = dimensions_of(reader), reader.GetNumberOfScalarComponents()
    local = data.upper() == "LOCAL"
    offset = int(fields.get("HeaderSize", 0)) or (header_bytes if local else 0)
    if offset == -1:  # the samples end the file
        offset = -int(np.prod(dimensions, dtype=object)) * components * dtype.itemsize
    wrap = Inflated if _flag(fields, "CompressedData") else None

    def place(image: vtkImageData) -> None:
        place_as_read(image, reader)
        _set_direction(image, fields)

    return SlabFile(
        path,
        "MetaImage",
        dimensions,
        dtype,
        open=opened_at(path if local else path.parent / data, offset, wrap=wrap),
        place=place,
        components=components,
        vtk_type=kind,
    )


def _flag(fields: _Fields, key: str) -> bool:
    return fields.get(key, "False").lower() in ("true", "1")


def _reader(path: FilePath) -> vtkMetaImageReader:
    reader = vtkMetaImageReader()
    if not reader.CanReadFile(str(path)):
        raise ValueError(f"'{path}' is not a MetaImage")
    reader.SetFileName(str(path))
    return reader


def _header(path: FilePath) -> tuple[_Fields, int]:
    """Read the text header, and its length; ElementDataFile is always its last field."""
    fields: _Fields = {}
    with open(path, "rb") as file:
        for line in iter(lambda: file.readline(4096), b""):
            key, _, value = line.decode("latin-1").partition("=")
            fields[key.strip()] = value.strip()
            if key.strip() == "ElementDataFile":
                break
        return fields, file.tell()


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
    with open(path, "wb") as file:
        file.write("".join(f"{key} = {value}\n" for key, value in header.items()).encode())
        values.astype(values.dtype.newbyteorder("<"), copy=False).tofile(file)


def _numbers(values: npt.ArrayLike) -> str:
    return " ".join(repr(float(v)) for v in np.ravel(values))
