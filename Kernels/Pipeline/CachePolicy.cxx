// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CachePolicy.h"

#include <algorithm>

namespace
{
constexpr std::int64_t SmallestFirstCache = 1 << 14; // slots
constexpr std::int64_t LargestFirstCache = 1 << 18;
constexpr std::int64_t PixelsPerFirstSlot = 4;
constexpr std::int64_t GrowthFactor = 4;
constexpr std::int64_t Headroom = 2;          // slots for each that is needed
constexpr std::int64_t LargestStep = 1 << 18; // slots
constexpr int MaximumConsecutiveDenials = 3;
constexpr std::size_t RecentImages = 8;
constexpr double PauseMilliseconds = 2000.0;
}

std::int64_t CachePolicy::SlotsAtFirst(std::int64_t pixels, std::int64_t maximumSlots)
{
  return std::min(
    std::clamp(pixels / PixelsPerFirstSlot, SmallestFirstCache, LargestFirstCache), maximumSlots);
}

std::int64_t CachePolicy::SlotsAfterPass(
  const glsl::PassRecord& pass, std::int64_t slots, std::int64_t pixels, std::int64_t maximumSlots)
{
  const std::int64_t needed = std::int64_t(pass.TouchedSlots) + pass.RefusedBlocks;
  this->ConsecutiveDenials = pass.RefusedBlocks > 0 ? this->ConsecutiveDenials + 1 : 0;
  if (this->ConsecutiveDenials > MaximumConsecutiveDenials)
  {
    this->Wanted = std::max(this->Wanted, 2 * slots);
  }
  if (this->ConsecutiveDenials > 0 && needed > slots)
  {
    const std::int64_t least = slots < pixels ? GrowthFactor * slots : 0;
    this->Wanted = std::max({ this->Wanted, least, Headroom * needed });
  }
  return this->ConsecutiveDenials > 0 ? this->StepFrom(slots, maximumSlots) : slots;
}

std::int64_t CachePolicy::SlotsForNewImage(
  std::int64_t slots, std::int64_t maximumSlots, double idleMilliseconds)
{
  if (this->RecentUsage.empty())
  {
    return slots;
  }
  this->Wanted = std::max(this->Wanted, Headroom * this->RecentUsage.back());
  const std::int64_t most = *std::max_element(this->RecentUsage.begin(), this->RecentUsage.end());
  if (this->RecentUsage.size() == RecentImages && GrowthFactor * most < slots &&
    idleMilliseconds >= PauseMilliseconds)
  {
    return std::min(std::max(Headroom * most, SmallestFirstCache), slots);
  }
  return this->StepFrom(slots, maximumSlots);
}

// Nothing is shown before the first image is complete: it does not wait for memory step by step.
std::int64_t CachePolicy::StepFrom(std::int64_t slots, std::int64_t maximumSlots) const
{
  const std::int64_t most = this->RecentUsage.empty() ? maximumSlots : slots + LargestStep;
  return std::max(slots, std::min({ this->Wanted, most, maximumSlots }));
}

void CachePolicy::RecordImage(std::int64_t touchedSlots)
{
  this->RecentUsage.push_back(touchedSlots);
  if (this->RecentUsage.size() > RecentImages)
  {
    this->RecentUsage.pop_front();
  }
}

void CachePolicy::RecordGrowth()
{
  this->ConsecutiveDenials = 0;
}

void CachePolicy::Reset()
{
  *this = CachePolicy();
}
