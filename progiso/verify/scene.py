"""Render images of a compressed volume, time them and compare them with the caster."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonMath import vtkMatrix4x4

from ..camera import Camera, orbit_camera
from ..compression import decompress
from ..geometry import samples_of
from ..io import compress
from ..measure import tolerances
from ..measure.agreement import Agreement, compare
from ..measure.isosurface import Isosurface
from ..measure.view import opposite
from ..oracle import caster
from .case import Outcome, Settings, worst_of
from .fields import make_image

#: Seconds that a GPU is kept busy before an image's time counts; it was busy not long ago.
_WARM_UP = 0.3

#: Part of grazing rays from which on the note tells of them.
_TOLD = 1e-3

#: Bits per sample where a case does not set a rate: samples are decoded to the last bits.
RATE = 32


def compressed(values: np.ndarray, rate: float = RATE, **geometry: Any) -> vtkImageData:
    """Compress values [z, y, x]; `geometry` as in `fields.make_image`."""
    return compress(make_image(values, **geometry), rate=rate)


def decoded(image: vtkImageData, user: np.ndarray | None = None) -> caster.Volume:
    """Decode a compressed volume by libzfp, for the caster."""
    plain = decompress(image)
    cells = plain.GetPointData().GetScalars() is None
    matrix = np.eye(4) if user is None else np.asarray(user, float)
    return caster.Volume.from_image(samples_of(plain), plain, matrix, 0.5 if cells else 0.0)


class Picture(Isosurface):
    """Shows a compressed volume in a view whose clipping planes may be given.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.
    isovalue : float
    size : tuple of int
        Width and height in pixels.
    user : 4x4 array, optional
        The prop's matrix.
    clip : tuple of float, optional
        Distances of the clipping planes; by default they stand around the volume.
    pixel_tolerance : float, optional
        How many pixels samples may be apart, to draw with levels of detail.
    settings
        Of `Isosurface`.
    """

    def __init__(
        self,
        image: vtkImageData,
        isovalue: float,
        size: tuple[int, int],
        *,
        user: np.ndarray | None = None,
        clip: tuple[float, float] | None = None,
        pixel_tolerance: float | None = None,
        **settings: Any,
    ) -> None:
        super().__init__(image, isovalue, size, **settings)
        self._clip = clip
        if pixel_tolerance is not None:
            self.mapper.SetLevelOfDetailToOn()
            self.mapper.SetPixelTolerance(pixel_tolerance)
        if user is not None:
            matrix = vtkMatrix4x4()
            matrix.DeepCopy(np.asarray(user, float).ravel())
            self.prop.SetUserMatrix(matrix)

    def look(self, camera: Camera) -> None:
        super().look(camera)
        if self._clip is not None:
            self.renderer.GetActiveCamera().SetClippingRange(self._clip)

    def time(self, camera: Camera, repeat: int) -> float:
        """Return the least milliseconds of an image; before each another image is rendered.

        With `repeat` 0 those of the first image.
        """
        first = self.warm_up(camera, _WARM_UP if repeat > 0 else 0.0)
        times = [] if repeat > 0 else [first]
        for _ in range(repeat):
            self.render_from(opposite(camera))
            times.append(self.render_from(camera))
        return min(times)

    def rays(self) -> tuple[caster.Camera, tuple[float, float]]:
        """Return camera and clipping range, for the caster."""
        camera = self.renderer.GetActiveCamera()
        return caster.Camera.from_vtk(camera), camera.GetClippingRange()


def check_depths(
    settings: Settings,
    image: vtkImageData,
    isovalue: float,
    camera: Camera | None = None,
    *,
    size: tuple[int, int] | None = None,
    grazing: float = tolerances.GRAZING_FRACTION,
    hits: bool = True,
    user: np.ndarray | None = None,
    note: str = "",
    volume: caster.Volume | None = None,
    level: float | None = None,
    sample: int | None = None,
    **options: Any,
) -> Outcome:
    """Render an image, time it, and compare its depths with the caster's.

    Parameters
    ----------
    settings : case.Settings
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        A compressed volume.
    isovalue : float
    camera : progiso.Camera, optional
        By default one of the orbit's.
    size : tuple of int, optional
        Of the image, in place of the settings'.
    grazing : float
        Part of the rays that may graze; with more there is too little to judge by.
    hits : bool
        Whether there have to be any; a case of none has to have none.
    user : 4x4 array, optional
        The prop's matrix.
    note : str
    volume : progiso.oracle.caster.Volume, optional
        What the caster casts; by default what libzfp decodes.
    level : float, optional
        The isovalue in that volume, where it is in other units.
    sample : int, optional
        How many rays of the image are held against the caster's, at random; by default all.
    options
        Of `Picture`.

    Returns
    -------
    case.Outcome
    """
    size = size or settings.size
    view = Picture(image, isovalue, size, user=user, **options)
    shot = shoot(view, camera, settings.repeat)
    volume = volume or decoded(image, user)
    pixels, depth = None, shot.depth
    if sample is not None:
        pixels = np.sort(np.random.default_rng(1).integers(0, depth.size, sample))
        depth = depth.ravel()[pixels]
    level = isovalue if level is None else level
    expected = caster.cast(
        volume, level, shot.eye, size, slack=tolerances.SLACK, clip=shot.clip, pixels=pixels
    )
    return judge(replace(shot, depth=depth), expected, grazing=grazing, hits=hits, note=note)


@dataclass(frozen=True)
class Shot:
    """Holds an image's depths, and what it takes to judge them.

    Attributes
    ----------
    depth : numpy.ndarray
    eye : progiso.oracle.caster.Camera
    clip : tuple of float
        Distances of the clipping planes.
    milliseconds : float
    defect : str
        What is wrong with the image as a whole; empty where nothing is.
    """

    depth: np.ndarray
    eye: caster.Camera
    clip: tuple[float, float]
    milliseconds: float
    defect: str


def shoot(view: Picture, camera: Camera | None, repeat: int) -> Shot:
    """Render and time an image, from one of the orbit's cameras by default, and close the view."""
    try:
        milliseconds = view.time(camera or orbit_camera(view.prop, 1, 4), repeat)
        depth, (eye, clip) = view.depth(), view.rays()
        complete, errors = view.converged(), view.mapper.GetNumberOfGLErrors()
    finally:
        view.close()
    defects = (
        "" if complete else "the image is not complete",
        f"{errors} OpenGL errors" if errors else "",
    )
    return Shot(depth, eye, clip, milliseconds, "; ".join(filter(None, defects)))


def judge(
    shot: Shot,
    expected: caster.Cast,
    *,
    grazing: float = tolerances.GRAZING_FRACTION,
    hits: bool = True,
    note: str = "",
) -> Outcome:
    """Hold an image's depths against the caster's; `grazing`, `hits`: see `check_depths`."""
    found = compare(shot.depth, expected)
    defects = (
        shot.defect,
        f"{found.grazing:.1%} of the rays graze" if found.grazing > grazing else "",
        _wrong_hits(found),
        "" if (found.hits > 0) == hits else f"{found.hits} hits",
    )
    error, limit = found.worst
    # beyond what is asked of depths, within what their float32 can tell
    rounded = bool(error > tolerances.DEPTH_VOXELS)
    far = np.max(np.where(np.isfinite(shot.depth), shot.depth, 0) * expected.voxels)
    distances = f"; float32 rounds distances of {far:.2g} voxels" if rounded else ""
    place = float(tolerances.PLACE_VOXELS * expected.spacing * np.max(expected.voxels))
    if place > tolerances.DEPTH_VOXELS:
        distances += f", and rays are made in steps of {place:.2g} of them"
    return Outcome(
        error,
        limit,
        shot.milliseconds,
        note="; ".join(filter(None, (note, f"{found.hits} hits{distances}{_grazing(found)}"))),
        documented=rounded,
        defect="; ".join(filter(None, defects)),
    )


def _grazing(found: Agreement) -> str:
    """Tell how many rays graze, where that is worth telling."""
    if found.grazing < _TOLD:
        return ""
    return f", {found.grazing:.1%} of the rays graze and {found.differing:.2%} differ"


def _wrong_hits(found: Agreement) -> str:
    """Tell how many rays hit or miss for certain where they must not."""
    count = int(np.isinf(found.error).sum())
    return f"{count} rays hit where they cannot, or miss what is certain" if count else ""


def check_views(
    settings: Settings,
    image: vtkImageData,
    isovalues: Sequence[float],
    cameras: Sequence[Camera | None] = (None,),
    **options: Any,
) -> Outcome:
    """Return the worst `check_depths` of all isovalues from all cameras."""
    options.setdefault("volume", decoded(image, options.get("user")))
    return worst_of(
        check_depths(settings, image, isovalue, camera, **options)
        for isovalue in isovalues
        for camera in cameras
    )


def parallel(camera: Camera, scale: float) -> Camera:
    """Make a camera's projection parallel, its image twice `scale` high."""
    return replace(camera, parallel=True, parallel_scale=float(scale))


def looking(
    position: Sequence[float] | np.ndarray,
    focal_point: Sequence[float] | np.ndarray,
    view_up: Sequence[float] | np.ndarray = (0.0, 1.0, 0.0),
    view_angle: float = 30.0,
) -> Camera:
    """Make a `progiso.Camera` of numbers of any kind."""
    place, target, up = (tuple(map(float, v)) for v in (position, focal_point, view_up))
    return Camera(place, target, up, view_angle=float(view_angle))
