// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CachePolicy.h"

#include <algorithm>

namespace
{
constexpr std::int64_t SmallestFirstCache = 1 << 14; // slots
constexpr std::int64_t LargestFirstCache = 1 << 16;
constexpr std::int64_t PixelsPerFirstSlot = 4;
constexpr std::int64_t GrowthFactor = 2; // of a cache that is copied, and of a small one
constexpr int MaximumConsecutiveDenials = 3;
// A GPU makes memory at 1 to 2 milliseconds a mebibyte: so many slots are 4.7 MiB.
constexpr std::int64_t LargestStep = 1 << 14;
constexpr std::int64_t ShrinkFactor = 4;
constexpr std::int64_t HeadroomOfShrunk = 2;
constexpr std::size_t RecentImages = 8;
constexpr double PauseMilliseconds = 2000.0;

// What a cache should have that is too small for so many slots. Growth costs what it adds: this is
// little more.
std::int64_t WithHeadroom(std::int64_t needed)
{
  return needed + needed / 4;
}

// Of an image that used so many slots, the next may use some others.
std::int64_t WithHeadroomAhead(std::int64_t used)
{
  return used + used / 2;
}
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
    this->Wanted = std::max(this->Wanted, GrowthFactor * slots);
  }
  if (this->ConsecutiveDenials > 0 && needed > slots)
  {
    const std::int64_t least = slots < pixels ? GrowthFactor * slots : 0;
    this->Wanted = std::max({ this->Wanted, least, WithHeadroom(needed) });
  }
  return this->MayStepNow() ? this->StepFrom(slots, maximumSlots) : slots;
}

// A step an image is enough, as long as eviction helps.
bool CachePolicy::MayStepNow() const
{
  const bool again = this->InPlace && this->StepsOfImage > 0 && !this->RecentUsage.empty();
  return this->ConsecutiveDenials > (again ? MaximumConsecutiveDenials : 0);
}

std::int64_t CachePolicy::SlotsForNewImage(
  std::int64_t slots, std::int64_t maximumSlots, double idleMilliseconds)
{
  this->StepsOfImage = 0;
  if (this->RecentUsage.empty())
  {
    return slots;
  }
  const std::int64_t most = *std::max_element(this->RecentUsage.begin(), this->RecentUsage.end());
  if (this->RecentUsage.size() == RecentImages && ShrinkFactor * most < slots &&
    idleMilliseconds >= PauseMilliseconds)
  {
    return std::min(std::max(HeadroomOfShrunk * most, SmallestFirstCache), slots);
  }
  this->Wanted = std::max(this->Wanted, WithHeadroomAhead(this->RecentUsage.back()));
  return this->StepFrom(slots, maximumSlots);
}

// A copy costs all that the cache has: it is to be the last for long. Memory that is added in place
// comes step by step, so that no image waits for much. Only the first image does: nothing is shown
// before.
std::int64_t CachePolicy::StepFrom(std::int64_t slots, std::int64_t maximumSlots) const
{
  if (this->Wanted <= slots)
  {
    return slots;
  }
  std::int64_t next = this->Wanted;
  if (!this->InPlace)
  {
    next = std::max(next, GrowthFactor * slots);
  }
  else if (!this->RecentUsage.empty())
  {
    next = std::min(next, slots + LargestStep);
  }
  return std::max(slots, std::min(next, maximumSlots));
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
  ++this->StepsOfImage;
}

void CachePolicy::Reset(bool inPlace)
{
  *this = CachePolicy();
  this->InPlace = inPlace;
}
