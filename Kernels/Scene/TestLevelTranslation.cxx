// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/LevelTranslation.h"

#include "Pipeline/FixedView.h"
#include "Pipeline/TestViews.h"

#include "vtkMatrix4x4.h"
#include "vtkNew.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
const double Octave = std::pow(2.0, 0.25); // a quarter of one
const std::vector<LevelSteps> Cubes = { { 1, 1, 1 }, { 2, 2, 2 }, { 4, 4, 4 }, { 8, 8, 8 } };

// Pixels are 1/100 of the depth apart, the volume's samples 1.
ViewGeometry PerspectiveView()
{
  ViewGeometry view = MakeParallelView(16, 16);
  view.EyeOrigin = {};
  view.EyeDirection = { { 0.0, 0.0, -1.0 }, { 0.01, 0.0, 0.0 }, { 0.0, 0.01, 0.0 } };
  return view;
}

ViewGeometry ParallelView(double pitch)
{
  ViewGeometry view = MakeParallelView(16, 16);
  view.EyeOrigin.PerX[0] = view.EyeOrigin.PerY[1] = pitch;
  return view;
}

void Translate(
  const std::vector<LevelSteps>& levels, double pixels, ViewGeometry& view, double stretch = 1.0)
{
  vtkNew<vtkMatrix4x4> eyeToIndex;
  eyeToIndex->SetElement(2, 2, 1.0 / stretch);
  TranslateLevels(eyeToIndex, levels, pixels, view);
}
}

TEST(LevelTranslation, ALevelBeginsWhereItsSamplesAreAPixelApart)
{
  ViewGeometry view = PerspectiveView();
  Translate(Cubes, 1.0, view);
  ASSERT_EQ(view.NumberOfLevels, 4);
  for (int level = 0; level < 3; ++level)
  {
    const double until = 200.0 * (1 << level);
    EXPECT_NEAR(view.Levels[level].Until, until, 1e-9);
    EXPECT_NEAR(view.Levels[level].BlendFrom, until / Octave, 1e-9);
    EXPECT_EQ(view.Levels[level].FirstWeight, 0.0);
    EXPECT_EQ(view.Levels[level].LastWeight, 1.0);
    EXPECT_EQ(LevelAtDepth(view, until * 0.999), level);
    EXPECT_EQ(LevelAtDepth(view, until), level + 1);
  }
  EXPECT_EQ(view.Levels[3].Until, EndlessDepth);
  EXPECT_EQ(LevelAtDepth(view, 1e9), 3);
}

TEST(LevelTranslation, ATolerancePutsThemNearer)
{
  ViewGeometry view = PerspectiveView();
  Translate(Cubes, 4.0, view);
  EXPECT_NEAR(view.Levels[0].Until, 50.0, 1e-9);
}

TEST(LevelTranslation, TheAxisWithTheFarthestSamplesCounts)
{
  ViewGeometry view = PerspectiveView();
  Translate({ { 1, 1, 1 }, { 2, 2, 1 }, { 4, 4, 2 } }, 1.0, view, 3.0);
  EXPECT_NEAR(view.Levels[0].Until, 300.0, 1e-9); // level 1 is as coarse as the volume along z
  EXPECT_NEAR(view.Levels[1].Until, 600.0, 1e-9);
}

// Level 1 is no coarser along z than level 0, and neither is level 2: each still has time to blend.
TEST(LevelTranslation, NoLevelIsLeftOut)
{
  ViewGeometry view = PerspectiveView();
  Translate({ { 1, 1, 1 }, { 2, 2, 1 }, { 4, 4, 1 }, { 8, 8, 2 } }, 1.0, view, 5.0);
  EXPECT_NEAR(view.Levels[0].Until, 500.0, 1e-9);
  EXPECT_NEAR(view.Levels[1].BlendFrom, 500.0, 1e-9);
  EXPECT_NEAR(view.Levels[1].Until, 500.0 * Octave, 1e-9);
  EXPECT_NEAR(view.Levels[2].Until, 1000.0, 1e-9);
}

TEST(LevelTranslation, InParallelProjectionAllDepthsHaveTheSame)
{
  ViewGeometry view = ParallelView(1.9);
  Translate(Cubes, 1.0, view);
  const double first = 2.0 / Octave;
  for (const double depth : { -1e6, 0.0, 1e6 })
  {
    EXPECT_EQ(LevelAtDepth(view, depth), 0);
  }
  EXPECT_LT(view.Levels[0].BlendFrom, -1e200);
  EXPECT_NEAR(view.Levels[0].FirstWeight, (1.9 - first) / (2.0 - first), 1e-9);
  EXPECT_EQ(view.Levels[0].FirstWeight, view.Levels[0].LastWeight);

  view = ParallelView(2.0);
  Translate(Cubes, 1.0, view);
  EXPECT_EQ(LevelAtDepth(view, 0.0), 1);
  EXPECT_EQ(view.Levels[1].BlendFrom, EndlessDepth); // alone
}

TEST(LevelTranslation, WithoutLevelsTheVolumeIsDrawnAtAllDepths)
{
  ViewGeometry view = PerspectiveView();
  TranslateNoLevels(view);
  EXPECT_EQ(view.NumberOfLevels, 1);
  EXPECT_EQ(LevelAtDepth(view, 1e200), 0);
}

// What rays compare their parameters with; weights at what is cut off.
TEST(LevelTranslation, SpansAreFixedWithinTheWay)
{
  ViewGeometry view = ParallelView(1.0);
  view.LastDrawn[0] = view.LastDrawn[1] = 16;
  view.LastDrawn[2] = 4; // depths from 6 to 10
  view.NumberOfLevels = 3;
  view.Levels[0] = { 2.0, 7.0, 0.0, 1.0 };
  view.Levels[1] = { 9.0, 13.0, 0.0, 1.0 };
  view.Levels[2] = { EndlessDepth, EndlessDepth, 0.0, 0.0 };
  const glsl::View fixed = FixView(view);
  const auto way = [](std::int32_t high, std::uint32_t low)
  {
    return std::ldexp(double(high), 32 - glsl::WAY_BITS) + std::ldexp(double(low), -glsl::WAY_BITS);
  };
  EXPECT_EQ(way(fixed.Levels[0].BlendHigh, fixed.Levels[0].BlendLow), 0.0);
  EXPECT_NEAR(fixed.Levels[0].FirstWeight, 0.8, 1e-5); // at depth 6
  EXPECT_NEAR(way(fixed.Levels[0].UntilHigh, fixed.Levels[0].UntilLow), 0.25, 1e-5);
  EXPECT_EQ(fixed.Levels[0].LastWeight, 1.0f);
  EXPECT_NEAR(way(fixed.Levels[1].BlendHigh, fixed.Levels[1].BlendLow), 0.75, 1e-5);
  EXPECT_EQ(fixed.Levels[1].FirstWeight, 0.0f);
  EXPECT_GE(way(fixed.Levels[1].UntilHigh, fixed.Levels[1].UntilLow), 1.0); // behind the end
  EXPECT_NEAR(fixed.Levels[1].LastWeight, 0.25, 1e-5);
  EXPECT_GE(way(fixed.Levels[2].BlendHigh, fixed.Levels[2].BlendLow), 1.0);
}

TEST(LevelTranslation, CountsPixelsByLevelAndFlags)
{
  PipelineScene scene;
  scene.View = ParallelView(1.0);
  scene.View.LastDrawn[2] = 4;
  scene.View.NumberOfLevels = 2;
  scene.View.Levels[0] = { 7.0, 8.0, 0.0, 1.0 };
  scene.View.Levels[1] = { EndlessDepth, EndlessDepth, 0.0, 0.0 };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // near and far hits, each without and with a flag; misses: without, and with
  const std::vector<std::uint32_t> keys = { 1u << 30, 1u << 30, 3u << 30, 3u << 30, glsl::NO_HIT,
    glsl::NO_HIT };
  const std::vector<float> depths = { 7.0f, -7.0f, 9.0f, -9.0f, -nan, -0.0f };
  PixelsOfLevels counts = CountLevels(scene, keys, depths);
  EXPECT_EQ(counts.Pixels, (std::vector<std::int64_t>{ 2, 2 }));
  EXPECT_DOUBLE_EQ(counts.UncertainFraction, 3.0 / 6.0);
  scene.Conservative = true; // then a flag tells of a hit on the volume itself
  counts = CountLevels(scene, keys, depths);
  EXPECT_EQ(counts.Pixels, (std::vector<std::int64_t>{ 3, 1 }));
  EXPECT_EQ(counts.UncertainFraction, 0.0);
}
