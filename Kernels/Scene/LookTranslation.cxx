// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/LookTranslation.h"

#include "Scene/ShownIsovalues.h"

#include "vtkColorTransferFunction.h"
#include "vtkCompressedVolume.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{
void GetColor(vtkVolumeProperty* property, double value, double color[3])
{
  if (property->GetColorChannels() == 1)
  {
    std::fill(color, color + 3, property->GetGrayTransferFunction()->GetValue(value));
  }
  else
  {
    property->GetRGBTransferFunction()->GetColor(value, color);
  }
}

void TranslateAttenuation(vtkLight* source, glsl::Light& light)
{
  const double* attenuation = source->GetAttenuationValues();
  light.ConstantAttenuation = static_cast<float>(attenuation[0]);
  light.LinearAttenuation = static_cast<float>(attenuation[1]);
  light.QuadraticAttenuation = static_cast<float>(attenuation[2]);
}

void TranslateCone(vtkLight* source, glsl::Light& light)
{
  const double angle = source->GetConeAngle();
  light.IsSpot = source->GetPositional() && angle < 90.0 ? 1 : 0;
  light.ConeExponent = static_cast<float>(source->GetExponent());
  light.ConeCosine = static_cast<float>(std::cos(vtkMath::RadiansFromDegrees(angle)));
}

void TranslateLight(vtkLight* source, vtkMatrix4x4* worldToEye, glsl::Light& light)
{
  double position[4], focus[4], direction[4] = {};
  source->GetTransformedPosition(position);
  source->GetTransformedFocalPoint(focus);
  const bool positional = source->GetPositional();
  for (int axis = 0; axis < 3; ++axis)
  {
    direction[axis] = focus[axis] - position[axis];
    position[axis] = positional ? position[axis] : -direction[axis];
  }
  position[3] = positional ? 1.0 : 0.0;
  worldToEye->MultiplyPoint(position, position);
  worldToEye->MultiplyPoint(direction, direction);
  vtkMath::Normalize(direction);
  if (!positional)
  {
    vtkMath::Normalize(position);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    light.Position[axis] = static_cast<float>(position[axis]);
    light.ConeAxis[axis] = static_cast<float>(direction[axis]);
    light.Diffuse[axis] =
      static_cast<float>(source->GetDiffuseColor()[axis] * source->GetIntensity());
    light.Specular[axis] =
      static_cast<float>(source->GetSpecularColor()[axis] * source->GetIntensity());
  }
  light.IsPositional = positional ? 1 : 0;
  TranslateAttenuation(source, light);
  TranslateCone(source, light);
}

void TranslateLights(vtkLightCollection* lights, vtkMatrix4x4* worldToEye, glsl::Look& look)
{
  vtkCollectionSimpleIterator iterator;
  lights->InitTraversal(iterator);
  int& count = look.NumberOfLights;
  for (vtkLight* light = lights->GetNextLight(iterator); light;
       light = lights->GetNextLight(iterator))
  {
    if (light->GetSwitch() && count < glsl::MAX_LIGHTS)
    {
      TranslateLight(light, worldToEye, look.Lights[count++]);
    }
  }
}
}

void TranslateIsovalues(
  vtkVolumeProperty* property, vtkCompressedVolume* volume, PipelineScene& scene)
{
  const std::vector<ShownIsovalue> shown = FindShownIsovalues(property);
  int& count = scene.View.NumberOfIsovalues;
  for (count = 0; count < glsl::MAX_ISOVALUES && count < static_cast<int>(shown.size()); ++count)
  {
    const double stored = volume->ToStored(shown[count].Value);
    glsl::FloatSum& isovalue = scene.View.Isovalues[count];
    isovalue.High = static_cast<float>(stored);
    isovalue.Low = static_cast<float>(stored - isovalue.High);
    double color[3];
    GetColor(property, shown[count].Value, color);
    std::copy(color, color + 3, scene.Look.Colors[count].Rgb);
    scene.Look.Colors[count].Opacity = static_cast<float>(shown[count].Opacity);
  }
  scene.Translucent = HasTranslucent(shown);
  if (count == 0)
  {
    scene.View.NearDistance = 1.0;
    scene.View.FarDistance = 0.0;
  }
}

void TranslateMaterial(vtkVolumeProperty* property, glsl::Look& look)
{
  look.Ambient = static_cast<float>(property->GetAmbient());
  look.Diffuse = static_cast<float>(property->GetDiffuse());
  look.Specular = static_cast<float>(property->GetSpecular());
  look.SpecularPower = static_cast<float>(property->GetSpecularPower());
}

void TranslateShading(
  vtkLightCollection* lights, int litSides, vtkMatrix4x4* worldToEye, PipelineScene& scene)
{
  glsl::Look& look = scene.Look;
  TranslateLights(lights, worldToEye, look);
  look.LitSides = litSides;
  const float left = look.Ambient + (litSides == glsl::LIT_LIKE_MESHES ? look.Diffuse : 0.0f);
  for (int i = 0; i < scene.View.NumberOfIsovalues && look.NumberOfLights == 0; ++i)
  {
    for (float& channel : look.Colors[i].Rgb)
    {
      channel *= std::min(left, 1.0f);
    }
  }
}
