// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid.h"

#include "Codec/BlockStream.h"

#include "vtkCompressedVolume.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace
{
using Three = std::array<int, 3>;
using Volumes = std::vector<vtkSmartPointer<vtkCompressedVolume>>;

constexpr int BlockBits = 512;
const double Cubic[3] = { 1.0, 1.0, 1.0 };

//------------------------------------------------------------------------------
// Makes waves.
std::vector<float> Waves(const Three& dims)
{
  std::vector<float> samples;
  for (int z = 0; z < dims[2]; ++z)
  {
    for (int y = 0; y < dims[1]; ++y)
    {
      for (int x = 0; x < dims[0]; ++x)
      {
        samples.push_back(std::sin(0.4f * x) + std::cos(0.3f * y + 0.1f * x) * std::sin(0.25f * z));
      }
    }
  }
  return samples;
}

//------------------------------------------------------------------------------
// Makes the levels of samples that come so many slices at a time; of which NaN are hidden.
class Maker
{
public:
  Maker(const Three& dims, int slices, int threads)
    : Dims(dims)
    , Slices(slices)
    , Made(dims.data(), threads)
  {
    this->Made.Hidden.HideNonFinite = true;
  }

  Volumes Make(const std::vector<float>& samples, int levels = 11)
  {
    EXPECT_TRUE(this->Made.Start(Cubic, levels, BlockBits).IsOk());
    const int size = this->Dims[0] * this->Dims[1];
    for (int z = 0; z < this->Dims[2]; z += this->Slices)
    {
      const int last = std::min(z + this->Slices, this->Dims[2]);
      vtkNew<vtkFloatArray> array;
      array->SetNumberOfValues((last - z) * size);
      std::copy(&samples[z * size], &samples[0] + last * size, array->GetPointer(0));
      EXPECT_TRUE(this->Made.AddSlices(array, 0, [](double) { return true; }));
    }
    return this->Made.Finish();
  }

  Pyramid& Get() { return this->Made; }

private:
  Three Dims;
  int Slices;
  Pyramid Made;
};

//------------------------------------------------------------------------------
std::vector<float> Decode(vtkCompressedVolume* volume)
{
  const int* const dims = volume->GetDimensions();
  std::vector<float> samples(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]);
  BlockStream blocks(dims, volume->GetBlockBits(), volume->GetStream()->GetPointer(0), 1);
  EXPECT_TRUE(blocks.Decode(samples.data(), [](double) { return true; }));
  return samples;
}

//------------------------------------------------------------------------------
void ExpectSame(const Volumes& one, const Volumes& other)
{
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i)
  {
    vtkUnsignedCharArray* const stream = one[i]->GetStream();
    ASSERT_EQ(stream->GetNumberOfValues(), other[i]->GetStream()->GetNumberOfValues());
    EXPECT_TRUE(std::equal(stream->GetPointer(0),
      stream->GetPointer(0) + stream->GetNumberOfValues(), other[i]->GetStream()->GetPointer(0)))
      << "level " << i + 1;
    EXPECT_TRUE(one[i]->GetHiddenSamples() == other[i]->GetHiddenSamples());
    EXPECT_TRUE(one[i]->GetHiddenCells() == other[i]->GetHiddenCells());
    EXPECT_EQ(one[i]->GetLargestError(), other[i]->GetLargestError());
    EXPECT_EQ(one[i]->GetMeanError(), other[i]->GetMeanError());
    EXPECT_EQ(one[i]->GetLargestDistance(), other[i]->GetLargestDistance());
    EXPECT_EQ(one[i]->GetRange()[0], other[i]->GetRange()[0]);
    EXPECT_EQ(one[i]->GetRange()[1], other[i]->GetRange()[1]);
  }
}

//------------------------------------------------------------------------------
TEST(Pyramid, DependsOnNeitherSlabsNorThreads)
{
  const Three dims = { 70, 131, 66 };
  for (const bool hides : { false, true })
  {
    std::vector<float> samples = Waves(dims);
    for (std::size_t i = 0; hides && i < samples.size(); ++i)
    {
      const bool isHidden = i % 70 < 20 || i % 977 == 0; // a box, and single samples
      samples[i] = isHidden ? std::numeric_limits<float>::quiet_NaN() : samples[i];
    }
    const Volumes expected = Maker(dims, 1000, 1).Make(samples);
    ASSERT_EQ(expected.size(), 2u);
    EXPECT_EQ(expected[0]->GetHiddenSamples().IsEmpty(), !hides);
    for (const int threads : { 1, 3 })
    {
      for (const int slices : { 4, 20, 1000 })
      {
        ExpectSame(Maker(dims, slices, threads).Make(samples), expected);
      }
    }
  }
}

//------------------------------------------------------------------------------
TEST(Pyramid, KeepsFewSlices)
{
  const Three dims = { 9, 5, 600 };
  Maker maker(dims, 4, 2);
  EXPECT_EQ(maker.Make(Waves(dims)).size(), 4u);
  EXPECT_LE(maker.Get().GetMostSlicesKept(), 7);
}

//------------------------------------------------------------------------------
// Border planes lie on border planes, and a sample beyond repeats the last.
TEST(Pyramid, KeepsBorders)
{
  const Three dims = { 66, 65, 4 };
  const std::vector<float> fine = Waves(dims);
  const Volumes levels = Maker(dims, 4, 1).Make(fine);
  ASSERT_EQ(levels.size(), 1u);
  vtkCompressedVolume* const level = levels[0];
  const int* const size = level->GetDimensions();
  ASSERT_EQ((Three{ size[0], size[1], size[2] }), (Three{ 34, 33, 3 }));
  const std::vector<float> coarse = Decode(level);
  const double error = 1.001 * level->GetLargestError();
  for (const int z : { 0, 2 })
  {
    for (const int y : { 0, 32 })
    {
      for (const int x : { 0, 33 })
      {
        const int from[3] = { std::min(2 * x, 65), 2 * y, std::min(2 * z, 3) };
        EXPECT_NEAR(
          coarse[x + 34 * (y + 33 * z)], fine[from[0] + 66 * (from[1] + 65 * from[2])], error);
      }
    }
  }
}

//------------------------------------------------------------------------------
// The bound holds of every fine sample, and is that of the errors and not of anything.
TEST(Pyramid, BoundsDistances)
{
  const Three dims = { 130, 5, 6 };
  const std::vector<float> fine = Waves(dims);
  const Volumes levels = Maker(dims, 4, 1).Make(fine);
  ASSERT_EQ(levels.size(), 2u);
  for (vtkCompressedVolume* level : levels)
  {
    const std::vector<float> coarse = Decode(level);
    const int* const size = level->GetDimensions();
    const int* const steps = level->GetSteps();
    double most = 0.0;
    for (int z = 0; z < dims[2]; ++z)
    {
      for (int y = 0; y < dims[1]; ++y)
      {
        for (int x = 0; x < dims[0]; ++x)
        {
          double value = 0.0;
          for (int corner = 0; corner < 8; ++corner)
          {
            const int at[3] = { x, y, z };
            double weight = 1.0;
            int place[3];
            for (int axis = 0; axis < 3; ++axis)
            {
              const int side = corner >> axis & 1;
              const double part = static_cast<double>(at[axis] % steps[axis]) / steps[axis];
              place[axis] = std::min(at[axis] / steps[axis] + side, size[axis] - 1);
              weight *= side ? part : 1.0 - part;
            }
            value += weight * coarse[place[0] + size[0] * (place[1] + size[1] * place[2])];
          }
          most = std::max(most, std::abs(value - fine[x + dims[0] * (y + dims[1] * z)]));
        }
      }
    }
    EXPECT_LE(most, level->GetLargestDistance() + 1e-6);
    EXPECT_GE(most, 0.3 * level->GetLargestDistance());
  }
}

//------------------------------------------------------------------------------
// A cell is hidden where more than half of those in it are; samples where none is near.
TEST(Pyramid, HidesCellsByMost)
{
  const Three dims = { 70, 8, 8 };
  std::vector<float> samples(70 * 8 * 8, 1.0f);
  for (int i = 0; i < 70 * 8 * 8; ++i)
  {
    if (i % 70 < 13) // of the cells up to x = 12
    {
      samples[i] = std::numeric_limits<float>::infinity();
    }
  }
  const Volumes levels = Maker(dims, 8, 1).Make(samples, 1);
  ASSERT_EQ(levels.size(), 1u);
  int blocks[3];
  levels[0]->GetBlocks(blocks);
  for (int x = 0; x < 35; ++x)
  {
    const int at[3] = { x, 2, 2 };
    EXPECT_EQ(levels[0]->GetHiddenSamples().Hides(at, blocks), x < 6) << x; // 11, 12 and 13
    // coarse cell 6 has the fine cells 12, hidden, and 13
    EXPECT_EQ(levels[0]->GetHiddenCells().Hides(at, blocks), x < 6) << x;
  }
  for (const float value : Decode(levels[0]))
  {
    EXPECT_TRUE(value == 0.0f || value == 1.0f) << value;
  }
}

//------------------------------------------------------------------------------
// Hidden cells that no sample hides.
TEST(Pyramid, TakesHiddenCells)
{
  const Three dims = { 66, 6, 6 };
  Maker maker(dims, 4, 1);
  for (int block = 0; block < 17 * 2 * 2; ++block)
  {
    maker.Get().HiddenCells.Append(block % 17 == 2 ? vtkBlockMask::AllBits : 0);
  }
  const Volumes levels = maker.Make(Waves(dims));
  ASSERT_EQ(levels.size(), 1u);
  int blocks[3];
  levels[0]->GetBlocks(blocks);
  EXPECT_TRUE(levels[0]->GetHiddenSamples().IsEmpty());
  for (int x = 0; x < 33; ++x)
  {
    const int at[3] = { x, 1, 2 };
    EXPECT_EQ(levels[0]->GetHiddenCells().Hides(at, blocks), x == 4 || x == 5) << x;
  }
}
}
