"""Hold the options of a run, which all measurements share."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkImageData

from ..camera import Camera, orbit_camera
from .fields import Field

#: Widths and heights that the scaling with image size goes through.
IMAGE_SIZES = ((640, 360), (1280, 720), (1920, 1080), (3840, 2160))

#: Those of a fly-through.
FLIGHT_SIZES = (IMAGE_SIZES[1], IMAGE_SIZES[3])

#: Stands for a field's fixed isovalues instead of a number of random ones.
PEERS = "peers"


@dataclass(frozen=True)
class Settings:
    """Holds the options of a run.

    Attributes
    ----------
    size : tuple of int
        Width and height of the images in pixels.
    isovalues : int or str
        How many random ones, or `PEERS` for the fixed ones.
    positions : int
        Of the orbit.
    repeat : int
        How often every image is timed.
    seed : int
        Of the random isovalues.
    largest : int, optional
        Largest side of the volumes in the scaling with volume size.
    images : tuple of tuple of int
        Widths and heights in the scaling with image size, of a fly-through, or of bounds.
    largest_mesh : int, optional
        Largest side of the volumes that meshes are made of.
    largest_plain : int, optional
        Largest side of the volumes that are shown decompressed in a fly-through.
    frames : int
        Of the long run, or of each movement of a fly-through.
    baseline : pathlib.Path, optional
        Where the package of an earlier commit is imported from, see `processes`.
    pictures : pathlib.Path, optional
        Folder where sheets of pictures go.
    """

    size: tuple[int, int]
    isovalues: int | str
    positions: int
    repeat: int = 1
    seed: int = 0
    largest: int | None = None
    images: tuple[tuple[int, int], ...] = IMAGE_SIZES
    largest_mesh: int | None = None
    largest_plain: int | None = None
    frames: int = 10_000
    baseline: Path | None = None
    pictures: Path | None = None

    def isovalues_of(self, field: Field) -> list[float]:
        """Return the isovalues that a field is rendered at."""
        if isinstance(self.isovalues, str):
            return list(field.isovalues)
        return field.random_isovalues(self.isovalues, self.seed)

    def not_plain(self, field: Field) -> str | None:
        """Return the reason why a field is not shown decompressed; None where it is."""
        large = self.largest_plain is not None and max(field.dimensions) > self.largest_plain
        return f"no plain volumes larger than {self.largest_plain}" if large else None

    def no_mesh_of(self, field: Field) -> str | None:
        """Return the reason why no mesh is made of a field; None where one is made."""
        large = self.largest_mesh is not None and max(field.dimensions) > self.largest_mesh
        return f"no meshes of volumes larger than {self.largest_mesh}" if large else None

    def cameras(self, image: vtkImageData) -> list[Camera]:
        """Return the orbit's cameras around an image."""
        return [orbit_camera(image, i, self.positions) for i in range(self.positions)]

    def heading(self, field: Field) -> dict[str, Any]:
        """Make what every record begins with: the field and how it was seen."""
        return {
            "field": field.name,
            "size": list(self.size),
            "isovalues": self.isovalues_of(field),
            "fixed_isovalues": self.isovalues == PEERS,
            "positions": self.positions,
            "repeat": self.repeat,
        }
