// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/HitReadback.h"

namespace
{
// Sections of the buffer, a word a pixel each.
constexpr std::int64_t KeySection = 0;
constexpr std::int64_t DepthSection = 1;
constexpr std::int64_t IsovalueSection = 2; // with several isovalues only

// Byte of a pixel's word.
std::int64_t Offset(const PipelineExtent& extent, std::int64_t section, std::int64_t pixel)
{
  return 4 * (section * extent.Pixels + pixel);
}
}

std::vector<std::uint32_t> HitReadback::ReadKeys()
{
  std::vector<std::uint32_t> keys(static_cast<std::size_t>(this->Extent.Pixels));
  this->Transfer.Read(
    this->Hits, Offset(this->Extent, KeySection, 0), keys.data(), 4 * this->Extent.Pixels);
  return keys;
}

std::vector<float> HitReadback::ReadDepths()
{
  std::vector<float> depths(static_cast<std::size_t>(this->Extent.Pixels));
  this->Transfer.Read(
    this->Hits, Offset(this->Extent, DepthSection, 0), depths.data(), 4 * this->Extent.Pixels);
  return depths;
}

PixelHit HitReadback::Read(std::int64_t pixel)
{
  PixelHit hit;
  this->Transfer.Read(this->Hits, Offset(this->Extent, KeySection, pixel), &hit.Key, 4);
  this->Transfer.Read(this->Hits, Offset(this->Extent, DepthSection, pixel), &hit.Depth, 4);
  if (this->Extent.SeveralIsovalues)
  {
    std::uint32_t isovalues = 0; // of the first hit in the upper half
    this->Transfer.Read(this->Hits, Offset(this->Extent, IsovalueSection, pixel), &isovalues, 4);
    hit.Isovalue = isovalues >> 16;
  }
  return hit;
}

std::int64_t HitReadback::GetObstacleOffset(const PipelineExtent& extent)
{
  const std::int64_t section = 2 + extent.SeveralIsovalues + extent.Colored;
  return Offset(extent, section, 0);
}
