"""NIfTI, Analyze, MGH, AFNI, PAR/REC and MINC: what nibabel reads, by region."""

from __future__ import annotations

import bz2
import gzip
import logging
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import nibabel
import nibabel.brikhead
import nibabel.parrec
import numpy as np
import numpy.typing as npt

from .._typing import Array, Dimensions
from .errors import reason_of
from .header_text import checked_geometry
from .source import Description, Geometry, Region, Selection, Source
from .stored import LONGEST_INFLATION, checked_index, chosen


@dataclass(frozen=True)
class _Layout:
    """What the axes of nibabel's array are; None where it has no such axis."""

    z: int | None
    y: int | None
    x: int | None
    time: int | None
    component: int | None

    def shape(self, sizes: tuple[int, ...]) -> Dimensions:
        depth, height, width = (1 if i is None else sizes[i] for i in (self.z, self.y, self.x))
        return depth, height, width


class NeuroSource(Source):
    """A volume that nibabel reads by slicing.

    Parameters
    ----------
    about : Description
        What the header tells.
    path : pathlib.Path
        The file.
    layout : _Layout
        The axes of nibabel's array.
    dtype : numpy.dtype
        Of the samples as nibabel gives them; of colours, a structure.
    time, component : int or None
        What is chosen.
    """

    def __init__(
        self, about: Description, path: Path, layout: _Layout, time: int, component: int | None
    ) -> None:
        super().__init__(about)
        self._path, self._layout, self._time, self._component = path, layout, time, component

    def _open(self) -> _Opened:
        with _logged([]):
            return _Opened(self._path)

    def _read(self, region: Region) -> Array:
        opened, layout = self.handle, self._layout
        shape = opened.image.shape
        parts: list[Any] = [slice(None)] * len(shape)
        for axis, part in zip((layout.z, layout.y, layout.x), region):
            if axis is not None:
                parts[axis] = part
        for axis in range(len(shape)):
            if axis == layout.time:
                parts[axis] = slice(self._time, self._time + 1)
            elif axis == layout.component and self._component is not None:
                parts[axis] = slice(self._component, self._component + 1)
        try:
            values = np.asarray(opened.image.dataobj[tuple(parts)])
            if region[0].stop == self.shape[0] and self._time == self.about.times - 1:
                opened.check_end()
        except (EOFError, OSError, ValueError, zlib.error) as error:
            raise ValueError(
                f"'{self.about.what}' is damaged or truncated: {reason_of(error)}"
            ) from error
        return self._arranged(values, tuple(p.stop - p.start for p in region))

    def _arranged(self, values: Array, shape: tuple[int, ...]) -> Array:
        """Bring nibabel's axes into the order z, y, x, component."""
        layout = self._layout
        order = [i for i in (layout.z, layout.y, layout.x, layout.component) if i is not None]
        others = [i for i in range(values.ndim) if i not in order]
        values = np.transpose(values, others + order)
        if values.dtype.names:  # colours
            values = np.stack([values[name] for name in values.dtype.names], axis=-1)
            if self._component is not None:
                values = values[..., self._component]
        components = (self.about.components,) if self.about.components > 1 else ()
        return values.reshape(shape + components).astype(self.dtype, copy=False)


def open_neuroimage(path: Path, selection: Selection) -> NeuroSource:
    """Open an image of a format that nibabel knows, in nibabel's coordinates.

    Of a series one time point is read; vectors and colours are components. A slope and an intercept
    are applied: the result is float32, or float64 where samples are wider than 16 bits.
    """
    unusual: list[str] = []
    with _logged(unusual):
        opened = _Opened(path)
    try:
        image, sizes = opened.image, opened.sizes()
        layout = _layout(path, image, sizes)
        opened.check_size(sizes)
        geometry, notes = _place(path, image, layout)
        disk = image.get_data_dtype()
        colours = len(disk.names or ())
        components = colours or (1 if layout.component is None else sizes[layout.component])
        component = checked_index(str(path), "component", selection.component, components)
        component = None if components == 1 else component
        times = 1 if layout.time is None else sizes[layout.time]
        time, told = chosen(str(path), "time point", selection.time, times)
        about = Description(
            what=str(path),
            shape=layout.shape(sizes),
            dtype=_dtype(image, disk),
            components=components if component is None else 1,
            name="NIFTI" if "Nifti" in type(image).__name__ else "scalars",
            geometry=geometry,
            sequential=opened.packed,
            times=times,
            labels=_labels(image),
            notes=(*(f"its header is unusual: {text}" for text in unusual), *notes, *told),
        )
    finally:
        opened.close()
    return NeuroSource(about, path, layout, time, component)


class _Opened:
    """An image of nibabel, with its files opened by what they hold, not by their names."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._streams: dict[str, Any] = {}
        suffixes = path.name.lower()
        if suffixes.endswith((".nii", ".nii.gz")):
            kind: Any = _nifti_class(path)
        else:
            _check_minc(path)
            kind = type(nibabel.load(path))
        _check_kind(path, kind)
        files = kind.filespec_to_file_map(path)
        text_headers = issubclass(kind, (nibabel.brikhead.AFNIImage, nibabel.parrec.PARRECImage))
        try:
            for name, holder in files.items():
                binary = name == "image" or not text_headers
                if binary and not suffixes.endswith(".mnc") and Path(holder.filename).exists():
                    holder.fileobj = self._streams[name] = _stream(Path(holder.filename))
            self.image = kind.from_file_map(files)
        except BaseException:
            self.close()
            raise
        self._data = files.get("image")

    @property
    def packed(self) -> bool:
        """Whether samples are compressed."""
        return isinstance(self._streams.get("image"), (gzip.GzipFile, bz2.BZ2File))

    def sizes(self) -> tuple[int, ...]:
        """Return the shape of nibabel's array."""
        return tuple(int(n) for n in self.image.shape)

    def check_size(self, sizes: tuple[int, ...]) -> None:
        """Raise where the file cannot hold all samples."""
        offset = getattr(self.image.dataobj, "offset", None)
        if offset is None or self._data is None or min(sizes) < 1:
            return
        held = int(np.prod(sizes, dtype=object)) * self.image.get_data_dtype().itemsize
        path = Path(self._data.filename)
        size, offset = path.stat().st_size, int(offset)
        if offset < 0 or offset + held > size * (LONGEST_INFLATION if self.packed else 1):
            slices = max(1, int(np.prod(sizes[2:])))
            place = min(slices - 1, max(0, size - offset) * slices // held)
            raise ValueError(
                f"'{self._path}' is truncated: it ends in slice {place} of {slices}, as "
                f"'{path.name}' has {size} bytes and the header announces {offset + held}"
            )

    def check_end(self) -> None:
        """Read on to a compressed stream's end, if it is near: its checksum lies there."""
        if self.packed:
            self._streams["image"].read(2**16)

    def close(self) -> None:
        for stream in self._streams.values():
            stream.close()


def _stream(path: Path) -> Any:
    """Open a file; where it is compressed, whatever its name, so that it is read decompressed."""
    with open(path, "rb") as file:
        begin = file.read(3)
    if begin[:2] == b"\x1f\x8b":
        return gzip.open(path)
    if begin == b"BZh":
        return bz2.open(path)
    return open(path, "rb")


def _nifti_class(path: Path) -> Any:
    """Tell whether a file is NIfTI-1 or NIfTI-2 by its first bytes."""
    with _stream(path) as stream:
        header = stream.read(352)
    for order in ("<i4", ">i4"):
        size = int(np.frombuffer(header[:4].ljust(4, b"\0"), order)[0])
        if size == 348 and header[344:348] == b"n+1\0":
            return nibabel.Nifti1Image
        if size == 540 and header[4:8] == b"n+2\0":
            return nibabel.Nifti2Image
    if header[344:347] in (b"ni1", b"ni2"):
        raise ValueError(f"'{path}' is half of a pair: name the .hdr file")
    raise ValueError(f"'{path}' is not a NIfTI image")


def _check_minc(path: Path) -> None:
    """Raise `ImportError` where MINC 2 wants h5py, which nibabel tells less clearly."""
    with open(path, "rb") as file:
        if file.read(4) == b"\x89HDF":
            try:
                import h5py  # noqa: F401
            except ImportError:
                raise ImportError(
                    f"reading '{path}' needs h5py: pip install 'progiso[medical]'"
                ) from None


def _check_kind(path: Path, kind: Any) -> None:
    """Raise where a file holds something else than samples on a grid."""
    if not issubclass(kind, nibabel.spatialimages.SpatialImage) or "Cifti" in kind.__name__:
        raise ValueError(f"'{path}' holds a {kind.__name__} of nibabel, which is no volume")


def _layout(path: Path, image: Any, sizes: tuple[int, ...]) -> _Layout:
    """Tell the axes of nibabel's array."""
    intent = image.header.get("intent_code", 0) if hasattr(image.header, "get") else 0
    if 3000 <= int(intent) < 3100:
        raise ValueError(f"'{path}' is a CIFTI file of surfaces' values, which is no volume")
    if not 2 <= len(sizes) <= 7 or any(n > 1 for n in sizes[5:]):
        raise ValueError(f"'{path}' is no volume: its shape is {sizes}")
    names = getattr(getattr(image.dataobj, "minc_file", None), "_dim_names", ())
    if names:  # MINC's axes come from the slowest to the fastest
        time = list(names).index("time") if "time" in names else None
        space: list[int | None] = [i for i in range(len(names)) if i != time]
        if len(space) > 3:
            raise ValueError(f"'{path}' is no volume: its axes are {', '.join(map(str, names))}")
        z, y, x = [None] * (3 - len(space)) + space
        return _Layout(z, y, x, time, None)
    return _Layout(
        z=2 if len(sizes) > 2 else None,
        y=1,
        x=0,
        time=3 if len(sizes) > 3 else None,
        component=4 if len(sizes) > 4 and sizes[4] > 1 else None,
    )


def _dtype(image: Any, disk: np.dtype[Any]) -> np.dtype[Any]:
    """Return the type that samples get: a slope makes them real numbers."""
    if disk.names:
        return disk[0].newbyteorder("=")
    proxy = image.dataobj
    if hasattr(proxy, "minc_file"):
        scaled = disk.kind in "iu"
    elif hasattr(proxy, "scaling"):  # AFNI's, a factor for each volume
        scaled = proxy.scaling is not None
    elif hasattr(proxy, "slope"):
        scaled = (proxy.slope, proxy.inter) != (1, 0)
    else:  # PAR/REC
        scaled = True
    if scaled and disk.kind in "iuf":
        narrow = disk.itemsize <= 2 or disk == np.float32
        return np.dtype(np.float32 if narrow else np.float64)
    if disk.kind == "f" and disk.itemsize > 8:
        return np.dtype(np.float64)
    return disk.newbyteorder("=")


def _place(path: Path, image: Any, layout: _Layout) -> tuple[Geometry, tuple[str, ...]]:
    """Return where samples lie, and what is unusual about it."""
    header, affine, units = image.header, image.affine, "mm"
    space: str | None = "RAS"
    notes: tuple[str, ...] = ()
    if isinstance(header, nibabel.Nifti1Header):
        units = header.get_xyzt_units()[0]
        affine, space, notes = _nifti_affine(header)
    elif isinstance(header, nibabel.AnalyzeHeader):
        notes = ("Analyze files do not tell left from right: x is taken to point to the left",)
    columns = [i for i in (layout.x, layout.y, layout.z) if i is not None]
    axes, spatial = np.eye(3), [i for i in range(len(image.shape)) if i != layout.time]
    for target, axis in enumerate(columns):
        axes[:, target] = affine[:3, spatial.index(axis)]
    if len(columns) == 2:  # one slice
        axes[:, 2] = affine[:3, 2]
    geometry = checked_geometry(
        path, axes, affine[:3, 3], units=None if units == "unknown" else _unit(units), space=space
    )
    return geometry, notes


def _unit(name: str) -> str:
    return {"micron": "um", "meter": "m"}.get(name, name)


def _nifti_affine(header: Any) -> tuple[npt.NDArray[Any], str | None, tuple[str, ...]]:
    """Return the sform if there is one, else the qform, else spacings alone."""
    skipped: list[str] = []
    for name in ("sform", "qform"):
        try:
            affine = getattr(header, f"get_{name}")(coded=True)[0]
        except (nibabel.spatialimages.HeaderDataError, ValueError, np.linalg.LinAlgError):
            affine = np.zeros((4, 4))
        if affine is None:
            continue
        lengths = np.linalg.norm(affine[:3, :3], axis=0)
        if np.isfinite(affine).all() and (lengths > 0).all():
            if abs(np.linalg.det(affine[:3, :3] / lengths)) > 1e-6:
                return affine, "RAS", tuple(skipped)
        skipped.append(f"its {name} places no volume and is left out")
    spacing = np.abs(np.array(header.get_zooms(), float)[:3])
    spacing = np.append(spacing, np.ones(3))[:3]
    spacing[~(np.isfinite(spacing) & (spacing > 0))] = 1
    skipped.append("it has neither sform nor qform: where left and right are is not known")
    return np.diag([*spacing, 1]), None, tuple(skipped)


def _labels(image: Any) -> bool | None:
    """Tell whether samples are labels, where the header does."""
    header = image.header
    if isinstance(header, nibabel.Nifti1Header):
        return header.get_intent()[0] in ("label", "neuronames") or None
    return None


@contextmanager
def _logged(messages: list[str]) -> Iterator[None]:
    """Collect what nibabel logs about a header, which it would print."""
    logger = nibabel.imageglobals.logger

    class Collector(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            if record.levelno >= logging.WARNING:
                messages.append(record.getMessage())

    handlers, propagate = logger.handlers, logger.propagate
    logger.handlers, logger.propagate = [Collector()], False
    try:
        yield
    finally:
        logger.handlers, logger.propagate = handlers, propagate
