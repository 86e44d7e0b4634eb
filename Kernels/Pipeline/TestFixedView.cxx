// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FixedView.h"

#include "Pipeline/TestViews.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace
{
// Parallel rays along -z through the pixels of 4 x 2, from z = 10 on; a volume from z = 2 to 6.
ViewGeometry MakeView()
{
  ViewGeometry view = MakeParallelView(4, 2);
  view.FirstDrawn[2] = 2;
  view.LastDrawn[0] = 4;
  view.LastDrawn[1] = 2;
  view.LastDrawn[2] = 6;
  return view;
}

double Number(std::int32_t high, std::uint32_t low, std::uint32_t least = 0)
{
  return high + std::ldexp(double(low), -32) + std::ldexp(double(least), -64);
}

// What Rays.glsl finds at a pixel.
double At(const glsl::FixedPixelVector& vector, int axis, int x, int y)
{
  return Number(vector.BaseHigh[axis], vector.BaseLow[axis]) +
    (2 * x + 1) * Number(vector.PerXHigh[axis], vector.PerXLow[axis], vector.PerXLeast[axis]) +
    (2 * y + 1) * Number(vector.PerYHigh[axis], vector.PerYLow[axis], vector.PerYLeast[axis]);
}

ViewGeometry MakePerspectiveView()
{
  ViewGeometry view = MakeView();
  view.ViewportSize[0] = 3840;
  view.ViewportSize[1] = 2160;
  view.RayOrigin = {};
  view.RayOrigin.Base[2] = 10.0;
  view.RayDirection = { { -1.0 / 3.0, -0.2, -1.0 }, { 2.0 / 3.0 / 3840, 0.0, 0.0 },
    { 0.0, 0.4 / 2160, 0.0 } };
  return view;
}
}

TEST(FixedView, DepthsAreThoseOfTheDrawnBox)
{
  const DrawnDepths depths = FindDrawnDepths(MakeView());
  EXPECT_NEAR(depths.First, 4.0, 1e-5);
  EXPECT_NEAR(depths.Last, 8.0, 1e-5);
  EXPECT_LT(depths.First, 4.0); // a surface on the border counts
  EXPECT_GT(depths.Last, 8.0);
}

TEST(FixedView, TheClippingRangeIsExact)
{
  ViewGeometry view = MakeView();
  view.NearDistance = 5.0;
  view.FarDistance = 7.0;
  const DrawnDepths depths = FindDrawnDepths(view);
  EXPECT_EQ(depths.First, 5.0);
  EXPECT_EQ(depths.Last, 7.0);
}

TEST(FixedView, KeysSpanTheDepths)
{
  const DrawnDepths depths = { 4.0, 8.0 };
  EXPECT_NEAR(HitDepth(depths, 0u), 4.0, 1e-8);
  EXPECT_NEAR(HitDepth(depths, 1u << 30), 5.0, 1e-8);
  EXPECT_NEAR(HitDepth(depths, glsl::NO_HIT - 1u), 8.0, 1e-8);
  EXPECT_TRUE(std::isinf(HitDepth(depths, glsl::NO_HIT)));
}

TEST(FixedView, WaysLeadFromTheFirstDepthToTheLast)
{
  const ViewGeometry view = MakePerspectiveView();
  const DrawnDepths depths = FindDrawnDepths(view);
  const glsl::View block = FixView(view);
  EXPECT_EQ(block.HasRays, 1);
  for (const int x : { 0, 1917, 3839 })
  {
    const double direction = -1.0 / 3.0 + (x + 0.5) * 2.0 / 3.0 / 3840;
    EXPECT_NEAR(At(block.RayOrigin, 0, x, 0), depths.First * direction, 1e-9);
    EXPECT_NEAR(At(block.RayWay, 0, x, 0), (depths.Last - depths.First) * direction, 1e-9);
    EXPECT_NEAR(At(block.RayOrigin, 2, x, 7), 10.0 - depths.First, 1e-9);
    EXPECT_NEAR(At(block.RayWay, 2, x, 7), depths.First - depths.Last, 1e-9);
  }
}

TEST(FixedView, GainsOfHardlyLessThanNothingAreNone)
{
  ViewGeometry view = MakePerspectiveView();
  view.RayDirection.PerX[1] = -1e-19;
  view.RayDirection.PerY[0] = 1e-19;
  const glsl::View block = FixView(view);
  EXPECT_NEAR(At(block.RayWay, 1, 0, 9), At(block.RayWay, 1, 3839, 9), 1e-9);
  EXPECT_NEAR(At(block.RayWay, 0, 7, 0), At(block.RayWay, 0, 7, 2159), 1e-9);
}

TEST(FixedView, NothingIsLostFarAway)
{
  ViewGeometry view = MakePerspectiveView();
  view.RayOrigin.Base[2] = view.Depth[3] = 1e9;
  view.RayDirection.PerX[0] *= 1e-9;
  view.RayDirection.Base[0] *= 1e-9;
  view.RayDirection.PerY[1] *= 1e-9;
  view.RayDirection.Base[1] *= 1e-9;
  view.FarDistance = 1e10;
  const glsl::View block = FixView(view);
  EXPECT_NEAR(At(block.RayOrigin, 0, 3839, 0), (1e9 - 6.0) * (1e-9 / 3.0) * 3839.0 / 3840.0, 1e-8);
  EXPECT_NEAR(At(block.RayOrigin, 2, 5, 5), 6.0, 1e-5);
  EXPECT_NEAR(At(block.RayWay, 2, 5, 5), -4.0, 1e-5);
}

TEST(FixedView, DrawsNothingOfWhatIsNotInTheClippingRange)
{
  ViewGeometry view = MakeView();
  view.FarDistance = 3.0;
  EXPECT_EQ(FixView(view).HasRays, 0);
  view.FarDistance = 0.0; // before the near plane: no isovalue is shown
  EXPECT_EQ(FixView(view).HasRays, 0);
}

TEST(FixedView, DrawsNothingOfAVolumeThatIsMuchLessThanAPixel)
{
  ViewGeometry view = MakeView();
  view.RayOrigin.PerX[0] = 1e8;
  EXPECT_EQ(FixView(view).HasRays, 1);
  view.RayOrigin.PerX[0] = 1e9;
  EXPECT_EQ(FixView(view).HasRays, 0);
}

TEST(FixedView, TellsWaysThatAreTooLong)
{
  ViewGeometry view = MakePerspectiveView();
  EXPECT_FALSE(HasTooLongWays(view));
  view.RayOrigin.PerX[0] = 1e9; // far away: a pixel is wider than the volume
  EXPECT_FALSE(HasTooLongWays(view));
  view.RayDirection.PerY[1] *= 1e9;
  EXPECT_TRUE(HasTooLongWays(view));
  view.FarDistance = 0.0;
  EXPECT_FALSE(HasTooLongWays(view));
}

TEST(FixedView, DistancesFromClippingPlanesKeepTheirProportions)
{
  ViewGeometry view = MakeView();
  for (const double scale : { 1.0, 1e-200, 1e200 })
  {
    view.NumberOfClippingPlanes = 5;
    ClippingPlane& plane = view.ClippingPlanes[4];
    plane.Normal[2] = -scale;
    plane.Offset = 5.0 * scale; // keeps z <= 5
    const glsl::View block = FixView(view);
    const double at = At(block.ClippingOrigin[1], 1, 0, 0);
    const double way = At(block.ClippingWay[1], 1, 0, 0);
    EXPECT_NEAR(-at / way, 0.25, 1e-6);
    EXPECT_LT(at, 0.0);
    EXPECT_GT(std::abs(at), 1e7); // uses the room that there is
    EXPECT_EQ(At(block.ClippingOrigin[0], 0, 0, 0), 0.0);
  }
}

TEST(FixedView, PlanesOfCroppingAreCellsAndPlacesInThem)
{
  ViewGeometry view = MakeView();
  view.CroppingLow[0] = 2.25;
  view.CroppingLow[1] = -0.25;
  view.CroppingHigh[2] = std::numeric_limits<double>::infinity();
  const glsl::View block = FixView(view);
  EXPECT_EQ(block.CroppingLow.Cell[0], 2);
  EXPECT_EQ(block.CroppingLow.Place[0], 0.25f);
  EXPECT_EQ(block.CroppingLow.Cell[1], -1);
  EXPECT_EQ(block.CroppingLow.Place[1], 0.75f);
  EXPECT_GT(block.CroppingHigh.Cell[2], 1 << 20);
}
