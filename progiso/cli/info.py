"""What `progiso info` tells of a volume."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkImageData

import progiso

from .._typing import Progress
from ..io import Source
from ..io.footer import check_footer
from ..vtkProgIsoFilters import vtkCompressedVolume


def describe_source(source: Source, progress: Progress | None) -> dict[str, Any]:
    """Collect what a file tells of its volume, and the range of its values.

    Samples are read some slices at a time, unless the format gives whole images.
    """
    if source.gives_all_arrays:
        return {**describe_image(source.image(progress)), **_describe_header(source)}
    image = vtkImageData()
    image.SetDimensions(source.about.dimensions)
    source.place(image)
    about = describe_image(image)
    about["point arrays"] = {source.about.name: _describe_samples(source, progress)}
    return {**about, **_describe_header(source)}


def verify_source(source: Source, path: Path) -> dict[str, str]:
    """Check all that a file's checksums cover, and decode or read everything else.

    Returns
    -------
    dict of str to str
        What was checked, and how.

    Raises
    ------
    ValueError
        When something is damaged; the message names the place.
    """
    facts = {}
    if path.suffix.lower() == ".vti":
        has_line = check_footer(path)
        size = path.stat().st_size
        facts["file"] = (
            f"{size} bytes match their checksums" if has_line else "has no checksums of its own"
        )
    image = source.image() if source.more_than_samples else None
    if image is None or not progiso.is_compressed(image):
        facts["samples"] = "all were read; they have no checksums"
        return facts
    volume, decoded = vtkCompressedVolume(), [0.0, 0.0]
    if not volume.Read(image):
        raise ValueError(f"'{path}' is {volume.GetErrorMessage()}")
    levels = [volume.GetLevel(number + 1) for number in range(volume.GetNumberOfLevels())]
    for number, each in enumerate((volume, *levels)):
        of_level = f" of level {number}" if number else ""
        if not each.FindDecodedRange(decoded):
            raise ValueError(
                f"'{path}' is damaged: blocks{of_level} decode to values that are not finite"
            )
        wrong = each.CheckRanges()
        if wrong:
            raise ValueError(f"'{path}' has{of_level} ranges of values that {wrong}")
        pages = -(-each.GetStream().GetNumberOfValues() // each.PageBytes)
        checked = each.GetHasChecksums() and path.suffix.lower() != ".zfp"
        low, high = decoded
        facts[f"stream{of_level}"] = (
            f"{pages} pages match their checksums" if checked else "has no checksums"
        )
        facts[f"ranges{of_level}"] = (
            f"those of {each.GetNumberOfBlocks()} blocks, {each.GetRangeBytes()} bytes, are right"
            if each.HasRanges()
            else "are not stored"
        )
        facts[f"blocks{of_level}"] = (
            f"{each.GetNumberOfBlocks()} decode to values from {low:.9g} to {high:.9g}"
        )
    return facts


def describe_image(image: vtkImageData) -> dict[str, Any]:
    """Collect geometry, arrays and, of a compressed volume, its metadata."""
    matrix = image.GetDirectionMatrix()
    about = {
        "dimensions": list(image.GetDimensions()),
        "extent": list(image.GetExtent()),
        "spacing": list(image.GetSpacing()),
        "origin": list(image.GetOrigin()),
        "direction": [matrix.GetElement(i, j) for i in range(3) for j in range(3)],
        "bounds": list(image.GetBounds()),
        "point arrays": _describe_arrays(image.GetPointData()),
        "cell arrays": _describe_arrays(image.GetCellData()),
    }
    if progiso.is_compressed(image):
        about["compressed"] = progiso.describe(image)
    return {key: value for key, value in about.items() if value != {}}


def _describe_arrays(attributes: vtkDataSetAttributes) -> dict[str, Any]:
    """Collect type, components and range of every array, by name."""
    arrays = (attributes.GetAbstractArray(i) for i in range(attributes.GetNumberOfArrays()))
    return {
        array.GetName() or "(unnamed)": {
            "type": array.GetDataTypeAsString(),
            "components": array.GetNumberOfComponents(),
            **({"range": _range_of(array)} if hasattr(array, "GetRange") else {}),
        }
        for array in arrays
    }


def _range_of(array: vtkDataArray) -> list[Any]:
    """Return an array's least and greatest value; of several components a pair for each."""
    ranges = [list(array.GetRange(i)) for i in range(array.GetNumberOfComponents())]
    return ranges[0] if len(ranges) == 1 else ranges


def _describe_samples(source: Source, progress: Progress | None) -> dict[str, Any]:
    """Find the type, the components and the range of a source's samples, as of an array."""
    components, depth = source.about.components, source.shape[0]
    low, high, done, hidden = np.full(components, np.inf), np.full(components, -np.inf), 0, 0
    for slab in source.slabs():
        done += len(slab)
        hidden += int(np.ma.getmaskarray(slab).sum()) // components
        values = slab.reshape(-1, components)
        if values.dtype.kind == "f":
            values = np.ma.masked_invalid(values)
        if np.ma.count(values):
            low = np.fmin(low, np.ma.filled(values.min(axis=0).astype(float), np.inf))
            high = np.fmax(high, np.ma.filled(values.max(axis=0).astype(float), -np.inf))
        if progress is not None:
            progress(done / depth)
    ranges = [[float(a), float(b)] for a, b in zip(low, high)]
    kind = numpy_to_vtk(np.empty(0, source.dtype), array_type=source.vtk_type)
    return {
        "type": kind.GetDataTypeAsString(),
        "components": components,
        "range": ranges[0] if components == 1 else ranges,
        **({"hidden": hidden} if hidden else {}),
    }


def _describe_header(source: Source) -> dict[str, Any]:
    """Collect what else a header tells, where it tells anything."""
    about = source.about
    facts = {
        "space": about.geometry.space,
        "units": about.geometry.units,
        "chunks": list(about.chunks[::-1]) if about.chunks else None,
        "channels": list(about.channels) or None,
        "time points": about.times if about.times > 1 else None,
        "series": list(about.series) or None,
        "labels": about.labels,
        "notes": list(about.notes) or None,
    }
    return {key: value for key, value in facts.items() if value is not None}


def file_bytes(path: Path) -> int:
    """Return the size of a file, or of all files in a folder; ``file.h5:/array`` counts as one."""
    if not path.exists():
        path = Path(str(path).partition(":/")[0])
    if path.is_dir():
        return sum(file.stat().st_size for file in path.rglob("*") if file.is_file())
    return path.stat().st_size
