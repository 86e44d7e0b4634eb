"""Zarr stores, versions 2 and 3, sharded too: plain arrays, xarray's, OME-Zarr's pyramids."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

try:
    import zarr
except ValueError as error:  # numcodecs cannot parse the version of some releases of zfpy
    raise RuntimeError(
        f"zarr cannot be imported ({error}); where zfpy is installed: pip install 'zfpy==1.0.1'"
    ) from error
from zarr.storage import LocalStore, ZipStore

from .._typing import Array
from .axes import AxesSource, Step, Values, choose, lay_out, place, role_of, unit_of
from .inside import Coordinates, only_volume, positional, steps_of
from .source import Description, Selection, Source

#: Bytes that are read at a time.
_PIECE_BYTES = 2**21


def open_zarr(path: Path, selection: Selection) -> Source:
    """Open an array of a Zarr store: a folder, or a ``.zip`` file of one.

    Parameters
    ----------
    path : pathlib.Path
        The store. A folder inside one, such as a level or ``labels/nuclei``, is a store, too.
    selection : Selection
        ``array`` is the path of an array or image inside; ``series`` one of several images;
        ``level``, ``channel``, ``time`` and ``component`` what of it.

    Returns
    -------
    Source

    Raises
    ------
    ValueError
        When the store is damaged, or holds no such array, or several; the message lists them.
    """
    store = _store(path)
    try:
        found = zarr.open(store=store, path=selection.array or "", mode="r")
        if isinstance(found, zarr.Group):
            return _open_group(path, found, selection)
        image = _image_of(store, found)
        if image is not None:
            return _open_group(path, image[0], replace(selection, level=image[1]))
        choose(path, "series", selection.series or 0, 1)
        _choose_only_level(path, selection)
        return _open_array(path, found, selection)
    except FileNotFoundError as error:
        where = f" at {selection.array!r}" if selection.array else ""
        raise ValueError(f"'{path}' holds no Zarr array or group{where}: {error}") from error
    finally:
        store.close()


class ZarrSource(AxesSource):
    """An array of a Zarr store, decompressed chunk by chunk."""

    def __init__(self, path: Path, array: str, *rest: Any) -> None:
        super().__init__(*rest)
        self._path, self._array = path, array

    def _open(self) -> _Opened:
        return _Opened(self._path, self._array)

    def _fetch(self, index: tuple[int | slice, ...]) -> Array:
        array = self.handle.array
        starts = [part.start if isinstance(part, slice) else None for part in index]
        found = np.empty([p.stop - p.start for p in index if isinstance(p, slice)], array.dtype)
        for piece in _pieces(index, array.chunks, array.dtype.itemsize):
            target = tuple(
                slice(part.start - start, part.stop - start)
                for part, start in zip(piece, starts)
                if isinstance(part, slice) and start is not None
            )
            try:
                found[target] = array[piece]
            except Exception as error:
                chunk = _damaged_chunk(array, piece)
                where = f"chunk {chunk} of " if chunk else ""
                raise ValueError(
                    f"cannot read {where}'{self._array or '/'}' in '{self._path}': {error}"
                ) from error
        return found


def _pieces(
    index: tuple[int | slice, ...], chunks: Sequence[int], itemsize: int
) -> Iterator[tuple[int | slice, ...]]:
    """Split a region between chunks until pieces are small, as zarr holds each several times."""
    parts = [(axis, part) for axis, part in enumerate(index) if isinstance(part, slice)]
    if math.prod(part.stop - part.start for _, part in parts) * itemsize > _PIECE_BYTES:
        for axis, part in parts:
            size = chunks[axis]
            middle = ((part.start + part.stop) // 2 + size - 1) // size * size
            middle = middle if middle < part.stop else (part.stop - 1) // size * size
            if middle > part.start:
                for half in (slice(part.start, middle), slice(middle, part.stop)):
                    yield from _pieces((*index[:axis], half, *index[axis + 1 :]), chunks, itemsize)
                return
    yield index


class _Opened:
    """An array of an open store."""

    def __init__(self, path: Path, array: str) -> None:
        self._store = _store(path)
        self.array: Any = zarr.open_array(store=self._store, path=array, mode="r")

    def close(self) -> None:
        """Close the store."""
        self._store.close()


def _store(path: Path) -> Any:
    """Open a folder, or a zip file, to be read."""
    return LocalStore(path, read_only=True) if path.is_dir() else ZipStore(path, mode="r")


def _image_of(store: Any, array: Any) -> tuple[Any, int] | None:
    """Return the OME-Zarr group that an array is a level of, and which; None where it is none."""
    folder = array.path.rpartition("/")[0]
    try:
        group = zarr.open_group(store=store, path=folder, mode="r")
    except (FileNotFoundError, ValueError):
        return None
    for scale in _ome(group).get("multiscales") or ():
        for number, level in enumerate(scale.get("datasets", ())):
            if f"{folder}/{level.get('path')}".strip("/") == array.path:
                return group, number
    return None


def _damaged_chunk(array: Any, index: tuple[int | slice, ...]) -> str | None:
    """Return the first chunk of a region that cannot be read."""
    sizes = array.shards or array.chunks
    ranges = []
    for part, size in zip(index, sizes):
        part = slice(part, part + 1) if isinstance(part, int) else part
        ranges.append(range(part.start // size, (part.stop - 1) // size + 1))
    for numbers in np.ndindex(*(len(r) for r in ranges)):
        chunk = [r[n] for r, n in zip(ranges, numbers)]
        try:
            array[tuple(slice(n * size, (n + 1) * size) for n, size in zip(chunk, sizes))]
        except Exception:
            return str(array.metadata.encode_chunk_key(tuple(chunk)))
    return None


# --- plain arrays ---------------------------------------------------------------------------------


def _open_array(path: Path, array: Any, selection: Selection) -> Source:
    """Open an array that no OME-Zarr group describes; xarray's attributes are read."""
    attributes = dict(array.attrs)
    names = attributes.get("_ARRAY_DIMENSIONS") or _names(array)
    notes: list[str] = []
    axes: list[str] | None = None
    steps: dict[str, Step] = {}
    if names is not None and len(names) == array.ndim:
        coordinates = _coordinates(array, names)
        axes = positional(names, {i: found.unit for i, found in coordinates.items()})
        steps = steps_of(axes, coordinates, array.shape, notes)
    values = _values(array, attributes)
    return _described(path, array, selection, axes, steps, values, notes=notes)


def _names(array: Any) -> list[str] | None:
    """Return the names of dimensions of version 3."""
    names = getattr(array.metadata, "dimension_names", None)
    return [name or "" for name in names] if names and any(names) else None


def _coordinates(array: Any, names: Sequence[str]) -> dict[int, Coordinates]:
    """Return the arrays beside an array that are called as its dimensions are."""
    found = {}
    folder = array.path.rpartition("/")[0]
    store = array.store_path.store
    for position, name in enumerate(names):
        inside = f"{folder}/{name}" if folder else name
        if not name or inside == array.path:
            continue
        try:
            beside = zarr.open_array(store=store, path=inside, mode="r")
        except (FileNotFoundError, KeyError):
            continue
        if beside.ndim == 1 and beside.dtype.kind in "iuf":
            attributes = dict(beside.attrs)
            values = _values(beside, attributes).decode(np.asarray(beside[:]))
            found[position] = Coordinates(name, values, attributes.get("units"))
    return found


def _values(array: Any, attributes: Mapping[str, Any]) -> Values:
    """Read what xarray's attributes tell of stored numbers; Zarr's own fill value is a sample."""
    missing = []
    if array.metadata.zarr_format == 2 and "_ARRAY_DIMENSIONS" in attributes:
        attributes = {"_FillValue": array.fill_value} | dict(attributes)  # as xarray reads it
    for name in ("_FillValue", "missing_value"):
        for value in np.ravel(attributes.get(name, ())):
            number = _number(value, array.dtype)
            if number is not None:
                missing.append(number)
    scale, offset = attributes.get("scale_factor", 1.0), attributes.get("add_offset", 0.0)
    return Values(
        array.dtype, float(scale), float(offset), tuple(dict.fromkeys(missing)), wide=True
    )


def _number(value: Any, dtype: np.dtype[Any]) -> float | int | None:
    """Return a number that JSON holds as such, by name, or in base 64 as xarray writes it."""
    import base64

    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            pass
        try:
            raw = base64.standard_b64decode(value)
            return np.frombuffer(raw, np.float64 if dtype.kind == "f" else dtype)[0].item()
        except (ValueError, IndexError):
            return None
    if isinstance(value, np.generic):
        value = value.item()
    return value if isinstance(value, (int, float)) else None


# --- groups ---------------------------------------------------------------------------------------


def _open_group(path: Path, group: Any, selection: Selection) -> Source:
    """Open the image of an OME-Zarr group, or the only array of another group."""
    ome = _ome(group)
    if ome.get("multiscales"):
        return _open_image(path, group, ome, selection)
    images = _images(group)
    if images:
        notes: list[str] = []
        names = list(images)
        number = choose(path, "series", selection.series, names, notes)
        image = images[names[number]]
        return _open_image(path, image, _ome(image), selection, tuple(names), notes)
    choose(path, "series", selection.series or 0, 1)
    _choose_only_level(path, selection)
    found = {
        name: item
        for name, item in group.members(max_depth=None)
        if isinstance(item, zarr.Array) and item.dtype.kind in "iufb"
    }
    return _open_array(path, only_volume(path, found), selection)


def _ome(group: Any) -> dict[str, Any]:
    """Return OME-Zarr's attributes: version 0.5 has them below "ome"."""
    attributes = dict(group.attrs)
    found = attributes.get("ome", attributes)
    return found if isinstance(found, dict) else {}


def _images(group: Any) -> dict[str, Any]:
    """Return the images below a group by name: those of bioformats2raw, of a plate, of labels."""
    found = {}
    for name, item in group.members(max_depth=3):
        if isinstance(item, zarr.Group) and _ome(item).get("multiscales"):
            if "/labels/" not in f"/{name}":  # those of an image, which is here, too
                found[name] = item
    return {name: found[name] for name in sorted(found, key=_natural)}


def _natural(name: str) -> list[Any]:
    """Sort numbers in names by their values."""
    import re

    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def _choose_only_level(path: Path, selection: Selection) -> None:
    choose(path, "level", selection.level or 0, 1)


# --- OME-Zarr -------------------------------------------------------------------------------------


def _open_image(
    path: Path,
    group: Any,
    ome: Mapping[str, Any],
    selection: Selection,
    series: tuple[str, ...] = (),
    notes: Sequence[str] = (),
) -> Source:
    """Open a level of an image."""
    told = list(notes)
    scales = ome["multiscales"]
    if not series:
        names = [str(scale.get("name", i)) for i, scale in enumerate(scales)]
        number = choose(path, "series", selection.series, names, told)
        series = tuple(names) if len(names) > 1 else ()
    else:
        number = 0
    scale = scales[number]
    levels = scale["datasets"]
    level = choose(path, "level", selection.level or 0, len(levels))
    array = group[levels[level]["path"]]
    axes = _axes(scale, array.ndim)
    steps = _transformed(scale, levels[level], axes, array.ndim)
    units = [unit_of(axis.get("unit")) if isinstance(axis, dict) else None for axis in axes]
    names_of_axes = [str(a.get("name", "")) if isinstance(a, dict) else str(a) for a in axes]
    roles = [
        {"time": "t", "channel": "c"}.get(a.get("type", ""), name) if isinstance(a, dict) else name
        for a, name in zip(axes, names_of_axes)
    ]
    placed = {
        role_of(role): Step(size, start, unit)
        for role, (size, start), unit in zip(roles, steps, units)
        if role_of(role) in ("z", "y", "x")
    }
    labels = True if "image-label" in ome else None
    channels = _channels(group, ome)
    values = Values(array.dtype)
    return _described(
        path,
        array,
        selection,
        roles,
        placed,
        values,
        notes=told,
        channels=channels,
        labels=labels,
        series=series,
        levels=len(levels),
    )


def _axes(scale: Mapping[str, Any], ndim: int) -> list[Any]:
    """Return an image's axes; before version 0.3 they were always the same five.

    Version 0.6 has them in systems of coordinates, of which the first is that of the levels.
    """
    systems = scale.get("coordinateSystems") or [{}]
    axes = scale.get("axes") or systems[0].get("axes") or list("tczyx")[-ndim:]
    if len(axes) != ndim:
        raise ValueError(f"its multiscales tell of {len(axes)} axes; the array has {ndim}")
    return list(axes)


def _transformed(
    scale: Mapping[str, Any], level: Mapping[str, Any], axes: Sequence[Any], ndim: int
) -> list[tuple[float | None, float]]:
    """Return the size and start of the steps along all axes: the level's, then the image's."""
    size, start = np.ones(ndim), np.zeros(ndim)
    told = False
    for change in _changes(level, scale):
        kind = change.get("type")
        if kind not in ("scale", "translation"):
            raise ValueError(f"its coordinates are transformed by {kind!r}, which is unknown")
        values = np.asarray(change.get(kind, ()), np.float64)
        if values.shape != (ndim,):
            raise ValueError(f"its {kind} {change.get(kind)} does not fit {ndim} axes")
        if kind == "scale":
            size, start, told = size * values, start * values, True
        else:
            start = start + values
    return [(float(s) if told else None, float(o)) for s, o in zip(size, start)]


def _changes(*owners: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Yield transformations one after the other, those of sequences, too."""
    for owner in owners:
        for change in owner.get("coordinateTransformations", ()):
            if change.get("type") == "sequence":
                yield from _changes({"coordinateTransformations": change["transformations"]})
            elif change.get("type") != "identity":
                yield change


def _channels(group: Any, ome: Mapping[str, Any]) -> list[str]:
    """Return the names of channels that "omero" tells."""
    omero = ome.get("omero") or {}
    return [
        str(channel.get("label", i)) if isinstance(channel, dict) else str(i)
        for i, channel in enumerate(omero.get("channels", ()))
    ]


def _described(
    path: Path,
    array: Any,
    selection: Selection,
    axes: Sequence[str] | None,
    steps: Mapping[str, Step],
    values: Values,
    *,
    notes: Sequence[str] = (),
    channels: Sequence[str] = (),
    labels: bool | None = None,
    series: tuple[str, ...] = (),
    levels: int = 0,
) -> Source:
    """Make a source of an array and what is told about it."""
    if array.dtype.kind not in "iufb":
        raise ValueError(f"'{path}': {array.path!r} holds {array.dtype}, not real numbers")
    layout = lay_out(path, axes, array.shape, selection, channels=channels)
    told = [*notes, *layout.notes]
    about = Description(
        what=str(path),
        shape=layout.shape,
        dtype=values.dtype,
        components=layout.components,
        name=array.basename if array.basename and not levels else path.name.split(".")[0],
        geometry=place(steps, layout.shape, told),
        chunks=layout.along(array.chunks),
        channels=layout.channels,
        times=layout.times,
        series=series,
        labels=labels,
        notes=tuple(told),
    )
    return ZarrSource(path, array.path, about, layout, values)
