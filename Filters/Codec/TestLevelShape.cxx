// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LevelShape.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace
{
using Three = std::array<int, 3>;

Three DimensionsOf(const LevelShape& shape)
{
  return { shape.Dimensions[0], shape.Dimensions[1], shape.Dimensions[2] };
}

Three StepsOf(const LevelShape& shape)
{
  return { shape.Steps[0], shape.Steps[1], shape.Steps[2] };
}

std::vector<LevelShape> Plan(Three dims, std::array<double, 3> spacing, int levels)
{
  return PlanLevels(dims.data(), spacing.data(), levels);
}

//------------------------------------------------------------------------------
TEST(LevelShape, CoversTheFineSamples)
{
  for (int fine = 3; fine < 40; ++fine)
  {
    const int last = 2 * (HalvedCount(fine) - 1);
    EXPECT_TRUE(last == fine - 1 || last == fine) << fine;
    EXPECT_LT(HalvedCount(fine), fine);
  }
}

//------------------------------------------------------------------------------
TEST(LevelShape, EndsWithOnePage)
{
  const auto shapes = Plan({ 257, 256, 130 }, { 1, 1, 1 }, 11);
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(DimensionsOf(shapes[0]), (Three{ 129, 129, 66 }));
  EXPECT_EQ(DimensionsOf(shapes[1]), (Three{ 65, 65, 34 }));
  EXPECT_EQ(DimensionsOf(shapes[2]), (Three{ 33, 33, 18 }));
  EXPECT_EQ(StepsOf(shapes[2]), (Three{ 8, 8, 8 }));
  EXPECT_TRUE(Plan({ 64, 64, 64 }, { 1, 1, 1 }, 11).empty());
  EXPECT_EQ(Plan({ 65, 64, 64 }, { 1, 1, 1 }, 11).size(), 1u);
  EXPECT_EQ(Plan({ 257, 256, 130 }, { 1, 1, 1 }, 2).size(), 2u);
  EXPECT_TRUE(Plan({ 257, 256, 130 }, { 1, 1, 1 }, 0).empty());
}

//------------------------------------------------------------------------------
TEST(LevelShape, HalvesFineAxesFirst)
{
  const auto shapes = Plan({ 512, 512, 128 }, { 0.5, -0.5, 2.0 }, 3);
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(StepsOf(shapes[0]), (Three{ 2, 2, 1 }));
  EXPECT_EQ(StepsOf(shapes[1]), (Three{ 4, 4, 1 }));
  EXPECT_EQ(StepsOf(shapes[2]), (Three{ 8, 8, 2 }));
  EXPECT_EQ(DimensionsOf(shapes[2]), (Three{ 65, 65, 65 }));
  // within a factor of the root of 2, and not
  EXPECT_EQ(StepsOf(Plan({ 99, 99, 99 }, { 1, 1.4, 1.42 }, 1)[0]), (Three{ 2, 2, 1 }));
}

//------------------------------------------------------------------------------
TEST(LevelShape, LeavesShortAxes)
{
  const auto shapes = Plan({ 2, 3, 300 }, { 0.01, 0.1, 1 }, 11);
  ASSERT_EQ(shapes.size(), 4u);
  EXPECT_EQ(DimensionsOf(shapes[0]), (Three{ 2, 2, 300 }));
  EXPECT_EQ(DimensionsOf(shapes[3]), (Three{ 2, 2, 39 }));
}

//------------------------------------------------------------------------------
TEST(LevelShape, TakesAnySpacing)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(StepsOf(Plan({ 99, 99, 99 }, { 0, nan, 7 }, 1)[0]), (Three{ 2, 2, 2 }));
  EXPECT_EQ(StepsOf(Plan({ 99, 99, 99 }, { 0, 0, 0 }, 1)[0]), (Three{ 2, 2, 2 }));
}

//------------------------------------------------------------------------------
TEST(LevelShape, GivesBits)
{
  EXPECT_EQ(BlockBitsOfLevel(1, 256), 256 + 3 * 64);
  EXPECT_EQ(BlockBitsOfLevel(3, 256), 256 + 5 * 64);
  EXPECT_EQ(BlockBitsOfLevel(1, 2000), 2048);
}
}
