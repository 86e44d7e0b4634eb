"""A progress bar on standard error, where that is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from .._typing import Progress


@contextmanager
def progress_bar(description: str) -> Iterator[Progress | None]:
    """Show a bar while the block runs.

    Parameters
    ----------
    description : str
        What is being done.

    Yields
    ------
    callable or None
        To be called with the fraction done, from 0 to 1. None when standard error is not a
        terminal: nothing is shown then.

    Examples
    --------
    >>> import progiso
    >>> from progiso.data import fetch
    >>> image = progiso.read(fetch("sphere", size=32))
    >>> with progress_bar("Compressing") as progress:
    ...     volume = progiso.compress(image, progress=progress)
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(description, total=1.0)
        yield lambda fraction: bar.update(task, completed=fraction)
