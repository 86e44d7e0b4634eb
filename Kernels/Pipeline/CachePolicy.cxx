// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CachePolicy.h"

#include <algorithm>

namespace
{
constexpr std::int64_t SmallestFirstCache = 16384; // slots
constexpr std::int64_t PixelsPerFirstSlot = 4;
constexpr std::int64_t GrowthFactor = 4;
constexpr std::int64_t Headroom = 2; // slots for each that is needed
constexpr int MaximumConsecutiveDenials = 3;
constexpr std::size_t RecentImages = 8;
}

std::int64_t CachePolicy::SlotsAtFirst(std::int64_t pixels, std::int64_t maximumSlots)
{
  return std::min(std::max(SmallestFirstCache, pixels / PixelsPerFirstSlot), maximumSlots);
}

std::int64_t CachePolicy::SlotsAfterPass(
  const glsl::PassRecord& pass, std::int64_t slots, std::int64_t pixels, std::int64_t maximumSlots)
{
  const std::int64_t needed = std::int64_t(pass.TouchedSlots) + pass.RefusedBlocks;
  const bool small = slots < pixels && needed > slots;
  this->ConsecutiveDenials = pass.RefusedBlocks > 0 ? this->ConsecutiveDenials + 1 : 0;
  if (this->ConsecutiveDenials <= (small ? 0 : MaximumConsecutiveDenials) || slots >= maximumSlots)
  {
    return slots;
  }
  const std::int64_t enough = small ? std::max(GrowthFactor * slots, Headroom * needed) : 2 * slots;
  return std::min(enough, maximumSlots);
}

std::int64_t CachePolicy::SlotsForNewImage(std::int64_t slots) const
{
  if (this->RecentUsage.size() < RecentImages)
  {
    return slots;
  }
  const std::int64_t most = *std::max_element(this->RecentUsage.begin(), this->RecentUsage.end());
  const std::int64_t enough = std::max(Headroom * most, SmallestFirstCache);
  return GrowthFactor * most < slots ? std::min(enough, slots) : slots;
}

void CachePolicy::RecordImage(std::int64_t touchedSlots)
{
  this->RecentUsage.push_back(touchedSlots);
  if (this->RecentUsage.size() > RecentImages)
  {
    this->RecentUsage.pop_front();
  }
}

void CachePolicy::Reset()
{
  this->ConsecutiveDenials = 0;
  this->RecentUsage.clear();
}
