// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/HitReadback.h"

#include "Shaders/HitSections.h"

#include <cmath>

namespace
{
// Byte of a pixel's word.
std::int64_t Offset(const SceneNeeds& needs, int HitSections::*section, std::int64_t pixel)
{
  return 4 * (HitSections(needs).*section * needs.Pixels + pixel);
}
}

std::vector<std::uint32_t> HitReadback::ReadKeys()
{
  std::vector<std::uint32_t> keys(static_cast<std::size_t>(this->Needs.Pixels));
  this->Transfer.Read(
    this->Hits, Offset(this->Needs, &HitSections::Key, 0), keys.data(), 4 * this->Needs.Pixels);
  return keys;
}

std::vector<float> HitReadback::ReadDepths()
{
  std::vector<float> depths(static_cast<std::size_t>(this->Needs.Pixels));
  this->Transfer.Read(
    this->Hits, Offset(this->Needs, &HitSections::Depth, 0), depths.data(), 4 * this->Needs.Pixels);
  return depths;
}

PixelHit HitReadback::Read(std::int64_t pixel)
{
  PixelHit hit;
  this->Transfer.Read(this->Hits, Offset(this->Needs, &HitSections::Key, pixel), &hit.Key, 4);
  this->Transfer.Read(this->Hits, Offset(this->Needs, &HitSections::Depth, pixel), &hit.Depth, 4);
  hit.Depth = std::fabs(hit.Depth);
  if (this->Needs.SeveralIsovalues)
  {
    std::uint32_t isovalues = 0; // of the first hit in the upper half
    this->Transfer.Read(
      this->Hits, Offset(this->Needs, &HitSections::Isovalue, pixel), &isovalues, 4);
    hit.Isovalue = isovalues >> 16;
  }
  return hit;
}

std::int64_t HitReadback::GetObstacleOffset(const SceneNeeds& needs)
{
  return Offset(needs, &HitSections::Obstacle, 0);
}
