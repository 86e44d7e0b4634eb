"""Writing files so that a reader never sees half of one."""

from __future__ import annotations

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def atomic_path(path):
    """Give a temporary path to write to, renamed to `path` when the block succeeds.

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
    FileNotFoundError
        When the folder of `path` does not exist.

    Examples
    --------
    >>> with atomic_path("depth.npy") as temporary:
    ...     numpy.save(temporary, depth)
    """
    path = Path(path)
    if not path.parent.is_dir():
        raise FileNotFoundError(f"cannot write '{path}': folder '{path.parent}' does not exist")
    if path.is_dir():
        raise IsADirectoryError(f"cannot write '{path}': it is a folder")
    with tempfile.TemporaryDirectory(prefix=".progiso-", dir=path.parent) as folder:
        temporary = Path(folder) / path.name
        yield temporary
        os.replace(temporary, path)
