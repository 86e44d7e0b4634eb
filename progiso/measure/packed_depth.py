"""Read distances along the rays from what VTK draws, finer than its depth buffer.

A fragment shader writes the distance from the eye into the 24 bits of the pixel's colour, evenly
over the range that the prop lies in. A depth buffer of 24 bits crowds its steps at the near
plane, which VTK puts up to a thousand times nearer than the far one; and VTK's volume mapper
writes no depth at all in isosurface mode.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..rendering import window_pixels
from .view import View

_STEPS = 2**24 - 2  # 0 is left for pixels without a surface

_GLSL = """
if ({hit})
{{
  float progisoPlace = clamp(({distance} - {near:.9g}) / {span:.9g}, 0.0, 1.0);
  uint progisoStep = uint(progisoPlace * {steps:.1f} + 0.5) + 1u;
  uvec3 progisoBytes = uvec3(progisoStep >> 16, progisoStep >> 8, progisoStep) & 255u;
  gl_FragData[0] = vec4(vec3(progisoBytes) / 255.0, 1.0);
}}
else
{{
  gl_FragData[0] = vec4(0.0);
}}
"""


@dataclass(frozen=True)
class DepthRange:
    """Distances from the eye between which a prop lies.

    Attributes
    ----------
    near, span : float
        The smallest, and how much larger the largest is, in world units.
    """

    near: float
    span: float

    @classmethod
    def of(cls, view: View) -> DepthRange:
        """Make the range of the sphere around a view's prop."""
        camera = view.renderer.GetActiveCamera()
        low, high = np.reshape(view.prop.GetBounds(), (3, 2)).T
        radius = np.linalg.norm(high - low) / 2
        away = np.linalg.norm((low + high) / 2 - camera.GetPosition())
        near = max(0.0, float(away - radius))
        return cls(near, float(away + radius) - near)

    @property
    def resolution(self) -> float:
        """Return the smallest difference between two distances, in world units."""
        return self.span / _STEPS

    def glsl(self, distance: str, hit: str = "true") -> str:
        """Write GLSL that replaces the colour by a distance.

        Parameters
        ----------
        distance, hit : str
            GLSL expressions of the distance from the eye, and of whether there is a surface.

        Returns
        -------
        str
        """
        return _GLSL.format(
            hit=hit, distance=distance, near=self.near, span=self.span, steps=float(_STEPS)
        )

    def read(self, view: View) -> np.ndarray:
        """Read the distances in a view that was rendered with this range's GLSL.

        Returns
        -------
        numpy.ndarray of float64, shape (height, width)
            World units along the rays, ``inf`` where there is no surface. Row 0 is the top.
        """
        red, green, blue = np.moveaxis(window_pixels(view.window, *view.size).astype(int), -1, 0)
        step = red << 16 | green << 8 | blue
        return np.where(step > 0, self.near + (step - 1) / _STEPS * self.span, np.inf)
