// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/PassLog.h"

#include <gtest/gtest.h>

namespace
{
// What the GPU tells after so many passes, of which the last left so many rays.
Snapshot After(std::uint32_t passes, std::uint32_t remainingRays)
{
  Snapshot snapshot = {};
  snapshot.Control.PassIndex = passes;
  snapshot.Records[(passes - 1) % glsl::PASS_RECORDS].RemainingRays = remainingRays;
  return snapshot;
}
}

TEST(PassLog, StartsWithAllRays)
{
  PassLog log;
  log.StartImage(500);
  EXPECT_EQ(log.GetRemainingRays(), 500);
  EXPECT_FALSE(log.AwaitsPasses());
  EXPECT_TRUE(log.GetPasses().empty());
}

TEST(PassLog, KnowsPassesInTheirOrder)
{
  PassLog log;
  log.StartImage(500);
  log.AddSubmitted();
  log.AddSubmitted();
  EXPECT_TRUE(log.AwaitsPasses());
  ASSERT_NE(log.AddKnown(After(1, 300)), nullptr);
  EXPECT_EQ(log.GetRemainingRays(), 300);
  EXPECT_TRUE(log.AwaitsPasses());
  ASSERT_NE(log.AddKnown(After(2, 0)), nullptr);
  EXPECT_FALSE(log.AwaitsPasses());
  log.SetTimes({ 1.5, 2.5 });
  ASSERT_EQ(log.GetPasses().size(), 2u);
  EXPECT_EQ(log.GetPasses()[0].RemainingRays, 300u);
  EXPECT_EQ(log.GetPasses()[1].ElapsedMilliseconds, 2.5);
}

TEST(PassLog, PassWithNothingToDoLeavesNoRecord)
{
  PassLog log;
  log.StartImage(500);
  log.AddSubmitted();
  log.AddSubmitted();
  log.AddKnown(After(1, 0));
  EXPECT_EQ(log.AddKnown(After(1, 0)), nullptr);
  EXPECT_EQ(log.GetKnown(), 2);
  EXPECT_EQ(log.GetPasses().size(), 1u);
}

TEST(PassLog, RecordsAreARing)
{
  PassLog log;
  log.StartImage(500);
  for (std::uint32_t pass = 1; pass <= glsl::PASS_RECORDS + 2; ++pass)
  {
    log.AddSubmitted();
    log.AddKnown(After(pass, 500 - pass));
  }
  EXPECT_EQ(log.GetPasses()[glsl::PASS_RECORDS + 1].RemainingRays, 500u - glsl::PASS_RECORDS - 2);
}

TEST(PassLog, IsStuckAfter64PassesWithoutProgress)
{
  PassLog log;
  log.StartImage(500);
  for (std::uint32_t pass = 1; pass <= 64; ++pass)
  {
    EXPECT_FALSE(log.IsStuck());
    log.AddSubmitted();
    log.AddKnown(After(pass, 500));
  }
  EXPECT_TRUE(log.IsStuck());
  Snapshot progress = After(65, 500);
  progress.Records[64 % glsl::PASS_RECORDS].DecodedBlocks = 1;
  log.AddSubmitted();
  log.AddKnown(progress);
  EXPECT_FALSE(log.IsStuck());
}
