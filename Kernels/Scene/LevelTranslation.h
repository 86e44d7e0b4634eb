// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Which level of detail is drawn at which depth: the coarsest whose samples, as the camera sees
// them, are no farther apart than some pixels.
#ifndef LevelTranslation_h
#define LevelTranslation_h

#include "Pipeline/PipelineScene.h"

#include <array>
#include <cstdint>
#include <vector>

class vtkMatrix4x4;

/// Samples of the volume from one of a level's to the next, along each axis.
using LevelSteps = std::array<int, 3>;

/// Finds the levels to draw of those that there are, the volume itself first. `pixels`, above 0:
/// how far apart samples may be. The view's rays are there already.
void TranslateLevels(vtkMatrix4x4* eyeToIndex, const std::vector<LevelSteps>& levels, double pixels,
  ViewGeometry& view);

/// Draws the volume itself at all depths.
void TranslateNoLevels(ViewGeometry& view);

/// The level that is drawn at a depth; where two blend, the finer one.
int LevelAtDepth(const ViewGeometry& view, double depth);

struct PixelsOfLevels
{
  std::vector<std::int64_t> Pixels; ///< that show the surface in each level
  double UncertainFraction = 0.0;   ///< of the image's pixels
};

/// Counts what pixels show, by their keys and depths as HitReadback reads them. Depths are
/// not looked at without levels.
PixelsOfLevels CountLevels(const PipelineScene& scene, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& depths);

#endif
