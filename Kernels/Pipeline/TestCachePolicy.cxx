// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CachePolicy.h"

#include <gtest/gtest.h>

namespace
{
constexpr std::int64_t Pixels = 100000;
constexpr std::int64_t Maximum = 1000000; // slots

// A pass that used so many slots and was denied so many blocks.
glsl::PassRecord Pass(std::uint32_t touched, std::uint32_t denied)
{
  glsl::PassRecord pass = {};
  pass.TouchedSlots = touched;
  pass.RefusedBlocks = denied;
  return pass;
}
}

TEST(CachePolicy, FirstCacheHasASlotForFourPixels)
{
  EXPECT_EQ(CachePolicy::SlotsAtFirst(1280 * 720, Maximum), 1280 * 720 / 4);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(4 * 16384 + 4, Maximum), 16385);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(4 * 16384 - 4, Maximum), 16384);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(1, Maximum), 16384);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(1280 * 720, 3000), 3000);
}

TEST(CachePolicy, StaysWhileNothingIsDenied)
{
  CachePolicy policy;
  for (int pass = 0; pass < 10; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(Pass(20000, 0), 16384, Pixels, Maximum), 16384);
  }
}

TEST(CachePolicy, SmallCacheGrowsAtOnceFourfold)
{
  CachePolicy policy;
  EXPECT_EQ(policy.SlotsAfterPass(Pass(16384, 1), 16384, Pixels, Maximum), 4 * 16384);
}

TEST(CachePolicy, SmallCacheGrowsToTwiceWhatIsNeeded)
{
  CachePolicy policy;
  EXPECT_EQ(
    policy.SlotsAfterPass(Pass(16384, 16384 + 1), 16384, Pixels, Maximum), 2 * (2 * 16384 + 1));
  EXPECT_EQ(policy.SlotsAfterPass(Pass(16384, 16384), 16384, Pixels, Maximum), 4 * 16384);
}

TEST(CachePolicy, SmallCacheWithRoomLeftGrowsOnlyWhenDeniedAgainAndAgain)
{
  // blocks are denied, but not because all slots are in use: map pages ran out
  CachePolicy policy;
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(Pass(10000, 6384), 16384, Pixels, Maximum), 16384);
  }
  EXPECT_EQ(policy.SlotsAfterPass(Pass(10000, 6384), 16384, Pixels, Maximum), 2 * 16384);
}

TEST(CachePolicy, LargeCacheDoublesAfterFourDenialsInARow)
{
  CachePolicy policy;
  const glsl::PassRecord denied = Pass(Pixels, 5000);
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, Pixels, Pixels, Maximum), Pixels);
  }
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 0), Pixels, Pixels, Maximum), Pixels);
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, Pixels, Pixels, Maximum), Pixels);
  }
  EXPECT_EQ(policy.SlotsAfterPass(denied, Pixels, Pixels, Maximum), 2 * Pixels);
}

TEST(CachePolicy, CacheIsSmallWithFewerSlotsThanPixels)
{
  CachePolicy policy;
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 1), Pixels - 1, Pixels, Maximum), 4 * (Pixels - 1));
}

TEST(CachePolicy, NeverExceedsTheMaximum)
{
  CachePolicy policy;
  EXPECT_EQ(policy.SlotsAfterPass(Pass(16384, 1), 16384, Pixels, 20000), 20000);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(20000, 1), 20000, Pixels, 20000), 20000);
}

TEST(CachePolicy, ResetForgetsDenials)
{
  CachePolicy policy;
  for (int pass = 0; pass < 3; ++pass)
  {
    policy.SlotsAfterPass(Pass(Pixels, 1), Pixels, Pixels, Maximum);
  }
  policy.Reset();
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 1), Pixels, Pixels, Maximum), Pixels);
}

TEST(CachePolicy, ShrinksWhenEightImagesUsedLessThanAQuarter)
{
  CachePolicy policy;
  for (int image = 0; image < 7; ++image)
  {
    policy.RecordImage(image == 3 ? 24999 : 10000);
    EXPECT_EQ(policy.SlotsForNewImage(100000), 100000);
  }
  policy.RecordImage(10000);
  EXPECT_EQ(policy.SlotsForNewImage(100000), 2 * 24999);
}

TEST(CachePolicy, AQuarterInUseIsEnoughToStay)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    policy.RecordImage(image == 0 ? 25000 : 100);
  }
  EXPECT_EQ(policy.SlotsForNewImage(100000), 100000);
  policy.RecordImage(100); // the image that used a quarter is no longer among the last eight
  EXPECT_EQ(policy.SlotsForNewImage(100000), 16384);
}

TEST(CachePolicy, DoesNotGrowForANewImage)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    policy.RecordImage(0);
  }
  EXPECT_EQ(policy.SlotsForNewImage(3000), 3000);
  EXPECT_EQ(policy.SlotsForNewImage(16385), 16384);
}

TEST(CachePolicy, ResetForgetsImages)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    policy.RecordImage(100);
  }
  policy.Reset();
  EXPECT_EQ(policy.SlotsForNewImage(100000), 100000);
}
