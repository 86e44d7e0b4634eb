// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BitCopy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace
{
using Words = std::vector<vtkTypeUInt64>;

Words RandomWords(std::size_t count, unsigned int seed)
{
  std::mt19937_64 generator(seed);
  Words words(count);
  for (vtkTypeUInt64& word : words)
  {
    word = generator();
  }
  return words;
}

bool GetBit(const Words& words, vtkTypeInt64 bit)
{
  return (words[bit / 64] >> bit % 64 & 1) != 0;
}

// What CopyBits() must do, bit by bit.
Words Expected(
  const Words& from, vtkTypeInt64 fromBit, Words to, vtkTypeInt64 toBit, vtkTypeInt64 count)
{
  const vtkTypeInt64 end = count > 0 ? (toBit + count + 63) / 64 * 64 : toBit;
  for (vtkTypeInt64 i = 0; toBit + i < end; ++i)
  {
    const vtkTypeUInt64 mask = vtkTypeUInt64(1) << (toBit + i) % 64;
    vtkTypeUInt64& word = to[(toBit + i) / 64];
    word = i < count && GetBit(from, fromBit + i) ? word | mask : word & ~mask;
  }
  return to;
}
}

TEST(BitCopy, EqualsCopyBitByBit)
{
  const Words from = RandomWords(8, 1), to = RandomWords(8, 2);
  for (const vtkTypeInt64 fromBit : { 0, 1, 31, 63, 64, 100 })
  {
    for (const vtkTypeInt64 toBit : { 0, 1, 33, 63, 64, 127 })
    {
      for (const vtkTypeInt64 count : { 0, 1, 2, 31, 63, 64, 65, 128, 200, 256, 320 })
      {
        Words copied = to;
        CopyBits(from.data(), fromBit, copied.data(), toBit, count);
        EXPECT_EQ(copied, Expected(from, fromBit, to, toBit, count))
          << count << " bits from " << fromBit << " to " << toBit;
      }
    }
  }
}

TEST(BitCopy, TakesStreamsAtAnyAddress)
{
  const Words from = RandomWords(4, 3);
  std::vector<unsigned char> moved(33);
  std::copy_n(reinterpret_cast<const unsigned char*>(from.data()), 32, moved.begin() + 1);
  Words copied(4);
  CopyBits(moved.data() + 1, 5, copied.data(), 0, 200);
  EXPECT_EQ(copied, Expected(from, 5, Words(4), 0, 200));
}

// The last word of a stream may be the last of its memory: the copy must not read beyond it.
TEST(BitCopy, ReadsNoWordWithoutBitsToCopy)
{
  const Words from = RandomWords(1, 4);
  Words copied(2);
  CopyBits(from.data(), 3, copied.data(), 64, 61);
  EXPECT_EQ(copied, (Words{ 0, from[0] >> 3 }));
}
