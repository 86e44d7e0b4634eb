// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// From VTK's scene to the pipeline's, and back from hit keys to depths. All in double
// precision: a volume may lie at 1e6 with a spacing of 1e-3.
#ifndef SceneTranslation_h
#define SceneTranslation_h

#include "Pipeline/PipelineScene.h"

#include <cstdint>

class vtkCompressedVolume;
class vtkImageData;
class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;

/// `viewport`: width, height and origin of what is drawn into. Rays, image, isovalues, clipping,
/// cropping, lights and material of a volume seen by a renderer's camera.
PipelineScene TranslateScene(vtkRenderer* renderer, vtkVolume* volume, vtkVolumeMapper* mapper,
  vtkImageData* image, vtkCompressedVolume* compressed, const int viewport[4]);

/// Are the rays numbers? They are not where the image's geometry, the prop's matrix or the camera
/// is not, or cannot be inverted, and no walk along them would end.
bool HasRays(const glsl::View& view);

/// Do rays have the same hits in both? Cameras are compared with a relative tolerance of 1e-7
/// (vtkWindowToImageFilter perturbs the view angle by rounding), everything else exactly.
bool SameHits(const glsl::View& a, const glsl::View& b);

/// Do hits look the same?
bool SameLook(const glsl::Look& a, const glsl::Look& b);

///@{ Of a pixel, from the viewport's bottom left: the ray's parameter at the hit that a key of
/// Rays.glsl stands for, infinity for no hit; the distance in world units of parameter t from the
/// camera (in parallel projection: from its plane); the place in eye coordinates.
double HitParameter(const glsl::View& view, int x, int y, std::uint32_t key);
double RayLength(const glsl::View& view, int x, int y, double t);
void EyePosition(const glsl::View& view, int x, int y, double t, double position[3]);
///@}

#endif
