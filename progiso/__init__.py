"""ProgIso: progressive isosurfaces of compressed volumes, for VTK, pyvista and ParaView.

>>> import progiso
>>> from progiso.data import fetch
>>> result = progiso.render(progiso.read(fetch("sphere", size=32)), isovalue=0.8)

`compress` compresses volumes, `compress_file` and `compress_slabs` those larger than memory, at a
rate that `least_rate` finds; `read` and `save` read and write them. `render` renders an image,
`make_isosurface` makes a prop for your own VTK renderer, ``plotter.progiso.add_isosurface`` adds
one to a pyvista plotter, and `contour` extracts triangles.
"""

from __future__ import annotations

import sys
from importlib import import_module
from pkgutil import extend_path
from typing import Any

# In a checkout's root, `python -m progiso` finds these sources before the installed package: this
# adds the latter's compiled modules. Elsewhere it changes nothing.
__path__ = extend_path(__path__, __name__)

from ._built import VERSION as __version__  # noqa: E402
from ._built import VTK_VERSION as _VTK_VERSION  # noqa: E402

try:
    from vtkmodules.vtkCommonCore import vtkVersion
except ImportError as error:
    raise ImportError(
        f"progiso needs VTK {_VTK_VERSION}: pip install vtk=={_VTK_VERSION}"
    ) from error

# Class layouts change between minor releases; without this check the process would crash.
_FOUND = vtkVersion.GetVTKVersion()
if _FOUND.split(".")[:2] != _VTK_VERSION.split(".")[:2]:
    raise ImportError(
        f"progiso was built for VTK {_VTK_VERSION} but found VTK {_FOUND}: install the former "
        "or build progiso for the latter"
    )

# The base classes of the wrapped classes have to be loaded before them.
import vtkmodules.vtkCommonExecutionModel  # noqa: E402,F401
import vtkmodules.vtkInteractionStyle  # noqa: E402,F401
import vtkmodules.vtkRenderingFreeType  # noqa: E402,F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: E402,F401
import vtkmodules.vtkRenderingVolume  # noqa: E402,F401
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: E402,F401

from ._opengl import choose_window  # noqa: E402

choose_window()

from .camera import Camera, orbit_camera, view_camera  # noqa: E402
from .compression import decompress, describe, is_compressed  # noqa: E402
from .geometry import image_from_array  # noqa: E402
from .io import compress, compress_file, compress_slabs, read, save  # noqa: E402
from .isosurface import make_isosurface  # noqa: E402
from .mesh import contour, save_surface  # noqa: E402
from .rates import least_rate  # noqa: E402
from .rendering import RenderResult, render, write_png  # noqa: E402
from .statistics import depth, statistics  # noqa: E402
from .vtkProgIsoFilters import (  # noqa: E402
    vtkCompressedVolume,
    vtkCompressedVolumeBuilder,
    vtkImageZFPCompress,
    vtkImageZFPDecompress,
    vtkSampleUnitsFinder,
    vtkZFPContour,
    vtkZFPReader,
    vtkZFPWriter,
)
from .vtkProgIsoKernels import (  # noqa: E402
    vtkIsosurfacePicker,
    vtkIsosurfaceVolume,
    vtkProgressiveIsosurfaceMapper,
    vtkProgressiveIsosurfaceStatistics,
)

__all__ = [
    "__version__",
    "Camera",
    "RenderResult",
    "add_isosurface",
    "compress",
    "compress_file",
    "compress_slabs",
    "contour",
    "decompress",
    "depth",
    "describe",
    "image_from_array",
    "is_compressed",
    "least_rate",
    "make_isosurface",
    "orbit_camera",
    "read",
    "render",
    "save",
    "save_surface",
    "statistics",
    "view_camera",
    "vtkCompressedVolume",
    "vtkCompressedVolumeBuilder",
    "vtkImageZFPCompress",
    "vtkImageZFPDecompress",
    "vtkIsosurfacePicker",
    "vtkIsosurfaceVolume",
    "vtkProgressiveIsosurfaceMapper",
    "vtkProgressiveIsosurfaceStatistics",
    "vtkSampleUnitsFinder",
    "vtkZFPContour",
    "vtkZFPReader",
    "vtkZFPWriter",
    "write_png",
]

# pyvista finds `plotter.progiso` by its entry point; pyvistaqt's QtInteractor, which does not ask
# pyvista for attributes that it lacks, finds it where pyvista was imported before.
if "pyvista" in sys.modules:
    import_module(f"{__name__}.pyvista.plugin")


def __getattr__(name: str) -> Any:
    """Import what needs pyvista only when it is used."""
    if name == "add_isosurface":
        from .pyvista.surfaces import add_isosurface

        return add_isosurface
    raise AttributeError(f"module 'progiso' has no attribute '{name}'")
