"""``image.progiso``: compression and contours of pyvista's images.

pyvista imports this module by its entry point when an image's ``progiso`` is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyvista

from .._typing import Isovalues, Progress
from ..compression import decompress, describe, is_compressed
from ..io import compress
from ..mesh import contour
from ..options import EncodingKeywords

if TYPE_CHECKING:
    from typing_extensions import Unpack


@pyvista.register_dataset_accessor("progiso", pyvista.ImageData)
class ImageAccessor:
    """``image.progiso`` of every :class:`pyvista.ImageData`.

    Examples
    --------
    >>> import progiso
    >>> import pyvista as pv
    >>> image = pv.ImageData(dimensions=(16, 16, 16))
    >>> image["height"] = image.points[:, 2]
    >>> volume = image.progiso.compress(rate=4)
    >>> volume.progiso.is_compressed, volume.progiso.info["rate"]
    (True, 4.0)
    """

    def __init__(self, image: pyvista.ImageData) -> None:
        self._image = image

    def compress(
        self, *, scalars: Any = None, **options: Unpack[EncodingKeywords]
    ) -> pyvista.ImageData:
        """Compress one array with fixed-rate ZFP, see :func:`progiso.compress`.

        Parameters
        ----------
        scalars : str or array, optional
            Point or cell array, by its name or itself; by default the active scalars.
        **options
            ``rate``, ``tolerance``, ``component``, ``mask_nan``, ``threads`` and ``progress`` as in
            :func:`progiso.compress`.

        Returns
        -------
        pyvista.ImageData
            A compressed volume; ``save("volume.vti")`` stores it.

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> volume = image.progiso.compress(rate=4)
        """
        return pyvista.wrap(compress(self._image, array=scalars, **options))

    def decompress(
        self, *, threads: int = 0, progress: Progress | None = None
    ) -> pyvista.ImageData:
        """Decompress a compressed volume into float32, see :func:`progiso.decompress`.

        Parameters
        ----------
        threads : int, default: 0
            Threads that decode; 0 for one per core.
        progress : callable, optional
            Called with the fraction done, from 0 to 1.

        Returns
        -------
        pyvista.ImageData

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> image.progiso.compress(rate=4).progiso.decompress().array_names
        ['height']
        """
        return pyvista.wrap(decompress(self._image, threads=threads, progress=progress))

    def contour(self, isovalues: Isovalues, **options: Any) -> pyvista.PolyData:
        """Extract isosurfaces as triangles, see :func:`progiso.contour`.

        Parameters
        ----------
        isovalues : float or sequence of float
            In the units of the image's values.
        **options
            Other parameters of :func:`progiso.contour`.

        Returns
        -------
        pyvista.PolyData

        Examples
        --------
        >>> import progiso
        >>> import pyvista as pv
        >>> image = pv.ImageData(dimensions=(16, 16, 16))
        >>> image["height"] = image.points[:, 2]
        >>> image.progiso.compress(rate=4).progiso.contour(7.5).n_points
        256
        """
        return pyvista.wrap(contour(self._image, isovalues, **options))

    @property
    def is_compressed(self) -> bool:
        """bool: whether the image is a compressed volume."""
        return is_compressed(self._image)

    @property
    def info(self) -> dict[str, Any]:
        """dict: metadata of a compressed volume, see :func:`progiso.describe`."""
        return describe(self._image)
