// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/CameraTranslation.h"

#include "vtkMatrix4x4.h"
#include "vtkNew.h"

#include <algorithm>
#include <cmath>

namespace
{
// Origins and directions of a camera's rays in eye coordinates, as functions of the pixel: each has
// a base, and what it gains for each pixel in x and in y. A ray's parameter is the depth along the
// view direction.
struct EyeRays
{
  double Origin[3][3] = {};
  double Direction[3][3] = {};
};

// Finds the point of the plane at depth z in eye coordinates that projects to (x, y) in normalised
// device coordinates.
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

// Origin and direction differ for each pixel: the rays of a stereo view do not meet in the eye.
EyeRays MakeEyeRays(vtkMatrix4x4* projection, int width, int height)
{
  const double corners[3][2] = { { -1.0, -1.0 }, { 1.0, -1.0 }, { -1.0, 1.0 } };
  double start[3][2], direction[3][2];
  for (int i = 0; i < 3; ++i)
  {
    Unproject(projection, 0.0, corners[i][0], corners[i][1], start[i]);
    Unproject(projection, -1.0, corners[i][0], corners[i][1], direction[i]);
    direction[i][0] -= start[i][0];
    direction[i][1] -= start[i][1];
  }
  EyeRays rays;
  for (int axis = 0; axis < 2; ++axis)
  {
    rays.Origin[0][axis] = start[0][axis];
    rays.Origin[1][axis] = (start[1][axis] - start[0][axis]) / width;
    rays.Origin[2][axis] = (start[2][axis] - start[0][axis]) / height;
    rays.Direction[0][axis] = direction[0][axis];
    rays.Direction[1][axis] = (direction[1][axis] - direction[0][axis]) / width;
    rays.Direction[2][axis] = (direction[2][axis] - direction[0][axis]) / height;
  }
  rays.Direction[0][2] = -1.0;
  return rays;
}

// Only the base of origins is a point; everything else is a vector.
void TranslateToIndex(
  const double eye[3][3], bool isOrigin, vtkMatrix4x4* eyeToIndex, PixelVector& index)
{
  double* const terms[] = { index.Base, index.PerX, index.PerY };
  for (int i = 0; i < 3; ++i)
  {
    double vector[4] = { eye[i][0], eye[i][1], eye[i][2], isOrigin && i == 0 ? 1.0 : 0.0 };
    eyeToIndex->MultiplyPoint(vector, vector);
    std::copy(vector, vector + 3, terms[i]);
  }
}

void CopyTerms(const double terms[3][3], PixelVector& vector)
{
  std::copy(terms[0], terms[0] + 3, vector.Base);
  std::copy(terms[1], terms[1] + 3, vector.PerX);
  std::copy(terms[2], terms[2] + 3, vector.PerY);
}

bool AreSmall(const double vector[3])
{
  const double most = 1e200; // their sums are finite, too
  return std::all_of(vector, vector + 3, [=](double value) { return std::abs(value) <= most; });
}

bool AreSmall(const PixelVector& vector)
{
  return AreSmall(vector.Base) && AreSmall(vector.PerX) && AreSmall(vector.PerY);
}
}

void TranslateRays(vtkMatrix4x4* projection, vtkMatrix4x4* eyeToIndex, ViewGeometry& view)
{
  vtkNew<vtkMatrix4x4> indexToEye;
  vtkMatrix4x4::Invert(eyeToIndex, indexToEye);
  for (int column = 0; column < 4; ++column)
  {
    view.Depth[column] = -indexToEye->GetElement(2, column);
  }
  const EyeRays rays = MakeEyeRays(projection, view.ViewportSize[0], view.ViewportSize[1]);
  TranslateToIndex(rays.Origin, true, eyeToIndex, view.RayOrigin);
  TranslateToIndex(rays.Direction, false, eyeToIndex, view.RayDirection);
  CopyTerms(rays.Origin, view.EyeOrigin);
  CopyTerms(rays.Direction, view.EyeDirection);
}

void TranslateDepths(vtkMatrix4x4* projection, glsl::Look& look)
{
  look.ClipZ = static_cast<float>(projection->GetElement(2, 3));
  look.ClipZPerT = static_cast<float>(-projection->GetElement(2, 2));
  look.ClipW = static_cast<float>(projection->GetElement(3, 3));
  look.ClipWPerT = static_cast<float>(-projection->GetElement(3, 2));
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

bool HasRays(const ViewGeometry& view)
{
  return AreSmall(view.RayOrigin) && AreSmall(view.RayDirection);
}
