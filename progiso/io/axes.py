"""Volumes in arrays of more axes: which are z, y and x, what is chosen of the rest, and where."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .._typing import Array, Dimensions
from .source import Description, Geometry, Region, Selection, Source

#: Names of axes by what they are: time, channel, slices, rows, columns, or components of a sample.
_ROLES = {
    "t": ("t", "time", "times", "frame", "frames", "phony_time"),
    "c": ("c", "channel", "channels", "band", "bands"),
    "z": ("z", "depth", "slice", "slices", "plane", "planes"),
    "y": ("y", "row", "rows", "height", "ny", "lat", "latitude"),
    "x": ("x", "column", "columns", "width", "nx", "lon", "longitude"),
    "s": ("s", "sample", "samples", "rgb", "rgba", "component", "components", "vector"),
}
_ROLE_OF = {name: role for role, names in _ROLES.items() for name in names}

_MICRONS = ("micron", "microns", "\u00b5m", "\u03bcm")

#: Lengths in metres by their usual names; the first name of a length is the one that is told.
_LENGTHS = {
    "km": (1e3, ("kilometer", "kilometers", "kilometre")),
    "m": (1.0, ("meter", "meters", "metre", "metres")),
    "dm": (1e-1, ("decimeter",)),
    "cm": (1e-2, ("centimeter", "centimeters", "centimetre")),
    "mm": (1e-3, ("millimeter", "millimeters", "millimetre", "millimetres")),
    "um": (
        1e-6,
        ("micrometer", "micrometers", "micrometre", "micron", "microns", "\u00b5m", "\u03bcm"),
    ),
    "nm": (1e-9, ("nanometer", "nanometers", "nanometre", "nanometres")),
    "angstrom": (1e-10, ("\u00e5", "\u212b", "angstroms")),
    "pm": (1e-12, ("picometer", "picometre")),
    "inch": (0.0254, ("in", "inches", '"')),
}
_UNIT_OF = {name: unit for unit, (_, names) in _LENGTHS.items() for name in (unit, *names)}

#: Components that an axis without a name may hold: colours with or without opacity.
_COLOURS = (3, 4)


class Step(NamedTuple):
    """What a file tells of the samples along one axis.

    Attributes
    ----------
    size : float or None
        From a sample to the next, negative where coordinates fall; None where it is not told.
    start : float
        Coordinate of the first sample.
    unit : str or None
        Of both, see `unit_of`.
    """

    size: float | None = None
    start: float = 0.0
    unit: str | None = None


@dataclass(frozen=True)
class Layout:
    """How a volume lies in an array of more axes.

    Attributes
    ----------
    parts : tuple of str or int
        What each axis of the array is: "z", "y", "x", "s" (components), or the index chosen on it.
    shape : tuple of 3 int
        Slices, rows and columns; one slice where no axis is "z".
    components : int
        Samples' components.
    channels, times, notes
        As in `Description`.
    """

    parts: tuple[str | int, ...]
    shape: Dimensions
    components: int = 1
    channels: tuple[str, ...] = ()
    times: int = 1
    notes: tuple[str, ...] = ()

    def index(self, region: Region) -> tuple[int | slice, ...]:
        """Return the array's index for a region along z, y and x."""
        along = dict(zip("zyx", region), s=slice(0, self.components))
        return tuple(along[part] if isinstance(part, str) else part for part in self.parts)

    def arrange(self, found: Array) -> Array:
        """Turn what the array gave for an index into slices, rows, columns and components."""
        order = [part for part in self.parts if isinstance(part, str)]
        found = found.transpose([order.index(part) for part in "zyxs" if part in order])
        return found if "z" in order else found[np.newaxis]

    def along(self, values: Sequence[Any], default: Any = 1) -> tuple[Any, Any, Any]:
        """Return those of an array's values per axis that belong to z, y and x."""
        of = {part: value for part, value in zip(self.parts, values)}
        z, y, x = (of.get(part, default) for part in "zyx")
        return z, y, x


def lay_out(
    what: object,
    axes: Sequence[str] | None,
    shape: Sequence[int],
    selection: Selection,
    *,
    channels: Sequence[str] = (),
) -> Layout:
    """Find the volume in an array of more axes.

    Parameters
    ----------
    what : object
        The file, for messages.
    axes : sequence of str or None
        Names of the array's axes, see `role_of`; None where the file does not tell.
    shape : sequence of int
        The array's.
    selection : Selection
        Which channel, time and component are wanted.
    channels : sequence of str, optional
        Names of the channels.

    Raises
    ------
    ValueError
        When it is not clear which axes are the volume's, or there is no such channel, time or
        component.
    """
    roles, notes = _roles(what, axes, shape, selection)
    length = {role: n for role, n in zip(roles, shape)}
    names = tuple(channels) if len(channels) == length.get("c", 1) else ()
    chosen = {
        "t": choose(what, "time", selection.time, length.get("t", 1), notes),
        "c": choose(what, "channel", selection.channel, names or length.get("c", 1), notes),
        "": 0,
    }
    if selection.component is not None:
        chosen["s"] = choose(what, "component", selection.component, length.get("s", 1), notes)
    elif length.get("s") == 1:
        chosen["s"] = 0
    parts = tuple(chosen.get(role, role) for role in roles)
    several = length.get("c", 1) > 1
    return Layout(
        parts,
        (length.get("z", 1), length["y"], length["x"]),
        components=length["s"] if "s" in parts else 1,
        channels=(names or tuple(map(str, range(length.get("c", 1))))) if several else (),
        times=length.get("t", 1),
        notes=tuple(notes),
    )


def role_of(name: str) -> str:
    """Return what an axis is by its name, or the name in lower case where it tells nothing.

    Examples
    --------
    >>> role_of("Channel"), role_of("lambda")
    ('c', 'lambda')
    """
    return _ROLE_OF.get(name.lower(), name.lower())


def roles_of(names: Sequence[str]) -> list[str]:
    """Return what the axes of an array are, see `role_of`: a height above latitudes is z.

    Examples
    --------
    >>> roles_of(["time", "height", "lat", "lon"]), roles_of(["height", "width"])
    (['t', 'z', 'y', 'x'], ['y', 'x'])
    """
    roles = [role_of(name) for name in names]
    if roles.count("y") > 1:
        roles = ["z" if name.lower() == "height" else role for name, role in zip(names, roles)]
    return roles


def choose(
    what: object,
    kind: str,
    wanted: int | str | None,
    of: Sequence[str] | int,
    notes: list[str] | None = None,
) -> int:
    """Choose one of several by number or name; the first, with a note, where none is named.

    Parameters
    ----------
    what : object
        The file, for messages.
    kind : str
        "channel", "time", "series", "level" or "component": the option that chooses.
    wanted : int, str or None
        What was asked for.
    of : sequence of str or int
        The names of what there is, or the number of it.
    notes : list of str, optional
        Gets the note on what was chosen by default.

    Raises
    ------
    ValueError
        When there is no such thing; the message lists what there is.
    """
    names = list(of) if not isinstance(of, int) else []
    count = of if isinstance(of, int) else len(names)
    listed = f"{count} of them, from 0"
    if names:
        listed = ", ".join(f"{i}: {name!r}" for i, name in enumerate(names[:50]))
    if wanted is None:
        if count > 1 and notes is not None:
            called = f" ({names[0]!r})" if names else ""
            notes.append(f"{kind} 0{called} of {count} is taken: choose by --{kind}")
        return 0
    if isinstance(wanted, str) and wanted in names:
        return names.index(wanted)
    try:
        number = int(wanted)
    except ValueError:
        number = -1
    if not 0 <= number < count:
        raise ValueError(f"'{what}' has no {kind} {wanted!r}; it has {listed}")
    return number


def unit_of(text: object) -> str | None:
    """Return the usual name of a unit, or None where the text names none.

    Examples
    --------
    >>> unit_of("micron"), unit_of("degrees_north"), unit_of("pixel")
    ('um', 'degrees_north', None)
    """
    if isinstance(text, bytes):
        text = text.decode("utf-8", "replace")
    word = str(text if text is not None else "").replace("\\u00B5", "\u00b5").strip().strip("\x00")
    if word.lower() in ("", "none", "null", "pixel", "pixels", "px", "voxel", "voxels", "1"):
        return None
    return _UNIT_OF.get(word, _UNIT_OF.get(word.lower(), word))


def even_step(values: npt.ArrayLike, unit: str | None = None) -> Step:
    """Return the step of coordinates, without a size where they are not evenly spaced."""
    found = np.asarray(values)
    if found.dtype.kind not in "iuf" or found.ndim != 1 or found.size == 0:
        return Step()
    found = found.astype(np.float64)
    if not np.isfinite(found).all():
        return Step()
    if found.size == 1:
        return Step(None, float(found[0]), unit)
    size = (found[-1] - found[0]) / (found.size - 1)
    # coordinates may be single precision: an error of some of their last bits is no unevenness
    room = abs(size) * 1e-3 + np.abs(found).max() * 4e-7
    even = np.abs(found - (found[0] + size * np.arange(found.size))).max() <= room
    return Step(float(size), float(found[0]), unit) if even and size else Step()


def place(steps: Mapping[str, Step], shape: Dimensions, notes: list[str]) -> Geometry:
    """Make a geometry of what a file tells about z, y and x.

    A spacing that the file does not tell is that of the axes that are told, or 1; a note says so.

    Parameters
    ----------
    steps : mapping of str to Step
        By axis, "z", "y" and "x".
    shape : tuple of 3 int
        Slices, rows and columns.
    notes : list of str
        Gets the notes.
    """
    known = {name: step for name, step in steps.items() if step.size and np.isfinite(step.size)}
    needed = [name for name, n in zip("zyx", shape) if n > 1 and name not in known]
    unit, factors = _common_unit(known, notes)
    fallback = 1.0
    for name in "yxz":
        if name in known:
            fallback = abs(float(known[name].size or 1)) * factors[name]
            break
    if needed:
        taken = f"that of {'rows' if 'y' in known else 'the other axis'}" if known else "1"
        notes.append(f"the spacing along {', '.join(sorted(needed))} is not told: {taken} is taken")
    sizes, starts = [], []
    for name in "xyz":
        step = known.get(name)
        sizes.append(float(step.size or 1) * factors[name] if step else fallback)
        start = steps[name].start * factors.get(name, 1.0) if name in steps else 0.0
        starts.append(start if np.isfinite(start) else 0.0)
    return Geometry(axes=np.diag(sizes), origin=np.array(starts), units=unit)


@dataclass(frozen=True)
class Values:
    """What stored numbers mean.

    Attributes
    ----------
    stored : numpy.dtype
        Type of the stored numbers.
    scale, offset : float
        A sample is ``stored * scale + offset``.
    missing : tuple of float
        Stored numbers that stand for no value; NaN is one of them where it is listed.
    wide : bool
        Whether scaled samples want double precision.
    """

    stored: np.dtype[Any]
    scale: float = 1.0
    offset: float = 0.0
    missing: tuple[Any, ...] = ()
    wide: bool = True
    dtype: np.dtype[Any] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "dtype", self._dtype())

    @property
    def scaled(self) -> bool:
        """Whether samples are not the stored numbers themselves."""
        return (self.scale, self.offset) != (1.0, 0.0)

    def decode(self, found: Array) -> Array:
        """Turn stored numbers into samples."""
        if self.scaled:
            return found.astype(self.dtype) * self.dtype.type(self.scale) + self.dtype.type(
                self.offset
            )
        return found.astype(self.dtype, copy=False)

    def mask(self, found: Array, components: int = 1) -> Array:
        """Turn stored numbers into samples, masked where one stands for no value.

        Parameters
        ----------
        found : numpy.ndarray
            The numbers.
        components : int
            Of a sample, along the last axis, if there are several: without one of them it has none.
        """
        samples = self.decode(found)
        if not self.missing:
            return samples
        mask = np.zeros(found.shape, bool)
        for value in self.missing:
            mask |= np.isnan(found) if value != value else found == value
        if components > 1:
            mask |= mask.any(axis=-1, keepdims=True)
        return np.ma.MaskedArray(samples, mask)

    def _dtype(self) -> np.dtype[Any]:
        if self.scaled:
            return np.dtype(np.float64 if self.wide else np.float32)
        if self.stored.kind == "b":
            return np.dtype(np.uint8)
        if self.stored.kind == "f" and self.stored.itemsize not in (4, 8):
            return np.dtype(np.float32 if self.stored.itemsize < 4 else np.float64)
        return self.stored.newbyteorder("=")


class AxesSource(Source):
    """A volume in an array of more axes that a library reads by index.

    Derived classes implement `_fetch`, and `_open` where that needs it.
    """

    def __init__(self, about: Description, layout: Layout, values: Values) -> None:
        super().__init__(about)
        self._layout, self._values = layout, values

    @abstractmethod
    def _fetch(self, index: tuple[int | slice, ...]) -> Array:
        """Read stored numbers; axes with an int as index fall away."""

    def _read(self, region: Region) -> Array:
        found = self._layout.arrange(self._fetch(self._layout.index(region)))
        return self._values.mask(found, self.about.components)


def _roles(
    what: object, axes: Sequence[str] | None, shape: Sequence[int], selection: Selection
) -> tuple[list[str], list[str]]:
    """Return each axis' role, "" where it has length 1 and no other, and notes."""
    notes: list[str] = []
    if axes is not None:
        roles = roles_of(axes)
    else:
        roles = _guessed(what, shape, selection, notes)
    doubtful = [i for i, role in enumerate(roles) if role not in _ROLES or roles.count(role) > 1]
    for i in doubtful:
        if shape[i] == 1:
            roles[i] = ""
    told = dict(zip(map(str, axes if axes is not None else roles), shape))
    left = [i for i in doubtful if roles[i]]
    if left:
        raise ValueError(f"'{what}': it is not clear which of the axes {told} are z, y and x")
    if "y" not in roles or "x" not in roles:
        raise ValueError(f"'{what}' is no volume or picture: its axes are {told}")
    return roles, notes


def _guessed(
    what: object, shape: Sequence[int], selection: Selection, notes: list[str]
) -> list[str]:
    """Return the roles of axes without names: the last ones are z, y and x."""
    leading: list[str] = [
        role
        for role, wanted in (("t", selection.time), ("c", selection.channel))
        if wanted is not None
    ]
    axes = list(range(len(shape)))
    while len(axes) > 3 and shape[axes[0]] == 1:
        axes.pop(0)
    roles = [""] * (len(shape) - len(axes))
    if len(axes) == 4 and not leading and shape[-1] in _COLOURS and min(shape[-4:-1]) > 4:
        notes.append(f"the last axis, of {shape[-1]}, is taken as components of the samples")
        return roles + ["z", "y", "x", "s"]
    if len(axes) < 2:
        raise ValueError(f"'{what}' is no volume or picture: its shape is {tuple(shape)}")
    extra = len(axes) - 3
    if extra > 0:
        if extra != len(leading):
            raise ValueError(
                f"'{what}' has axes of {tuple(shape)} without names: say by --channel or --time "
                "what comes before z, y and x (time first)"
            )
        return roles + leading + ["z", "y", "x"]
    return roles + list("zyx"[-len(axes) :])


def _common_unit(
    known: Mapping[str, Step], notes: list[str]
) -> tuple[str | None, dict[str, float]]:
    """Return the unit that all axes are told in, and what turns each axis' own into it."""
    units = {name: step.unit for name, step in known.items()}
    factors = dict.fromkeys("zyx", 1.0)
    distinct = set(units.values())
    if len(distinct) == 1:
        return distinct.pop(), factors
    if distinct and all(unit in _LENGTHS for unit in distinct):
        chosen = units.get("x") or units.get("y") or next(iter(units.values()))
        assert chosen is not None
        for name, unit in units.items():
            factors[name] = _LENGTHS[str(unit)][0] / _LENGTHS[chosen][0]
        return chosen, factors
    if distinct:
        told = ", ".join(f"{name} in {unit or 'no unit'}" for name, unit in units.items())
        notes.append(f"the axes have different units ({told})")
    return None, factors
