// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HalvingFilter.h"

#include "Codec/LevelShape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace
{
using Flags = std::vector<unsigned char>;

struct Line
{
  std::vector<float> Values;
  Flags Hidden; // empty if none is
};

//------------------------------------------------------------------------------
Line Along(const Line& fine)
{
  const int count = static_cast<int>(fine.Values.size());
  Line coarse;
  coarse.Values.resize(HalvedCount(count));
  coarse.Hidden.resize(fine.Hidden.empty() ? 0 : HalvedCount(count));
  HalvingFilter::FilterAlong(
    { fine.Values.data(), fine.Hidden.empty() ? nullptr : fine.Hidden.data() }, count,
    coarse.Values.data(), coarse.Hidden.empty() ? nullptr : coarse.Hidden.data());
  return coarse;
}

//------------------------------------------------------------------------------
// The same by rows of one sample.
Line Across(const Line& fine)
{
  const int count = static_cast<int>(fine.Values.size());
  Line coarse;
  coarse.Values.resize(HalvedCount(count));
  coarse.Hidden.resize(fine.Hidden.empty() ? 0 : HalvedCount(count));
  for (int at = 0; at < HalvedCount(count); ++at)
  {
    LevelRow rows[HalvingFilter::Taps];
    for (int i = 0; i < HalvingFilter::Taps; ++i)
    {
      const int from = 2 * at + i - HalvingFilter::Reach;
      if (from >= 0 && from < count)
      {
        rows[i] = { &fine.Values[from], fine.Hidden.empty() ? nullptr : &fine.Hidden[from] };
      }
    }
    HalvingFilter::FilterAcross(
      rows, 1, &coarse.Values[at], coarse.Hidden.empty() ? nullptr : &coarse.Hidden[at]);
  }
  return coarse;
}

//------------------------------------------------------------------------------
Line Noise(int count, bool withHidden)
{
  std::mt19937 random(count);
  std::uniform_real_distribution<float> values(-1.0f, 1.0f);
  Line line;
  for (int i = 0; i < count; ++i)
  {
    line.Values.push_back(values(random));
    if (withHidden)
    {
      line.Hidden.push_back(values(random) > 0.3f);
    }
  }
  return line;
}

//------------------------------------------------------------------------------
TEST(HalvingFilter, IsTheSameAlongAndAcross)
{
  for (int count = 3; count < 30; ++count)
  {
    for (const bool withHidden : { false, true })
    {
      const Line fine = Noise(count, withHidden);
      const Line along = Along(fine), across = Across(fine);
      EXPECT_EQ(along.Hidden, across.Hidden) << count;
      for (std::size_t i = 0; i < along.Values.size(); ++i)
      {
        const bool isHidden = withHidden && along.Hidden[i];
        EXPECT_TRUE(isHidden || along.Values[i] == across.Values[i]) << count << " " << i;
      }
    }
  }
}

//------------------------------------------------------------------------------
// A line stays as it is, but for a sample beyond the border, which is as the last one.
TEST(HalvingFilter, KeepsLines)
{
  for (int count = 3; count < 20; ++count)
  {
    Line fine;
    for (int i = 0; i < count; ++i)
    {
      fine.Values.push_back(3.0f * i - 7.0f);
    }
    const Line coarse = Along(fine);
    for (std::size_t i = 0; i < coarse.Values.size(); ++i)
    {
      EXPECT_EQ(coarse.Values[i], fine.Values[std::min<std::size_t>(2 * i, count - 1)]) << count;
    }
  }
}

//------------------------------------------------------------------------------
TEST(HalvingFilter, KeepsParabolas)
{
  Line fine;
  for (int i = 0; i < 33; ++i)
  {
    fine.Values.push_back((i - 16.0f) * (i - 16.0f));
  }
  const Line coarse = Along(fine);
  for (int i = 2; i < 15; ++i)
  {
    EXPECT_FLOAT_EQ(coarse.Values[i], fine.Values[2 * i]) << i;
  }
}

//------------------------------------------------------------------------------
TEST(HalvingFilter, IsItsFormula)
{
  Line fine = Noise(40, false);
  for (int i = 12; i < 25; ++i)
  {
    fine.Values[i] = i < 19 ? 0.0f : 1.0f; // an edge, beside which the filter alone would ring
  }
  const Line coarse = Along(fine);
  int limited = 0;
  for (int i = 2; i <= 18; ++i)
  {
    const float* const at = &fine.Values[2 * i];
    const double filtered = (16.0 * at[0] + 9.0 * (at[-1] + at[1]) - (at[-3] + at[3])) / 32.0;
    const auto range = std::minmax({ at[-1], at[0], at[1] });
    limited += filtered < range.first || filtered > range.second;
    EXPECT_NEAR(coarse.Values[i], std::clamp<double>(filtered, range.first, range.second), 1e-6);
  }
  EXPECT_GT(limited, 0);
  EXPECT_LT(limited, 17);
}

//------------------------------------------------------------------------------
TEST(HalvingFilter, DoesNotOverflow)
{
  const float most = std::numeric_limits<float>::max();
  for (const std::vector<float>& pattern : std::vector<std::vector<float>>{
         { most }, { -most }, { most, -most }, { most, most, -most }, { most, 0, 0, -most } })
  {
    for (const int count : { 3, 4, 16, 17 })
    {
      Line fine;
      for (int i = 0; i < count; ++i)
      {
        fine.Values.push_back(pattern[i % pattern.size()]);
      }
      for (const float value : Along(fine).Values)
      {
        EXPECT_TRUE(std::isfinite(value)) << count;
      }
    }
  }
}

//------------------------------------------------------------------------------
// What is hidden does not count, whatever its value.
TEST(HalvingFilter, WeighsVisibleSamples)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Line fine;
  fine.Values = { 1, 2, nan, 4, 5, nan, nan, nan, 9, 10 };
  fine.Hidden = { 0, 0, 1, 0, 0, 1, 1, 1, 0, 0 };
  const Line coarse = Along(fine);
  EXPECT_EQ(coarse.Hidden, (Flags{ 0, 0, 0, 1, 0, 0 }));
  EXPECT_EQ(coarse.Values[0], 1.0f);
  EXPECT_EQ(coarse.Values[1], 3.0f);               // (2 + 4) / 2
  EXPECT_FLOAT_EQ(coarse.Values[2], 14.0f / 3.0f); // (4 + 2 * 5) / 3
  EXPECT_FLOAT_EQ(coarse.Values[4], 28.0f / 3.0f); // (2 * 9 + 10) / 3
  EXPECT_EQ(coarse.Values[5], 10.0f);              // beyond the border
  fine.Hidden = { 1, 0, 0, 0, 0, 0, 0, 0, 0, 1 };
  const Line borders = Along(fine);
  EXPECT_EQ(borders.Hidden, (Flags{ 0, 0, 0, 0, 0, 1 }));
  EXPECT_EQ(borders.Values[0], 2.0f);
}
}
