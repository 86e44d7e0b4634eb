// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ViewState.h"

#include "vtkNew.h"
#include "vtkRenderer.h"

#include <gtest/gtest.h>

#include <optional>

namespace
{
class ViewStateOfRenders : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Scene.View.ViewportSize[0] = 20;
    this->Scene.View.ViewportSize[1] = 10;
    this->Scene.View.RayDirection.Base[2] = -1.0;
    this->Scene.View.FarDistance = 100.0;
  }

  bool GoesOn()
  {
    return this->State.Update(this->Renderer, this->Scene, this->Props, this->Palette);
  }

  vtkNew<vtkRenderer> Renderer;
  PipelineScene Scene;
  Obstacles Props;
  std::optional<glsl::Palette> Palette;
  ViewState State;
};
}

TEST_F(ViewStateOfRenders, TheSameSceneGoesOn)
{
  EXPECT_FALSE(this->State.IsKnown());
  EXPECT_FALSE(this->GoesOn());
  EXPECT_TRUE(this->GoesOn());
  EXPECT_TRUE(this->State.IsOf(this->Renderer));
  this->State.Forget();
  EXPECT_FALSE(this->State.IsKnown());
  EXPECT_FALSE(this->GoesOn());
}

TEST_F(ViewStateOfRenders, RoundingOfTheCameraGoesOnWithTheFirstRays)
{
  this->GoesOn();
  this->Scene.View.RayDirection.Base[2] = -1.0 - 1e-9;
  EXPECT_TRUE(this->GoesOn());
  EXPECT_EQ(this->State.GetScene().View.RayDirection.Base[2], -1.0);
  this->Scene.View.RayDirection.Base[2] = -1.0 - 1e-6;
  EXPECT_FALSE(this->GoesOn());
}

TEST_F(ViewStateOfRenders, TheImageIsThatOfTheFirstRays)
{
  this->Scene.View.ImageSize[0] = 5;
  this->GoesOn();
  this->Scene.View.RayDirection.Base[2] = -1.0 - 1e-9;
  this->Scene.View.ImageSize[0] = 6; // by rounding
  this->Scene.View.ImageOrigin[1] = 1;
  EXPECT_TRUE(this->GoesOn());
  EXPECT_EQ(this->State.GetScene().View.ImageSize[0], 5);
  EXPECT_EQ(this->State.GetScene().View.ImageOrigin[1], 0);
  this->Scene.View.ViewportOrigin[0] = 1;
  EXPECT_FALSE(this->GoesOn());
}

TEST_F(ViewStateOfRenders, AnyOtherChangeOfTheViewRestarts)
{
  this->GoesOn();
  this->Scene.View.DrawnRegions = 1;
  EXPECT_FALSE(this->GoesOn());
  this->Scene.View.Isovalues[15].Low = 1e-30f;
  EXPECT_FALSE(this->GoesOn());
  this->Scene.View.FirstDrawn[1] = 1;
  EXPECT_FALSE(this->GoesOn());
  EXPECT_TRUE(this->GoesOn());
}

TEST_F(ViewStateOfRenders, ANewLookRestartsOnlyTranslucentImages)
{
  this->GoesOn();
  this->Scene.Look.Ambient = 0.5f;
  EXPECT_TRUE(this->GoesOn());
  EXPECT_EQ(this->State.GetScene().Look.Ambient, 0.5f);
  this->Scene.Translucent = true;
  this->GoesOn();
  this->Scene.Look.Ambient = 0.75f;
  EXPECT_FALSE(this->GoesOn());
  this->Palette.emplace();
  EXPECT_FALSE(this->GoesOn());
  this->Props.Time = 7;
  EXPECT_FALSE(this->GoesOn());
  EXPECT_TRUE(this->GoesOn());
}

TEST_F(ViewStateOfRenders, TellsOfANewPalette)
{
  this->GoesOn();
  EXPECT_TRUE(this->State.HasNewPalette());
  this->GoesOn();
  EXPECT_FALSE(this->State.HasNewPalette());
  this->Palette.emplace();
  EXPECT_TRUE(this->GoesOn());
  EXPECT_TRUE(this->State.HasNewPalette());
  this->Palette->Tolerance = 1.0f;
  EXPECT_TRUE(this->GoesOn());
  EXPECT_TRUE(this->State.HasNewPalette());
  EXPECT_TRUE(this->GoesOn());
  EXPECT_FALSE(this->State.HasNewPalette());
}

TEST_F(ViewStateOfRenders, ViewsThatTakeTurnsAreNotSettled)
{
  this->GoesOn();
  EXPECT_TRUE(this->State.IsSettled());
  vtkNew<vtkRenderer> other;
  EXPECT_FALSE(this->State.Update(other, this->Scene, this->Props, this->Palette));
  EXPECT_FALSE(this->State.IsSettled());
  EXPECT_FALSE(this->GoesOn());
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_FALSE(this->State.IsSettled());
    EXPECT_TRUE(this->GoesOn());
  }
  EXPECT_TRUE(this->State.IsSettled());
}
