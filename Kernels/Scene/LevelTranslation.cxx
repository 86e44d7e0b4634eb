// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/LevelTranslation.h"

#include "Scene/HitGeometry.h"

#include "vtkMatrix4x4.h"
#include "vtkNew.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace
{
// A level goes over to the next in the last quarter of an octave of the distance between samples.
const double Blending = std::pow(2.0, -0.25);
// Below such a share a pixel's growth with the depth is rounding: the projection is parallel.
constexpr double Rounding = 1e-9;

double Length(const double vector[3])
{
  return std::hypot(vector[0], vector[1], vector[2]);
}

double LargestPerPixel(const PixelVector& vector)
{
  return std::max(Length(vector.PerX), Length(vector.PerY));
}

// The distance between pixels at a depth: At0 + depth * PerDepth.
struct PixelPitch
{
  explicit PixelPitch(const ViewGeometry& view)
    : At0(LargestPerPixel(view.EyeOrigin))
    , PerDepth(LargestPerPixel(view.EyeDirection))
  {
    const double gain = this->PerDepth * (std::abs(view.NearDistance) + std::abs(view.FarDistance));
    this->Parallel = gain <= Rounding * this->At0;
  }

  double DepthOf(double pitch) const { return (pitch - this->At0) / this->PerDepth; }

  double At0;
  double PerDepth;
  bool Parallel = false;
};

// The distance between a level's samples along the axis where it is largest.
double LargestSpacing(vtkMatrix4x4* indexToEye, const LevelSteps& steps)
{
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double edge[3] = { steps[axis] * indexToEye->GetElement(0, axis),
      steps[axis] * indexToEye->GetElement(1, axis),
      steps[axis] * indexToEye->GetElement(2, axis) };
    largest = std::max(largest, Length(edge));
  }
  return largest;
}

// The same at all depths: nothing, one level, or a blend of two.
LevelSpan SpanOfParallel(double pitch, double from, double until)
{
  if (pitch >= until)
  {
    return { -EndlessDepth, -EndlessDepth, 0.0, 0.0 };
  }
  if (pitch <= from)
  {
    return { EndlessDepth, EndlessDepth, 0.0, 0.0 };
  }
  const double weight = (pitch - from) / (until - from);
  return { -EndlessDepth, EndlessDepth, weight, weight };
}
}

void TranslateNoLevels(ViewGeometry& view)
{
  view.NumberOfLevels = 1;
  view.Levels[0] = { EndlessDepth, EndlessDepth, 0.0, 0.0 };
}

void TranslateLevels(vtkMatrix4x4* eyeToIndex, const std::vector<LevelSteps>& levels, double pixels,
  ViewGeometry& view)
{
  TranslateNoLevels(view);
  vtkNew<vtkMatrix4x4> indexToEye;
  vtkMatrix4x4::Invert(eyeToIndex, indexToEye);
  const PixelPitch pitch(view);
  view.NumberOfLevels =
    static_cast<std::int32_t>(std::min<std::size_t>(levels.size(), glsl::MAX_LEVELS));
  double before = 0.0; // pitch from which on the level is drawn
  for (int level = 0; level + 1 < view.NumberOfLevels; ++level)
  {
    const double spacing = LargestSpacing(indexToEye, levels[level + 1]);
    // of two levels that are as coarse along an axis the first is drawn for as long as blending
    // takes: no step may be seen
    const double until = std::max(spacing / pixels, before / Blending);
    const double from = std::max(Blending * until, before);
    view.Levels[level] = pitch.Parallel
      ? SpanOfParallel(pitch.At0, from, until)
      : LevelSpan{ pitch.DepthOf(from), pitch.DepthOf(until), 0.0, 1.0 };
    before = until;
  }
  view.Levels[view.NumberOfLevels - 1] = { EndlessDepth, EndlessDepth, 0.0, 0.0 };
}

int LevelAtDepth(const ViewGeometry& view, double depth)
{
  int level = 0;
  while (level + 1 < view.NumberOfLevels && depth >= view.Levels[level].Until)
  {
    ++level;
  }
  return level;
}

// Flags: see LEVEL_FLAG in Hits.glsl.
PixelsOfLevels CountLevels(const PipelineScene& scene, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& depths)
{
  const ViewGeometry& view = scene.View;
  PixelsOfLevels counts;
  counts.Pixels.assign(std::max(view.NumberOfLevels, 1), 0);
  if (view.NumberOfLevels <= 1)
  {
    counts.Pixels[0] =
      static_cast<std::int64_t>(keys.size()) - std::count(keys.begin(), keys.end(), glsl::NO_HIT);
    return counts;
  }
  const std::vector<double> hits =
    HitDepths(view, keys, scene.Translucent ? depths : std::vector<float>());
  std::int64_t uncertain = 0;
  for (std::size_t pixel = 0; pixel < keys.size(); ++pixel)
  {
    const bool isHit = keys[pixel] != glsl::NO_HIT;
    const bool flag = std::signbit(depths[pixel]);
    if (isHit)
    {
      ++counts.Pixels[scene.Conservative && flag ? 0 : LevelAtDepth(view, hits[pixel])];
    }
    uncertain += !scene.Conservative && flag && (isHit || depths[pixel] == 0.0f) ? 1 : 0;
  }
  counts.UncertainFraction =
    static_cast<double>(uncertain) / static_cast<double>(std::max<std::size_t>(keys.size(), 1));
  return counts;
}
