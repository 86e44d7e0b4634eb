// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/MacrocellBox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace
{
VolumeSize SizeOf(int x, int y, int z)
{
  const int samples[3] = { x, y, z };
  return VolumeSize(samples);
}

std::vector<MacrocellBox> CutAll(const VolumeSize& size, const VolumeSlice& all, std::int64_t most)
{
  std::vector<MacrocellBox> boxes;
  for (VolumeSlice rest = all; rest.First < rest.End; rest.First = boxes.back().Macrocells.End)
  {
    boxes.push_back(FirstBox(size, rest, most));
  }
  return boxes;
}

VolumeSlice AllOf(const VolumeSize& size)
{
  return { 0, size.GetNumberOfMacrocells() };
}

// Does a box have all of a macrocell's blocks, and those behind that there are?
bool HasBlocksOf(const MacrocellBox& box, const VolumeSize& size, std::int64_t macrocell)
{
  const std::int64_t at[3] = { macrocell % size.Macrocells[0],
    macrocell / size.Macrocells[0] % size.Macrocells[1],
    macrocell / (size.Macrocells[0] * size.Macrocells[1]) };
  bool has = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t end = std::min(4 * at[axis] + 5, size.Blocks[axis]);
    has = has && box.Blocks.First[axis] <= 4 * at[axis] &&
      box.Blocks.First[axis] + box.Blocks.Size[axis] >= end;
  }
  return has;
}
}

TEST(MacrocellBox, TakesAVolumeThatFitsWhole)
{
  const VolumeSize size = SizeOf(140, 132, 136);
  const MacrocellBox box = FirstBox(size, AllOf(size), size.GetNumberOfBlocks());
  EXPECT_EQ(box.Macrocells.GetItems(), 9 * 9 * 9);
  EXPECT_EQ(box.GetNumberOfBlocks(), 35 * 33 * 34);
  EXPECT_EQ(WholeBox(size).GetNumberOfBlocks(), 35 * 33 * 34);
}

TEST(MacrocellBox, IsAPartOfARowOrRowsOrLayers)
{
  const VolumeSize size = SizeOf(256, 256, 256); // 16^3 macrocells, 64^3 blocks
  const auto items = [&](const VolumeSlice& of, std::int64_t most)
  { return FirstBox(size, of, most).Macrocells.GetItems(); };
  EXPECT_EQ(items({ 0, 4096 }, 124), 1); // whatever fits
  EXPECT_EQ(items({ 0, 4096 }, 13 * 25), 3);
  EXPECT_EQ(items({ 0, 4096 }, 64 * 25), 16);
  EXPECT_EQ(items({ 0, 4096 }, 64 * 9 * 5), 2 * 16);
  EXPECT_EQ(items({ 0, 4096 }, 64 * 64 * 5), 256);
  EXPECT_EQ(items({ 0, 4096 }, 64 * 64 * 9), 512);
  EXPECT_EQ(items({ 5, 4096 }, 1 << 20), 11); // to the end of the row
  EXPECT_EQ(items({ 16, 4096 }, 1 << 20), 240);
  EXPECT_EQ(items({ 0, 47 }, 1 << 20), 32);
  EXPECT_EQ(items({ 32, 47 }, 1 << 20), 15);
}

// Whatever the volume, all macrocells come in their order, and each has its blocks.
TEST(MacrocellBox, CoversAllMacrocells)
{
  for (const VolumeSize& size : { SizeOf(2, 2, 2), SizeOf(17, 16, 1), SizeOf(65, 33, 49),
         SizeOf(3, 200, 64), SizeOf(256, 1, 256) })
  {
    for (const std::int64_t most : { 125, 130, 700, 2048, 1 << 20 })
    {
      std::int64_t next = 0;
      for (const MacrocellBox& box : CutAll(size, AllOf(size), most))
      {
        EXPECT_EQ(box.Macrocells.First, next);
        EXPECT_LE(box.GetNumberOfBlocks(), most);
        for (std::int64_t i = box.Macrocells.First; i < box.Macrocells.End; ++i)
        {
          EXPECT_TRUE(HasBlocksOf(box, size, i)) << i;
        }
        next = box.Macrocells.End;
      }
      EXPECT_EQ(next, size.GetNumberOfMacrocells());
    }
  }
}

TEST(MacrocellBox, SlicesEndWithRowsAndLayers)
{
  const VolumeSize size = SizeOf(256, 256, 256);
  EXPECT_EQ(MacrocellsAtATime(size, { 0, 4096 }, 10), 10);
  EXPECT_EQ(MacrocellsAtATime(size, { 0, 4096 }, 40), 32);
  EXPECT_EQ(MacrocellsAtATime(size, { 10, 4096 }, 10), 6);
  EXPECT_EQ(MacrocellsAtATime(size, { 32, 4096 }, 300), 224);
  EXPECT_EQ(MacrocellsAtATime(size, { 256, 4096 }, 1000), 768);
  EXPECT_EQ(MacrocellsAtATime(size, { 4000, 4096 }, 96), 96);
  EXPECT_EQ(MacrocellsAtATime(size, { 4090, 4096 }, 1000), 6);
}
