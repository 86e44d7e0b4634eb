"""MetaImage (``.mha``, ``.mhd``): VTK reads the samples but passes over the orientation."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkMetaImageReader

from ._vtk import vtk_errors
from .geometry import axes_of, set_axes

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


def read_metaimage(path):
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
    reader = vtkMetaImageReader()
    if not reader.CanReadFile(str(path)):
        raise ValueError(f"'{path}' is not a MetaImage")
    with vtk_errors(f"cannot read '{path}'"):
        reader.SetFileName(str(path))
        reader.Update()
    image = reader.GetOutput()
    transform = _header(path).get("TransformMatrix")
    if transform and len(transform.split()) == 9:
        # The file lists one axis after the other: its rows are the direction's columns.
        direction = np.array(transform.split(), float).reshape(3, 3).T
        set_axes(image, direction * np.asarray(image.GetSpacing()), image.GetOrigin())
    return image


def _header(path):
    """Fields of a MetaImage's text header; ElementDataFile is always its last."""
    fields = {}
    with open(path, "rb") as file:
        for line in iter(lambda: file.readline(4096), b""):
            key, _, value = line.decode("latin-1").partition("=")
            fields[key.strip()] = value.strip()
            if key.strip() == "ElementDataFile":
                break
    return fields


def write_metaimage(image, path):
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


def _numbers(values):
    return " ".join(repr(float(v)) for v in np.ravel(values))
