"""VTK's own image files: ``.vti``, ``.pvti`` and ``.vtk``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSetAttributes, vtkImageData
from vtkmodules.vtkCommonMisc import vtkErrorCode
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOLegacy import vtkDataSetReader
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader,
    vtkXMLImageDataWriter,
    vtkXMLPImageDataReader,
)

from .._typing import Array, Progress
from .._vtk import observe_progress, vtk_errors
from ..compression import is_compressed
from ..geometry import GHOSTS
from ..vtkProgIsoFilters import vtkCompressedVolume
from .files import DISK_FULL
from .footer import add_footer, check_footer
from .images import ImageSource, checked_image, geometry_of, make_active, place_as
from .source import Description, Region, Selection, Source
from .vti_check import check_vti

_POINTS = 0  # vtkDataObject::FieldAssociations

#: VTK's readers that read by extent, by suffix.
_BY_EXTENT: dict[str, Callable[[], Any]] = {
    ".vti": vtkXMLImageDataReader,
    ".pvti": vtkXMLPImageDataReader,
    ".vtkhdf": vtkHDFReader,
}


def open_vtk(path: Path, selection: Selection) -> Source:
    """Open one of VTK's own image files.

    ``.vti``, ``.pvti`` and ``.vtkhdf`` are read by extent where an array of points is asked for, or
    active, and nothing is hidden; what else they hold comes with the whole image. ``.vtk`` is read
    whole, as VTK does.
    """
    if path.suffix.lower() in (".vti", ".pvti"):
        check_footer(path)
    make = _BY_EXTENT.get(path.suffix.lower())
    if make is None:
        return ImageSource(path, read_with(vtkDataSetReader(), path), selection.array)
    if path.suffix.lower() == ".vti":
        check_vti(path)
    array = _plain_array(path, make(), selection.array)
    if array is None:
        return ImageSource(path, read_with(make(), path), selection.array)
    return ExtentSource(path, make, array)


def _plain_array(path: Path, reader: Any, wanted: str | None) -> str | None:
    """Return the array of points that can be read by extent, or None if all has to be read."""
    with vtk_errors(f"cannot read '{path}'"):
        reader.SetFileName(str(path))
        reader.UpdateInformation()
    if not isinstance(reader.GetOutputDataObject(0), vtkImageData):
        return None
    points, cells = reader.GetPointDataArraySelection(), reader.GetCellDataArraySelection()
    names = {points.GetArrayName(i) for i in range(points.GetNumberOfArrays())}
    hidden = GHOSTS in names or cells.ArrayExists(GHOSTS)
    active = vtkDataObject.GetActiveFieldInformation(
        reader.GetOutputInformation(0), _POINTS, vtkDataSetAttributes.SCALARS
    )
    name = wanted or (active.Get(vtkDataObject.FIELD_NAME()) if active is not None else None)
    return None if hidden or name not in names else name


class ExtentSource(Source):
    """An array of points in a file that VTK reads by extent."""

    gives_all_arrays = True

    def __init__(self, path: Path, make: Callable[[], Any], array: str) -> None:
        self._path, self._make, self._array = path, make, array
        with vtk_errors(f"cannot read '{path}'"):
            self._frame = self._read_frame()
        width, height, depth = self._frame.GetDimensions()
        first = self._frame.GetExtent()[::2]
        one = self._read_extent(self._open(), [n for n in first for _ in range(2)])
        self.vtk_type = one.GetDataType()
        super().__init__(
            Description(
                what=str(path),
                shape=(depth, height, width),
                dtype=vtk_to_numpy(one).dtype.newbyteorder("="),
                components=one.GetNumberOfComponents(),
                name=array,
                geometry=geometry_of(self._frame),
            )
        )

    def _read_frame(self) -> vtkImageData:
        """Read all but the arrays of points and cells."""
        reader = self._make()
        reader.SetFileName(str(self._path))
        reader.UpdateInformation()
        reader.GetPointDataArraySelection().DisableAllArrays()
        reader.GetCellDataArraySelection().DisableAllArrays()
        reader.Update()
        return checked_image(self._path, reader.GetOutputDataObject(0))

    def _open(self) -> Any:
        """Make a reader of the array; to open one parses all of a file whose data are in line."""
        reader = self._make()
        reader.SetFileName(str(self._path))
        reader.UpdateInformation()
        reader.GetCellDataArraySelection().DisableAllArrays()
        points = reader.GetPointDataArraySelection()
        points.DisableAllArrays()
        points.EnableArray(self._array)
        return reader

    def _read_extent(self, reader: Any, extent: Sequence[int]) -> vtkDataArray:
        with vtk_errors(f"cannot read '{self._path}'"):
            reader.UpdateExtent(extent)
        image = reader.GetOutputDataObject(0)
        array = image.GetPointData().GetArray(self._array)
        if array is None or tuple(image.GetExtent()) != tuple(extent):
            raise ValueError(f"cannot read {list(extent)} of '{self._path}'")
        return array

    def _read(self, region: Region) -> Array:
        starts = self._frame.GetExtent()[::2]
        extent = [
            start + end
            for start, part in zip(starts, reversed(region))
            for end in (part.start, part.stop - 1)
        ]
        values = vtk_to_numpy(self._read_extent(self.handle, extent))
        return values.reshape(*(part.stop - part.start for part in region), *values.shape[1:])

    def image(self, progress: Progress | None = None) -> vtkImageData:
        image = checked_image(self._path, read_with(self._make(), self._path, progress))
        make_active(image, self._array)
        return image

    def place(self, image: vtkImageData) -> None:
        place_as(image, self._frame)


def read_with(reader: Any, path: Path, progress: Progress | None = None) -> vtkDataObject:
    """Run a VTK reader on a file."""
    observe_progress(reader, progress)
    try:
        with vtk_errors(f"cannot read '{path}'"):
            reader.SetFileName(str(path))
            reader.Update()
    except RuntimeError as error:
        if "not well-formed" in str(error) and _has_raw_appended_data(path):
            raise RuntimeError(
                f"cannot read '{path}': its data are appended raw, which VTK before 9.3.1 cannot "
                "read with a libexpat of 2024 or later; preload libEagerExpat.so (README, "
                "ParaView), or save the file without appended data"
            ) from None
        raise
    return reader.GetOutputDataObject(0)


def _has_raw_appended_data(path: Path) -> bool:
    """Tell whether a file's XML ends where raw bytes begin."""
    with open(path, "rb") as file:
        return b'<AppendedData encoding="raw"' in file.read(2**20)


def write_with(writer: Any, path: Path) -> None:
    """Run a VTK writer that reports failure by an error, by returning 0, or by a code alone."""
    writer.AddObserver("ProgressEvent", lambda *_: None)  # lets Python handle signals meanwhile
    writer.SetFileName(str(path))
    failure = f"cannot write '{path}'"
    try:
        with vtk_errors(failure):
            written = writer.Write()
    except RuntimeError as error:
        code = writer.GetErrorCode()
        if code == vtkErrorCode.OutOfDiskSpaceError or str(error).endswith(" failed"):
            raise RuntimeError(f"{failure}: {_reason(code)}") from error
        raise
    if written == 0 or writer.GetErrorCode() or not path.is_file():
        raise RuntimeError(f"{failure}: {_reason(writer.GetErrorCode())}")


def _reason(code: int) -> str:
    """Say what an error code of VTK means."""
    if code in (0, vtkErrorCode.OutOfDiskSpaceError):
        return DISK_FULL
    return str(vtkErrorCode.GetStringFromErrorCode(code))


def check_xml(path: Path) -> None:
    """Raise `RuntimeError` unless a file of VTK's XML formats ends as one."""
    with open(path, "rb") as file:
        file.seek(max(0, path.stat().st_size - 256))
        if not file.read().rstrip().endswith(b"</VTKFile>"):
            raise RuntimeError(f"cannot write '{path}': {DISK_FULL}")


def write_vti(
    image: vtkImageData, path: Path, *, progress: Progress | None = None, appended: bool = False
) -> None:
    """Write a ``.vti``; a compressed stream is not squeezed a second time.

    Data are in line unless asked otherwise: Debian 12's ParaView cannot read appended data since a
    security update of its XML parser (libexpat1 2.5.0-1+deb12u2).
    """
    writer = vtkXMLImageDataWriter()
    if is_compressed(image):
        writable = vtkImageData()
        writable.ShallowCopy(image)
        image = writable
        vtkCompressedVolume.SpeedUpRanges(image)
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
    write_with(writer, path)
    check_xml(path)
    add_footer(path)
