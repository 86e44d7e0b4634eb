"""Arrays inside a file: which one is meant, and what HDF5's and Zarr's conventions share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from .._typing import Array
from .axes import Step, even_step, roles_of, unit_of

#: How many arrays a message lists.
_LISTED = 30


class Coordinates(NamedTuple):
    """Coordinates along an axis, or the edges of the samples, which are one more.

    Attributes
    ----------
    name : str
        Of the axis.
    values : numpy.ndarray
        Along one axis.
    unit : object
        As the file tells it.
    """

    name: str
    values: Array
    unit: object


def only_volume(path: Path, arrays: Mapping[str, Any]) -> Any:
    """Return the only array of three axes and more, or else of two.

    Raises
    ------
    ValueError
        When there are several or none; the message lists them.
    """
    for axes in (3, 2):
        fitting = {name: array for name, array in arrays.items() if _used(array) >= axes}
        if len(fitting) == 1:
            return next(iter(fitting.values()))
        if fitting:
            name = min(fitting).lstrip("/")
            raise ValueError(
                f"'{path}' holds several arrays: name one, as in '{path.name}:/{name}': "
                f"{list_of(fitting)}"
            )
    raise ValueError(f"'{path}' holds no volume; its arrays are {list_of(arrays)}")


def list_of(arrays: Mapping[str, Any]) -> str:
    """List arrays with their shapes and types."""
    texts = [f"{name} {'x'.join(map(str, a.shape))} {a.dtype}" for name, a in arrays.items()]
    more = f" and {len(texts) - _LISTED} more" if len(texts) > _LISTED else ""
    return (", ".join(sorted(texts)[:_LISTED]) or "none") + more


def positional(names: Sequence[str], units: Mapping[int, object]) -> list[str]:
    """Return what axes are where their names need not tell: the last ones are z, y and x.

    Parameters
    ----------
    names : sequence of str
        Of all axes. Those of time, channels and components count, as do those of y and x where both
        are there, and of z or of one other axis.
    units : mapping of int to object
        Of coordinates, by number of axis; "days since ..." is time.
    """
    roles = roles_of(names)
    for position, unit in units.items():
        text = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else str(unit)
        if " since " in text:
            roles[position] = "t"
    if {"z", "y", "x"} <= set(roles):
        return roles
    kept = [i for i, role in enumerate(roles) if role not in ("t", "c", "s")]
    others = [i for i in kept if roles[i] not in ("y", "x")]
    if len(kept) == 3 and {"y", "x"} <= set(roles) and len(others) == 1:
        roles[others[0]] = "z"
        return roles
    for axis, i in zip("xyz", reversed(kept)):
        roles[i] = axis
    return roles


def steps_of(
    roles: Sequence[str],
    coordinates: Mapping[int, Coordinates],
    shape: Sequence[int],
    notes: list[str],
) -> dict[str, Step]:
    """Turn coordinates into steps along z, y and x; a note tells which are not evenly spaced."""
    steps = {}
    for position, (name, values, unit) in coordinates.items():
        if roles[position] not in ("z", "y", "x") or values.dtype.kind not in "iuf":
            continue
        if values.size == shape[position] + 1:
            values = values[1:] / 2 + values[:-1] / 2
        step = even_step(values, unit_of(unit))
        if step.size is None and values.size > 1:
            notes.append(f"the coordinates {name!r} are not evenly spaced: left out")
        else:
            steps[roles[position]] = step
    return steps


def _used(array: Any) -> int:
    """Count the axes of more than one sample; of an array of one sample, all."""
    return sum(n > 1 for n in array.shape) or len(array.shape)
