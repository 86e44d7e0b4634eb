"""HDF5 files: plain ones, NeXus, NetCDF-4, Imaris, and arrays whose attributes name their axes."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .._typing import Array
from .axes import AxesSource, Step, Values, choose, lay_out, place, unit_of
from .inside import Coordinates, list_of, only_volume, positional, steps_of
from .source import Description, Selection, Source

with suppress(ImportError):
    import hdf5plugin  # noqa: F401 (registers filters)

#: Attributes that hold the distance of samples along z, y and x, and their unit where it is fixed.
_SPACINGS = {
    "element_size_um": "um",  # ilastik, Fiji's HDF5 plugin, elf
    "element_size_nm": "nm",
    "resolution": "",  # a unit of its own is in "unit"
    "voxel_size": "",
    "spacing": "",
    "pixel_size": "",
}


@dataclass
class Meta:
    """What a file tells about an array besides its samples."""

    axes: Sequence[str] | None = None
    steps: dict[str, Step] = field(default_factory=dict)
    channels: Sequence[str] = ()
    values: Values | None = None
    labels: bool | None = None
    notes: list[str] = field(default_factory=list)


def open_hdf5(path: Path, selection: Selection) -> Source:
    """Open an array of an HDF5 file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    selection : Selection
        ``array`` is its path inside the file. By default it is NeXus' default, or the only array
        of three axes and more. ``channel``, ``time``, ``component``, ``level`` (Imaris).

    Returns
    -------
    Source

    Raises
    ------
    ValueError
        When the file is damaged, or holds no such array, or several; the message lists them.
    ImportError
        When a filter is not installed that the array was compressed by.
    """
    with _opened(path) as file:
        if selection.array is None and "DataSetInfo" in file and "DataSet" in file:
            return _open_imaris(path, file, selection)
        choose(path, "level", selection.level or 0, 1)
        choose(path, "series", selection.series or 0, 1)
        dataset, signal = _find(path, file, selection)
        _check_stored(path, dataset)
        meta = _meta(path, dataset, signal)
        values = meta.values or Values(dataset.dtype)
        layout = lay_out(path, meta.axes, dataset.shape, selection, channels=meta.channels)
        notes = [*layout.notes, *meta.notes]
        chunks = layout.along(dataset.chunks) if dataset.chunks else None
        about = Description(
            what=str(path),
            shape=layout.shape,
            dtype=values.dtype,
            components=layout.components,
            name=dataset.name.rsplit("/", 1)[-1] or path.stem,
            geometry=place(meta.steps, layout.shape, notes),
            chunks=chunks,
            channels=layout.channels,
            times=layout.times,
            labels=meta.labels,
            notes=tuple(notes),
        )
        return Hdf5Source(path, dataset.name, about, layout, values)


class Hdf5Source(AxesSource):
    """An array of an HDF5 file, decompressed chunk by chunk."""

    def __init__(self, path: Path, array: str, *rest: Any) -> None:
        super().__init__(*rest)
        self._path, self._array = path, array

    def _open(self) -> Any:
        return _opened(self._path)

    def _fetch(self, index: tuple[int | slice, ...]) -> Array:
        found: Array = self.handle[self._array][index]
        return found


def _opened(path: Path) -> Any:
    """Open a file to be read."""
    with open(path, "rb") as file:
        if file.read(3) == b"CDF":
            raise ValueError(
                f"'{path}' is classic NetCDF, not NetCDF-4: convert it by nccopy -k nc4"
            )
    return h5py.File(path, "r")


# --- which array ----------------------------------------------------------------------------------


def _find(path: Path, file: Any, selection: Selection) -> tuple[Any, Any]:
    """Return the array that is wanted, and the NeXus group that tells its axes, or None."""
    if selection.array:
        name = selection.array.strip("/")
        if name not in file:
            raise ValueError(f"'{path}' has no array {name!r}; it has {list_of(_arrays(file))}")
        found = file[name]
        if isinstance(found, h5py.Group):
            inside = _default_of(found)
            found = inside if inside is not None else only_volume(path, _arrays(found))
        if not _numeric(found):
            raise ValueError(f"'{path}': {name!r} holds {found.dtype}, not real numbers")
        group = found.parent
        return found, group if _text(group.attrs.get("signal")) == _last(found) else None
    signal = _default_of(file)
    if signal is not None and _numeric(signal) and signal.ndim >= 2:
        return signal, signal.parent
    return only_volume(path, _arrays(file)), None


def _default_of(group: Any) -> Any:
    """Follow NeXus' attributes to the array that is shown by default, or return None."""
    for _ in range(8):
        child = _text(group.attrs.get("default"))
        if not child or not isinstance(group.get(child), h5py.Group):
            break
        group = group[child]
    signal = _text(group.attrs.get("signal"))
    if signal and isinstance(group.get(signal), h5py.Dataset):
        return group[signal]
    for child in group.values():  # older files mark the array itself
        if isinstance(child, h5py.Dataset) and _text(child.attrs.get("signal")) == "1":
            return child
    return None


def _arrays(group: Any) -> dict[str, Any]:
    """Return all arrays of numbers below a group by their paths; linked ones once."""
    found: dict[str, Any] = {}

    def visit(_name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and _numeric(item) and not _is_scale(item):
            found[item.name] = item

    group.visititems(visit)
    return found


def _numeric(item: Any) -> bool:
    return (
        isinstance(item, h5py.Dataset)
        and item.shape is not None
        and item.dtype.kind in "iufb"
        and item.dtype.subdtype is None
    )


def _is_scale(dataset: Any) -> bool:
    return _text(dataset.attrs.get("CLASS")) == "DIMENSION_SCALE"


def _check_stored(path: Path, dataset: Any) -> None:
    """Raise where other files are missing that hold the samples, or what decompresses them.

    HDF5 would fill in samples of missing files, and name a folder of plugins.
    """
    others = (
        [source.file_name for source in dataset.virtual_sources()] if dataset.is_virtual else []
    )
    others += [name for name, _, _ in dataset.external or ()]
    for name in others:
        if name != "." and "%" not in name and not (path.parent / name).exists():
            raise ValueError(f"cannot read '{path}': samples are in '{name}', which is missing")
    properties = dataset.id.get_create_plist()
    for number in range(properties.get_nfilters()):
        code, _, _, name = properties.get_filter(number)
        if not h5py.h5z.filter_avail(code):
            called = _text(name) or "unnamed"
            raise ImportError(
                f"reading '{path}' needs HDF5's filter {code} ({called}), which hdf5plugin may "
                "have: pip install 'progiso[hdf5]'"
            )


# --- what is told of it ---------------------------------------------------------------------------


def _meta(path: Path, dataset: Any, signal: Any) -> Meta:
    """Gather what attributes, NeXus' axes or NetCDF's dimensions tell of an array."""
    meta = Meta(values=_values(dataset))
    tags = _text(dataset.attrs.get("axistags"))
    names = dataset.attrs.get("axes")
    if signal is not None:
        names = signal.attrs.get("axes", names)
    if tags:
        meta.axes = [tag["key"] for tag in json.loads(tags)["axes"]]
    elif signal is not None:
        _read_nexus(dataset, signal, names, meta)
    elif any(len(dimension) for dimension in dataset.dims) or "DIMENSION_LIST" in dataset.attrs:
        _read_dimensions(dataset, meta)
    elif isinstance(names, (str, bytes)) and len(_text(names)) == dataset.ndim:
        meta.axes = list(_text(names))
    elif names is not None and not isinstance(names, (str, bytes)):
        listed = [_text(name) for name in np.ravel(names)]
        meta.axes = listed if len(listed) == dataset.ndim else None
    elif any(dimension.label for dimension in dataset.dims):
        meta.axes = positional([dimension.label for dimension in dataset.dims], {})
    if not meta.steps:
        meta.steps = _attribute_steps(dataset)
    if meta.axes is not None and len(meta.axes) != dataset.ndim:
        meta.notes.append(f"the names of axes {list(meta.axes)} do not fit {dataset.shape}")
        meta.axes = None
    return meta


def _attribute_steps(dataset: Any) -> dict[str, Step]:
    """Return the steps in attributes of an array, along z, y and x."""
    for name, unit in _SPACINGS.items():
        sizes = dataset.attrs.get(name)
        if sizes is None:
            continue
        try:
            sizes = np.broadcast_to(np.asarray(sizes, np.float64).ravel(), (3,))
        except (TypeError, ValueError):
            continue
        if (sizes > 0).all():
            told = unit or unit_of(dataset.attrs.get("unit", dataset.attrs.get("units")))
            start = np.zeros(3)
            with suppress(TypeError, ValueError):
                start = np.broadcast_to(np.asarray(dataset.attrs.get("offset", 0), float), (3,))
            return {a: Step(float(s), float(o), told) for a, s, o in zip("zyx", sizes, start)}
    return {}


def _read_nexus(dataset: Any, group: Any, names: Any, meta: Meta) -> None:
    """Read the axes that a NeXus group names, and their coordinates."""
    text = [_text(name) for name in np.ravel(names)] if names is not None else []
    if len(text) == 1 and dataset.ndim > 1:
        text = text[0].replace("[", "").replace("]", "").replace(",", ":").split(":")
    if len(text) != dataset.ndim:
        if text:
            meta.notes.append(f"NeXus' axes {text} do not fit {dataset.shape}")
        return
    _read_coordinates(dataset, text, {i: group.get(name) for i, name in enumerate(text)}, meta)


def _read_dimensions(dataset: Any, meta: Meta) -> None:
    """Read NetCDF's dimensions, and their coordinates."""
    scales = [dimension[0] if len(dimension) else None for dimension in dataset.dims]
    names = [_last(scale) if scale is not None else "" for scale in scales]
    _read_coordinates(dataset, names, dict(enumerate(scales)), meta)


def _read_coordinates(
    dataset: Any, names: Sequence[str], arrays: Mapping[int, Any], meta: Meta
) -> None:
    """Read the arrays of coordinates that belong to axes, or None."""
    coordinates = {}
    for position, found in arrays.items():
        if found is None or not _numeric(found) or found.ndim != 1 or _is_bare(found):
            continue
        unit = found.attrs.get("units", found.attrs.get("unit"))
        values = _values(found).decode(found[()])
        coordinates[position] = Coordinates(_last(found), values, unit)
    meta.axes = positional(names, {i: found.unit for i, found in coordinates.items()})
    meta.steps = steps_of(meta.axes, coordinates, dataset.shape, meta.notes)


def _is_bare(scale: Any) -> bool:
    """Tell whether a dimension of NetCDF has a length only, and no coordinates."""
    return _text(scale.attrs.get("NAME")).startswith("This is a netCDF dimension but not")


def _values(dataset: Any) -> Values:
    """Read what NetCDF's conventions tell of stored numbers; HDF5's own fill value is a sample."""
    attributes = dataset.attrs
    dtype = dataset.dtype
    if _text(attributes.get("_Unsigned")).lower() == "true" and dtype.kind == "i":
        dtype = np.dtype(f"u{dtype.itemsize}")
    missing: list[Any] = []
    for name in ("_FillValue", "missing_value"):
        for value in np.ravel(attributes.get(name, ())):
            if isinstance(value, np.number):
                missing.append(value.item())
    scale, offset = (
        np.ravel(attributes.get(name, default))[0]
        for name, default in (("scale_factor", np.float32(1)), ("add_offset", np.float32(0)))
    )
    wide = any(np.asarray(v).dtype.itemsize > 4 for v in (scale, offset)) or dtype.itemsize > 2
    return Values(dtype, float(scale), float(offset), tuple(dict.fromkeys(missing)), wide)


# --- Imaris ---------------------------------------------------------------------------------------


def _open_imaris(path: Path, file: Any, selection: Selection) -> Source:
    """Open an Imaris file: levels, time points and channels are groups; chunks are padded."""
    levels = _numbered(file["DataSet"], "ResolutionLevel")
    level = choose(path, "level", selection.level or 0, len(levels))
    times = _numbered(levels[level], "TimePoint")
    notes: list[str] = []
    time = choose(path, "time", selection.time, len(times), notes)
    channels = _numbered(times[time], "Channel")
    info = file["DataSetInfo"]
    names = [
        _chars(info[f"Channel {i}"].attrs.get("Name")) if f"Channel {i}" in info else str(i)
        for i in range(len(channels))
    ]
    number = choose(path, "channel", selection.channel, names, notes)
    choose(path, "series", selection.series or 0, 1)
    choose(path, "component", selection.component or 0, 1)
    group = channels[number]
    dataset = group["Data"]
    _check_stored(path, dataset)
    sizes = [int(_chars(group.attrs[f"ImageSize{axis}"])) for axis in "ZYX"]
    if any(size > n for size, n in zip(sizes, dataset.shape)):
        raise ValueError(f"'{path}' tells of {sizes} samples and holds {dataset.shape}")
    layout = lay_out(path, "zyx", sizes, Selection())
    values = Values(dataset.dtype)
    about = Description(
        what=str(path),
        shape=layout.shape,
        dtype=values.dtype,
        name=path.stem,
        geometry=place(_imaris_steps(info["Image"].attrs, sizes), layout.shape, notes),
        chunks=dataset.chunks,
        channels=tuple(names) if len(names) > 1 else (),
        times=len(times),
        notes=tuple(notes),
    )
    return Hdf5Source(path, dataset.name, about, layout, values)


def _imaris_steps(attributes: Any, sizes: Sequence[int]) -> dict[str, Step]:
    """Return the steps of a box whose sides are those of the outer samples, not their centres."""
    unit = unit_of(_chars(attributes.get("Unit"))) or "um"
    steps = {}
    for number, (axis, size) in enumerate(zip("xyz", reversed(sizes))):
        low, high = (attributes.get(f"Ext{end}{number}") for end in ("Min", "Max"))
        if low is None or high is None:
            continue
        step = (float(_chars(high)) - float(_chars(low))) / size
        steps[axis] = Step(step or None, float(_chars(low)) + step / 2, unit)
    return steps


def _numbered(group: Any, name: str) -> list[Any]:
    """Return the groups "NAME 0", "NAME 1" and so on."""
    found: list[Any] = []
    while f"{name} {len(found)}" in group:
        found.append(group[f"{name} {len(found)}"])
    if not found:
        raise ValueError(f"there is no group '{name} 0' in {group.name}")
    return found


def _chars(value: Any) -> str:
    """Join Imaris' attributes, arrays of characters."""
    if value is None:
        return ""
    return b"".join(np.ravel(np.asarray(value, "S1"))).decode("utf-8", "replace").strip("\x00 ")


def _text(value: Any) -> str:
    """Return an attribute's text, or "" where it is none."""
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.ravel()[0]
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    if isinstance(value, (int, np.integer)):
        return str(value)
    return value if isinstance(value, str) else ""


def _last(item: Any) -> str:
    return str(item.name).rsplit("/", 1)[-1]
