// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Store/StoredRanges.h"

#include "Shaders/BufferTable.h"
#include "Shaders/Glsl.h"

#include <cstddef>

namespace
{
constexpr int BlockRangeWords = glsl::BLOCKS_PER_MACROCELL / 2;
}

int WordsOfMacrocell(const SceneNeeds& needs)
{
  SceneNeeds one = needs;
  one.Macrocells = 1;
  const BufferInfo& info = PipelineBuffers()[static_cast<std::size_t>(Buffer::Macrocells)];
  return static_cast<int>(info.Bytes(one) / static_cast<std::int64_t>(sizeof(std::uint32_t)));
}

// The range comes first, those of blocks last: see BufferStructs.glsl.h.
std::vector<std::uint32_t> DescribeMacrocells(
  const RangeReader& ranges, std::int64_t first, std::int64_t count, const SceneNeeds& needs)
{
  const int size = WordsOfMacrocell(needs);
  std::vector<std::uint32_t> words(static_cast<std::size_t>(size * count));
  for (std::int64_t i = 0; i < count; ++i)
  {
    std::uint32_t* const macrocell = words.data() + size * i;
    ranges(first + i, macrocell, macrocell + size - BlockRangeWords);
  }
  return words;
}
