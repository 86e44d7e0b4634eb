// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/MacrocellBox.h"

#include <algorithm>
#include <array>

namespace
{
using Extent = std::array<std::int64_t, 3>;

// The blocks of so many macrocells on each axis, and a layer of neighbours behind where there is
// one.
glsl::BlockBox BlocksOf(const VolumeSize& size, const Extent& first, const Extent& count)
{
  glsl::BlockBox box = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t begin = glsl::MACROCELL_SIDE * first[axis];
    const std::int64_t end = begin + glsl::MACROCELL_SIDE * count[axis] + 1;
    box.First[axis] = static_cast<std::int32_t>(begin);
    box.Size[axis] = static_cast<std::int32_t>(std::min(end, size.Blocks[axis]) - begin);
  }
  return box;
}

std::int64_t NumberOf(const glsl::BlockBox& box)
{
  return std::int64_t(box.Size[0]) * box.Size[1] * box.Size[2];
}

Extent CoordinatesOf(const VolumeSize& size, std::int64_t macrocell)
{
  const Extent& all = size.Macrocells;
  return { macrocell % all[0], macrocell / all[0] % all[1], macrocell / (all[0] * all[1]) };
}
}

std::int64_t MacrocellBox::GetNumberOfBlocks() const
{
  return NumberOf(this->Blocks);
}

MacrocellBox WholeBox(const VolumeSize& size)
{
  return { { 0, size.GetNumberOfMacrocells() }, BlocksOf(size, { 0, 0, 0 }, size.Macrocells) };
}

MacrocellBox FirstBox(const VolumeSize& size, const VolumeSlice& macrocells, std::int64_t most)
{
  const Extent first = CoordinatesOf(size, macrocells.First);
  Extent count = { 1, 1, 1 };
  std::int64_t items = 1; // of one more on the axis: all that it has on those before
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t end =
      std::min(size.Macrocells[axis] - first[axis], macrocells.GetItems() / items);
    Extent next = count;
    for (next[axis] = 2; next[axis] <= end && NumberOf(BlocksOf(size, first, next)) <= most;
         ++next[axis])
    {
      count[axis] = next[axis];
    }
    if (count[axis] < size.Macrocells[axis])
    {
      break; // the next on a further axis would not follow
    }
    items *= count[axis];
  }
  const std::int64_t taken = count[0] * count[1] * count[2];
  return { { macrocells.First, macrocells.First + taken }, BlocksOf(size, first, count) };
}

std::int64_t MacrocellsAtATime(
  const VolumeSize& size, const VolumeSlice& macrocells, std::int64_t most)
{
  const std::int64_t row = size.Macrocells[0];
  const std::int64_t layer = row * size.Macrocells[1];
  const std::int64_t end = macrocells.First + most;
  if (end >= macrocells.End)
  {
    return macrocells.GetItems();
  }
  for (const std::int64_t multiple : { layer, row })
  {
    const std::int64_t last = end / multiple * multiple;
    if (last > macrocells.First)
    {
      return last - macrocells.First;
    }
  }
  return most;
}
