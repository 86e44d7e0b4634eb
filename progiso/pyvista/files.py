"""``pyvista.read`` and ``save`` of the formats that pyvista has no reader or writer for."""

from __future__ import annotations

from typing import Any

import pyvista

from ..io import read as _read
from ..io import save


def read(path: str, **selection: Any) -> pyvista.ImageData:
    """Read a volume as ``pyvista.read`` does; keywords as in :func:`progiso.read`."""
    return pyvista.wrap(_read(path, **selection))


def write(dataset: pyvista.DataObject, path: str, **options: Any) -> None:
    """Write a volume as ``dataset.save`` does; keywords as in :func:`progiso.save`."""
    save(dataset, path, **options)
