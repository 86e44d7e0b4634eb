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
void TranslatePart(vtkImageData* image, vtkCompressedVolume* compressed, glsl::View& view)
{
  const int* drawn = image->GetExtent();
  const int* samples = compressed->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    view.FirstDrawn[axis] = drawn[2 * axis] - samples[2 * axis];
    view.LastDrawn[axis] =
      std::min(drawn[2 * axis + 1] - samples[2 * axis], compressed->GetDimensions()[axis] - 1);
  }
}

// Only the base of origins is a point, all else are vectors.
void TranslateToIndex(
  const double eye[3][3], bool isOrigin, vtkMatrix4x4* eyeToIndex, glsl::PixelVector& index)
{
  double* const terms[] = { index.Base, index.PerX, index.PerY };
  for (int i = 0; i < 3; ++i)
  {
    double vector[4] = { eye[i][0], eye[i][1], eye[i][2], isOrigin && i == 0 ? 1.0 : 0.0 };
    eyeToIndex->MultiplyPoint(vector, vector);
    std::copy(vector, vector + 3, terms[i]);
  }
}

void CopyTerms(const double terms[3][3], glsl::PixelVector& vector)
{
  std::copy(terms[0], terms[0] + 3, vector.Base);
  std::copy(terms[1], terms[1] + 3, vector.PerX);
  std::copy(terms[2], terms[2] + 3, vector.PerY);
}

void TranslateRays(const EyeRays& rays, vtkMatrix4x4* eyeToIndex, glsl::View& view)
{
  TranslateToIndex(rays.Origin, true, eyeToIndex, view.RayOrigin);
  TranslateToIndex(rays.Direction, false, eyeToIndex, view.RayDirection);
  CopyTerms(rays.Origin, view.EyeOrigin);
  CopyTerms(rays.Direction, view.EyeDirection);
}

// Gradients transform by the transposed inverse; the scale does not matter, so keep it in float's
// range.
void TranslateNormals(vtkMatrix4x4* eyeToIndex, glsl::Look& look)
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
      look.NormalMatrix[row][column] = // a column of the transposed matrix is a row
        static_cast<float>(eyeToIndex->GetElement(row, column) / largest);
    }
  }
}

void TranslateLight(vtkLight* source, vtkMatrix4x4* worldToEye, glsl::Light& light)
{
  double position[4], focus[4], way[4] = {};
  source->GetTransformedPosition(position);
  source->GetTransformedFocalPoint(focus);
  const bool positional = source->GetPositional();
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
    light.Position[axis] = static_cast<float>(position[axis]);
    light.ConeAxis[axis] = static_cast<float>(way[axis]);
    light.Diffuse[axis] =
      static_cast<float>(source->GetDiffuseColor()[axis] * source->GetIntensity());
    light.Specular[axis] =
      static_cast<float>(source->GetSpecularColor()[axis] * source->GetIntensity());
  }
  const double* attenuation = source->GetAttenuationValues();
  light.ConstantAttenuation = static_cast<float>(attenuation[0]);
  light.LinearAttenuation = static_cast<float>(attenuation[1]);
  light.QuadraticAttenuation = static_cast<float>(attenuation[2]);
  light.IsPositional = positional ? 1 : 0;
  light.IsSpot = positional && source->GetConeAngle() < 90.0 ? 1 : 0;
  light.ConeExponent = static_cast<float>(source->GetExponent());
  light.ConeCosine =
    static_cast<float>(std::cos(vtkMath::RadiansFromDegrees(source->GetConeAngle())));
}

void TranslateLights(vtkRenderer* renderer, vtkMatrix4x4* worldToEye, glsl::Look& look)
{
  vtkCollectionSimpleIterator iterator;
  vtkLightCollection* lights = renderer->GetLights();
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

// Isovalues that show, in the stream's units, with their colours and opacities from the transfer
// functions.
void TranslateIsovalues(
  vtkVolumeProperty* property, vtkCompressedVolume* compressed, PipelineScene& scene)
{
  vtkContourValues* values = property->GetIsoSurfaceValues();
  int& count = scene.View.NumberOfIsovalues;
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    const double value = values->GetValue(i);
    const double opacity =
      std::min(std::max(property->GetScalarOpacity()->GetValue(value), 0.0), 1.0);
    if (opacity == 0.0 || count == glsl::MAX_ISOVALUES)
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
    glsl::Isovalue& isovalue = scene.View.Isovalues[count];
    isovalue.High = static_cast<float>(stored);
    isovalue.Low = static_cast<float>(stored - isovalue.High);
    std::copy(color, color + 3, scene.Look.Colors[count].Rgb);
    scene.Look.Colors[count].Opacity = static_cast<float>(opacity);
    scene.Translucent = scene.Translucent || opacity < 1.0;
    ++count;
  }
  if (count == 0) // no ray meets anything
  {
    scene.View.NearDistance = 1.0;
    scene.View.FarDistance = 0.0;
  }
}

// The mapper's planes are in world coordinates.
void TranslateClipping(vtkVolumeMapper* mapper, vtkMatrix4x4* worldToIndex, glsl::View& view)
{
  vtkPlaneCollection* planes = mapper->GetClippingPlanes();
  vtkNew<vtkMatrix4x4> indexToWorld;
  vtkMatrix4x4::Invert(worldToIndex, indexToWorld);
  const int count = planes ? planes->GetNumberOfItems() : 0;
  for (int i = 0; i < count && i < glsl::MAX_CLIPPING_PLANES; ++i)
  {
    vtkPlane* plane = planes->GetItem(i);
    double normal[3], origin[3];
    plane->GetNormal(normal);
    plane->GetOrigin(origin);
    double terms[4] = { normal[0], normal[1], normal[2], -vtkMath::Dot(normal, origin) };
    double translated[4] = {};
    for (int axis = 0; axis < 4; ++axis)
    {
      for (int row = 0; row < 4; ++row)
      {
        translated[axis] += terms[row] * indexToWorld->GetElement(row, axis);
      }
    }
    glsl::ClippingPlane& translatedPlane = view.ClippingPlanes[view.NumberOfClippingPlanes++];
    std::copy(translated, translated + 3, translatedPlane.Normal);
    translatedPlane.Offset = translated[3];
  }
}

// The planes between the regions lie in the image's own axes, whatever its direction matrix is.
void TranslateCropping(
  vtkVolumeMapper* mapper, vtkImageData* image, vtkCompressedVolume* compressed, glsl::View& view)
{
  view.DrawnRegions = glsl::ALL_REGIONS;
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
    view.CroppingLow[axis] = std::min(low, high);
    view.CroppingHigh[axis] = std::max(low, high);
  }
  view.DrawnRegions = mapper->GetCroppingRegionFlags() & glsl::ALL_REGIONS;
}

void TranslateMaterial(vtkVolumeProperty* property, glsl::Look& look)
{
  look.Ambient = static_cast<float>(property->GetAmbient());
  look.Diffuse = static_cast<float>(property->GetDiffuse());
  look.Specular = static_cast<float>(property->GetSpecular());
  look.SpecularPower = static_cast<float>(property->GetSpecularPower());
}

void TranslateDepths(vtkMatrix4x4* projection, glsl::Look& look)
{
  look.ClipZ = static_cast<float>(projection->GetElement(2, 3));
  look.ClipZPerT = static_cast<float>(-projection->GetElement(2, 2));
  look.ClipW = static_cast<float>(projection->GetElement(3, 3));
  look.ClipWPerT = static_cast<float>(-projection->GetElement(3, 2));
}

void TranslateShading(vtkRenderer* renderer, vtkMatrix4x4* worldToEye, PipelineScene& scene)
{
  glsl::Look& look = scene.Look;
  TranslateLights(renderer, worldToEye, look);
  look.LitSides = renderer->GetTwoSidedLighting() ? glsl::TWO_SIDED : glsl::ONE_SIDED;
  for (int i = 0; i < scene.View.NumberOfIsovalues && look.NumberOfLights == 0; ++i)
  {
    for (float& channel : look.Colors[i].Rgb) // in the dark no normal is needed
    {
      channel *= look.Ambient;
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

bool NearlySame(const glsl::PixelVector& a, const glsl::PixelVector& b)
{
  return NearlySame(a.Base, b.Base) && NearlySame(a.PerX, b.PerX) && NearlySame(a.PerY, b.PerY);
}

bool AreSmall(const double vector[3])
{
  const double most = 1e200; // their sums are finite, too
  return std::all_of(vector, vector + 3, [=](double value) { return std::abs(value) <= most; });
}

bool AreSmall(const glsl::PixelVector& vector)
{
  return AreSmall(vector.Base) && AreSmall(vector.PerX) && AreSmall(vector.PerY);
}
}

PipelineScene TranslateScene(vtkRenderer* renderer, vtkVolume* volume, vtkVolumeMapper* mapper,
  vtkImageData* image, vtkCompressedVolume* compressed, const int viewport[4])
{
  PipelineScene scene;
  glsl::View& view = scene.View;
  std::copy(viewport, viewport + 2, view.ImageSize);
  std::copy(viewport + 2, viewport + 4, view.ImageOrigin);
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

  TranslateRays(MakeEyeRays(projection, viewport[0], viewport[1]), eyeToIndex, view);
  if (!(determinant != 0.0)) // nothing was inverted
  {
    std::fill_n(view.RayDirection.Base, 3, std::numeric_limits<double>::quiet_NaN());
  }
  camera->GetClippingRange(view.NearDistance, view.FarDistance);
  TranslatePart(image, compressed, view);
  TranslateIsovalues(volume->GetProperty(), compressed, scene);
  TranslateClipping(mapper, worldToIndex, view);
  TranslateCropping(mapper, image, compressed, view);

  TranslateNormals(eyeToIndex, scene.Look);
  TranslateDepths(projection, scene.Look);
  TranslateMaterial(volume->GetProperty(), scene.Look);
  if (volume->GetProperty()->GetShade())
  {
    TranslateShading(renderer, worldToEye, scene);
  }
  return scene;
}

bool HasRays(const glsl::View& view)
{
  return AreSmall(view.RayOrigin) && AreSmall(view.RayDirection);
}

bool SameHits(const glsl::View& a, const glsl::View& b)
{
  glsl::View exact = b; // after what is compared with a tolerance has been evened out
  for (auto vector : { &glsl::View::RayOrigin, &glsl::View::RayDirection, &glsl::View::EyeOrigin,
         &glsl::View::EyeDirection })
  {
    if (!NearlySame(a.*vector, b.*vector))
    {
      return false;
    }
    exact.*vector = a.*vector;
  }
  const double rangeOfA[] = { a.NearDistance, a.FarDistance, 0.0 };
  const double rangeOfB[] = { b.NearDistance, b.FarDistance, 0.0 };
  exact.NearDistance = a.NearDistance;
  exact.FarDistance = a.FarDistance;
  return NearlySame(rangeOfA, rangeOfB) && std::memcmp(&a, &exact, sizeof(a)) == 0;
}

bool SameLook(const glsl::Look& a, const glsl::Look& b)
{
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

namespace
{
double AtPixel(const glsl::PixelVector& vector, int axis, double px, double py)
{
  return vector.Base[axis] + px * vector.PerX[axis] + py * vector.PerY[axis];
}

double FiniteInverse(double d)
{
  return std::abs(d) > 1e-290 ? 1.0 / d : 1e290;
}

// As in Rays.glsl.
void ClipRay(const glsl::View& view, double px, double py, double& enter, double& leave)
{
  for (int i = 0; i < view.NumberOfClippingPlanes; ++i)
  {
    const glsl::ClippingPlane& plane = view.ClippingPlanes[i];
    double at = plane.Offset, along = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      at += plane.Normal[axis] * AtPixel(view.RayOrigin, axis, px, py);
      along += plane.Normal[axis] * AtPixel(view.RayDirection, axis, px, py);
    }
    const double t = -at * FiniteInverse(along);
    enter = along > 0.0 ? std::max(enter, t) : enter;
    leave = along < 0.0 ? std::min(leave, t) : leave;
  }
}
}

double HitParameter(const glsl::View& view, int x, int y, std::uint32_t key)
{
  if (key == glsl::NO_HIT)
  {
    return std::numeric_limits<double>::infinity();
  }
  const double px = x + 0.5, py = y + 0.5;
  double enter = view.NearDistance, leave = view.FarDistance;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double origin = AtPixel(view.RayOrigin, axis, px, py);
    const double inverse = FiniteInverse(AtPixel(view.RayDirection, axis, px, py));
    const double first = (view.FirstDrawn[axis] - origin) * inverse;
    const double last = (view.LastDrawn[axis] - origin) * inverse;
    enter = std::max(enter, std::min(first, last));
    leave = std::min(leave, std::max(first, last));
  }
  ClipRay(view, px, py, enter, leave);
  return enter + (key + 0.5) / glsl::HIT_STEPS * (leave - enter);
}

double RayLength(const glsl::View& view, int x, int y, double t)
{
  double squares = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double eye = AtPixel(view.EyeDirection, axis, x + 0.5, y + 0.5);
    squares += eye * eye;
  }
  return t * std::sqrt(squares);
}

void EyePosition(const glsl::View& view, int x, int y, double t, double position[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    position[axis] = AtPixel(view.EyeOrigin, axis, x + 0.5, y + 0.5) +
      t * AtPixel(view.EyeDirection, axis, x + 0.5, y + 0.5);
  }
}
