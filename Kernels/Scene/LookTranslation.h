// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Isovalues with their colours, material and lights.
#ifndef LookTranslation_h
#define LookTranslation_h

#include "Pipeline/PipelineScene.h"

class vtkCompressedVolume;
class vtkLightCollection;
class vtkMatrix4x4;
class vtkVolumeProperty;

/// Translates the isovalues that show to the units of the stream, and finds their colours and
/// opacities. Without one no ray meets anything.
void TranslateIsovalues(
  vtkVolumeProperty* property, vtkCompressedVolume* volume, PipelineScene& scene);

void TranslateMaterial(vtkVolumeProperty* property, glsl::Look& look);

/// Translates the lights that are switched on. Without one, ambient light alone is left: the
/// colours are darkened here, and no normal is needed.
void TranslateShading(
  vtkLightCollection* lights, bool twoSided, vtkMatrix4x4* worldToEye, PipelineScene& scene);

#endif
