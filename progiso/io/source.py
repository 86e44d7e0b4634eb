"""What every format looks like to the rest: a volume of which only the header has been read."""

from __future__ import annotations

import threading
import warnings
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array, Dimensions, Progress, Vector
from ..geometry import hide_points, image_from_array, set_axes
from ..vtkProgIsoFilters import vtkCompressedVolume
from .errors import reading

#: Part of a volume: slices of samples along z, y and x, without steps.
Region: TypeAlias = tuple[slice, slice, slice]

#: Bytes of samples that are read at a time, in whole layers of blocks: few, as libraries hold them
#: several times while they decompress.
_SLAB_BYTES = 2**23

#: Bytes above which a layer of chunks is not read at once, but chunks several times.
_LAYER_BYTES = 2**27

#: World coordinates with known axes, as the signs that turn them into those of "RAS" (towards a
#: patient's right, anterior and superior).
SPACES = {"RAS": (1, 1, 1), "LPS": (-1, -1, 1), "LAS": (-1, 1, 1)}


@dataclass(frozen=True, kw_only=True, eq=False)
class Geometry:
    """Where samples lie in the world.

    Attributes
    ----------
    axes : numpy.ndarray, shape (3, 3)
        Column *j* is the world vector from a sample to its neighbour along x, y or z.
    origin : numpy.ndarray, shape (3,)
        World position of sample (0, 0, 0).
    extent_start : tuple of 3 int
        VTK's index of the first sample along x, y and z; `origin` is then that of index 0.
    units : str or None
        Of lengths, such as "mm"; None where the file does not tell.
    space : str or None
        What the axes of the world mean, a key of `SPACES` or the file's own word; None where the
        file does not tell.
    """

    axes: npt.NDArray[np.float64] = field(default_factory=lambda: np.eye(3))
    origin: npt.NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    extent_start: Dimensions = (0, 0, 0)
    units: str | None = None
    space: str | None = None

    @property
    def spacing(self) -> Vector:
        """Return the distances from one sample to the next along x, y and z."""
        return np.linalg.norm(self.axes, axis=0)

    def place(self, image: vtkImageData) -> None:
        """Give an image of the same dimensions this place in the world."""
        set_axes(image, self.axes, self.origin)
        starts = zip(self.extent_start, image.GetDimensions())
        image.SetExtent([index for start, n in starts for index in (start, start + n - 1)])
        vtkCompressedVolume.Place(image)

    def in_space(self, space: str) -> Geometry:
        """Return the same place in other world coordinates.

        Raises
        ------
        ValueError
            When this geometry's own coordinates are not known, or `space` is not.
        """
        if space not in SPACES:
            raise ValueError(f"unknown space {space!r}: choose one of {', '.join(SPACES)}")
        if self.space not in SPACES:
            own = "its space is not known" if self.space is None else f"it is in {self.space!r}"
            raise ValueError(f"cannot place the volume in {space}: {own}")
        signs = np.array(SPACES[self.space]) * SPACES[space]
        return replace(
            self, axes=self.axes * signs[:, np.newaxis], origin=self.origin * signs, space=space
        )


@dataclass(frozen=True, kw_only=True)
class Selection:
    """What of a file is wanted, where it holds more than one volume; None takes the default.

    Attributes
    ----------
    array : str
        Name of an array, or the path of one inside a file.
    component : int
        Component of samples that are vectors or colours.
    channel : int or str
        Number or name of a channel.
    time : int
        Number of a time point.
    series : int or str
        Number or name of an image in a file of several, or of a DICOM series.
    level : int
        Level of a pyramid; 0, the default, is the finest.
    space : str
        World coordinates to place the volume in, a key of `SPACES`.
    axes : str
        Order of the dimensions of an array without names for them (``.npy``): "xyz" or "zyx".
    dimensions, rate
        Of a ``.zfp`` file without header.
    """

    array: str | None = None
    component: int | None = None
    channel: int | str | None = None
    time: int | None = None
    series: int | str | None = None
    level: int | None = None
    space: str | None = None
    axes: str | None = None
    dimensions: Sequence[int] | None = None
    rate: float | None = None


class SelectionKeywords(TypedDict, total=False):
    """Keywords of `Selection` but for those of ``.zfp`` files."""

    array: str | None
    component: int | None
    channel: int | str | None
    time: int | None
    series: int | str | None
    level: int | None
    space: str | None
    axes: str | None


@dataclass(frozen=True, kw_only=True, eq=False)
class Description:
    """What a header tells about a volume.

    Attributes
    ----------
    what : str
        The file, for messages and notes.
    shape : tuple of int
        Slices, rows and columns: samples along z, y and x.
    dtype : numpy.dtype
        Of what `Source.read` returns, in native byte order.
    components : int
        Values per sample; 1 also where one component has been selected.
    name : str
        Of the array.
    geometry : Geometry
        Where the samples lie.
    chunks : tuple of 3 int or None
        Shape of what the file is read by, along z, y and x; None where any region is as good.
    sequential : bool
        Whether only reading from the first slice to the last is cheap, as of gzipped samples.
    channels : tuple of str
        Names of the channels that can be selected; empty where there is but one.
    times : int
        Number of time points that can be selected.
    series : tuple of str
        Names of the images or series that can be selected; empty where there is but one.
    labels : bool or None
        Whether samples are labels (True) or intensities (False); None where the file does not tell.
    notes : tuple of str
        What a user should know: what was chosen by default, what the file does not tell.
    """

    what: str
    shape: Dimensions
    dtype: np.dtype[Any]
    components: int = 1
    name: str = "scalars"
    geometry: Geometry = field(default_factory=Geometry)
    chunks: Dimensions | None = None
    sequential: bool = False
    channels: tuple[str, ...] = ()
    times: int = 1
    series: tuple[str, ...] = ()
    labels: bool | None = None
    notes: tuple[str, ...] = ()

    @property
    def dimensions(self) -> Dimensions:
        """Samples along x, y and z."""
        return self.shape[2], self.shape[1], self.shape[0]

    @property
    def sample_bytes(self) -> int:
        """Bytes of all samples, decompressed."""
        return int(np.prod(self.shape, dtype=object)) * self.components * self.dtype.itemsize


class Source(ABC):
    """A volume in a file, or in an object that reads lazily, whose samples are read by region.

    A source may be read from several threads at once, and sent to another process: what it has
    opened is closed before, and opened there again. Derived classes implement `_read`, and where
    they open anything, `_open`.

    Attributes
    ----------
    about : Description
        What the header tells.
    """

    #: Whether `_read` may run in several threads at once; otherwise one after the other.
    concurrent: ClassVar[bool] = False

    #: Whether `image` gives more than the samples, so that what works on images has to have it.
    more_than_samples: bool = False

    #: Whether `image` gives all arrays of the file, so that one has to be chosen of it again.
    gives_all_arrays: bool = False

    #: VTK's number of the samples' type, where NumPy's type has several.
    vtk_type: int | None = None

    def __init__(self, about: Description) -> None:
        if min(about.shape) < 1 or about.components < 1:
            shape = "x".join(map(str, about.dimensions))
            raise ValueError(f"'{about.what}' holds no samples: {shape}")
        if about.dtype.kind not in "iuf" or not about.dtype.isnative:
            raise ValueError(f"'{about.what}' holds {about.dtype} samples, not real numbers")
        self.about = about
        self._lock = threading.RLock()
        self._opened: Any = None

    # --- what derived classes implement -----------------------------------------------------------

    @abstractmethod
    def _read(self, region: Region) -> Array:
        """Read a region that lies inside; any layout, of the type that `about` tells."""

    def _open(self) -> Any:
        """Open what `handle` returns; it is closed by its method ``close``, if it has one."""
        raise NotImplementedError

    # --- what others call -------------------------------------------------------------------------

    @property
    def shape(self) -> Dimensions:
        """Samples along z, y and x."""
        return self.about.shape

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the samples that are read."""
        return self.about.dtype

    @property
    def handle(self) -> Any:
        """What the source reads from, opened when it is first needed."""
        with self._lock:
            if self._opened is None:
                self._opened = self._open()
            return self._opened

    def read(self, region: Region | None = None) -> Array:
        """Read samples.

        Parameters
        ----------
        region : tuple of 3 slice, optional
            Along z, y and x, as NumPy takes them, but without steps; by default everything.

        Returns
        -------
        numpy.ndarray, shape (depth, height, width) or (depth, height, width, components)
            In native byte order. It may be a view of a file: do not write to it. A masked array
            where the file tells of samples that have no value (a mask, a fill value, "no data"),
            or an array of that kind is read.

        Raises
        ------
        IndexError
            When the region is empty or has steps.
        ValueError, RuntimeError
            When the file is damaged or ends early; the message names it.
        """
        inside = self._inside(region)
        with reading(self.about.what), nullcontext() if self.concurrent else self._lock:
            found = self._read(inside)
        expected = tuple(part.stop - part.start for part in inside)
        expected += (self.about.components,) if self.about.components > 1 else ()
        if found.shape != expected or found.dtype != self.about.dtype:
            raise ValueError(
                f"'{self.about.what}' gave {found.shape} samples of {found.dtype} where its header "
                f"announces {expected} of {self.about.dtype}"
            )
        return found

    def slabs(self) -> Iterator[Array]:
        """Read everything some slices at a time, from the first to the last.

        Yields
        ------
        numpy.ndarray or numpy.ma.MaskedArray
            The next slices as by `read`, a multiple of 4 of them unless they are the last.
        """
        depth = self.shape[0]
        step = self._slices_at_a_time()
        for first in range(0, depth, step):
            yield self.read((slice(first, min(first + step, depth)), slice(None), slice(None)))

    def image(self, progress: Progress | None = None) -> vtkImageData:
        """Read everything as an image whose active point scalars are the samples.

        Formats that hold more, VTK's own, give all of it: other arrays, data of cells, or a
        compressed volume as it is.
        """
        about = self.about
        samples = self.read()
        image = image_from_array(
            np.ascontiguousarray(np.ma.getdata(samples)).reshape(-1),
            about.dimensions,
            name=about.name,
            components=about.components,
        )
        self.place(image)
        if np.ma.is_masked(samples):
            mask = np.ma.getmaskarray(samples).reshape(*self.shape, -1)
            hide_points(image, np.asarray(mask.any(axis=-1)))
        if progress is not None:
            progress(1.0)
        return image

    def place(self, image: vtkImageData) -> None:
        """Give an image of the same dimensions the place of the samples in the world."""
        self.about.geometry.place(image)

    def tell_notes(self, depth: int = 2) -> None:
        """Warn of what was chosen by default, as of the caller's caller (or `depth` above)."""
        for note in self.about.notes:
            warnings.warn(f"'{self.about.what}': {note}", stacklevel=depth + 1)

    def close(self) -> None:
        """Close what the source has opened; reading opens it again."""
        with self._lock:
            opened, self._opened = self._opened, None
            if hasattr(opened, "close"):
                opened.close()

    def __enter__(self) -> Source:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in self.__dict__.items() if k not in ("_lock", "_opened")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._lock, self._opened = threading.RLock(), None

    def _slices_at_a_time(self) -> int:
        """Choose a number of slices: whole layers of blocks, whole chunks, of moderate size."""
        about, layer = self.about, 4
        if about.chunks is not None:
            layer = int(np.lcm(4, about.chunks[0]))
        slice_bytes = max(1, about.sample_bytes // about.shape[0])
        if layer * slice_bytes > _LAYER_BYTES:  # chunks are tall: read some of them twice
            layer = 4
        return max(layer, _SLAB_BYTES // slice_bytes // layer * layer)

    def _inside(self, region: Region | None) -> Region:
        """Return a region with starts and stops, or raise where nothing of it lies inside."""
        region = (slice(None),) * 3 if region is None else region
        parts = [part.indices(n) for part, n in zip(region, self.shape)]
        if len(region) != 3 or any(step != 1 or stop <= start for start, stop, step in parts):
            raise IndexError(f"{region} is no region of {self.shape} samples")
        z, y, x = (slice(start, stop) for start, stop, _ in parts)
        return z, y, x
