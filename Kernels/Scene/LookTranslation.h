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

/// Translates the lights that are switched on, which reach `litSides` (see Constants.glsl.h).
/// Without one no normal is needed, and the colours are darkened here: ambient light alone is left,
/// or as VTK has it of meshes, ambient and diffuse light.
void TranslateShading(
  vtkLightCollection* lights, int litSides, vtkMatrix4x4* worldToEye, PipelineScene& scene);

#endif
