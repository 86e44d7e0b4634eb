"""Measure what levels of detail get wrong, and what they spare, beside VTK's mapper.

Depths are held against the double-precision caster over the decompressed samples, which VTK's
mapper is given, too; of volumes that are too large for it, against ProgIso's own exact image.
Colours are held against a picture eight times as wide and high, exact, whose pixels are averaged.
All ways have one material, and lights that reach both sides of a surface.

Times are medians of the view after the camera moved by 2 degrees, both views having been rendered
before: shaders are compiled, and blocks that the views need are decoded.
"""

from __future__ import annotations

import math
import statistics
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from .._typing import Array
from ..camera import Camera, view_camera
from ..compression import decompress
from ..geometry import samples_of
from ..io import compress
from ..measure.isosurface import Isosurface
from ..measure.view import View, turned
from ..options import MAX_LEVELS
from ..oracle import caster
from ..rendering import MAX_SIZE, window_pixels
from ..vtkProgIsoKernels import vtkProgressiveIsosurfaceMapper
from .errors import of_one_image
from .fields import Field, plain
from .latency import MOVE
from .settings import Settings
from .volume_mapper import VolumeMapper

#: The part of an image's height that the volume covers.
VIEWS = {"middle": 2 / 3, "far": 1 / 3, "farthest": 1 / 10}

#: How many pixels of the exact picture, along each axis, are averaged to one of the reference.
REFERENCE = 8

#: Largest width and height of an image, of which the reference's picture can still be rendered.
LARGEST_IMAGE = MAX_SIZE // REFERENCE

#: Names of the ways of ProgIso: whether levels of detail are drawn, and the pixels between samples.
EXACT, ON, CONSERVATIVE = "Off", "On", "Conservative"
OURS = {
    EXACT: (vtkProgressiveIsosurfaceMapper.LevelOfDetailOff, 1.0),
    "On, 0.5 pixels": (vtkProgressiveIsosurfaceMapper.LevelOfDetailOn, 0.5),
    ON: (vtkProgressiveIsosurfaceMapper.LevelOfDetailOn, 1.0),
    "On, 2 pixels": (vtkProgressiveIsosurfaceMapper.LevelOfDetailOn, 2.0),
    CONSERVATIVE: (vtkProgressiveIsosurfaceMapper.LevelOfDetailConservative, 1.0),
}

#: VTK's distances between samples in the smallest spacing, by the names of its ways.
PEER = "VTK, 1 voxel"
THEIRS = {"VTK, 1/4 voxel": 0.25, PEER: 1.0, "VTK, 4 voxels": 4.0}

#: What a sheet of pictures shows.
SHOWN = (EXACT, ON, CONSERVATIVE, PEER)

#: How often views are timed at least, unless that takes more than so many milliseconds.
_REPEAT, _ENOUGH_MS = 5, 5000.0

#: Most samples of a volume whose exact depths come from the double-precision caster.
_CAST_SAMPLES = 2**26


def depth_errors(depth: Array, exact: Array, footprint: Array) -> dict[str, float | None]:
    """Summarize how far depths are off, in footprints of pixels.

    Parameters
    ----------
    depth, exact : numpy.ndarray, shape (height, width)
        Distances along the rays, ``inf`` where there is no hit.
    footprint : numpy.ndarray, shape (height, width)
        Distance of neighbouring pixels' rays at a distance of 1 along the ray.

    Returns
    -------
    dict
        ``mean``, ``p99`` and ``largest`` over the rays that both hit (None where there are none);
        ``missed`` and ``invented``: the rays that do not hit where they should, and that hit where
        they should not, in parts of those that should (of one where there are none).

    Examples
    --------
    >>> depth_errors(np.array([2.5, np.inf]), np.array([2.0, 2.0]), np.array([0.5, 0.5]))
    {'mean': 0.5, 'p99': 0.5, 'largest': 0.5, 'missed': 0.5, 'invented': 0.0}
    """
    hit, due = np.isfinite(depth), np.isfinite(exact)
    both, count = hit & due, max(1, int(due.sum()))
    off = np.abs(depth[both] - exact[both]) / (footprint[both] * exact[both])
    return {
        "mean": float(off.mean()) if off.size else None,
        "p99": float(np.quantile(off, 0.99)) if off.size else None,
        "largest": float(off.max()) if off.size else None,
        "missed": float((due & ~hit).sum()) / count,
        "invented": float((hit & ~due).sum()) / count,
    }


def color_error(picture: Array, reference: Array) -> float:
    """Compute the root mean square difference of colours where one of two pictures shows something.

    Parameters
    ----------
    picture, reference : numpy.ndarray, shape (height, width, 3)
        Red, green and blue from 0 to 255, on black.

    Returns
    -------
    float
        0 of pictures that show nothing.

    Examples
    --------
    >>> color_error(np.array([[[3, 3, 3], [0, 0, 0]]]), np.array([[[0, 0, 0], [0, 0, 0]]]))
    3.0
    """
    shown = picture.any(axis=-1) | reference.any(axis=-1)
    off = picture[shown].astype(float) - reference[shown]
    return float(np.sqrt(np.square(off).mean())) if off.size else 0.0


def averaged(picture: Array, count: int) -> Array:
    """Average squares of so many pixels along each axis.

    Parameters
    ----------
    picture : numpy.ndarray, shape (count * height, count * width, 3)
    count : int

    Returns
    -------
    numpy.ndarray of float32, shape (height, width, 3)
    """
    height, width = picture.shape[0] // count, picture.shape[1] // count
    squares = picture.reshape(height, count, width, count, 3)
    return squares.mean(axis=(1, 3), dtype=np.float32)


def measure_bounds(field: Field, settings: Settings) -> dict[str, Any]:
    """Measure the errors and times of all ways, in all views of a field.

    Parameters
    ----------
    field : fields.Field
    settings : settings.Settings
        The images are those of the first isovalue, at most `LARGEST_IMAGE` wide and high. With
        ``pictures`` each view's are drawn on a sheet in that folder.

    Returns
    -------
    dict
        ``isovalue``, ``exact`` (what depths are held against: ``caster``, or ``Off``), and
        ``views``, each with ``view``, ``hits`` (of the exact depths) and ``rows``, one a way:
        ``way``, ``distance`` (VTK's), ``ms``, `depth_errors`'s figures and ``color``, the
        `color_error`; of ProgIso also ``blocks`` (that a first image decodes as rays meet them),
        ``levels`` ({level: pixels}) and ``uncertain`` (a fraction of the pixels). A row with
        ``failed`` has nothing else. With ``left_out`` there is no image.
    """
    return of_one_image(field, settings, lambda: _Measurement(field, settings).run())


@dataclass(frozen=True)
class _Image:
    """Holds what the rays of a view see exactly, and the picture that the ways come near to."""

    camera: Camera
    exact: Array
    footprint: Array
    reference: Array


class _Measurement:
    """Measures one field at one size."""

    def __init__(self, field: Field, settings: Settings) -> None:
        self._field, self._settings = field, settings
        self._isovalue = settings.isovalues_of(field)[0]
        self._volume = compress(plain(field), rate=field.rate, levels=MAX_LEVELS)

    @cached_property
    def _decompressed(self) -> vtkImageData:
        return decompress(self._volume)

    @property
    def _casts(self) -> bool:
        """Tell whether the volume is small enough for the double-precision caster."""
        return self._field.voxels <= _CAST_SAMPLES

    def run(self) -> dict[str, Any]:
        return {
            "isovalue": self._isovalue,
            "exact": "caster" if self._casts else EXACT,
            "views": [self._view(name, part) for name, part in VIEWS.items()],
        }

    def _view(self, name: str, part: float) -> dict[str, Any]:
        width, height = self._settings.size
        camera = view_camera(self._volume, aspect=width / height, zoom=part)
        image = self._image(camera)
        measured = {way: self._our_row(way, image) for way in OURS}
        measured |= {way: self._their_row(way, image) for way in THEIRS}
        if self._settings.pictures is not None:
            path = self._settings.pictures / f"{name}-{self._field.name}-{width}x{height}.png"
            shown = {way: measured[way][1] for way in SHOWN}
            _draw_sheet({**shown, "reference": image.reference}, path)
        return {
            "view": name,
            "hits": int(np.isfinite(image.exact).sum()),
            "rows": [{"way": way, **row} for way, (row, _) in measured.items()],
        }

    # ---- what is right

    def _image(self, camera: Camera) -> _Image:
        size = self._settings.size
        exact = self._ours(*OURS[EXACT])
        exact.render_from(camera)
        depth = exact.depth()
        seen = exact.renderer.GetActiveCamera()
        rays = caster.Camera.from_vtk(seen)
        across = (rays.rays(size)[1] @ rays.forward).reshape(depth.shape)
        footprint = 2 * math.tan(math.radians(camera.view_angle) / 2) / size[1] * across
        if self._casts:
            samples = caster.Volume.from_image(samples_of(self._decompressed), self._decompressed)
            clip = seen.GetClippingRange()
            depth = caster.cast(samples, self._isovalue, rays, size, clip=clip).depth
        exact.close()
        return _Image(camera, depth, footprint, self._reference(camera))

    def _reference(self, camera: Camera) -> Array:
        width, height = (REFERENCE * side for side in self._settings.size)
        view = self._ours(*OURS[EXACT], size=(width, height))
        view.render_from(camera)
        picture = window_pixels(view.window, width, height)
        view.close()
        return averaged(picture, REFERENCE)

    # ---- ways

    def _ours(
        self,
        level_of_detail: int,
        tolerance: float,
        *,
        size: tuple[int, int] | None = None,
        cached: bool = False,
    ) -> Isosurface:
        size = size or self._settings.size
        view = Isosurface(self._volume, self._isovalue, size, cached=cached)
        view.mapper.SetLitLikeMeshes(False)  # as VTK lights volumes
        view.mapper.SetLevelOfDetail(level_of_detail)
        view.mapper.SetPixelTolerance(tolerance)
        return view

    def _our_row(self, way: str, image: _Image) -> tuple[dict[str, Any], Array | None]:
        """Measure a way of ProgIso; return its row and its picture."""
        view = self._ours(*OURS[way], cached=True)
        view.render_from(image.camera)
        first = view.statistics()
        view.close()
        about = {
            "blocks": sum(one["decoded_blocks"] for one in first["passes"]),
            "levels": {str(level): count for level, count in first["levels"].items()},
            "uncertain": first["uncertain"],
        }
        row, picture = self._row(self._ours(*OURS[way]), image)
        return {**row, **about}, picture

    def _their_row(self, way: str, image: _Image) -> tuple[dict[str, Any], Array | None]:
        """Measure VTK's mapper, or tell why it fails; return its row and its picture."""
        distance, size = THEIRS[way], self._settings.size
        view = VolumeMapper(self._decompressed, self._isovalue, size, distance)
        _copy_material(self._ours(*OURS[EXACT]), view)
        try:
            row, picture = self._row(view, image)
        except RuntimeError as error:  # VTK's own limits are a result, too
            view.close()
            return {"failed": str(error)}, None
        return {"distance": distance, **row}, picture

    def _row(self, view: View, image: _Image) -> tuple[dict[str, Any], Array]:
        """Measure what all ways have, and close the view; return its picture, too."""
        milliseconds = self._time(view, image.camera)
        picture = window_pixels(view.window, *self._settings.size)
        errors = depth_errors(view.depth(), image.exact, image.footprint)
        view.close()
        color = color_error(picture, image.reference)
        return {"ms": milliseconds, **errors, "color": color}, picture

    def _time(self, view: View, camera: Camera) -> float:
        """Return the median milliseconds after moves back and forth, the last one to the camera."""
        pair = (turned(camera, MOVE), camera)
        view.warm_up(camera)
        for each in pair:
            view.render_from(each)
        times: list[float] = []
        repeat = max(_REPEAT, self._settings.repeat)
        while not times or (len(times) < repeat and sum(times) < _ENOUGH_MS):
            times += [view.render_from(each) for each in pair]
        return statistics.median(times)


def _copy_material(ours: View, theirs: View) -> None:
    """Give a view another one's material, so that only what is drawn differs."""
    source, target = ours.prop.GetProperty(), theirs.prop.GetProperty()
    target.SetAmbient(source.GetAmbient())
    target.SetDiffuse(source.GetDiffuse())
    target.SetSpecular(source.GetSpecular())
    target.SetSpecularPower(source.GetSpecularPower())


def _draw_sheet(pictures: dict[str, Array | None], path: Path) -> None:
    from .sheets import draw_sheet  # only here, so that measuring needs no matplotlib

    draw_sheet({name: each for name, each in pictures.items() if each is not None}, path)
