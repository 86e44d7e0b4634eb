// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Decides how many slots the cache of decoded blocks has, from what the passes and the last images
// needed. GPUs take long to make memory, and a new cache is empty: it is resized seldom and by
// much.
#ifndef CachePolicy_h
#define CachePolicy_h

#include "Shaders/BufferTable.h"
#include "Shaders/Glsl.h"

#include <cstdint>
#include <deque>

class CachePolicy
{
public:
  /// A first cache is small, beside the most that memory allows.
  static std::int64_t SlotsAtFirst(std::int64_t pixels, std::int64_t maximumSlots);

  /// A cache with fewer slots than pixels grows as soon as a pass needs more. A larger one only
  /// doubles, and only after several passes in a row were denied blocks: up to then eviction helps,
  /// and another pass costs less than memory. Returns `slots` where it stays as it is.
  std::int64_t SlotsAfterPass(const glsl::PassRecord& pass, std::int64_t slots, std::int64_t pixels,
    std::int64_t maximumSlots);

  /// A cache that the last images left mostly unused shrinks, but not as far that it would soon
  /// grow again.
  std::int64_t SlotsForNewImage(std::int64_t slots) const;

  /// Records how many slots a complete image used.
  void RecordImage(std::int64_t touchedSlots);
  /// Forgets all that was recorded of another cache.
  void Reset();

private:
  int ConsecutiveDenials = 0;           ///< passes in a row that were denied blocks
  std::deque<std::int64_t> RecentUsage; ///< slots that the last images used, newest last
};

#endif
