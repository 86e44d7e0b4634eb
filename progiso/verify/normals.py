"""Compare normals with gradients: analytic ones, and central differences in double precision."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkLight
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkCameraPass,
    vtkFramebufferPass,
    vtkLightsPass,
    vtkOpaquePass,
    vtkRenderPassCollection,
    vtkSequencePass,
    vtkTextureObject,
)

from ..camera import Camera, orbit_camera
from ..measure import tolerances
from ..oracle import caster
from .case import Case, Outcome, Settings
from .fields import coordinates, noise
from .scene import Picture, compressed, decoded, looking

_ROTATION = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]


class LitPicture(Picture):
    """Normals by light: three lights along the axes, one colour each, shine on a white surface.

    The picture is drawn in float32, by way of VTK's render passes, so that no level is rounded.
    """

    def __init__(
        self, image: vtkImageData, isovalue: float, size: tuple[int, int], **settings: Any
    ) -> None:
        super().__init__(image, isovalue, size, **settings)
        material = self.prop.GetProperty()
        material.SetAmbient(0)
        material.SetDiffuse(1)
        material.SetSpecular(0)
        self.renderer.SetTwoSidedLighting(False)
        self.renderer.SetAutomaticLightCreation(False)
        passes, sequence, camera = vtkRenderPassCollection(), vtkSequencePass(), vtkCameraPass()
        passes.AddItem(vtkLightsPass())
        passes.AddItem(vtkOpaquePass())
        sequence.SetPasses(passes)
        camera.SetDelegatePass(sequence)
        self._frame = vtkFramebufferPass()
        self._frame.SetColorFormat(vtkTextureObject.Float32)
        self._frame.SetDelegatePass(camera)
        self.renderer.SetPass(self._frame)

    def normals(self, camera: Camera) -> np.ndarray:
        """Return unit vectors in world coordinates [row, column, axis], to where values are lower.

        Zero where there is no surface; row 0 is the top of the image.
        """
        up, down = (self._light(camera, sign) for sign in (1, -1))
        normals = (up - down)[::-1].astype(float)
        length = np.linalg.norm(normals, axis=2, keepdims=True)
        return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)

    def _light(self, camera: Camera, sign: int) -> np.ndarray:
        """Render by light from one side of the axes or the other."""
        self.renderer.RemoveAllLights()
        for axis in np.eye(3):
            light = vtkLight()
            light.SetPositional(False)
            light.SetPosition(sign * axis)
            light.SetFocalPoint(0, 0, 0)
            light.SetColor(axis)
            self.renderer.AddLight(light)
        self.render_from(camera)
        texture = self._frame.GetColorTexture()
        width, height = texture.GetWidth(), texture.GetHeight()
        colors = np.zeros((height, width, 4), np.float32)
        buffer = texture.Download()
        buffer.Download2D(texture.GetVTKDataType(), colors, (width, height), 4, (0, 0))
        return colors[..., :3]


def check_normals(
    settings: Settings,
    image: vtkImageData,
    isovalue: float,
    gradient: Callable[[np.ndarray], np.ndarray] | None = None,
    *,
    camera: Camera | None = None,
    limit: float = tolerances.NORMAL_DEGREES,
    inner: float = 0.0,
    note: str = "",
    **options: Any,
) -> Outcome:
    """Render normals and compare them with a gradient.

    Parameters
    ----------
    settings : case.Settings
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.
    isovalue : float
    gradient : callable, optional
        Takes places in index space [ray, axis], returns gradients there with respect to it. By
        default that of the decoded values: central differences, interpolated.
    camera : progiso.Camera, optional
        By default one of the orbit's.
    limit : float
        In degrees.
    inner : float
        Hits less than so many voxels from the volume's border do not count.
    note : str
    options
        Of `scene.Picture`.

    Returns
    -------
    case.Outcome
    """
    plain = Picture(image, isovalue, settings.size, **options)
    camera = camera or orbit_camera(plain.prop, 1, 4)
    try:
        milliseconds = plain.time(camera, settings.repeat)
    finally:
        plain.close()
    view = LitPicture(image, isovalue, settings.size, **options)
    try:
        normals = view.normals(camera).reshape(-1, 3)
        depth, (eye, _) = view.depth().ravel(), view.rays()
    finally:
        view.close()
    volume, hit = decoded(image), np.isfinite(depth)
    origins, directions = eye.rays(settings.size)
    places = (origins + directions * np.where(hit, depth, 0)[:, None])[hit]
    expected, judged = _expected_normals(volume, places, gradient, inner)
    angles = _degrees(normals[hit], expected)[judged]
    lit = np.linalg.norm(normals, axis=1) > 0
    return Outcome(
        float(angles.max(initial=0.0)),
        limit,
        milliseconds,
        "degrees",
        "; ".join(
            filter(None, (note, f"{judged.sum()} normals, mean {angles.mean():.2g} degrees"))
        ),
        defect="hits without a normal" if (lit != hit).any() else "" if judged.any() else "no hits",
    )


def _expected_normals(
    volume: caster.Volume,
    places: np.ndarray,
    gradient: Callable[[np.ndarray], np.ndarray] | None,
    inner: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return vectors along the normals at places in world coordinates, and which of them count."""
    to_index = np.linalg.inv(volume.index_to_world)
    places = places @ to_index[:3, :3].T + to_index[:3, 3]
    last = np.array(volume.values.shape[::-1]) - 1.0
    expected = (gradient or _Differences(volume.values))(np.clip(places, 0, last))
    within = ((places >= inner) & (places <= last - inner)).all(axis=1)
    # where there is next to no gradient, its direction is a matter of rounding
    strong = np.linalg.norm(expected, axis=1)
    judged = within & (strong > tolerances.WEAK_GRADIENT * strong.max())
    # a gradient is transformed by the inverse's transpose
    return -expected @ to_index[:3, :3], judged


def _degrees(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the angles between vectors, exact also where they are small."""
    a, b = (v / np.linalg.norm(v, axis=1, keepdims=True).clip(1e-300) for v in (a, b))
    half = np.linalg.norm(a - b, axis=1) / 2
    return 2 * np.degrees(np.arcsin(np.clip(half, 0, 1)))


class _Differences:
    """Computes central differences, one-sided at the border, trilinear between samples."""

    def __init__(self, values: np.ndarray) -> None:
        self._gradients = np.stack(np.gradient(values.astype(float))[::-1], axis=-1)

    def __call__(self, places: np.ndarray) -> np.ndarray:
        shape = np.array(self._gradients.shape[:3][::-1])
        cell = np.clip(np.floor(places), 0, shape - 2).astype(int)
        local = places - cell
        total = np.zeros((len(places), 3))
        for corner in np.ndindex(2, 2, 2):
            weight = np.prod(np.where(corner, local, 1 - local), axis=1)
            x, y, z = (cell + corner).T
            total += weight[:, None] * self._gradients[z, y, x]
        return total


# --- fields with a gradient -----------------------------------------------------------------------


def _quadric(settings: Settings, scale: float = 1.0, **geometry: Any) -> Outcome:
    """Render a quadratic field: its central differences are its gradient, between samples too."""
    shape, centre = (22, 26, 24), np.array([11.3, 12.8, 10.4])
    a, b = np.diag([1.0, 0.6, 0.8]), np.array([[0, 0.2, -0.1], [0.2, 0, 0.15], [-0.1, 0.15, 0]])
    form = a + b
    offset = np.stack(coordinates(shape), axis=-1) - centre
    values = np.einsum("...i,ij,...j", offset, form, offset) * scale
    return check_normals(
        settings,
        compressed(values.astype(np.float32), **geometry),
        49.0 * scale,
        lambda places: 2 * (places - centre) @ form,
        limit=tolerances.NORMAL_DEGREES,
        inner=1.0,
    )


def _sphere(radius: float, settings: Settings) -> Outcome:
    """Render a sphere; the error of its central differences falls with the square of its radius."""
    size = int(2 * radius + 8)
    centre = np.array([0.37, 0.61, 0.13]) + size / 2 - 0.5
    distance = np.linalg.norm(np.stack(coordinates((size,) * 3), axis=-1) - centre, axis=-1)
    return check_normals(
        settings,
        compressed(distance.astype(np.float32)),
        radius,
        lambda places: places - centre,
        limit=tolerances.NORMAL_SPHERE_DEGREES / radius**2,
    )


def _plane(settings: Settings) -> Outcome:
    """Render a linear field up to the volume's border: the normal is the same everywhere."""
    x, y, z = coordinates((12, 14, 16))
    values = x + 0.8 * y + 0.5 * z
    gradient = np.array([1.0, 0.8, 0.5])
    return check_normals(
        settings,
        compressed(values.astype(np.float32)),
        14.2,
        lambda places: np.broadcast_to(gradient, places.shape),
        limit=tolerances.NORMAL_DEGREES,
    )


# --- against double precision ---------------------------------------------------------------------


def _noise(cached: bool, settings: Settings) -> Outcome:
    """Render white noise: normals across all faces of cells, blocks and macrocells."""
    return check_normals(
        settings,
        compressed(noise((21, 18, 19), 17)),
        0.4,
        limit=tolerances.NORMAL_NOISE_DEGREES,
        cached=cached,
    )


def _block_corner(cached: bool, settings: Settings) -> Outcome:
    """Look at the corner of eight blocks from so near that a pixel is a thousandth of a voxel."""
    values = noise((16, 16, 16), 18)
    values[7:9, 7:9, 7:9] = np.linspace(-1, 1, 8).reshape(2, 2, 2)
    image = compressed(values)
    isovalue = float(decoded(image).values[8, 8, 8])
    camera = looking((8.2, 8.3, 8.25), (8, 8, 8), (0, 0, 1), 20)
    return check_normals(
        settings,
        image,
        isovalue,
        camera=camera,
        limit=tolerances.NORMAL_NOISE_DEGREES,
        cached=cached,
    )


CASES = (
    Case("normals of a quadric", _quadric),
    Case("normals of a quadric, values of 1e-25", partial(_quadric, scale=1e-27), quick=False),
    Case("normals of a quadric, values of 1e38", partial(_quadric, scale=2e35), quick=False),
    Case(
        "normals of a quadric, rotated, spacing 1:2:0.5",
        partial(_quadric, spacing=(1, 2, 0.5), direction=_ROTATION),
    ),
    Case("normals of a sphere of 6 voxels", partial(_sphere, 6.0), quick=False),
    Case("normals of a sphere of 20 voxels", partial(_sphere, 20.0)),
    Case("normals of a plane, to the volume's border", _plane),
    Case("normals in white noise", partial(_noise, False)),
    Case("normals in white noise, pass by pass", partial(_noise, True), quick=False),
    Case("normals about a corner of eight blocks", partial(_block_corner, False), quick=False),
    Case("normals about a corner of eight blocks, pass by pass", partial(_block_corner, True)),
)
