// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CachePolicy.h"

#include <algorithm>

namespace
{
constexpr std::int64_t SmallestFirstCache = 1 << 14; // slots
constexpr std::int64_t LargestFirstCache = 1 << 18;
constexpr std::int64_t PixelsPerFirstSlot = 4;
constexpr std::int64_t Headroom = 2; // slots for each that is needed
constexpr int MaximumConsecutiveDenials = 3;
// Measured on an H100: a mebibyte takes 1.5 milliseconds, and 5 where the cache has 700 already.
// So many slots are 2.4 MiB.
constexpr std::int64_t LargestStep = 1 << 13;
constexpr std::int64_t ShrinkFactor = 4;
constexpr std::size_t RecentImages = 8;
constexpr double PauseMilliseconds = 2000.0;

// Did an image use so many slots that the next may lack some?
bool IsFull(std::int64_t touchedSlots, std::int64_t slots)
{
  return 20 * touchedSlots > 19 * slots;
}
}

std::int64_t CachePolicy::SlotsAtFirst(std::int64_t pixels, std::int64_t maximumSlots)
{
  return std::min(
    std::clamp(pixels / PixelsPerFirstSlot, SmallestFirstCache, LargestFirstCache), maximumSlots);
}

std::int64_t CachePolicy::SlotsAfterPass(
  const glsl::PassRecord& pass, std::int64_t slots, std::int64_t maximumSlots)
{
  const std::int64_t needed = std::int64_t(pass.TouchedSlots) + pass.RefusedBlocks;
  this->ConsecutiveDenials = pass.RefusedBlocks > 0 ? this->ConsecutiveDenials + 1 : 0;
  const bool again = this->ConsecutiveDenials > MaximumConsecutiveDenials;
  if (again || (this->ConsecutiveDenials > 0 && needed > slots && this->MayStep()))
  {
    return this->Towards(Headroom * std::max(needed, slots), slots, maximumSlots);
  }
  return slots;
}

// A step an image is enough, as long as eviction helps.
bool CachePolicy::MayStep() const
{
  return this->IsFirstImage() || !this->InPlace || this->StepsOfImage == 0;
}

std::int64_t CachePolicy::SlotsForNewImage(
  std::int64_t slots, std::int64_t maximumSlots, double idleMilliseconds)
{
  this->StepsOfImage = 0;
  if (this->IsFirstImage())
  {
    return slots;
  }
  const std::int64_t most = *std::max_element(this->RecentUsage.begin(), this->RecentUsage.end());
  if (this->RecentUsage.size() == RecentImages && ShrinkFactor * most < slots &&
    idleMilliseconds >= PauseMilliseconds)
  {
    return std::min(std::max(Headroom * most, SmallestFirstCache), slots);
  }
  const std::int64_t last = this->RecentUsage.back();
  return IsFull(last, slots) ? this->Towards(Headroom * last, slots, maximumSlots) : slots;
}

std::int64_t CachePolicy::SlotsAfterImage(
  std::int64_t touchedSlots, std::int64_t slots, std::int64_t maximumSlots)
{
  const std::int64_t next =
    this->IsFirstImage() ? this->Towards(Headroom * touchedSlots, slots, maximumSlots) : slots;
  this->RecentUsage.push_back(touchedSlots);
  if (this->RecentUsage.size() > RecentImages)
  {
    this->RecentUsage.pop_front();
  }
  return next;
}

// Only the first image waits for all the memory that there is to be: nothing is shown before, and
// the second is to be drawn at full speed. Later, memory comes step by step; a copy costs all that
// the cache has, and is to be the last for long.
std::int64_t CachePolicy::Towards(
  std::int64_t wanted, std::int64_t slots, std::int64_t maximumSlots) const
{
  const bool byStep = this->InPlace && !this->IsFirstImage();
  const std::int64_t next = byStep ? std::min(wanted, slots + LargestStep) : wanted;
  return std::max(slots, std::min(next, maximumSlots));
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
