// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/HitGeometry.h"

#include "Pipeline/FixedView.h"

#include <cmath>

namespace
{
double AtPixel(const PixelVector& vector, int axis, double px, double py)
{
  return vector.Base[axis] + px * vector.PerX[axis] + py * vector.PerY[axis];
}

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

std::vector<float> HitDistances(const ViewGeometry& view, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& firstParameters)
{
  std::vector<float> distances(keys.size());
  const DrawnDepths depths = FindDrawnDepths(view);
  for (int y = 0; y < view.ImageSize[1]; ++y)
  {
    for (int x = 0; x < view.ImageSize[0]; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * view.ImageSize[0] + x;
      const double last = HitDepth(depths, keys[pixel]);
      const bool isTranslucent = !firstParameters.empty() && std::isfinite(last);
      const double t = isTranslucent ? firstParameters[pixel] : last;
      distances[pixel] = static_cast<float>(RayLength(view, x, y, t));
    }
  }
  return distances;
}
