"""Show a volume by vtkGPUVolumeRayCastMapper in isosurface blend mode."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkVolume, vtkVolumeProperty
from vtkmodules.vtkRenderingVolume import vtkGPUVolumeRayCastMapper

from ..measure.packed_depth import DepthRange
from ..measure.view import View

# The mapper samples at fixed steps and shades the first sample behind the surface: the shader keeps
# that place, in texture coordinates. Texture coordinates have samples at texel centres.
_DECLARE = "vec3 progisoHit = vec3(-1.0);\n"
_REMEMBER = "if (progisoHit.x < 0.0 && g_fragColor.a > 0.0) { progisoHit = g_dataPos; }\n"
_TEXELS = "vec3(textureSize(in_volume[0], 0))"
_PLACE = f"vec4((progisoHit * {_TEXELS} - 0.5) / ({_TEXELS} - 1.0), 1.0)"
_TO_EYE = "in_modelViewMatrix * in_volumeMatrix[0] * in_textureDatasetMatrix[0]"


class VolumeMapper(View):
    """A plain volume, rendered by VTK's mapper.

    Parameters
    ----------
    image : vtkmodules.vtkCommonDataModel.vtkImageData
        Plain.
    isovalue : float
    size : tuple of int
        Width and height in pixels.
    sample_distance : float, optional
        Between samples along a ray, in the smallest spacing; by default what VTK chooses.
    """

    label = "VTK isosurface mapper"

    def __init__(
        self,
        image: vtkImageData,
        isovalue: float,
        size: tuple[int, int],
        sample_distance: float | None = None,
    ) -> None:
        self.mapper = vtkGPUVolumeRayCastMapper()
        self.mapper.SetInputData(image)
        self.mapper.SetBlendModeToIsoSurface()
        if sample_distance is not None:
            self.mapper.AutoAdjustSampleDistancesOff()
            self.mapper.SetSampleDistance(sample_distance * min(image.GetSpacing()))
        prop = vtkVolume()
        prop.SetMapper(self.mapper)
        prop.SetProperty(_opaque_property(image, isovalue))
        super().__init__(prop, size)

    def set_isovalue(self, isovalue: float) -> None:
        """Show another isovalue from the next render on."""
        self.prop.GetProperty().GetIsoSurfaceValues().SetValue(0, isovalue)

    def depth(self) -> np.ndarray:
        """Render once more, and read the distances along the rays."""
        depths = DepthRange.of(self)
        hit = "progisoHit.x >= 0.0"
        replacements = {
            "//VTK::Base::Dec": _DECLARE,
            "//VTK::RenderToImage::Impl": _REMEMBER,
            "//VTK::RenderToImage::Exit": depths.glsl(f"length(({_TO_EYE} * {_PLACE}).xyz)", hit),
        }
        shader = self.prop.GetShaderProperty()
        for tag, code in replacements.items():
            shader.AddFragmentShaderReplacement(tag, True, f"{tag}\n{code}", False)
        self.render()
        shader.ClearAllFragmentShaderReplacements()
        return depths.read(self)

    def depth_resolution(self) -> float:
        """Return the resolution of `depth` in world units."""
        return DepthRange.of(self).resolution


def _opaque_property(image: vtkImageData, isovalue: float) -> vtkVolumeProperty:
    """Make a property that is white, shaded and opaque at every value."""
    low, high = image.GetScalarRange()
    color, opacity = vtkColorTransferFunction(), vtkPiecewiseFunction()
    color.AddRGBPoint(low, 1.0, 1.0, 1.0)
    for value in (low, high):
        opacity.AddPoint(value, 1.0)
    properties = vtkVolumeProperty()
    properties.GetIsoSurfaceValues().SetValue(0, isovalue)
    properties.SetColor(color)
    properties.SetScalarOpacity(opacity)
    properties.SetInterpolationTypeToLinear()
    properties.ShadeOn()
    return properties
