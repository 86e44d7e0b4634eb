// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CachePolicy.h"

#include <gtest/gtest.h>

namespace
{
constexpr std::int64_t Pixels = 100000;
constexpr std::int64_t Maximum = 1000000; // slots
constexpr std::int64_t Step = 16384;
constexpr double NoPause = 1999.0; // milliseconds
constexpr double Pause = 2000.0;

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
  EXPECT_EQ(CachePolicy::SlotsAtFirst(400 * 300, Maximum), 400 * 300 / 4);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(4 * 16384 + 4, Maximum), 16385);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(4 * 16384 - 4, Maximum), 16384);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(1, Maximum), 16384);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(3840 * 2160, Maximum), 65536);
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

TEST(CachePolicy, SmallCacheDoublesAtOnce)
{
  CachePolicy policy;
  EXPECT_EQ(policy.SlotsAfterPass(Pass(16384, 1), 16384, Pixels, Maximum), 2 * 16384);
}

TEST(CachePolicy, GrowsToAQuarterMoreThanIsNeeded)
{
  CachePolicy policy;
  policy.Reset(true);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 20), Pixels, Pixels, Maximum), 125025);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 50000), Pixels, Pixels, Maximum), 187500);
}

TEST(CachePolicy, ACopiedCacheDoublesAtLeast)
{
  CachePolicy policy;
  policy.Reset(false);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 20), Pixels, Pixels, Maximum), 2 * Pixels);
  policy.RecordImage(2 * Pixels);
  EXPECT_EQ(policy.SlotsForNewImage(2 * Pixels, Maximum, NoPause), 4 * Pixels);
}

TEST(CachePolicy, WithRoomLeftGrowsOnlyWhenDeniedAgainAndAgain)
{
  // blocks are denied, but not because all slots are in use: others' blocks are, or pages ran out
  CachePolicy policy;
  const glsl::PassRecord denied = Pass(10000, 6384);
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, 16384, Pixels, Maximum), 16384);
  }
  EXPECT_EQ(policy.SlotsAfterPass(Pass(10000, 0), 16384, Pixels, Maximum), 16384);
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, 16384, Pixels, Maximum), 16384);
  }
  EXPECT_EQ(policy.SlotsAfterPass(denied, 16384, Pixels, Maximum), 2 * 16384);
}

TEST(CachePolicy, NeverExceedsTheMaximum)
{
  CachePolicy policy;
  EXPECT_EQ(policy.SlotsAfterPass(Pass(16384, 1), 16384, Pixels, 20000), 20000);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(20000, 1), 20000, Pixels, 20000), 20000);
  policy.RecordImage(20000);
  EXPECT_EQ(policy.SlotsForNewImage(16384, 20000, NoPause), 20000);
}

TEST(CachePolicy, GrowthForgetsDenials)
{
  CachePolicy policy;
  for (int pass = 0; pass < 3; ++pass)
  {
    policy.SlotsAfterPass(Pass(0, 1), Pixels, Pixels, Maximum);
  }
  policy.RecordGrowth();
  EXPECT_EQ(policy.SlotsAfterPass(Pass(0, 1), Pixels, Pixels, Maximum), Pixels);
}

TEST(CachePolicy, OnlyTheFirstImageGrowsByMoreThanAStep)
{
  const std::int64_t much = 100 * Maximum;
  CachePolicy policy;
  policy.Reset(true);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 3 * Maximum), Pixels, Pixels, much),
    (Pixels + 3 * Maximum) * 5 / 4);
  policy.Reset(true);
  policy.RecordImage(Pixels);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 3 * Maximum), Pixels, Pixels, much), Pixels + Step);
  // denied again, the cache gets the next step, but not where the pass got all that it wanted
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 0), Pixels + Step, Pixels, much), Pixels + Step);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Pixels, 1), Pixels + Step, Pixels, much), Pixels + 2 * Step);
}

TEST(CachePolicy, AnImageTakesAnotherStepOnlyWhenDeniedAgainAndAgain)
{
  CachePolicy policy;
  policy.Reset(true);
  policy.RecordImage(Pixels);
  const std::int64_t slots = policy.SlotsForNewImage(Pixels, Maximum, NoPause);
  EXPECT_EQ(slots, Pixels + Step);
  policy.RecordGrowth();
  const glsl::PassRecord denied = Pass(Pixels, 50000);
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, slots, Pixels, Maximum), slots);
  }
  EXPECT_EQ(policy.SlotsAfterPass(denied, slots, Pixels, Maximum), slots + Step);
  policy.RecordGrowth();
  EXPECT_EQ(policy.SlotsAfterPass(denied, slots + Step, Pixels, Maximum), slots + Step);
}

TEST(CachePolicy, GrowsForANewImageWhenTheLastUsedMoreThanTwoThirds)
{
  CachePolicy policy;
  policy.Reset(true);
  EXPECT_EQ(policy.SlotsForNewImage(30000, Maximum, NoPause), 30000);
  policy.RecordImage(20000);
  EXPECT_EQ(policy.SlotsForNewImage(30000, Maximum, NoPause), 30000);
  policy.RecordImage(20002);
  EXPECT_EQ(policy.SlotsForNewImage(30000, Maximum, NoPause), 30003);
}

TEST(CachePolicy, GrowsStepByStepForNewImages)
{
  CachePolicy policy;
  policy.Reset(true);
  policy.RecordImage(100000);
  EXPECT_EQ(policy.SlotsForNewImage(120000, Maximum, NoPause), 120000 + Step);
  policy.RecordImage(100000);
  EXPECT_EQ(policy.SlotsForNewImage(120000 + Step, Maximum, NoPause), 150000);
}

TEST(CachePolicy, ShrinksWhenEightImagesUsedLessThanAQuarter)
{
  CachePolicy policy;
  for (int image = 0; image < 7; ++image)
  {
    policy.RecordImage(image == 3 ? 24999 : 10000);
    EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 100000);
  }
  policy.RecordImage(10000);
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 2 * 24999);
}

TEST(CachePolicy, ShrinksOnlyAfterAPause)
{
  CachePolicy policy;
  for (int image = 0; image < 20; ++image)
  {
    policy.RecordImage(100);
    EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, NoPause), 100000);
  }
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 16384);
}

TEST(CachePolicy, AQuarterInUseIsEnoughToStay)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    policy.RecordImage(image == 0 ? 25000 : 100);
  }
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 100000);
  policy.RecordImage(100); // the image that used a quarter is no longer among the last eight
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 16384);
}

TEST(CachePolicy, ASmallCacheDoesNotShrink)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    policy.RecordImage(0);
  }
  EXPECT_EQ(policy.SlotsForNewImage(3000, Maximum, Pause), 3000);
  EXPECT_EQ(policy.SlotsForNewImage(16385, Maximum, Pause), 16384);
}

TEST(CachePolicy, ResetForgetsImages)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    policy.RecordImage(100);
  }
  policy.Reset(false);
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 100000);
}
