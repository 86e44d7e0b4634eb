"""Does once in small what a benchmark may do, and prints the files that this loaded, as JSON.

`pack-bundle` runs it to find out which of VTK's many libraries have to come along.
"""

import contextlib
import importlib
import io
import json
import pkgutil
import sys
import tempfile
from pathlib import Path

import numpy as np
import vtkmodules.vtkInteractionStyle  # noqa: F401
import vtkmodules.vtkRenderingFreeType  # noqa: F401
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkFlyingEdges3D, vtkPolyDataNormals
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkImagingCore import vtkImageCast
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkColorTransferFunction,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextActor,
    vtkVolume,
    vtkVolumeProperty,
    vtkWindowToImageFilter,
)
from vtkmodules.vtkRenderingVolume import vtkGPUVolumeRayCastMapper

import progiso
from progiso.cli import main
from progiso.data import fetch


def import_everything():
    """Import all modules of the package but those that want pyvista, which does not come along."""
    for module in pkgutil.walk_packages(progiso.__path__, "progiso."):
        parts = module.name.split(".")
        if "pyvista" not in parts and parts[-1] != "__main__" and not parts[-1].startswith("lib"):
            importlib.import_module(module.name)
    with contextlib.suppress(ImportError):
        import zfpy  # noqa: F401


def use_command_line(folder):
    """Generate, compress, describe, render and decompress, as `python -m progiso` does."""
    raw = fetch("gyroid", size=32, folder=folder)
    for arguments in (
        ["compress", raw, folder / "volume.vti"],
        ["compress", raw, folder / "volume.zfp"],
        ["info", folder / "volume.vti", "--json"],
        ["decompress", folder / "volume.zfp", folder / "plain.vti"],
        ["decompress", folder / "volume.zfp", folder / "plain.mha"],
        ["render", folder / "volume.zfp", "--isovalue", 0, "--size", "64x48",
         "--output", folder / "image.png",
         "--depth", folder / "depth.npy", "--stats", folder / "statistics.json"],
        ["data"],
    ):  # fmt: skip
        if main([str(a) for a in arguments]):
            sys.exit(f"progiso {arguments[0]} failed")
    with contextlib.suppress(SystemExit):
        main(["--help"])
    return progiso.read(raw)


def draw(prop, folder):
    """Render with a line of text, off screen, and write and read the image."""
    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.AddViewProp(prop)
    renderer.AddViewProp(vtkTextActor(input="text"))
    window.SetOffScreenRendering(True)
    window.SetSize(64, 48)
    window.AddRenderer(renderer)
    window.Render()
    grabber, writer = vtkWindowToImageFilter(), vtkPNGWriter()
    grabber.SetInput(window)
    writer.SetInputConnection(grabber.GetOutputPort())
    writer.SetFileName(str(folder / "window.png"))
    writer.Write()
    reader = vtkPNGReader()
    reader.SetFileName(str(folder / "window.png"))
    reader.Update()


def use_vtk(image, folder):
    """Draw what VTK's users have today: its own isosurface mapper, and meshes."""
    mapper, isosurface, look = vtkGPUVolumeRayCastMapper(), vtkVolume(), vtkVolumeProperty()
    mapper.SetInputData(image)
    mapper.SetBlendModeToIsoSurface()
    look.GetIsoSurfaceValues().SetValue(0, 0.0)
    look.SetColor(vtkColorTransferFunction())
    look.SetScalarOpacity(vtkPiecewiseFunction())
    isosurface.SetMapper(mapper)
    isosurface.SetProperty(look)
    draw(isosurface, folder)
    for extractor in (vtkFlyingEdges3D(), vtkContourFilter()):
        extractor.SetInputData(image)
        extractor.SetValue(0, 0.0)
        normals, cells = vtkPolyDataNormals(), vtkGeometryFilter()
        surface, actor = vtkPolyDataMapper(), vtkActor()
        normals.SetInputConnection(extractor.GetOutputPort())
        cells.SetInputConnection(normals.GetOutputPort())
        surface.SetInputConnection(cells.GetOutputPort())
        actor.SetMapper(surface)
        draw(actor, folder)
    source, writer = vtkSphereSource(), vtkXMLPolyDataWriter()
    writer.SetInputConnection(source.GetOutputPort())
    writer.SetFileName(str(folder / "mesh.vtp"))
    writer.Write()
    cast = vtkImageCast()
    cast.SetInputData(image)
    cast.SetOutputScalarTypeToShort()
    cast.Update()


def use_libraries():
    """Use NumPy's parts that load on demand, and the progress bar, which only a terminal sees."""
    np.linalg.svd(np.fft.fft(np.random.default_rng(0).normal(size=(8, 8))))
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(file=io.StringIO(), force_terminal=True)) as bar:
        bar.update(bar.add_task("task", total=1.0), completed=1.0)


def loaded_files():
    """Return the files of Python modules and shared libraries in this process."""
    modules = {getattr(m, "__file__", None) for m in list(sys.modules.values())}
    maps = Path("/proc/self/maps").read_text(encoding="utf-8").splitlines()
    return sorted(modules - {None} | {line.split()[-1] for line in maps if ".so" in line})


with tempfile.TemporaryDirectory() as name, contextlib.redirect_stdout(io.StringIO()):
    import_everything()
    use_vtk(use_command_line(Path(name)), Path(name))
    use_libraries()
print(json.dumps(loaded_files()))
