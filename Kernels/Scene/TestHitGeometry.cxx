// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/HitGeometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace
{
// Parallel rays along -z through the pixels of 4 x 2, from z = 10 on; a volume from z = 2 to 6.
glsl::View MakeView()
{
  glsl::View view = {};
  view.ImageSize[0] = 4;
  view.ImageSize[1] = 2;
  for (glsl::PixelVector* origin : { &view.RayOrigin, &view.EyeOrigin })
  {
    origin->Base[2] = 10.0;
    origin->PerX[0] = 1.0;
    origin->PerY[1] = 1.0;
  }
  view.RayDirection.Base[2] = view.EyeDirection.Base[2] = -1.0;
  view.NearDistance = 1.0;
  view.FarDistance = 100.0;
  view.FirstDrawn[2] = 2;
  view.LastDrawn[0] = 4;
  view.LastDrawn[1] = 2;
  view.LastDrawn[2] = 6;
  return view;
}

void AddPlane(glsl::View& view, double normalZ, double offset)
{
  glsl::ClippingPlane& plane = view.ClippingPlanes[view.NumberOfClippingPlanes++];
  plane.Normal[2] = normalZ;
  plane.Offset = offset;
}

double FirstParameter(const glsl::View& view)
{
  return HitParameter(view, 1, 1, 0u);
}

double LastParameter(const glsl::View& view)
{
  return HitParameter(view, 1, 1, static_cast<std::uint32_t>(glsl::HIT_STEPS) - 1u);
}
}

TEST(HitGeometry, KeysSpanTheRayInTheVolume)
{
  const glsl::View view = MakeView();
  EXPECT_NEAR(FirstParameter(view), 4.0, 1e-8);
  EXPECT_NEAR(LastParameter(view), 8.0, 1e-8);
  EXPECT_NEAR(HitParameter(view, 1, 1, static_cast<std::uint32_t>(glsl::HIT_STEPS / 4)), 5.0, 1e-8);
}

TEST(HitGeometry, NoHitIsInfinitelyFar)
{
  EXPECT_TRUE(std::isinf(HitParameter(MakeView(), 0, 0, glsl::NO_HIT)));
  EXPECT_TRUE(
    std::isinf(RayLength(MakeView(), 0, 0, HitParameter(MakeView(), 0, 0, glsl::NO_HIT))));
}

TEST(HitGeometry, TheClippingRangeEndsRays)
{
  glsl::View view = MakeView();
  view.NearDistance = 5.0;
  view.FarDistance = 7.0;
  EXPECT_NEAR(FirstParameter(view), 5.0, 1e-8);
  EXPECT_NEAR(LastParameter(view), 7.0, 1e-8);
}

TEST(HitGeometry, ClippingPlanesEndRays)
{
  glsl::View view = MakeView();
  AddPlane(view, -1.0, 5.5); // keeps z <= 5.5
  AddPlane(view, 1.0, -3.0); // keeps z >= 3
  EXPECT_NEAR(FirstParameter(view), 4.5, 1e-8);
  EXPECT_NEAR(LastParameter(view), 7.0, 1e-8);
}

TEST(HitGeometry, PlanesAlongARayDoNotEndIt)
{
  glsl::View view = MakeView();
  view.ClippingPlanes[view.NumberOfClippingPlanes++].Normal[0] = 1.0;
  EXPECT_NEAR(FirstParameter(view), 4.0, 1e-8);
  EXPECT_NEAR(LastParameter(view), 8.0, 1e-8);
}

TEST(HitGeometry, LengthsAreInWorldUnits)
{
  glsl::View view = MakeView();
  EXPECT_DOUBLE_EQ(RayLength(view, 0, 0, 4.0), 4.0);
  view.EyeDirection.PerX[0] = 1.5; // at x = 0.5: (0.75, 0, -1)
  EXPECT_DOUBLE_EQ(RayLength(view, 0, 0, 4.0), 5.0);
}

TEST(HitGeometry, PositionsAreThoseOfPixelCentres)
{
  double position[3];
  EyePosition(MakeView(), 3, 1, 4.0, position);
  EXPECT_DOUBLE_EQ(position[0], 3.5);
  EXPECT_DOUBLE_EQ(position[1], 1.5);
  EXPECT_DOUBLE_EQ(position[2], 6.0);
}

TEST(HitGeometry, DistancesOfAllPixels)
{
  const glsl::View view = MakeView();
  std::vector<std::uint32_t> keys(8, glsl::NO_HIT);
  keys[5] = 0u; // x = 1, y = 1
  std::vector<float> distances = HitDistances(view, keys, {});
  EXPECT_FLOAT_EQ(distances[5], 4.0f);
  EXPECT_TRUE(std::isinf(distances[4]));
  // of a translucent image the first hits count, where there are any
  distances = HitDistances(view, keys, std::vector<float>(8, 2.0f));
  EXPECT_FLOAT_EQ(distances[5], 2.0f);
  EXPECT_TRUE(std::isinf(distances[4]));
}
