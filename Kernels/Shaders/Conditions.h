// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// When a scene needs a buffer or a stage: the predicate that the code asks, beside the words that
// the documentation shows.
#ifndef Conditions_h
#define Conditions_h

#include "Shaders/SceneNeeds.h"

struct Condition
{
  const char* Words;
  bool (*Holds)(const SceneNeeds&);
};

namespace Conditions
{
using E = SceneNeeds;
constexpr Condition Always = { "always", [](const E&) { return true; } };
constexpr Condition Cached = { "cache", [](const E& e) { return e.Cached; } };
constexpr Condition Evicting = { "cache smaller than the volume",
  [](const E& e) { return e.Cached && e.Slots < e.Blocks; } };
constexpr Condition Decoded = { "no cache", [](const E& e) { return !e.Cached; } };
constexpr Condition UnknownRanges = { "ranges of blocks to be found",
  [](const E& e) { return !e.StoredRanges; } };
constexpr Condition DecodedAtFirst = { "no cache, or ranges of blocks to be found",
  [](const E& e) { return !e.Cached || !e.StoredRanges; } };
constexpr Condition Colored = { "colours", [](const E& e) { return e.Colored; } };
constexpr Condition CachedColors = { "cache and colours",
  [](const E& e) { return e.Cached && e.Colored; } };
constexpr Condition DecodedColors = { "no cache, and colours",
  [](const E& e) { return !e.Cached && e.Colored; } };
constexpr Condition Hidden = { "hidden cells", [](const E& e) { return e.HiddenCells; } };
constexpr Condition HiddenColors = { "hidden colours", [](const E& e) { return e.HiddenColors; } };
constexpr Condition Translucent = { "translucent", [](const E& e) { return e.Translucent; } };
constexpr Condition StoredNormals = { "lit and opaque",
  [](const E& e) { return e.Lit && !e.Translucent; } };
constexpr Condition FinishedHits = { "lit, translucent or colours",
  [](const E& e) { return e.Lit || e.Translucent || e.Colored; } };
constexpr Condition SeveralPasses = { "cache or translucent",
  [](const E& e) { return !e.IsSinglePass(); } };
constexpr Condition Straggling = { "cache or translucent, levels of detail not conservative",
  [](const E& e) { return !e.IsSinglePass() && !e.Conservative; } };
constexpr Condition Detailed = { "detailed statistics", [](const E& e) { return e.Detailed; } };
}

#endif
