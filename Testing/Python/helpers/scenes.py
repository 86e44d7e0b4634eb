"""Scenes with the mapper in them, and how the caster judges their depth."""

import itertools
import re

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter

from helpers.images import metadata, reference_volume
from helpers.messages import vtk_messages
from progiso import depth, statistics, vtkIsosurfaceVolume, vtkProgressiveIsosurfaceMapper
from progiso.measure import tolerances
from progiso.measure.agreement import compare
from progiso.oracle.caster import Camera, cast

MANY_RENDERS = 5000

#: Settings under which also a small volume goes through cache, passes and speculation.
CACHED = {"DecodeWholeVolume": False}


class Scene:
    """One isosurface in an off-screen window, seen by a caster's camera.

    Parameters
    ----------
    image : vtkImageData
        plain or compressed.
    isovalue : float
    camera : progiso.oracle.caster.Camera
    size : (int, int)
    user_matrix : 4x4 array
    lit : bool
        whether light falls on the surface.
    settings
        of the mapper: ``SpeculationLimit=1`` calls ``SetSpeculationLimit(1)``.
    """

    def __init__(
        self, image, isovalue, camera, size=(160, 120), user_matrix=None, lit=False, **settings
    ):
        self.mapper = vtkProgressiveIsosurfaceMapper()
        self.mapper.SetInputData(image)
        for name, value in settings.items():
            getattr(self.mapper, "Set" + name)(value)
        self.volume = vtkIsosurfaceVolume()
        self.volume.SetMapper(self.mapper)
        if user_matrix is not None:
            matrix = vtkMatrix4x4()
            matrix.DeepCopy(np.asarray(user_matrix, float).ravel())
            self.volume.SetUserMatrix(matrix)
        self.volume.GetProperty().SetShade(lit)
        self.isovalue = isovalue
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(0.2, 0.3, 0.4)
        self.renderer.AddVolume(self.volume)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)
        self.camera = camera

    @property
    def isovalue(self):
        return self.volume.GetProperty().GetIsoSurfaceValues().GetValue(0)

    @isovalue.setter
    def isovalue(self, value):
        self.volume.GetProperty().GetIsoSurfaceValues().SetValue(0, value)

    @property
    def camera(self):
        return Camera.from_vtk(self.renderer.GetActiveCamera())

    @camera.setter
    def camera(self, camera):
        target = self.renderer.GetActiveCamera()
        target.SetPosition(camera.position)
        target.SetFocalPoint(camera.focal_point)
        target.SetViewUp(camera.view_up)
        target.SetViewAngle(camera.view_angle)
        target.SetParallelProjection(camera.parallel_scale is not None)
        target.SetParallelScale(camera.parallel_scale or 1.0)

    @property
    def clipping_range(self):
        return self.renderer.GetActiveCamera().GetClippingRange()

    def render(self, clipping_range=None):
        """Render until the image is complete; return how many renders that took."""
        if clipping_range is None:
            self.renderer.ResetCameraClippingRange()
        else:
            self.renderer.GetActiveCamera().SetClippingRange(clipping_range)
        for count in itertools.count(1):
            self.window.Render()
            if self.mapper.GetConverged():
                break
            assert count < MANY_RENDERS, (
                f"not complete after {count} renders: {self.statistics()['passes'][-1]}"
            )
        assert self.mapper.GetNumberOfGLErrors() == 0
        return count

    def depth(self, clipping_range=None):
        """Render; return the depth image, row 0 at the top."""
        self.render(clipping_range)
        return depth(self.mapper)

    def statistics(self):
        return statistics(self.mapper, self.renderer)

    def picture(self):
        """Return the window's colours [row, column, rgb], row 0 at the top."""
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.Update()
        width, height, _ = grab.GetOutput().GetDimensions()
        return (
            vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
            .reshape(height, width, -1)[::-1, :, :3]
            .copy()
        )


def least_budget(image, isovalue, camera, size=(160, 120), **settings):
    """Return the least memory budget of a lit scene.

    The warning says it when there is only one byte.
    """
    scene = Scene(image, isovalue, camera, size, lit=True, MemoryBudget=1, **settings)
    with vtk_messages() as messages:
        scene.window.Render()
    return int(re.search(r"\((\d+) bytes\)", "".join(messages))[1])


def orbit(volume, i, n, view_angle=50.0, distance=1.5):
    """Return the camera that `progiso.orbit_camera` has for a caster's volume."""
    corners = np.array(list(itertools.product(*[(0, s - 1) for s in volume.values.shape[::-1]])))
    world = corners @ volume.index_to_world[:3, :3].T + volume.index_to_world[:3, 3]
    low, high = world.min(axis=0), world.max(axis=0)
    y = (2 * i / n - 1) + 1 / n
    r, phi = np.sqrt(1 - y * y), i * np.pi * (3 - np.sqrt(5))
    centre = (low + high) / 2
    position = centre + distance * (high - low).max() * np.array(
        [r * np.cos(phi), y, r * np.sin(phi)]
    )
    return Camera(tuple(position), tuple(centre), view_angle=view_angle)


def check_scene(
    image,
    isovalue,
    camera,
    size=(160, 120),
    user_matrix=None,
    grazing=tolerances.GRAZING_FRACTION,
    volume=None,
    **settings,
):
    """Hold the depth of a compressed volume's scene against the caster; return the scene."""
    scene = Scene(image, isovalue, camera, size, user_matrix, **settings)
    got = scene.depth()
    volume = volume or reference_volume(image, user_matrix)
    expected = cast(
        volume, isovalue, camera, size, slack=tolerances.SLACK, clip=scene.clipping_range
    )
    check_depth(got, expected, grazing)
    return scene


def check_depth(depth, expected, grazing=tolerances.GRAZING_FRACTION):
    """Hold a depth image against a `Cast`, as `progiso.measure.agreement` does.

    Not too many rays may graze.
    """
    assert depth.dtype == np.float32 and depth.shape == expected.depth.shape
    found = compare(depth, expected)
    wrong = found.wrong
    if wrong.any():
        lines = [
            f"  row {r} column {c}: {depth[r, c]:.9g}, expected {expected.depth[r, c]:.9g}"
            f" ({expected.early[r, c]:.9g} to {expected.late[r, c]:.9g}),"
            f" off by {found.error[r, c]:.3g} voxels"
            for r, c in np.argwhere(wrong)[:8]
        ]
        raise AssertionError(
            f"{wrong.sum()} of {wrong.size} pixels are off by more than is allowed\n"
            + "\n".join(lines)
        )
    assert found.grazing <= grazing, (
        f"{found.grazing:.2%} of the rays that can hit graze: too many to judge by"
    )


def check_memory(image, statistics):
    """Hold the GPU memory that a scene reports against the formula, cache and stream aside."""
    memory = statistics["memory"]
    cache = sum(
        bytes_ for name, bytes_ in memory["buffers"].items() if name.lower().startswith("cache")
    )
    assert cache > 0
    blocks = np.prod([-(-int(n) // 4) for n in metadata(image, "Dimensions")])
    bound = tolerances.BYTES_PER_BLOCK * blocks + tolerances.BYTES_PER_PIXEL * np.prod(
        statistics["size"]
    )
    rest = memory["total"] - memory["compressed"] - cache
    assert rest <= bound, (
        f"{rest} bytes for {blocks} blocks and {np.prod(statistics['size'])} pixels:"
        f" {memory['buffers']}"
    )
