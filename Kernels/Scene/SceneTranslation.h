// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// From VTK's scene to the pipeline's.
#ifndef SceneTranslation_h
#define SceneTranslation_h

#include "Pipeline/PipelineScene.h"
#include "Scene/LevelTranslation.h"

#include <vector>

class vtkCompressedVolume;
class vtkImageData;
class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;

/// What a mapper's properties, and its renderer, ask for.
struct SceneChoice
{
  int Viewport[4] = {};           ///< width, height and origin, in pixels, of what is drawn into
  int ImageReduction = 1;         ///< how many of these pixels there are to a ray on each axis
  int LitSides = 0;               ///< see Constants.glsl.h
  std::vector<LevelSteps> Levels; ///< of detail to choose from; empty: the volume itself is drawn
  double PixelTolerance = 1.0;    ///< how many pixels the samples of a level may be apart
};

/// Translates a volume as a renderer's camera sees it: rays, image, isovalues, clipping, cropping,
/// levels of detail, lights and material.
PipelineScene TranslateScene(vtkRenderer* renderer, vtkVolume* prop, vtkVolumeMapper* mapper,
  vtkImageData* image, vtkCompressedVolume* volume, const SceneChoice& choice);

#endif
