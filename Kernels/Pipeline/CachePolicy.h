// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Decides how many slots the cache of decoded blocks has, from what the passes and the last images
// needed. GPUs take long to make memory: the first image of a volume gets enough for those that
// follow, which then seldom need more, and get it bit by bit. It shrinks seldom: a smaller cache is
// a new one, and empty.
#ifndef CachePolicy_h
#define CachePolicy_h

#include "Shaders/BufferTable.h"
#include "Shaders/Glsl.h"

#include <cstdint>
#include <deque>

class CachePolicy
{
public:
  /// A first cache is small, beside the most that memory allows: the first image grows it.
  static std::int64_t SlotsAtFirst(std::int64_t pixels, std::int64_t maximumSlots);

  /// A cache grows when it denies a pass blocks because it is too small for the image. Where it is
  /// not, eviction helps: then only several denials in a row make it grow. Returns `slots` where it
  /// stays as it is.
  std::int64_t SlotsAfterPass(
    const glsl::PassRecord& pass, std::int64_t slots, std::int64_t maximumSlots);

  /// A cache of which the last image used nearly all grows. One that the last images left mostly
  /// unused shrinks, but not as far that it would soon grow again, and only after a pause of so
  /// many milliseconds: not while a user turns the volume.
  std::int64_t SlotsForNewImage(
    std::int64_t slots, std::int64_t maximumSlots, double idleMilliseconds);

  /// Records how many slots a complete image used. After the first one the cache gets as many as
  /// two such images use.
  std::int64_t SlotsAfterImage(
    std::int64_t touchedSlots, std::int64_t slots, std::int64_t maximumSlots);
  /// Records that the cache has grown.
  void RecordGrowth();
  /// Forgets all that was recorded of another cache. `inPlace`: memory is added to this one, which
  /// else moves to larger buffers.
  void Reset(bool inPlace);

private:
  bool IsFirstImage() const { return this->RecentUsage.empty(); }
  bool MayStep() const;
  std::int64_t Towards(std::int64_t wanted, std::int64_t slots, std::int64_t maximumSlots) const;

  bool InPlace = false;
  int ConsecutiveDenials = 0;           ///< passes in a row that were denied blocks
  int StepsOfImage = 0;                 ///< by which the cache has grown
  std::deque<std::int64_t> RecentUsage; ///< slots that the last images used, newest last
};

#endif
