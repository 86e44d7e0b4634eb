// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ImageRectangle.h"

#include "Pipeline/FixedView.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace
{
using Exact = long double; // as rays are made from: see FixedView.cxx
using Vector = std::array<Exact, 3>;

constexpr Exact RayRounding = 1.0 / (1u << 30); // in voxels, with room to spare: see FixView
constexpr Exact MostDoubt = 0.5;                // in pixels, of which there is one around the image

// A corner of what is drawn, in index space and with its depth along the view direction.
struct Corner
{
  Vector Place;
  Exact Depth;
};

// The pixel through which a corner is seen.
struct SeenCorner
{
  Exact Pixel[2];
  Exact Doubt; ///< how far it may be off, in pixels
  Vector PerX; ///< what the place at this depth gains with a pixel
};

Exact Dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector Cross(const Vector& a, const Vector& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

// a + factor b
Vector Sum(const double a[3], Exact factor, const double b[3])
{
  return { a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2] };
}

// The direction of the ray in the middle of the viewport.
Vector MiddleDirection(const ViewGeometry& view)
{
  const PixelVector& direction = view.RayDirection;
  Vector middle;
  for (int axis = 0; axis < 3; ++axis)
  {
    middle[axis] = direction.Base[axis] + view.ViewportSize[0] / Exact(2) * direction.PerX[axis] +
      view.ViewportSize[1] / Exact(2) * direction.PerY[axis];
  }
  return middle;
}

Corner BoxCorner(const ViewGeometry& view, int number)
{
  Corner corner = { {}, view.Depth[3] };
  for (int axis = 0; axis < 3; ++axis)
  {
    corner.Place[axis] = number >> axis & 1 ? view.LastDrawn[axis] : view.FirstDrawn[axis];
    corner.Depth += view.Depth[axis] * corner.Place[axis];
  }
  return corner;
}

Corner PointBetween(const Corner& a, const Corner& b, Exact depth)
{
  const Exact share = (depth - a.Depth) / (b.Depth - a.Depth);
  Corner point = { {}, depth };
  for (int axis = 0; axis < 3; ++axis)
  {
    point.Place[axis] = a.Place[axis] + share * (b.Place[axis] - a.Place[axis]);
  }
  return point;
}

// The corners of that part of the drawn box that lies behind a depth.
std::vector<Corner> CornersBehind(const ViewGeometry& view, Exact depth)
{
  std::vector<Corner> corners;
  for (int number = 0; number < 8; ++number)
  {
    const Corner corner = BoxCorner(view, number);
    if (corner.Depth >= depth)
    {
      corners.push_back(corner);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const Corner other = BoxCorner(view, number ^ 1 << axis);
      if (corner.Depth < depth && other.Depth > depth)
      {
        corners.push_back(PointBetween(corner, other, depth));
      }
    }
  }
  return corners;
}

// Solves place = origin + depth * direction for the pixel, from what both gain with pixels. Along
// the ray there is a rest, as the depth is rounded, too.
SeenCorner FindPixel(const ViewGeometry& view, const Corner& corner)
{
  const Vector base = Sum(view.RayOrigin.Base, corner.Depth, view.RayDirection.Base);
  const Vector perX = Sum(view.RayOrigin.PerX, corner.Depth, view.RayDirection.PerX);
  const Vector perY = Sum(view.RayOrigin.PerY, corner.Depth, view.RayDirection.PerY);
  const Vector along = MiddleDirection(view);
  const Vector acrossX = Cross(perY, along), acrossY = Cross(along, perX);
  const Exact volume = Dot(perX, acrossX);
  const Vector way = { corner.Place[0] - base[0], corner.Place[1] - base[1],
    corner.Place[2] - base[2] };
  SeenCorner seen = { { Dot(way, acrossX) / volume, Dot(way, acrossY) / volume }, 0.0, perX };
  for (int axis = 0; axis < 3; ++axis)
  {
    const Exact pixels = std::max(std::abs(acrossX[axis]), std::abs(acrossY[axis]));
    seen.Doubt += RayRounding * pixels / std::abs(volume);
  }
  return seen;
}

// First pixel and the one behind the last, in x and y.
struct Range
{
  Exact First[2] = { INFINITY, INFINITY };
  Exact End[2] = { -INFINITY, -INFINITY };
};

// A pixel counts if its centre does, and so do its neighbours. Nothing is returned where the
// pixels of corners are in doubt, or not all are before the eye.
std::optional<Range> FindPixels(const ViewGeometry& view, const std::vector<Corner>& corners)
{
  Range range;
  std::optional<Vector> perX;
  for (const Corner& corner : corners)
  {
    const SeenCorner seen = FindPixel(view, corner);
    perX = perX ? perX : seen.PerX;
    const bool known = seen.Doubt < MostDoubt && Dot(*perX, seen.PerX) > 0;
    for (int axis = 0; axis < 2; ++axis)
    {
      if (!known || !std::isfinite(seen.Pixel[axis]))
      {
        return std::nullopt;
      }
      const Exact centre = seen.Pixel[axis] - Exact(0.5);
      range.First[axis] = std::min(range.First[axis], std::ceil(centre) - 1);
      range.End[axis] = std::max(range.End[axis], std::floor(centre) + 2);
    }
  }
  return range;
}

std::int32_t Within(Exact pixel, std::int32_t size)
{
  return static_cast<std::int32_t>(std::clamp(pixel, Exact(0), Exact(size)));
}

void SetImage(const Range& range, ViewGeometry& view)
{
  for (int axis = 0; axis < 2; ++axis)
  {
    const std::int32_t size = view.ViewportSize[axis];
    const std::int32_t first = Within(range.First[axis], size);
    view.ImageOrigin[axis] = first;
    view.ImageSize[axis] = std::max(Within(range.End[axis], size) - first, 0);
  }
  if (IsEmpty(view))
  {
    std::fill_n(view.ImageOrigin, 2, 0);
    std::fill_n(view.ImageSize, 2, 0);
  }
}
}

void FindImage(ViewGeometry& view)
{
  const DrawnDepths depths = FindDrawnDepths(view);
  const bool nothing = depths.First >= depths.Last; // false for what is not a number
  const std::vector<Corner> corners =
    nothing ? std::vector<Corner>() : CornersBehind(view, depths.First);
  const std::optional<Range> pixels = FindPixels(view, corners);
  std::fill_n(view.ImageOrigin, 2, 0);
  std::copy(view.ViewportSize, view.ViewportSize + 2, view.ImageSize);
  if (pixels)
  {
    SetImage(*pixels, view);
  }
}

bool IsEmpty(const ViewGeometry& view)
{
  return view.ImageSize[0] == 0 || view.ImageSize[1] == 0;
}
