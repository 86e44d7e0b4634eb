// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/HitGeometry.h"

#include "Pipeline/TestViews.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace
{
// Parallel rays along -z through the pixels of 4 x 2, from z = 10 on; a volume from z = 2 to 6.
ViewGeometry MakeView()
{
  ViewGeometry view = MakeParallelView(4, 2);
  view.ImageSize[0] = 4;
  view.ImageSize[1] = 2;
  view.FirstDrawn[2] = 2;
  view.LastDrawn[0] = 4;
  view.LastDrawn[1] = 2;
  view.LastDrawn[2] = 6;
  return view;
}
}

TEST(HitGeometry, LengthsAreInWorldUnits)
{
  ViewGeometry view = MakeView();
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
  const ViewGeometry view = MakeView();
  std::vector<std::uint32_t> keys(8, glsl::NO_HIT);
  keys[5] = 0u; // x = 1, y = 1
  std::vector<float> distances = HitDistances(view, keys, {});
  EXPECT_NEAR(distances[5], 4.0f, 1e-5);
  EXPECT_TRUE(std::isinf(distances[4]));
  // of a translucent image the first hits count, where there are any
  distances = HitDistances(view, keys, std::vector<float>(8, 2.0f));
  EXPECT_FLOAT_EQ(distances[5], 2.0f);
  EXPECT_TRUE(std::isinf(distances[4]));
}

TEST(HitGeometry, DistancesOfAnImageInTheViewport)
{
  ViewGeometry view = MakeView();
  view.EyeDirection.PerX[0] = 0.5;
  const ViewGeometry whole = view;
  view.ImageOrigin[0] = 1;
  view.ImageOrigin[1] = 1;
  view.ImageSize[0] = 2;
  view.ImageSize[1] = 1;
  const std::vector<float> distances = HitDistances(view, { glsl::NO_HIT, 7u }, {});
  ASSERT_EQ(distances.size(), 8u);
  std::vector<std::uint32_t> keys(8, glsl::NO_HIT);
  keys[6] = 7u; // x = 2, y = 1
  EXPECT_EQ(distances, HitDistances(whole, keys, {}));
  EXPECT_TRUE(std::isfinite(distances[6]));
}

TEST(HitGeometry, PixelsOfAnImageInTheViewport)
{
  ViewGeometry view = MakeView();
  EXPECT_EQ(ImagePixel(view, 3, 1), 7);
  view.ImageOrigin[0] = 1;
  view.ImageOrigin[1] = 1;
  view.ImageSize[0] = 2;
  view.ImageSize[1] = 1;
  EXPECT_EQ(ImagePixel(view, 1, 1), 0);
  EXPECT_EQ(ImagePixel(view, 2, 1), 1);
  for (const int x : { 0, 3 })
  {
    EXPECT_FALSE(ImagePixel(view, x, 1));
  }
  EXPECT_FALSE(ImagePixel(view, 1, 0));
  EXPECT_FALSE(ImagePixel(view, 1, 2));
}
