// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SceneTranslation.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

namespace
{
// Where the rays of a camera start and go, in eye coordinates, as functions of the pixel:
// base + x dx + y dy. The depth along the view direction is their parameter.
struct EyeRays
{
  double Origin[3][3] = {};
  double Direction[3][3] = {};
};

// The point on the eye-space plane at which normalised device coordinates (x, y) lie: on z = -1 in
// perspective, on z = 0 in parallel projection.
void Unproject(vtkMatrix4x4* projection, bool perspective, double x, double y, double eye[2])
{
  const vtkMatrix4x4& p = *projection;
  const double z = perspective ? -1.0 : 0.0;
  const double w = p.GetElement(3, 2) * z + p.GetElement(3, 3);
  const double rx = x * w - p.GetElement(0, 2) * z - p.GetElement(0, 3);
  const double ry = y * w - p.GetElement(1, 2) * z - p.GetElement(1, 3);
  const double a = p.GetElement(0, 0), b = p.GetElement(0, 1), c = p.GetElement(1, 0),
               d = p.GetElement(1, 1);
  const double determinant = a * d - b * c;
  eye[0] = (d * rx - b * ry) / determinant;
  eye[1] = (a * ry - c * rx) / determinant;
}

EyeRays MakeEyeRays(vtkMatrix4x4* projection, int width, int height)
{
  const bool perspective = projection->GetElement(3, 2) != 0.0;
  double corner[2], right[2], top[2];
  Unproject(projection, perspective, -1.0, -1.0, corner);
  Unproject(projection, perspective, 1.0, -1.0, right);
  Unproject(projection, perspective, -1.0, 1.0, top);
  EyeRays rays;
  auto& plane = perspective ? rays.Direction : rays.Origin;
  for (int axis = 0; axis < 2; ++axis)
  {
    plane[0][axis] = corner[axis];
    plane[1][axis] = (right[axis] - corner[axis]) / width;
    plane[2][axis] = (top[axis] - corner[axis]) / height;
  }
  rays.Direction[0][2] = -1.0;
  return rays;
}

// Index space of the samples to world: extent, origin, spacing, direction, the prop's matrix.
void SamplesToWorld(
  vtkVolume* volume, vtkImageData* image, vtkCompressedVolume* compressed, vtkMatrix4x4* matrix)
{
  const double shift = compressed->GetAssociation() == vtkCompressedVolume::CellData ? 0.5 : 0.0;
  const int* extent = compressed->GetExtent();
  vtkNew<vtkMatrix4x4> offset;
  for (int axis = 0; axis < 3; ++axis)
  {
    offset->SetElement(axis, 3, extent[2 * axis] + shift);
  }
  vtkMatrix4x4::Multiply4x4(image->GetIndexToPhysicalMatrix(), offset, matrix);
  vtkMatrix4x4::Multiply4x4(volume->GetMatrix(), matrix, matrix);
}

// The image's part of the samples; a piece with cell data reaches to the next one's first samples.
void TranslatePart(vtkImageData* image, vtkCompressedVolume* compressed, SceneBlock& scene)
{
  const int* drawn = image->GetExtent();
  const int* samples = compressed->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    scene.FirstDrawn[axis] = drawn[2 * axis] - samples[2 * axis];
    scene.LastDrawn[axis] =
      std::min(drawn[2 * axis + 1] - samples[2 * axis], compressed->GetDimensions()[axis] - 1);
  }
}

void TranslateRays(const EyeRays& rays, vtkMatrix4x4* eyeToIndex, SceneBlock& scene)
{
  for (int i = 0; i < 3; ++i)
  {
    const double point = i == 0 ? 1.0 : 0.0; // only the base is a point, the rest are vectors
    const double origin[4] = { rays.Origin[i][0], rays.Origin[i][1], rays.Origin[i][2], point };
    const double direction[4] = { rays.Direction[i][0], rays.Direction[i][1], rays.Direction[i][2],
      0.0 };
    double result[4];
    eyeToIndex->MultiplyPoint(origin, result);
    std::copy(result, result + 3, scene.RayOrigin[i]);
    eyeToIndex->MultiplyPoint(direction, result);
    std::copy(result, result + 3, scene.RayDirection[i]);
    for (int axis = 0; axis < 3; ++axis)
    {
      scene.EyeOrigin[i][axis] = rays.Origin[i][axis];
      scene.EyeDirection[i][axis] = rays.Direction[i][axis];
    }
  }
}

// Gradients transform by the transposed inverse; the scale does not matter, so keep it in float's
// range.
void TranslateNormals(vtkMatrix4x4* eyeToIndex, SceneBlock& scene)
{
  double largest = 0.0;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      largest = std::max(largest, std::abs(eyeToIndex->GetElement(row, column)));
    }
  }
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      scene.NormalMatrix[4 * row + column] =
        static_cast<float>(eyeToIndex->GetElement(row, column) / largest);
    }
  }
}

void TranslateLights(vtkRenderer* renderer, vtkMatrix4x4* worldToEye, SceneBlock& scene)
{
  vtkCollectionSimpleIterator iterator;
  vtkLightCollection* lights = renderer->GetLights();
  lights->InitTraversal(iterator);
  int count = 0;
  for (vtkLight* light = lights->GetNextLight(iterator); light;
       light = lights->GetNextLight(iterator))
  {
    if (!light->GetSwitch() || count == SceneBlock::MaximumLights)
    {
      continue;
    }
    double position[4], focus[4], place[4];
    light->GetTransformedPosition(position);
    light->GetTransformedFocalPoint(focus);
    const double w = light->GetPositional() ? 1.0 : 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = light->GetPositional() ? position[axis] : position[axis] - focus[axis];
    }
    place[3] = w;
    worldToEye->MultiplyPoint(place, place);
    const double* color = light->GetDiffuseColor();
    for (int axis = 0; axis < 3; ++axis)
    {
      scene.Lights[count].Place[axis] = static_cast<float>(place[axis]);
      scene.Lights[count].Color[axis] = static_cast<float>(color[axis] * light->GetIntensity());
    }
    scene.Lights[count].Place[3] = static_cast<float>(w);
    ++count;
  }
  scene.Lighting[0] = count;
}

void TranslateLook(vtkRenderer* renderer, vtkVolumeProperty* property, double isovalue,
  vtkMatrix4x4* worldToEye, SceneBlock& scene)
{
  double color[3];
  if (property->GetColorChannels() == 1)
  {
    std::fill(color, color + 3, property->GetGrayTransferFunction()->GetValue(isovalue));
  }
  else
  {
    property->GetRGBTransferFunction()->GetColor(isovalue, color);
  }
  scene.Material[0] = static_cast<float>(property->GetAmbient());
  scene.Material[1] = static_cast<float>(property->GetDiffuse());
  scene.Material[2] = static_cast<float>(property->GetSpecular());
  scene.Material[3] = static_cast<float>(property->GetSpecularPower());
  double brightness = 1.0;
  if (property->GetShade())
  {
    TranslateLights(renderer, worldToEye, scene);
    brightness =
      scene.Lighting[0] > 0 ? 1.0 : property->GetAmbient(); // in the dark no normal is needed
  }
  for (int i = 0; i < 3; ++i)
  {
    scene.Color[i] = static_cast<float>(brightness * color[i]);
  }
}

bool NearlySame(const double* a, const double* b)
{
  double difference = 0.0, size = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(a[i]));
  }
  return difference <= 1e-7 * size;
}

constexpr std::size_t ExactBegins = offsetof(SceneBlock, FirstDrawn);
}

SceneBlock TranslateScene(
  vtkRenderer* renderer, vtkVolume* volume, vtkImageData* image, vtkCompressedVolume* compressed)
{
  SceneBlock scene;
  renderer->GetTiledSizeAndOrigin(
    &scene.Image[0], &scene.Image[1], &scene.Image[2], &scene.Image[3]);
  vtkCamera* camera = renderer->GetActiveCamera();
  vtkMatrix4x4* projection =
    camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1, 1);
  vtkMatrix4x4* worldToEye = camera->GetModelViewTransformMatrix();
  vtkNew<vtkMatrix4x4> eyeToIndex;
  SamplesToWorld(volume, image, compressed, eyeToIndex);
  vtkMatrix4x4::Multiply4x4(worldToEye, eyeToIndex, eyeToIndex);
  eyeToIndex->Invert();

  TranslateRays(MakeEyeRays(projection, scene.Image[0], scene.Image[1]), eyeToIndex, scene);
  camera->GetClippingRange(scene.RayRange);
  TranslatePart(image, compressed, scene);
  vtkVolumeProperty* property = volume->GetProperty();
  const double isovalue = property->GetIsoSurfaceValues()->GetValue(0);
  scene.Isovalue[0] = static_cast<float>(isovalue);
  scene.Isovalue[1] = static_cast<float>(isovalue - scene.Isovalue[0]);

  TranslateNormals(eyeToIndex, scene);
  scene.DepthTerms[0] = static_cast<float>(projection->GetElement(2, 3));
  scene.DepthTerms[1] = static_cast<float>(-projection->GetElement(2, 2));
  scene.DepthTerms[2] = static_cast<float>(projection->GetElement(3, 3));
  scene.DepthTerms[3] = static_cast<float>(-projection->GetElement(3, 2));
  TranslateLook(renderer, property, isovalue, worldToEye, scene);
  return scene;
}

bool SameHits(const SceneBlock& a, const SceneBlock& b)
{
  for (int i = 0; i < 3; ++i)
  {
    if (!NearlySame(a.RayOrigin[i], b.RayOrigin[i]) ||
      !NearlySame(a.RayDirection[i], b.RayDirection[i]))
    {
      return false;
    }
  }
  return NearlySame(a.RayRange, b.RayRange) && std::equal(a.Image, a.Image + 4, b.Image) &&
    std::equal(a.Isovalue, a.Isovalue + 2, b.Isovalue);
}

void KeepHits(const SceneBlock& from, SceneBlock& to)
{
  std::memcpy(&to, &from, ExactBegins);
}

float HitDistance(const SceneBlock& scene, int x, int y, std::uint32_t key)
{
  if (key == 0xFFFFFFFFu)
  {
    return std::numeric_limits<float>::infinity();
  }
  const double px = x + 0.5, py = y + 0.5;
  double enter = scene.RayRange[0], leave = scene.RayRange[1];
  double eyeLength = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double origin =
      scene.RayOrigin[0][axis] + px * scene.RayOrigin[1][axis] + py * scene.RayOrigin[2][axis];
    const double direction = scene.RayDirection[0][axis] + px * scene.RayDirection[1][axis] +
      py * scene.RayDirection[2][axis];
    const double inverse = std::abs(direction) > 1e-290 ? 1.0 / direction : 1e290;
    const double first = (scene.FirstDrawn[axis] - origin) * inverse;
    const double last = (scene.LastDrawn[axis] - origin) * inverse;
    enter = std::max(enter, std::min(first, last));
    leave = std::min(leave, std::max(first, last));
    const double eye = scene.EyeDirection[0][axis] + px * scene.EyeDirection[1][axis] +
      py * scene.EyeDirection[2][axis];
    eyeLength += eye * eye;
  }
  const double t = enter + (key + 0.5) / 4294967040.0 * (leave - enter);
  return static_cast<float>(t * std::sqrt(eyeLength));
}
