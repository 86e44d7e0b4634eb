// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The ranges of values of a volume's blocks, where they come with the volume: they need not be
// found on the GPU.
#ifndef StoredRanges_h
#define StoredRanges_h

#include "Shaders/SceneNeeds.h"

#include <cstdint>
#include <functional>
#include <vector>

/// Gets the range of a macrocell and those of its blocks, as glsl::Macrocell has them: two words,
/// and BLOCKS_PER_MACROCELL / 2.
using RangeReader =
  std::function<void(std::int64_t macrocell, std::uint32_t* range, std::uint32_t* blockRanges)>;

/// Words of a macrocell in its buffer.
int WordsOfMacrocell(const SceneNeeds& needs);

/// Makes the words of so many macrocells. What they know of a cache is 0.
std::vector<std::uint32_t> DescribeMacrocells(
  const RangeReader& ranges, std::int64_t first, std::int64_t count, const SceneNeeds& needs);

#endif
