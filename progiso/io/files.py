"""Files that appear under their names only when they are complete."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from .._typing import FilePath


def check_output(path: FilePath, suffixes: Iterable[str] | None = None) -> None:
    """Check, before long work, that its result can be written.

    Parameters
    ----------
    path : str or os.PathLike
        The file to create or replace.
    suffixes : iterable of str, optional
        What its name may end in.

    Raises
    ------
    ValueError
        When the name ends in something else.
    FileNotFoundError, IsADirectoryError, PermissionError
        When the folder does not exist or is not writable, or `path` is a folder.
    """
    path = Path(path)
    if suffixes is not None and not path.name.lower().endswith(tuple(suffixes)):
        raise ValueError(f"do not know how to write '{path}': use one of {', '.join(suffixes)}")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"cannot write '{path}': folder '{path.parent}' does not exist")
    if path.is_dir():
        raise IsADirectoryError(f"cannot write '{path}': it is a folder")
    if not os.access(path.parent, os.W_OK):
        raise PermissionError(f"cannot write '{path}': folder '{path.parent}' is not writable")


@contextmanager
def atomic_path(path: FilePath) -> Iterator[Path]:
    """Yield a temporary path to write to, renamed to `path` when the block succeeds.

    Parameters
    ----------
    path : str or os.PathLike
        The file to create or replace. Its folder must exist.

    Yields
    ------
    pathlib.Path
        A path in the same folder, with the same name inside a temporary folder of its own, so
        that writers that go by the suffix work.

    Raises
    ------
    OSError
        When `path` cannot be written, see `check_output`.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with atomic_path(Path(folder) / "note.txt") as temporary:
    ...         _ = temporary.write_text("complete")
    ...     (Path(folder) / "note.txt").read_text()
    'complete'
    """
    path = Path(path)
    check_output(path)
    with tempfile.TemporaryDirectory(prefix=".progiso-", dir=path.parent) as folder:
        temporary = Path(folder) / path.name
        yield temporary
        os.replace(temporary, path)
