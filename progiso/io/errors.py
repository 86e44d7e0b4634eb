"""One kind of error for whatever a library that reads files may raise."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

#: Errors that say all by their type, and leave as they are.
_PLAIN = (
    FileNotFoundError,
    PermissionError,
    IsADirectoryError,
    NotADirectoryError,
    ImportError,
    MemoryError,
)

#: Warnings for those who write programs, also about files that others have left open.
_UNTOLD = (DeprecationWarning, PendingDeprecationWarning, ResourceWarning)


@contextmanager
def reading(what: object) -> Iterator[None]:
    """Turn an exception of a library that reads a file into one that names the file.

    Parameters
    ----------
    what : object
        The file.

    Raises
    ------
    ValueError
        "cannot read 'file': reason", of any other exception than those that say all by themselves
        (no such file, no permission, not installed, no memory).

    Examples
    --------
    >>> with reading("a.mgz"):
    ...     raise KeyError("vector_dimension")
    Traceback (most recent call last):
        ...
    ValueError: cannot read 'a.mgz': KeyError 'vector_dimension'
    """
    try:
        yield
    except _PLAIN:
        raise
    except Exception as error:
        named = f"'{what}'" in str(error)
        if named and isinstance(error, (ValueError, RuntimeError)):
            raise
        start = "" if named else f"cannot read '{what}': "
        raise ValueError(f"{start}{reason_of(error)}") from error


@contextmanager
def header_warnings(what: object) -> Iterator[None]:
    """Look at what a library warns of while it reads a header: data that are lost are an error.

    Other warnings are passed on with the file's name. Not for code that runs in several threads,
    as Python's list of filters of warnings is one for all.

    Raises
    ------
    ValueError
        "cannot read 'file': the warning", see `lost_data`.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield
    for warning in caught:
        text = " ".join(str(warning.message).split())
        if lost_data(text):
            raise ValueError(f"cannot read '{what}': {text}")
        if not issubclass(warning.category, _UNTOLD):
            warnings.warn(text if str(what) in text else f"'{what}': {text}", stacklevel=4)


def reason_of(error: BaseException) -> str:
    """Tell an exception's reason on one line, with its type where the text alone is no sentence."""
    text = " ".join(str(error).split())
    if isinstance(error, (KeyError, AttributeError, IndexError, TypeError)) or not text:
        return f"{type(error).__name__} {text}".strip()
    return text


def lost_data(text: str) -> bool:
    """Tell whether a library's warning says that samples are missing or invented."""
    words = ("truncated", "corrupt", "unexpected end", "incomplete", "missing data", "short read")
    return any(word in text.lower() for word in words)
