// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CachePolicy.h"

#include <gtest/gtest.h>

namespace
{
constexpr std::int64_t Maximum = 1000000; // slots
constexpr std::int64_t Many = 100000;
constexpr std::int64_t Step = 8192;
constexpr double NoPause = 1999.0; // milliseconds
constexpr double Pause = 2000.0;

// A pass that used so many slots and was denied so many blocks.
glsl::PassRecord Pass(std::int64_t touched, std::int64_t denied)
{
  glsl::PassRecord pass = {};
  pass.TouchedSlots = static_cast<std::uint32_t>(touched);
  pass.RefusedBlocks = static_cast<std::uint32_t>(denied);
  return pass;
}

// Records an image that used so many slots of many.
void Used(CachePolicy& policy, std::int64_t touched)
{
  EXPECT_EQ(policy.SlotsAfterImage(touched, 2 * touched, Maximum), 2 * touched);
}

// Of a cache that grows in place and has shown an image.
CachePolicy PolicyAfterAnImage()
{
  CachePolicy policy;
  policy.Reset(true);
  Used(policy, 10000);
  return policy;
}
}

TEST(CachePolicy, FirstCacheHasASlotForFourPixels)
{
  EXPECT_EQ(CachePolicy::SlotsAtFirst(1280 * 720, Maximum), 1280 * 720 / 4);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(4 * 16384 + 4, Maximum), 16385);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(4 * 16384 - 4, Maximum), 16384);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(1, Maximum), 16384);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(3840 * 2160, Maximum), 262144);
  EXPECT_EQ(CachePolicy::SlotsAtFirst(1280 * 720, 3000), 3000);
}

TEST(CachePolicy, StaysWhileNothingIsDenied)
{
  CachePolicy policy;
  for (int pass = 0; pass < 10; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(Pass(20000, 0), 16384, Maximum), 16384);
  }
}

TEST(CachePolicy, GrowsInTheFirstImageAtOnceToTwiceWhatIsNeeded)
{
  for (const bool inPlace : { false, true })
  {
    CachePolicy policy;
    policy.Reset(inPlace);
    EXPECT_EQ(policy.SlotsAfterPass(Pass(16384, 1), 16384, Maximum), 2 * 16385);
    policy.RecordGrowth();
    EXPECT_EQ(policy.SlotsAfterPass(Pass(2 * 16385, 300000), 2 * 16385, Maximum), 665540);
    policy.RecordGrowth();
    EXPECT_EQ(policy.SlotsAfterImage(400000, 665540, Maximum), 800000);
  }
}

TEST(CachePolicy, WithRoomLeftGrowsOnlyWhenDeniedAgainAndAgain)
{
  // blocks are denied, but not because all slots are in use: others' blocks are, or pages ran out
  CachePolicy policy;
  const glsl::PassRecord denied = Pass(10000, 6384);
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, 16384, Maximum), 16384);
  }
  EXPECT_EQ(policy.SlotsAfterPass(Pass(10000, 0), 16384, Maximum), 16384);
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, 16384, Maximum), 16384);
  }
  EXPECT_EQ(policy.SlotsAfterPass(denied, 16384, Maximum), 2 * 16384);
}

TEST(CachePolicy, NeverExceedsTheMaximum)
{
  CachePolicy policy;
  EXPECT_EQ(policy.SlotsAfterPass(Pass(16384, 1), 16384, 20000), 20000);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(20000, 1), 20000, 20000), 20000);
  EXPECT_EQ(policy.SlotsAfterImage(20000, 16384, 20000), 20000);
  EXPECT_EQ(policy.SlotsForNewImage(20000, 20000, NoPause), 20000);
}

TEST(CachePolicy, GrowthForgetsDenials)
{
  CachePolicy policy;
  for (int pass = 0; pass < 3; ++pass)
  {
    policy.SlotsAfterPass(Pass(0, 1), Many, Maximum);
  }
  policy.RecordGrowth();
  EXPECT_EQ(policy.SlotsAfterPass(Pass(0, 1), Many, Maximum), Many);
}

TEST(CachePolicy, StaysAfterTheFirstImageWhileThereIsRoom)
{
  CachePolicy policy = PolicyAfterAnImage();
  for (int image = 0; image < 20; ++image)
  {
    EXPECT_EQ(policy.SlotsForNewImage(Many, Maximum, NoPause), Many);
    EXPECT_EQ(policy.SlotsAfterPass(Pass(Many / 2, Many / 2), Many, Maximum), Many);
    EXPECT_EQ(policy.SlotsAfterPass(Pass(Many * 95 / 100, 0), Many, Maximum), Many);
    EXPECT_EQ(policy.SlotsAfterImage(Many * 95 / 100, Many, Maximum), Many);
  }
}

TEST(CachePolicy, LaterGrowsByAStepAnImageWhenBlocksAreDenied)
{
  CachePolicy policy = PolicyAfterAnImage();
  const glsl::PassRecord denied = Pass(Many, 500000);
  EXPECT_EQ(policy.SlotsAfterPass(denied, Many, Maximum), Many + Step);
  policy.RecordGrowth();
  for (int pass = 0; pass < 3; ++pass)
  {
    EXPECT_EQ(policy.SlotsAfterPass(denied, Many + Step, Maximum), Many + Step);
  }
  // eviction does not help
  EXPECT_EQ(policy.SlotsAfterPass(denied, Many + Step, Maximum), Many + 2 * Step);
  policy.RecordGrowth();
  EXPECT_EQ(policy.SlotsAfterPass(denied, Many + 2 * Step, Maximum), Many + 2 * Step);
  policy.SlotsForNewImage(Many + 2 * Step, Maximum, NoPause);
  EXPECT_EQ(policy.SlotsAfterPass(denied, Many + 2 * Step, Maximum), Many + 3 * Step);
}

TEST(CachePolicy, LaterGrowsByAStepWhenAnImageUsedNearlyAll)
{
  CachePolicy policy = PolicyAfterAnImage();
  EXPECT_EQ(policy.SlotsAfterImage(Many * 95 / 100 + 1, Many, Maximum), Many);
  EXPECT_EQ(policy.SlotsForNewImage(Many, Maximum, NoPause), Many + Step);
}

TEST(CachePolicy, ACopiedCacheGrowsByMuch)
{
  CachePolicy policy;
  policy.Reset(false);
  Used(policy, 10000);
  EXPECT_EQ(policy.SlotsAfterPass(Pass(Many, 50000), Many, Maximum), 300000);
  EXPECT_EQ(policy.SlotsAfterImage(Many, Many, Maximum), Many);
  EXPECT_EQ(policy.SlotsForNewImage(Many, Maximum, NoPause), 2 * Many);
}

TEST(CachePolicy, ShrinksWhenEightImagesUsedLessThanAQuarter)
{
  CachePolicy policy;
  for (int image = 0; image < 7; ++image)
  {
    Used(policy, image == 3 ? 24999 : 10000);
    EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 100000);
  }
  Used(policy, 10000);
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 2 * 24999);
}

TEST(CachePolicy, ShrinksOnlyAfterAPause)
{
  CachePolicy policy;
  for (int image = 0; image < 20; ++image)
  {
    Used(policy, 100);
    EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, NoPause), 100000);
  }
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 16384);
}

TEST(CachePolicy, AQuarterInUseIsEnoughToStay)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    Used(policy, image == 0 ? 25000 : 100);
  }
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 100000);
  Used(policy, 100); // the image that used a quarter is no longer among the last eight
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 16384);
}

TEST(CachePolicy, ASmallCacheDoesNotShrink)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    Used(policy, 0);
  }
  EXPECT_EQ(policy.SlotsForNewImage(3000, Maximum, Pause), 3000);
  EXPECT_EQ(policy.SlotsForNewImage(16385, Maximum, Pause), 16384);
}

TEST(CachePolicy, ResetForgetsImages)
{
  CachePolicy policy;
  for (int image = 0; image < 8; ++image)
  {
    Used(policy, 100);
  }
  policy.Reset(false);
  EXPECT_EQ(policy.SlotsForNewImage(100000, Maximum, Pause), 100000);
}
