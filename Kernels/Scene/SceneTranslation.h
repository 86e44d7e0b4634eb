// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// From VTK's scene to the pipeline's.
#ifndef SceneTranslation_h
#define SceneTranslation_h

#include "Pipeline/PipelineScene.h"

class vtkCompressedVolume;
class vtkImageData;
class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;

/// Translates a volume as a renderer's camera sees it: rays, image, isovalues, clipping, cropping,
/// lights and material. `viewport`: width, height and origin, in pixels, of what is drawn into.
/// `reduction`: how many of these pixels there are to a ray on each axis. `litSides`: see
/// Constants.glsl.h.
PipelineScene TranslateScene(vtkRenderer* renderer, vtkVolume* prop, vtkVolumeMapper* mapper,
  vtkImageData* image, vtkCompressedVolume* volume, const int viewport[4], int reduction,
  int litSides);

#endif
