// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The ranges of blocks against a definition of them, sample by sample; the steps they are told in;
// their records, whole and damaged.
#include "Codec/BlockRangeFinder.h"
#include "Codec/BlockStream.h"
#include "Codec/RangeSteps.h"
#include "Codec/SampleEncoder.h"
#include "Codec/SampleSummary.h"

#include "vtkBlockMask.h"
#include "vtkBlockRanges.h"
#include "vtkCompressedVolume.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkTypeUInt32Array.h"
#include "vtkTypeUInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace
{
using RangeSteps::KeyOf;
using RangeSteps::KeyRange;

constexpr float Infinity = std::numeric_limits<float>::infinity();

bool Unbounded(double)
{
  return true;
}

// A volume that is encoded by parts of some slabs.
struct Encoded
{
  Encoded(std::array<int, 3> dims, double rate, const std::vector<float>& samples,
    const std::vector<unsigned char>& flags = {}, int slabsAtATime = 1000)
    : Dimensions(dims)
    , BlockBits(vtkCompressedVolume::BlockBitsForRate(rate))
    , Words(vtkCompressedVolume::StreamBytesFor(dims.data(), this->BlockBits) / 8)
    , Blocks(dims.data(), this->BlockBits, this->Words.data(), 2)
  {
    EXPECT_TRUE(this->Encoder.Allocate(this->Blocks).IsOk());
    const vtkTypeInt64 slice = static_cast<vtkTypeInt64>(dims[0]) * dims[1];
    for (vtkTypeInt64 slab = 0; slab < this->Blocks.GetNumberOfSlabs(); slab += slabsAtATime)
    {
      const vtkTypeInt64 last = std::min(slab + slabsAtATime, this->Blocks.GetNumberOfSlabs());
      const vtkTypeInt64 begin = 4 * slab * slice;
      const vtkTypeInt64 end = std::min<vtkTypeInt64>(4 * last, dims[2]) * slice;
      vtkNew<vtkFloatArray> array;
      array->SetNumberOfValues(end - begin);
      std::copy(samples.begin() + begin, samples.begin() + end, array->GetPointer(0));
      this->Encoder.Hidden.Flags = flags.empty() ? nullptr : flags.data() + begin;
      this->Encoder.Hidden.HidingFlags = 1;
      EXPECT_TRUE(this->Encoder.EncodeSlabs(this->Blocks, slab, last, array, 0, Unbounded));
    }
    const int blocks[3] = { static_cast<int>(this->Blocks.GetBlocks()[0]),
      static_cast<int>(this->Blocks.GetBlocks()[1]),
      static_cast<int>(this->Blocks.GetBlocks()[2]) };
    this->Hidden = this->Encoder.GetMask().ToCells(blocks, vtkBlockMask());
  }

  std::vector<float> Decode() const
  {
    std::vector<float> samples(
      static_cast<std::size_t>(this->Dimensions[0]) * this->Dimensions[1] * this->Dimensions[2]);
    this->Blocks.Decode(samples.data(), Unbounded);
    return samples;
  }

  std::array<int, 3> Dimensions;
  int BlockBits;
  std::vector<vtkTypeUInt64> Words;
  BlockStream Blocks;
  SampleEncoder Encoder;
  vtkBlockMask Hidden;
};

// The range of a block's visible cells, from corner to corner.
KeyRange RangeByDefinition(
  const Encoded& volume, const std::vector<float>& decoded, const vtkTypeInt64 block[3])
{
  const auto& dims = volume.Dimensions;
  const vtkTypeInt64* const blocks = volume.Blocks.GetBlocks();
  KeyRange range;
  if (block[0] >= blocks[0] || block[1] >= blocks[1] || block[2] >= blocks[2])
  {
    return range;
  }
  const vtkTypeUInt64 hidden =
    volume.Hidden.Get(block[0] + blocks[0] * (block[1] + blocks[1] * block[2]));
  for (int corner = 0; corner < 512; ++corner)
  {
    const int cell = corner / 8;
    const vtkTypeInt64 low[3] = { 4 * block[0] + cell % 4, 4 * block[1] + cell / 4 % 4,
      4 * block[2] + cell / 16 };
    if (low[0] + 1 < dims[0] && low[1] + 1 < dims[1] && low[2] + 1 < dims[2] &&
      !(hidden >> cell & 1))
    {
      range.Add(KeyOf(decoded[static_cast<std::size_t>(low[0] + (corner & 1) +
        dims[0] * (low[1] + (corner >> 1 & 1) + dims[1] * (low[2] + (corner >> 2 & 1))))]));
    }
  }
  return range;
}

void CheckByDefinition(const Encoded& volume, const vtkBlockRanges& ranges)
{
  const std::vector<float> decoded = volume.Decode();
  const RangeLayout layout(volume.Dimensions.data());
  ASSERT_EQ(ranges.GetNumberOfMacrocells(), layout.GetNumberOfMacrocells());
  for (vtkTypeInt64 i = 0; i < layout.GetNumberOfMacrocells(); ++i)
  {
    const vtkTypeInt64* const count = layout.GetMacrocells();
    const vtkTypeInt64 place[3] = { i % count[0], i / count[0] % count[1],
      i / (count[0] * count[1]) };
    KeyRange expected[64], whole;
    RangeLayout::ForEachBlock(place,
      [&](int n, const vtkTypeInt64 block[3])
      {
        expected[n] = RangeByDefinition(volume, decoded, block);
        whole.Add(expected[n]);
      });
    vtkTypeUInt32 range[2], steps[32];
    ranges.GetMacrocell(i, range, steps);
    ASSERT_EQ(range[0], RangeRecords::BitsOf(whole.Low)) << i;
    ASSERT_EQ(range[1], RangeRecords::BitsOf(whole.High)) << i;
    for (int n = 0; n < 64; ++n)
    {
      ASSERT_EQ(steps[n / 2] >> 16 * (n % 2) & 0xFFFF, RangeSteps::Find(expected[n], whole))
        << i << " " << n;
    }
  }
}

std::vector<float> Samples(std::array<int, 3> dims, unsigned seed, float scale = 1.0f)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> values(-scale, scale);
  std::vector<float> samples(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]);
  std::generate(samples.begin(), samples.end(), [&]() { return values(random); });
  return samples;
}

vtkBlockRanges RangesOf(Encoded& volume)
{
  return volume.Encoder.GetRanges().Finish(volume.Blocks, volume.Hidden);
}
}

TEST(RangeSteps, AreTheNarrowestThatHoldTheRange)
{
  std::mt19937 random(7);
  std::uniform_int_distribution<std::uint32_t> bits;
  std::uniform_int_distribution<int> exponents(-120, 120);
  for (int i = 0; i < 20000; ++i)
  {
    float values[4];
    const float scale = std::ldexp(1.0f, exponents(random));
    for (float& value : values)
    {
      value = scale * (static_cast<float>(bits(random) >> 8) / (1 << 23) - (i % 3));
    }
    std::sort(values, values + 4);
    const KeyRange whole = { KeyOf(values[0]), KeyOf(values[3]) };
    const KeyRange block = { KeyOf(values[1]), KeyOf(values[2]) };
    const vtkTypeUInt16 steps = RangeSteps::Find(block, whole);
    const int low = steps & 255, high = steps >> 8;
    ASSERT_LE(RangeSteps::LowOf(values[0], values[3], low), values[1]);
    ASSERT_GE(RangeSteps::HighOf(values[0], values[3], high), values[2]);
    if (steps != RangeSteps::AllSteps)
    {
      ASSERT_TRUE(low == 255 || RangeSteps::LowOf(values[0], values[3], low + 1) > values[1]);
      ASSERT_TRUE(high == 0 || RangeSteps::HighOf(values[0], values[3], high - 1) < values[2]);
    }
  }
}

TEST(RangeSteps, OfWhatHasNoSteps)
{
  const KeyRange none;
  const float tiny = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(RangeSteps::Find(none, none), RangeSteps::NoSteps);
  EXPECT_EQ(RangeSteps::Find(none, { KeyOf(0.0f), KeyOf(1.0f) }), RangeSteps::NoSteps);
  for (const auto& [low, high] :
    { std::pair(1.0f, 1.0f), std::pair(-tiny, tiny), std::pair(-Infinity, 1.0f),
      std::pair(-Infinity, Infinity), std::pair(-0.0f, 0.0f), std::pair(1e-31f, 2e-31f) })
  {
    const KeyRange range = { KeyOf(low), KeyOf(high) };
    EXPECT_EQ(RangeSteps::Find(range, range), RangeSteps::AllSteps) << low << " " << high;
  }
  const float most = std::numeric_limits<float>::max();
  const KeyRange whole = { KeyOf(-most), KeyOf(most) }, block = { KeyOf(0.0f), KeyOf(0.0f) };
  EXPECT_EQ(RangeSteps::Find(block, whole), 128 | 128 << 8);
}

TEST(RangeSteps, KeysAreInTheOrderOfFloats)
{
  const float tiny = std::numeric_limits<float>::denorm_min();
  const float ordered[] = { -Infinity, -3e38f, -1.0f, -tiny, -0.0f, 0.0f, tiny, 1.0f, Infinity };
  for (std::size_t i = 1; i < std::size(ordered); ++i)
  {
    EXPECT_LT(KeyOf(ordered[i - 1]), KeyOf(ordered[i]));
    EXPECT_EQ(RangeSteps::ValueOf(KeyOf(ordered[i])), ordered[i]);
  }
}

TEST(BlockRanges, AreThoseOfTheDecodedSamples)
{
  const std::array<int, 3> sizes[] = { { 2, 2, 2 }, { 4, 4, 4 }, { 5, 4, 9 }, { 16, 17, 18 },
    { 33, 15, 30 }, { 65, 66, 68 }, { 130, 3, 7 } };
  for (const auto& dims : sizes)
  {
    for (const double rate : { 0.5, 4.0, 7.3 })
    {
      for (const int slabs : { 1, 3, 1000 })
      {
        Encoded volume(dims, rate, Samples(dims, 1), {}, slabs);
        CheckByDefinition(volume, RangesOf(volume));
      }
    }
  }
}

TEST(BlockRanges, LeaveHiddenCellsOut)
{
  const std::array<int, 3> dims = { 70, 41, 37 };
  std::mt19937 random(3);
  for (const int one : { 2, 40, 4000 }) // of so many samples
  {
    std::vector<unsigned char> flags(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]);
    std::generate(flags.begin(), flags.end(), [&]() { return random() % one == 0; });
    std::fill(flags.begin(), flags.begin() + flags.size() / 3, 1); // whole macrocells
    std::vector<float> samples = Samples(dims, 2);
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      samples[i] = flags[i] ? 1e6f : samples[i];
    }
    Encoded volume(dims, 6.0, samples, flags, 2);
    CheckByDefinition(volume, RangesOf(volume));
  }
}

TEST(BlockRanges, OfExtremeValues)
{
  const std::array<int, 3> dims = { 21, 22, 23 };
  for (const float scale : { 1e-29f, 1e-40f, 1.7e38f, 0.0f })
  {
    Encoded volume(dims, 8.0, Samples(dims, 4, scale));
    CheckByDefinition(volume, RangesOf(volume));
  }
  Encoded random(dims, 3.0, Samples(dims, 5)); // damaged: any values, infinite ones too
  std::mt19937_64 bits(6);
  std::generate(random.Words.begin(), random.Words.end(), bits);
  BlockRangeFinder finder(random.Blocks);
  ASSERT_TRUE(finder.Allocate().IsOk());
  SampleSummary summary;
  ASSERT_TRUE(finder.AddAll(random.Blocks, summary, Unbounded));
  CheckByDefinition(random, finder.Finish(random.Blocks, vtkBlockMask()));
}

TEST(BlockRanges, AreTheSameFoundLater)
{
  const std::array<int, 3> dims = { 66, 70, 34 };
  Encoded volume(dims, 2.0, Samples(dims, 8));
  BlockRangeFinder finder(volume.Blocks);
  ASSERT_TRUE(finder.Allocate().IsOk());
  SampleSummary summary, expected;
  ASSERT_TRUE(finder.AddAll(volume.Blocks, summary, Unbounded));
  ASSERT_TRUE(volume.Blocks.Summarize(expected, Unbounded));
  EXPECT_EQ(summary.Minimum, expected.Minimum);
  EXPECT_EQ(summary.Maximum, expected.Maximum);
  EXPECT_TRUE(finder.Finish(volume.Blocks, vtkBlockMask()) == RangesOf(volume));
}

TEST(BlockRanges, OfConstantPartsTakeNoRoom)
{
  const std::array<int, 3> dims = { 193, 65, 64 }; // 4 x 2 pages, of which some have no cells
  std::vector<float> samples(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2], 2.5f);
  Encoded constant(dims, 4.0, samples);
  const vtkBlockRanges nothing = RangesOf(constant);
  CheckByDefinition(constant, nothing);
  EXPECT_EQ(nothing.GetNumberOfPages(), 8);
  EXPECT_EQ(nothing.GetNumberOfPagesWithoutRecord(), 8);
  EXPECT_EQ(nothing.GetBytes(), 8 * 16);
  samples[0] = 3.0f; // a macrocell has steps, of those in one page
  Encoded other(dims, 4.0, samples);
  const vtkBlockRanges some = RangesOf(other);
  CheckByDefinition(other, some);
  EXPECT_EQ(some.GetNumberOfPagesWithoutRecord(), 7);
  EXPECT_EQ(some.GetBytes(), 8 * 16 + 8 * (1 + 64 + 16));
}

TEST(BlockRanges, RefuseDamagedArrays)
{
  const std::array<int, 3> dims = { 70, 66, 20 };
  Encoded volume(dims, 4.0, Samples(dims, 9));
  const vtkBlockRanges whole = RangesOf(volume);
  std::mt19937 random(10);
  for (int i = 0; i < 3000; ++i)
  {
    vtkNew<vtkTypeUInt32Array> directory;
    vtkNew<vtkTypeUInt64Array> records;
    directory->DeepCopy(whole.GetDirectory());
    records->DeepCopy(whole.GetRecords());
    const int kind = i % 4;
    if (kind == 0)
    {
      directory->GetPointer(0)[random() % 16] ^= 1U << random() % 32;
    }
    else if (kind == 1)
    {
      records->GetPointer(0)[random() % records->GetNumberOfValues()] ^= 1ULL << random() % 64;
    }
    else if (kind == 2)
    {
      records->SetNumberOfValues(random() % (records->GetNumberOfValues() - 1));
    }
    else
    {
      directory->SetNumberOfValues(random() % 16);
    }
    vtkBlockRanges read;
    const std::string error = read.FromArrays(directory, records, dims.data());
    EXPECT_EQ(error.empty(), !read.IsEmpty());
    EXPECT_TRUE(!error.empty() || kind < 2) << kind;
    for (vtkTypeInt64 m = 0; error.empty() && m < read.GetNumberOfMacrocells(); ++m)
    {
      vtkTypeUInt32 range[2], steps[32];
      read.GetMacrocell(m, range, steps); // within the arrays
    }
    EXPECT_TRUE(kind != 1 || !error.empty() || !read.CheckRecords().empty());
  }
  vtkBlockRanges again;
  EXPECT_EQ(again.FromArrays(whole.GetDirectory(), whole.GetRecords(), dims.data()), "");
  EXPECT_EQ(again.CheckRecords(), "");
  EXPECT_TRUE(again == whole && again.Fit(dims.data()));
  const int others[3] = { 70, 65, 20 };
  EXPECT_FALSE(again.Fit(others));
  EXPECT_NE(again.FromArrays(nullptr, nullptr, dims.data()), "");
}
