// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FixedView.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace
{
constexpr int MostBits = 29;     // of coordinates before the point: see SpeedOf in Rays.glsl
constexpr double Margin = 1e-6;  // of the depths, for the rounding of what they come from
constexpr double Farthest = 1e9; // cell, beyond all volumes
// Of the few numbers of a view, so that nothing is lost where a volume is far away.
using Exact = long double;

bool Fits(Exact coordinate)
{
  return coordinate < std::ldexp(Exact(1), MostBits);
}

// A number that is Base + x PerX + y PerY at a pixel.
struct PixelNumber
{
  Exact Base = 0.0;
  Exact PerX = 0.0;
  Exact PerY = 0.0;

  Exact LargestIn(const std::int32_t size[2]) const
  {
    Exact largest = 0.0;
    for (int corner = 0; corner < 4; ++corner)
    {
      const Exact x = corner & 1 ? size[0] : 0, y = corner & 2 ? size[1] : 0;
      largest = std::max(largest, std::abs(this->Base + x * this->PerX + y * this->PerY));
    }
    return largest;
  }
};

PixelNumber operator*(Exact factor, const PixelNumber& number)
{
  return { factor * number.Base, factor * number.PerX, factor * number.PerY };
}

PixelNumber operator+(const PixelNumber& a, const PixelNumber& b)
{
  return { a.Base + b.Base, a.PerX + b.PerX, a.PerY + b.PerY };
}

PixelNumber ComponentOf(const PixelVector& vector, int axis)
{
  return { vector.Base[axis], vector.PerX[axis], vector.PerY[axis] };
}

// The words before the point and behind it, and one more.
struct FixedNumber
{
  explicit FixedNumber(Exact value)
  {
    const Exact words = std::ldexp(value, 32), whole = std::floor(words);
    const std::int64_t bits = static_cast<std::int64_t>(whole);
    this->High = static_cast<std::int32_t>(bits >> 32);
    this->Low = static_cast<std::uint32_t>(bits);
    // what is hardly below zero rounds to a whole one
    const Exact rest = std::min(std::ldexp(words - whole, 32), Exact(0xFFFFFFFFu));
    this->Least = static_cast<std::uint32_t>(rest);
  }

  std::int32_t High;
  std::uint32_t Low;
  std::uint32_t Least;
};

void Store(const PixelNumber& number, int component, glsl::FixedPixelVector& vector)
{
  const FixedNumber base(number.Base), perX(number.PerX / 2), perY(number.PerY / 2);
  vector.BaseHigh[component] = base.High;
  vector.BaseLow[component] = base.Low;
  vector.PerXHigh[component] = perX.High;
  vector.PerXLow[component] = perX.Low;
  vector.PerXLeast[component] = perX.Least;
  vector.PerYHigh[component] = perY.High;
  vector.PerYLow[component] = perY.Low;
  vector.PerYLeast[component] = perY.Least;
}

// Origins and ways of all pixels on one axis, or their distances from a clipping plane.
struct Line
{
  PixelNumber Origin;
  PixelNumber Way;

  Exact LargestIn(const std::int32_t size[2]) const
  {
    return std::max(this->Origin.LargestIn(size), this->Way.LargestIn(size));
  }
};

Line LineOnAxis(const ViewGeometry& view, const DrawnDepths& depths, int axis)
{
  const PixelNumber origin = ComponentOf(view.RayOrigin, axis);
  const PixelNumber direction = ComponentOf(view.RayDirection, axis);
  return { origin + Exact(depths.First) * direction,
    (Exact(depths.Last) - depths.First) * direction };
}

// The scale does not matter: as much as there is room for.
Line DistancesFromPlane(const ClippingPlane& plane, const Line axes[3], const std::int32_t size[2])
{
  Line line;
  line.Origin.Base = plane.Offset;
  for (int axis = 0; axis < 3; ++axis)
  {
    line.Origin = line.Origin + Exact(plane.Normal[axis]) * axes[axis].Origin;
    line.Way = line.Way + Exact(plane.Normal[axis]) * axes[axis].Way;
  }
  const Exact largest = line.LargestIn(size);
  const Exact scale = largest > 0 ? std::ldexp(Exact(1), MostBits - 1 - std::ilogb(largest)) : 1;
  return { scale * line.Origin, scale * line.Way };
}

void FixRays(const ViewGeometry& view, const DrawnDepths& depths, glsl::View& block)
{
  Line axes[3];
  bool fits = depths.First < depths.Last;
  for (int axis = 0; axis < 3; ++axis)
  {
    axes[axis] = LineOnAxis(view, depths, axis);
    fits = fits && Fits(axes[axis].LargestIn(view.ViewportSize));
  }
  if (!fits)
  {
    return;
  }
  block.HasRays = 1;
  block.FirstDepth = static_cast<float>(depths.First);
  block.DepthOfWay = static_cast<float>(depths.Last - depths.First);
  for (int axis = 0; axis < 3; ++axis)
  {
    Store(axes[axis].Origin, axis, block.RayOrigin);
    Store(axes[axis].Way, axis, block.RayWay);
  }
  for (int i = 0; i < view.NumberOfClippingPlanes; ++i)
  {
    const Line line = DistancesFromPlane(view.ClippingPlanes[i], axes, view.ViewportSize);
    Store(line.Origin, i % 3, block.ClippingOrigin[i / 3]);
    Store(line.Way, i % 3, block.ClippingWay[i / 3]);
  }
}

// A parameter within a ray's way, or just behind its end.
Exact ParameterOf(double depth, const DrawnDepths& depths)
{
  const Exact way = (Exact(depth) - depths.First) / (Exact(depths.Last) - depths.First);
  const Exact end = std::ldexp(Exact(1), glsl::WAY_BITS);
  return std::max(Exact(0), std::min(std::ceil(end * way), end + 1));
}

// The weight that two depths and their weights give at a parameter between or beyond them.
float WeightAt(Exact parameter, const LevelSpan& span, const DrawnDepths& depths)
{
  if (span.FirstWeight == span.LastWeight || span.BlendFrom >= span.Until)
  {
    return static_cast<float>(span.LastWeight);
  }
  const Exact way = std::ldexp(parameter, -glsl::WAY_BITS);
  const Exact depth = depths.First + way * (Exact(depths.Last) - depths.First);
  const Exact share = (depth - span.BlendFrom) / (Exact(span.Until) - span.BlendFrom);
  const Exact weight = span.FirstWeight + share * (span.LastWeight - span.FirstWeight);
  return static_cast<float>(std::max(Exact(0), std::min(weight, Exact(1))));
}

// A parameter that a depth has exactly keeps its weight: levels meet there without a step.
void FixSpan(const LevelSpan& span, const DrawnDepths& depths, glsl::LevelSpan& block)
{
  const Exact first = ParameterOf(span.BlendFrom, depths);
  const Exact last = ParameterOf(span.Until, depths);
  const Exact end = std::ldexp(Exact(1), glsl::WAY_BITS);
  const auto firstBits = static_cast<std::int64_t>(first),
             lastBits = static_cast<std::int64_t>(last);
  block.BlendHigh = static_cast<std::int32_t>(firstBits >> 32);
  block.BlendLow = static_cast<std::uint32_t>(firstBits);
  block.UntilHigh = static_cast<std::int32_t>(lastBits >> 32);
  block.UntilLow = static_cast<std::uint32_t>(lastBits);
  const bool begins = first > 0 && first <= end, ends = last > 0 && last <= end;
  block.FirstWeight = begins ? static_cast<float>(span.FirstWeight) : WeightAt(first, span, depths);
  block.LastWeight = ends ? static_cast<float>(span.LastWeight) : WeightAt(last, span, depths);
}

void ToFloat(const PixelVector& vector, glsl::PixelVector& rounded)
{
  std::copy(vector.Base, vector.Base + 3, rounded.Base);
  std::copy(vector.PerX, vector.PerX + 3, rounded.PerX);
  std::copy(vector.PerY, vector.PerY + 3, rounded.PerY);
}

void FixPlanes(const double places[3], glsl::CellPlanes& planes)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double place = std::max(-Farthest, std::min(Farthest, places[axis]));
    planes.Cell[axis] = static_cast<std::int32_t>(std::floor(place));
    planes.Place[axis] = static_cast<float>(place - std::floor(place));
  }
}
}

// A corner's depth is the least or the greatest, as the drawn part is a box.
DrawnDepths FindDrawnDepths(const ViewGeometry& view)
{
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (int corner = 0; corner < 8; ++corner)
  {
    double depth = view.Depth[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int32_t* drawn = corner >> axis & 1 ? view.LastDrawn : view.FirstDrawn;
      depth += view.Depth[axis] * drawn[axis];
    }
    first = std::min(first, depth);
    last = std::max(last, depth);
  }
  const double margin = Margin * (last - first);
  return { std::max(first - margin, view.NearDistance), std::min(last + margin, view.FarDistance) };
}

double HitDepth(const DrawnDepths& depths, std::uint32_t key)
{
  if (key == glsl::NO_HIT)
  {
    return std::numeric_limits<double>::infinity();
  }
  return depths.First + std::ldexp(key + 0.5, -glsl::KEY_BITS) * (depths.Last - depths.First);
}

bool HasTooLongWays(const ViewGeometry& view)
{
  const DrawnDepths depths = FindDrawnDepths(view);
  bool tooLong = false;
  for (int axis = 0; axis < 3 && depths.First < depths.Last; ++axis)
  {
    tooLong = tooLong || !Fits(LineOnAxis(view, depths, axis).Way.LargestIn(view.ViewportSize));
  }
  return tooLong;
}

glsl::View FixView(const ViewGeometry& view)
{
  glsl::View block = {};
  const DrawnDepths depths = FindDrawnDepths(view);
  FixRays(view, depths, block);
  block.NumberOfLevels = view.NumberOfLevels;
  for (int level = 0; level < view.NumberOfLevels && depths.First < depths.Last; ++level)
  {
    FixSpan(view.Levels[level], depths, block.Levels[level]);
  }
  ToFloat(view.EyeOrigin, block.EyeOrigin);
  ToFloat(view.EyeDirection, block.EyeDirection);
  FixPlanes(view.CroppingLow, block.CroppingLow);
  FixPlanes(view.CroppingHigh, block.CroppingHigh);
  std::copy(view.FirstDrawn, view.FirstDrawn + 3, block.FirstDrawn);
  std::copy(view.LastDrawn, view.LastDrawn + 3, block.LastDrawn);
  for (int axis = 0; axis < 2; ++axis)
  {
    block.ImageSize[axis] = view.ImageSize[axis];
    block.FirstPixel[axis] = view.ImageOrigin[axis];
    block.ViewportSize[axis] = view.ViewportSize[axis];
    block.ViewportOrigin[axis] = view.ViewportOrigin[axis];
    block.PixelsPerFragment[axis] =
      static_cast<float>(view.ViewportSize[axis]) / static_cast<float>(view.WindowSize[axis]);
  }
  std::copy(std::begin(view.Isovalues), std::end(view.Isovalues), block.Isovalues);
  block.NumberOfIsovalues = view.NumberOfIsovalues;
  block.NumberOfClippingPlanes = view.NumberOfClippingPlanes;
  block.DrawnRegions = view.DrawnRegions;
  return block;
}
