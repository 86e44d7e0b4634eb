// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SliceSize.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
// The longest of the slices of some work, after a first one of 256 items.
double LongestSlice(std::int64_t items, double itemsPerMillisecond)
{
  SliceSize size(256);
  double longest = 0.0;
  for (std::int64_t done = 0; done < items;)
  {
    const double milliseconds = static_cast<double>(size.Get()) / itemsPerMillisecond;
    longest = std::max(longest, milliseconds);
    done += size.Get();
    size.Record(size.Get(), milliseconds);
  }
  return longest;
}
}

TEST(SliceSize, BeginsAsItIsTold)
{
  EXPECT_EQ(SliceSize(256).Get(), 256);
}

TEST(SliceSize, GrowsAndShrinksFourfoldAtMost)
{
  SliceSize size(256);
  size.Record(size.Get(), 0.0);
  EXPECT_EQ(size.Get(), 1024);
  size.Record(size.Get(), 12.5);
  EXPECT_EQ(size.Get(), 2048);
  size.Record(size.Get(), 50.0);
  EXPECT_EQ(size.Get(), 1024);
  size.Record(size.Get(), 5000.0);
  EXPECT_EQ(size.Get(), 256);
}

TEST(SliceSize, LearnsFromSlicesThatAreNearlyWhole)
{
  SliceSize size(256);
  size.Record(128, 1.0);
  EXPECT_EQ(size.Get(), 256);
  size.Record(243, 12.5);
  EXPECT_EQ(size.Get(), 486);
}

TEST(SliceSize, IsNeverEmptyAndNeverEndless)
{
  SliceSize size(1);
  size.Record(size.Get(), 1e9);
  EXPECT_EQ(size.Get(), 1);
  for (int slice = 0; slice < 50; ++slice)
  {
    size.Record(size.Get(), 0.0);
  }
  EXPECT_EQ(size.Get(), 1LL << 30);
}

TEST(SliceSize, StaysBelowWhatAWatchdogAllows)
{
  for (const double itemsPerMillisecond : { 10.0, 1000.0, 1e6 })
  {
    EXPECT_LE(LongestSlice(100000000, itemsPerMillisecond), SliceSize::Milliseconds * 1.1);
  }
}
