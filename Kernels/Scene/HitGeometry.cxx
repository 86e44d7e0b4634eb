// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/HitGeometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Repeats ClipRay() of Rays.glsl.
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

std::vector<float> HitDistances(const glsl::View& view, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& firstParameters)
{
  std::vector<float> distances(keys.size());
  for (int y = 0; y < view.ImageSize[1]; ++y)
  {
    for (int x = 0; x < view.ImageSize[0]; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * view.ImageSize[0] + x;
      const double last = HitParameter(view, x, y, keys[pixel]);
      const bool isTranslucent = !firstParameters.empty() && std::isfinite(last);
      const double t = isTranslucent ? firstParameters[pixel] : last;
      distances[pixel] = static_cast<float>(RayLength(view, x, y, t));
    }
  }
  return distances;
}
