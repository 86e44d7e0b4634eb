// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/SceneTranslation.h"

#include "Pipeline/ImageRectangle.h"
#include "Scene/CameraTranslation.h"
#include "Scene/LookTranslation.h"
#include "Scene/RegionTranslation.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <limits>

namespace
{
// Without an inverse all elements are NaN, and there are no rays.
void FindEyeToIndex(vtkMatrix4x4* worldToEye, vtkMatrix4x4* indexToWorld, vtkMatrix4x4* eyeToIndex)
{
  vtkNew<vtkMatrix4x4> indexToEye;
  vtkMatrix4x4::Multiply4x4(worldToEye, indexToWorld, indexToEye);
  vtkMatrix4x4::Invert(indexToEye, eyeToIndex);
  if (indexToEye->Determinant() == 0.0)
  {
    std::fill_n(eyeToIndex->GetData(), 16, std::numeric_limits<double>::quiet_NaN());
  }
}
}

PipelineScene TranslateScene(vtkRenderer* renderer, vtkVolume* prop, vtkVolumeMapper* mapper,
  vtkImageData* image, vtkCompressedVolume* volume, const SceneChoice& choice)
{
  PipelineScene scene;
  ViewGeometry& view = scene.View;
  vtkCamera* camera = renderer->GetActiveCamera();
  vtkVolumeProperty* property = prop->GetProperty();
  vtkMatrix4x4* projection =
    camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1, 1);
  vtkMatrix4x4* worldToEye = camera->GetModelViewTransformMatrix();
  vtkNew<vtkMatrix4x4> indexToWorld, worldToIndex, eyeToIndex;
  FindIndexToWorld(prop, image, volume, indexToWorld);
  vtkMatrix4x4::Invert(indexToWorld, worldToIndex);
  FindEyeToIndex(worldToEye, indexToWorld, eyeToIndex);

  for (int axis = 0; axis < 2; ++axis)
  {
    const int pixels = choice.Viewport[axis];
    view.WindowSize[axis] = pixels;
    view.ViewportSize[axis] = (pixels + choice.ImageReduction - 1) / choice.ImageReduction;
  }
  std::copy(choice.Viewport + 2, choice.Viewport + 4, view.ViewportOrigin);
  TranslateRays(projection, eyeToIndex, view);
  camera->GetClippingRange(view.NearDistance, view.FarDistance);
  TranslateNoLevels(view);
  if (!choice.Levels.empty() && HasRays(view))
  {
    TranslateLevels(eyeToIndex, choice.Levels, choice.PixelTolerance, view);
  }
  TranslateExtent(image, volume, view);
  FindImage(view);
  TranslateClipping(mapper->GetClippingPlanes(), worldToIndex, view);
  TranslateCropping(mapper, image, volume, view);
  TranslateIsovalues(property, volume, scene);

  TranslateNormals(eyeToIndex, scene.Look);
  TranslateDepths(projection, scene.Look);
  TranslateMaterial(property, scene.Look);
  if (property->GetShade())
  {
    TranslateShading(renderer->GetLights(), choice.LitSides, worldToEye, scene);
  }
  return scene;
}
