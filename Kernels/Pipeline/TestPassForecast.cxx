// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/PassForecast.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
constexpr double Unlimited = std::numeric_limits<double>::infinity();
}

TEST(PassForecast, AFirstImageIsThreePassesAhead)
{
  const PassForecast forecast;
  EXPECT_EQ(forecast.PassesToSubmit(0, Unlimited), 3);
  EXPECT_EQ(forecast.PassesToSubmit(7, Unlimited), 10);
}

TEST(PassForecast, NoPassBeyondTheLastImagesNumberUntilAllOfThoseAreKnown)
{
  PassForecast forecast;
  forecast.RecordImage(5);
  EXPECT_EQ(forecast.PassesToSubmit(0, Unlimited), 3);
  EXPECT_EQ(forecast.PassesToSubmit(2, Unlimited), 5);
  EXPECT_EQ(forecast.PassesToSubmit(3, Unlimited), 5);
  EXPECT_EQ(forecast.PassesToSubmit(4, Unlimited), 5);
  EXPECT_EQ(forecast.PassesToSubmit(5, Unlimited), 7);
  EXPECT_EQ(forecast.PassesToSubmit(9, Unlimited), 11);
}

TEST(PassForecast, WithLittleTimeAFirstPassIsAlone)
{
  PassForecast forecast;
  EXPECT_EQ(forecast.PassesToSubmit(0, 50.0), 1);
  forecast.RecordTime(1, 2.0);
  EXPECT_EQ(forecast.PassesToSubmit(1, 48.0), 4);
}

TEST(PassForecast, AsManyPassesAsFitIntoTheTime)
{
  PassForecast forecast;
  forecast.RecordTime(4, 40.0);
  EXPECT_EQ(forecast.PassesToSubmit(4, 100.0), 7);
  EXPECT_EQ(forecast.PassesToSubmit(4, 29.9), 6);
  EXPECT_EQ(forecast.PassesToSubmit(4, 20.0), 6);
  EXPECT_EQ(forecast.PassesToSubmit(4, 19.9), 5);
  EXPECT_EQ(forecast.PassesToSubmit(4, 1.0), 5); // one at least
  EXPECT_EQ(forecast.PassesToSubmit(4, -1.0), 5);
}
