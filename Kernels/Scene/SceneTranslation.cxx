// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/SceneTranslation.h"

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
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
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

// The point of an eye-space plane at which normalised device coordinates (x, y) lie.
void Unproject(vtkMatrix4x4* projection, double z, double x, double y, double eye[2])
{
  const vtkMatrix4x4& p = *projection;
  const double w = p.GetElement(3, 2) * z + p.GetElement(3, 3);
  const double rx = x * w - p.GetElement(0, 2) * z - p.GetElement(0, 3);
  const double ry = y * w - p.GetElement(1, 2) * z - p.GetElement(1, 3);
  const double a = p.GetElement(0, 0), b = p.GetElement(0, 1), c = p.GetElement(1, 0),
               d = p.GetElement(1, 1);
  const double determinant = a * d - b * c;
  eye[0] = (d * rx - b * ry) / determinant;
  eye[1] = (a * ry - c * rx) / determinant;
}

// Rays need not meet in the eye: those of a stereo view are sheared.
EyeRays MakeEyeRays(vtkMatrix4x4* projection, int width, int height)
{
  const double corners[3][2] = { { -1.0, -1.0 }, { 1.0, -1.0 }, { -1.0, 1.0 } };
  double start[3][2], way[3][2];
  for (int i = 0; i < 3; ++i)
  {
    Unproject(projection, 0.0, corners[i][0], corners[i][1], start[i]);
    Unproject(projection, -1.0, corners[i][0], corners[i][1], way[i]);
    way[i][0] -= start[i][0];
    way[i][1] -= start[i][1];
  }
  EyeRays rays;
  for (int axis = 0; axis < 2; ++axis)
  {
    rays.Origin[0][axis] = start[0][axis];
    rays.Origin[1][axis] = (start[1][axis] - start[0][axis]) / width;
    rays.Origin[2][axis] = (start[2][axis] - start[0][axis]) / height;
    rays.Direction[0][axis] = way[0][axis];
    rays.Direction[1][axis] = (way[1][axis] - way[0][axis]) / width;
    rays.Direction[2][axis] = (way[2][axis] - way[0][axis]) / height;
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

void TranslateLight(vtkLight* light, vtkMatrix4x4* worldToEye, SceneLight& place)
{
  double position[4], focus[4], way[4] = {};
  light->GetTransformedPosition(position);
  light->GetTransformedFocalPoint(focus);
  const bool positional = light->GetPositional();
  for (int axis = 0; axis < 3; ++axis)
  {
    way[axis] = focus[axis] - position[axis];
    position[axis] = positional ? position[axis] : -way[axis];
  }
  position[3] = positional ? 1.0 : 0.0;
  worldToEye->MultiplyPoint(position, position);
  worldToEye->MultiplyPoint(way, way);
  vtkMath::Normalize(way);
  if (!positional)
  {
    vtkMath::Normalize(position);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    place.Place[axis] = static_cast<float>(position[axis]);
    place.Axis[axis] = static_cast<float>(way[axis]);
    place.Color[axis] = static_cast<float>(light->GetDiffuseColor()[axis] * light->GetIntensity());
    place.Highlight[axis] =
      static_cast<float>(light->GetSpecularColor()[axis] * light->GetIntensity());
    place.Fading[axis] = static_cast<float>(light->GetAttenuationValues()[axis]);
  }
  const bool spot = positional && light->GetConeAngle() < 90.0;
  place.Place[3] = static_cast<float>(position[3]);
  place.Color[3] = static_cast<float>(light->GetExponent());
  place.Axis[3] =
    spot ? static_cast<float>(std::cos(vtkMath::RadiansFromDegrees(light->GetConeAngle()))) : -2.0f;
}

void TranslateLights(vtkRenderer* renderer, vtkMatrix4x4* worldToEye, SceneBlock& scene)
{
  vtkCollectionSimpleIterator iterator;
  vtkLightCollection* lights = renderer->GetLights();
  lights->InitTraversal(iterator);
  int& count = scene.Lighting[0];
  for (vtkLight* light = lights->GetNextLight(iterator); light;
       light = lights->GetNextLight(iterator))
  {
    if (light->GetSwitch() && count < SceneBlock::MaximumLights)
    {
      TranslateLight(light, worldToEye, scene.Lights[count++]);
    }
  }
}

// Isovalues that show, in the stream's units, with their colours and opacities from the transfer
// functions.
void TranslateIsovalues(
  vtkVolumeProperty* property, vtkCompressedVolume* compressed, SceneBlock& scene)
{
  vtkContourValues* values = property->GetIsoSurfaceValues();
  int& count = scene.Surface[0];
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    const double value = values->GetValue(i);
    const double opacity =
      std::min(std::max(property->GetScalarOpacity()->GetValue(value), 0.0), 1.0);
    if (opacity == 0.0 || count == SceneBlock::MaximumIsovalues)
    {
      continue;
    }
    double color[3];
    if (property->GetColorChannels() == 1)
    {
      std::fill(color, color + 3, property->GetGrayTransferFunction()->GetValue(value));
    }
    else
    {
      property->GetRGBTransferFunction()->GetColor(value, color);
    }
    const double stored = compressed->ToStored(value);
    scene.Isovalues[count][0] = static_cast<float>(stored);
    scene.Isovalues[count][1] = static_cast<float>(stored - scene.Isovalues[count][0]);
    std::copy(color, color + 3, scene.Colors[count]);
    scene.Colors[count][3] = static_cast<float>(opacity);
    scene.Lighting[1] |= opacity < 1.0 ? 1 : 0;
    ++count;
  }
  if (count == 0) // no ray meets anything
  {
    scene.RayRange[0] = 1.0;
    scene.RayRange[1] = 0.0;
  }
}

// The mapper's planes are in world coordinates.
void TranslateClipping(vtkVolumeMapper* mapper, vtkMatrix4x4* worldToIndex, SceneBlock& scene)
{
  vtkPlaneCollection* planes = mapper->GetClippingPlanes();
  vtkNew<vtkMatrix4x4> indexToWorld;
  vtkMatrix4x4::Invert(worldToIndex, indexToWorld);
  const int count = planes ? planes->GetNumberOfItems() : 0;
  for (int i = 0; i < count && i < SceneBlock::MaximumClippingPlanes; ++i)
  {
    vtkPlane* plane = planes->GetItem(i);
    double normal[3], origin[3];
    plane->GetNormal(normal);
    plane->GetOrigin(origin);
    double terms[4] = { normal[0], normal[1], normal[2], -vtkMath::Dot(normal, origin) };
    double* translated = scene.ClippingPlanes[scene.Surface[1]++];
    for (int axis = 0; axis < 4; ++axis)
    {
      for (int row = 0; row < 4; ++row)
      {
        translated[axis] += terms[row] * indexToWorld->GetElement(row, axis);
      }
    }
  }
}

// The planes between the regions lie in the image's own axes, whatever its direction matrix is.
void TranslateCropping(
  vtkVolumeMapper* mapper, vtkImageData* image, vtkCompressedVolume* compressed, SceneBlock& scene)
{
  if (!mapper->GetCropping())
  {
    return;
  }
  const double shift = compressed->GetAssociation() == vtkCompressedVolume::CellData ? 0.5 : 0.0;
  const double* planes = mapper->GetCroppingRegionPlanes();
  for (int axis = 0; axis < 3; ++axis)
  {
    const double first = compressed->GetExtent()[2 * axis] + shift;
    const double origin = image->GetOrigin()[axis], spacing = image->GetSpacing()[axis];
    const double low = (planes[2 * axis] - origin) / spacing - first;
    const double high = (planes[2 * axis + 1] - origin) / spacing - first;
    scene.CroppingLow[axis] = std::min(low, high);
    scene.CroppingHigh[axis] = std::max(low, high);
  }
  scene.Surface[2] = mapper->GetCroppingRegionFlags() & SceneBlock::AllRegions;
}

void TranslateLook(
  vtkRenderer* renderer, vtkVolumeProperty* property, vtkMatrix4x4* worldToEye, SceneBlock& scene)
{
  scene.Material[0] = static_cast<float>(property->GetAmbient());
  scene.Material[1] = static_cast<float>(property->GetDiffuse());
  scene.Material[2] = static_cast<float>(property->GetSpecular());
  scene.Material[3] = static_cast<float>(property->GetSpecularPower());
  if (!property->GetShade())
  {
    return;
  }
  TranslateLights(renderer, worldToEye, scene);
  scene.Lighting[3] = renderer->GetTwoSidedLighting() ? 1 : 0;
  for (int i = 0; i < scene.Surface[0] && scene.Lighting[0] == 0; ++i)
  {
    for (int channel = 0; channel < 3; ++channel) // in the dark no normal is needed
    {
      scene.Colors[i][channel] *= scene.Material[0];
    }
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

SceneBlock TranslateScene(vtkRenderer* renderer, vtkVolume* volume, vtkVolumeMapper* mapper,
  vtkImageData* image, vtkCompressedVolume* compressed, const int viewport[4])
{
  SceneBlock scene;
  std::copy(viewport, viewport + 4, scene.Image);
  vtkCamera* camera = renderer->GetActiveCamera();
  vtkMatrix4x4* projection =
    camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1, 1);
  vtkMatrix4x4* worldToEye = camera->GetModelViewTransformMatrix();
  vtkNew<vtkMatrix4x4> indexToWorld, worldToIndex, eyeToIndex;
  SamplesToWorld(volume, image, compressed, indexToWorld);
  vtkMatrix4x4::Invert(indexToWorld, worldToIndex);
  vtkMatrix4x4::Multiply4x4(worldToEye, indexToWorld, eyeToIndex);
  const double determinant = eyeToIndex->Determinant();
  eyeToIndex->Invert();

  TranslateRays(MakeEyeRays(projection, scene.Image[0], scene.Image[1]), eyeToIndex, scene);
  if (!(determinant != 0.0)) // nothing was inverted
  {
    std::fill_n(scene.RayDirection[0], 3, std::numeric_limits<double>::quiet_NaN());
  }
  camera->GetClippingRange(scene.RayRange);
  TranslatePart(image, compressed, scene);
  TranslateIsovalues(volume->GetProperty(), compressed, scene);
  TranslateClipping(mapper, worldToIndex, scene);
  TranslateCropping(mapper, image, compressed, scene);

  TranslateNormals(eyeToIndex, scene);
  scene.DepthTerms[0] = static_cast<float>(projection->GetElement(2, 3));
  scene.DepthTerms[1] = static_cast<float>(-projection->GetElement(2, 2));
  scene.DepthTerms[2] = static_cast<float>(projection->GetElement(3, 3));
  scene.DepthTerms[3] = static_cast<float>(-projection->GetElement(3, 2));
  TranslateLook(renderer, volume->GetProperty(), worldToEye, scene);
  return scene;
}

bool HasRays(const SceneBlock& scene)
{
  const double most = 1e200; // their sums are finite, too
  const auto isSmall = [=](double value) { return std::abs(value) <= most; };
  const double* const origin = scene.RayOrigin[0];
  const double* const direction = scene.RayDirection[0];
  return std::all_of(origin, origin + 12, isSmall) &&
    std::all_of(direction, direction + 12, isSmall);
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
  return NearlySame(a.RayRange, b.RayRange) &&
    std::memcmp(a.ClippingPlanes, b.ClippingPlanes, sizeof(a.ClippingPlanes)) == 0 &&
    std::memcmp(a.CroppingLow, b.CroppingLow, sizeof(a.CroppingLow)) == 0 &&
    std::memcmp(a.CroppingHigh, b.CroppingHigh, sizeof(a.CroppingHigh)) == 0 &&
    std::equal(a.Image, a.Image + 4, b.Image) && std::equal(a.Surface, a.Surface + 4, b.Surface) &&
    std::memcmp(a.Isovalues, b.Isovalues, sizeof(a.Isovalues)) == 0;
}

bool SameLook(const SceneBlock& a, const SceneBlock& b)
{
  const char* look = reinterpret_cast<const char*>(a.NormalMatrix);
  const std::size_t begin = offsetof(SceneBlock, NormalMatrix);
  return std::memcmp(look, reinterpret_cast<const char*>(&b) + begin, sizeof(SceneBlock) - begin) ==
    0;
}

void KeepHits(const SceneBlock& from, SceneBlock& to)
{
  std::memcpy(&to, &from, ExactBegins);
}

namespace
{
// The base of a pixel's ray, or its direction: see Scene.glsl.
double AtPixel(const double terms[3][4], int axis, double px, double py)
{
  return terms[0][axis] + px * terms[1][axis] + py * terms[2][axis];
}

double FiniteInverse(double d)
{
  return std::abs(d) > 1e-290 ? 1.0 / d : 1e290;
}

// As in Rays.glsl.
void ClipRay(const SceneBlock& scene, double px, double py, double& enter, double& leave)
{
  for (int i = 0; i < scene.Surface[1]; ++i)
  {
    const double* plane = scene.ClippingPlanes[i];
    double at = plane[3], along = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      at += plane[axis] * AtPixel(scene.RayOrigin, axis, px, py);
      along += plane[axis] * AtPixel(scene.RayDirection, axis, px, py);
    }
    const double t = -at * FiniteInverse(along);
    enter = along > 0.0 ? std::max(enter, t) : enter;
    leave = along < 0.0 ? std::min(leave, t) : leave;
  }
}
}

double HitParameter(const SceneBlock& scene, int x, int y, std::uint32_t key)
{
  if (key == 0xFFFFFFFFu)
  {
    return std::numeric_limits<double>::infinity();
  }
  const double px = x + 0.5, py = y + 0.5;
  double enter = scene.RayRange[0], leave = scene.RayRange[1];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double origin = AtPixel(scene.RayOrigin, axis, px, py);
    const double inverse = FiniteInverse(AtPixel(scene.RayDirection, axis, px, py));
    const double first = (scene.FirstDrawn[axis] - origin) * inverse;
    const double last = (scene.LastDrawn[axis] - origin) * inverse;
    enter = std::max(enter, std::min(first, last));
    leave = std::min(leave, std::max(first, last));
  }
  ClipRay(scene, px, py, enter, leave);
  return enter + (key + 0.5) / 4294967040.0 * (leave - enter);
}

double RayLength(const SceneBlock& scene, int x, int y, double t)
{
  double squares = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double eye = AtPixel(scene.EyeDirection, axis, x + 0.5, y + 0.5);
    squares += eye * eye;
  }
  return t * std::sqrt(squares);
}

void EyePosition(const SceneBlock& scene, int x, int y, double t, double position[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    position[axis] = AtPixel(scene.EyeOrigin, axis, x + 0.5, y + 0.5) +
      t * AtPixel(scene.EyeDirection, axis, x + 0.5, y + 0.5);
  }
}
