"""Render one prop in an off-screen window, and time it."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import replace
from time import perf_counter

import numpy as np
from vtkmodules.vtkRenderingCore import vtkProp3D, vtkRenderer, vtkRenderWindow

from .._vtk import vtk_errors
from ..camera import Camera

#: Seconds that a GPU is kept busy before its times count.
WARM_UP = 1.0


class View(ABC):
    """A prop alone on black in a window of its own.

    Parameters
    ----------
    prop : vtkmodules.vtkRenderingCore.vtkProp3D
        What is shown.
    size : tuple of int
        Width and height in pixels.
    """

    #: Name of this way to an image, for tables.
    label: str

    def __init__(self, prop: vtkProp3D, size: tuple[int, int]) -> None:
        self.prop = prop
        self.size = size
        self.renderer = vtkRenderer()
        self.renderer.AddViewProp(prop)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*self.size)
        self.window.AddRenderer(self.renderer)

    def look(self, camera: Camera) -> None:
        """Move to a `progiso.Camera`, and set the clipping range around the prop."""
        camera.apply(self.renderer.GetActiveCamera())
        self.renderer.ResetCameraClippingRange()

    def render(self) -> float:
        """Render, and wait until the GPU has finished.

        Returns
        -------
        float
            Milliseconds of wall clock.

        Raises
        ------
        RuntimeError
            With VTK's message, when it reported an error.
        """
        with vtk_errors("cannot render"):
            start = perf_counter()
            self.window.Render()
            self.window.WaitForCompletion()
            elapsed = perf_counter() - start
        return 1e3 * elapsed

    def render_from(self, camera: Camera) -> float:
        """Look, then render, and return the milliseconds of rendering."""
        self.look(camera)
        return self.render()

    def warm_up(self, camera: Camera, seconds: float = WARM_UP) -> float:
        """Render from a camera, for as long as a GPU takes to speed up.

        While the CPU prepares something a GPU falls asleep, and runs at a third of its speed for
        some tenths of a second after. A software renderer renders once.

        Parameters
        ----------
        camera : progiso.Camera
        seconds : float
            How long the GPU is kept busy.

        Returns
        -------
        float
            Milliseconds of the first image.
        """
        start = perf_counter()
        first = self.render_from(camera)
        software = "llvmpipe" in self.window.ReportCapabilities()
        while not software and perf_counter() - start < seconds:
            self.render()
        return first

    @abstractmethod
    def depth(self) -> np.ndarray:
        """Return distances along the last view's rays, ``inf`` without a hit; row 0 is the top."""

    @abstractmethod
    def depth_resolution(self) -> float:
        """Return the resolution of `depth` in world units."""

    def close(self) -> None:
        """Close the window and free all that it holds on the GPU."""
        self.window.Finalize()


def opposite(camera: Camera) -> Camera:
    """Move a camera to the other side of its focal point.

    Parameters
    ----------
    camera : progiso.Camera

    Returns
    -------
    progiso.Camera
    """
    position = tuple(2 * f - p for f, p in zip(camera.focal_point, camera.position))
    return replace(camera, position=position)


def turned(camera: Camera, degrees: float) -> Camera:
    """Move a camera around its focal point, on the great circle to its right.

    Parameters
    ----------
    camera : progiso.Camera
    degrees : float

    Returns
    -------
    progiso.Camera
    """
    offset = np.subtract(camera.position, camera.focal_point)
    right = np.cross(camera.view_up, offset)
    right *= np.linalg.norm(offset) / np.linalg.norm(right)
    angle = math.radians(degrees)
    position = camera.focal_point + math.cos(angle) * offset + math.sin(angle) * right
    return replace(camera, position=tuple(position.tolist()))
