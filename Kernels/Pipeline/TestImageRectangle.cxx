// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ImageRectangle.h"

#include "Pipeline/FixedView.h"
#include "Pipeline/TestViews.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace
{
constexpr int Width = 100, Height = 80;

// Parallel rays along -z, a pixel for each voxel, through the box from (20, 30, 2) to (40, 50, 6).
ViewGeometry ParallelView()
{
  ViewGeometry view = MakeParallelView(Width, Height);
  const int first[] = { 20, 30, 2 }, last[] = { 40, 50, 6 };
  std::copy(first, first + 3, view.FirstDrawn);
  std::copy(last, last + 3, view.LastDrawn);
  return view;
}

// Rays from `eye` along -z, `slope` to each side at the left and right.
ViewGeometry PerspectiveView(const double eye[3], double slope)
{
  ViewGeometry view = ParallelView();
  view.RayOrigin = {};
  std::copy(eye, eye + 3, view.RayOrigin.Base);
  const double perPixel = 2.0 * slope / Width;
  view.RayDirection = { { -slope, -perPixel * Height / 2.0, -1.0 }, { perPixel, 0.0, 0.0 },
    { 0.0, perPixel, 0.0 } };
  view.Depth[3] = eye[2];
  view.NearDistance = 1e-3;
  view.FarDistance = 1e6;
  return view;
}

std::vector<int> ImageOf(ViewGeometry view)
{
  FindImage(view);
  return { view.ImageOrigin[0], view.ImageOrigin[1], view.ImageSize[0], view.ImageSize[1] };
}

const std::vector<int> Nothing = { 0, 0, 0, 0 }, Everything = { 0, 0, Width, Height };

// Whether a pixel's ray passes through the drawn box within the clipping range.
bool Meets(const ViewGeometry& view, int x, int y)
{
  double enter = view.NearDistance, leave = view.FarDistance;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto at = [=](const PixelVector& vector)
    { return vector.Base[axis] + (x + 0.5) * vector.PerX[axis] + (y + 0.5) * vector.PerY[axis]; };
    const double origin = at(view.RayOrigin), direction = at(view.RayDirection);
    const double first = (view.FirstDrawn[axis] - origin) / direction;
    const double last = (view.LastDrawn[axis] - origin) / direction;
    enter = std::max(enter, std::min(first, last));
    leave = std::min(leave, std::max(first, last));
  }
  return enter <= leave;
}
}

TEST(ImageRectangle, IsThatOfTheVolumeAndAPixelAround)
{
  EXPECT_EQ(ImageOf(ParallelView()), std::vector<int>({ 19, 29, 22, 22 }));
}

TEST(ImageRectangle, FollowsWhatIsDrawnOfTheVolume)
{
  ViewGeometry view = ParallelView();
  view.FirstDrawn[0] = 30;
  view.LastDrawn[1] = 31;
  EXPECT_EQ(ImageOf(view), std::vector<int>({ 29, 29, 12, 3 }));
}

TEST(ImageRectangle, EndsWithTheViewport)
{
  ViewGeometry view = ParallelView();
  view.RayOrigin.Base[0] = 30.0;
  view.RayOrigin.Base[1] = -40.0;
  EXPECT_EQ(ImageOf(view), std::vector<int>({ 0, 69, 11, 11 }));
}

TEST(ImageRectangle, IsEmptyWhereTheVolumeIsOutOfSight)
{
  ViewGeometry view = ParallelView();
  view.RayOrigin.Base[0] = 42.0;
  EXPECT_EQ(ImageOf(view), Nothing);
  view = ParallelView();
  view.RayOrigin.Base[1] = -Height;
  EXPECT_EQ(ImageOf(view), Nothing);
  view = ParallelView();
  view.NearDistance = 9.0; // behind the volume
  EXPECT_EQ(ImageOf(view), Nothing);
  view.NearDistance = 1.0;
  view.FarDistance = 3.0; // before it
  EXPECT_EQ(ImageOf(view), Nothing);
}

TEST(ImageRectangle, IsAllOfTheViewportWithinTheVolume)
{
  const double eye[] = { 30.0, 40.0, 4.0 };
  EXPECT_EQ(ImageOf(PerspectiveView(eye, 0.5)), Everything);
}

TEST(ImageRectangle, OfAVolumeBesideTheEyeIsWhatTheNearPlaneLeaves)
{
  const double eye[] = { 45.0, 40.0, 4.0 }; // half of it is behind the eye
  const std::vector<int> image = ImageOf(PerspectiveView(eye, 4.0));
  EXPECT_EQ(image[0], 0);
  EXPECT_EQ(image[3], Height);
  // at a depth of 2 the nearest side is 2.5 to the left of each step ahead
  EXPECT_EQ(image[2], static_cast<int>(std::ceil(Width / 2.0 * (1.0 - 2.5 / 4.0) - 0.5)) + 1);
  const double ahead[] = { 30.0, 40.0, 1.0 };
  EXPECT_EQ(ImageOf(PerspectiveView(ahead, 4.0)), Nothing);
}

TEST(ImageRectangle, IsAllOfTheViewportWherePixelsAreSmallerThanRaysAreExact)
{
  ViewGeometry view = ParallelView();
  view.RayOrigin.Base[0] = 50.0; // out of sight, by how much is not known
  view.RayOrigin.PerX[0] = 1e-10;
  EXPECT_EQ(ImageOf(view), Everything);
  view.RayOrigin.PerX[0] = 1e-6;
  EXPECT_EQ(ImageOf(view), Nothing);
  view.RayOrigin.PerX[0] = 0.0;
  EXPECT_EQ(ImageOf(view), Everything);
  view.RayOrigin.PerX[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ImageOf(view), Everything);
}

TEST(ImageRectangle, HoldsAllRaysThatMeetTheVolume)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int large = 0, small = 0, empty = 0;
  for (int i = 0; i < 300; ++i)
  {
    const double eye[] = { 30.0 + 60.0 * uniform(random), 40.0 + 60.0 * uniform(random),
      10.0 + 30.0 * uniform(random) };
    ViewGeometry view = PerspectiveView(eye, std::exp(uniform(random)));
    FindImage(view);
    int left = Width, right = 0, bottom = Height, top = 0;
    for (int y = 0; y < Height; ++y)
    {
      for (int x = 0; x < Width; ++x)
      {
        if (Meets(view, x, y))
        {
          left = std::min(left, x);
          right = std::max(right, x + 1);
          bottom = std::min(bottom, y);
          top = std::max(top, y + 1);
        }
      }
    }
    const int* origin = view.ImageOrigin;
    const int* size = view.ImageSize;
    if (left < right)
    {
      // a pixel more to each side, and a box's corner may pass between the pixels' centres
      EXPECT_TRUE(origin[0] <= left && left <= origin[0] + 4) << i;
      EXPECT_TRUE(origin[1] <= bottom && bottom <= origin[1] + 4) << i;
      EXPECT_TRUE(right <= origin[0] + size[0] && origin[0] + size[0] <= right + 4) << i;
      EXPECT_TRUE(top <= origin[1] + size[1] && origin[1] + size[1] <= top + 4) << i;
    }
    large += size[0] * size[1] > Width * Height / 2;
    small += !IsEmpty(view) && size[0] * size[1] < Width * Height / 4;
    empty += IsEmpty(view);
  }
  EXPECT_GT(large, 0);
  EXPECT_GT(small, 10);
  EXPECT_GT(empty, 10);
}
