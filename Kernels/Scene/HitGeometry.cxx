// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/HitGeometry.h"

#include "Pipeline/FixedView.h"

#include <cmath>
#include <limits>

namespace
{
double AtPixel(const PixelVector& vector, int axis, double px, double py)
{
  return vector.Base[axis] + px * vector.PerX[axis] + py * vector.PerY[axis];
}
}

std::optional<std::int64_t> ImagePixel(const ViewGeometry& view, int x, int y)
{
  const int column = x - view.ImageOrigin[0], row = y - view.ImageOrigin[1];
  if (column < 0 || row < 0 || column >= view.ImageSize[0] || row >= view.ImageSize[1])
  {
    return std::nullopt;
  }
  return std::int64_t(row) * view.ImageSize[0] + column;
}

double RayLength(const ViewGeometry& view, int x, int y, double t)
{
  double squares = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double eye = AtPixel(view.EyeDirection, axis, x + 0.5, y + 0.5);
    squares += eye * eye;
  }
  return t * std::sqrt(squares);
}

void EyePosition(const ViewGeometry& view, int x, int y, double t, double position[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    position[axis] = AtPixel(view.EyeOrigin, axis, x + 0.5, y + 0.5) +
      t * AtPixel(view.EyeDirection, axis, x + 0.5, y + 0.5);
  }
}

std::vector<double> HitDepths(const ViewGeometry& view, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& firstParameters)
{
  const DrawnDepths depths = FindDrawnDepths(view);
  std::vector<double> found(keys.size());
  for (std::size_t pixel = 0; pixel < keys.size(); ++pixel)
  {
    const double last = HitDepth(depths, keys[pixel]);
    const bool isTranslucent = !firstParameters.empty() && std::isfinite(last);
    found[pixel] = isTranslucent ? std::fabs(firstParameters[pixel]) : last;
  }
  return found;
}

std::vector<float> HitDistances(const ViewGeometry& view, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& firstParameters)
{
  const std::size_t width = view.ViewportSize[0];
  std::vector<float> distances(
    width * view.ViewportSize[1], std::numeric_limits<float>::infinity());
  const std::vector<double> depths = HitDepths(view, keys, firstParameters);
  for (std::size_t pixel = 0; pixel < depths.size(); ++pixel)
  {
    const int x = view.ImageOrigin[0] + static_cast<int>(pixel % view.ImageSize[0]);
    const int y = view.ImageOrigin[1] + static_cast<int>(pixel / view.ImageSize[0]);
    distances[y * width + x] = static_cast<float>(RayLength(view, x, y, depths[pixel]));
  }
  return distances;
}
