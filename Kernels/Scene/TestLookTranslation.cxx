// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/LookTranslation.h"
#include "Scene/ShownIsovalues.h"

#include "vtkColorTransferFunction.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <gtest/gtest.h>

namespace
{
// Isovalues 1 to 4: hidden, translucent, opaque, and with an opacity beyond 1.
class LookTranslation : public testing::Test
{
protected:
  void SetUp() override
  {
    vtkContourValues* values = this->Property->GetIsoSurfaceValues();
    vtkPiecewiseFunction* opacity = this->Property->GetScalarOpacity();
    opacity->RemoveAllPoints();
    const double opacities[] = { 0.0, 0.25, 1.0, 1.5 };
    for (int i = 0; i < 4; ++i)
    {
      values->SetValue(i, i + 1.0);
      opacity->AddPoint(i + 1.0, opacities[i]);
    }
    vtkNew<vtkColorTransferFunction> color;
    color->AddRGBPoint(0.0, 0.0, 0.5, 1.0);
    color->AddRGBPoint(4.0, 1.0, 0.5, 0.0);
    this->Property->SetColor(color);
    this->Property->SetAmbient(0.5);
  }

  vtkNew<vtkVolumeProperty> Property;
  vtkNew<vtkCompressedVolume> Volume;
  vtkNew<vtkMatrix4x4> WorldToEye;
  PipelineScene Scene;
};
}

TEST_F(LookTranslation, ShowsIsovaluesThatAreNotTransparent)
{
  const std::vector<ShownIsovalue> shown = FindShownIsovalues(this->Property);
  ASSERT_EQ(shown.size(), 3u);
  EXPECT_EQ(shown[0].Value, 2.0);
  EXPECT_EQ(shown[0].Opacity, 0.25);
  EXPECT_EQ(shown[2].Value, 4.0);
  EXPECT_EQ(shown[2].Opacity, 1.0);
  EXPECT_TRUE(HasTranslucent(shown));
  EXPECT_FALSE(HasTranslucent({ { 3.0, 1.0 } }));
  EXPECT_FALSE(HasTranslucent({}));
}

TEST_F(LookTranslation, IsovaluesComeInTheUnitsOfTheStream)
{
  this->Volume->SetOffset(-1e8);
  this->Volume->SetScale(0.125);
  TranslateIsovalues(this->Property, this->Volume, this->Scene);
  ASSERT_EQ(this->Scene.View.NumberOfIsovalues, 3);
  for (int i = 0; i < 3; ++i)
  {
    const glsl::FloatSum& isovalue = this->Scene.View.Isovalues[i];
    EXPECT_EQ(double(isovalue.High) + isovalue.Low, (i + 2.0 + 1e8) * 8.0);
  }
  EXPECT_TRUE(this->Scene.Translucent);
  EXPECT_EQ(this->Scene.Look.Colors[0].Opacity, 0.25f);
  EXPECT_EQ(this->Scene.Look.Colors[0].Rgb[0], 0.5f);
  EXPECT_EQ(this->Scene.Look.Colors[2].Rgb[0], 1.0f);
  EXPECT_EQ(this->Scene.Look.Colors[2].Rgb[2], 0.0f);
}

TEST_F(LookTranslation, WithoutIsovaluesRaysAreEmpty)
{
  this->Property->GetIsoSurfaceValues()->SetNumberOfContours(1);
  this->Scene.View.FarDistance = 100.0;
  TranslateIsovalues(this->Property, this->Volume, this->Scene);
  EXPECT_EQ(this->Scene.View.NumberOfIsovalues, 0);
  EXPECT_GT(this->Scene.View.NearDistance, this->Scene.View.FarDistance);
  EXPECT_FALSE(this->Scene.Translucent);
}

TEST_F(LookTranslation, LightsThatAreOffDoNotCount)
{
  vtkNew<vtkLightCollection> lights;
  vtkNew<vtkLight> off, sun, spot;
  off->SwitchOff();
  sun->SetPosition(0.0, 0.0, 5.0);
  sun->SetFocalPoint(0.0, 0.0, 0.0);
  sun->SetIntensity(0.5);
  spot->SetPositional(true);
  spot->SetPosition(1.0, 2.0, 3.0);
  spot->SetConeAngle(60.0);
  lights->AddItem(off);
  lights->AddItem(sun);
  lights->AddItem(spot);
  TranslateShading(lights, glsl::TWO_SIDED, this->WorldToEye, this->Scene);
  const glsl::Look& look = this->Scene.Look;
  ASSERT_EQ(look.NumberOfLights, 2);
  EXPECT_EQ(look.LitSides, glsl::TWO_SIDED);
  EXPECT_EQ(look.Lights[0].IsPositional, 0);
  EXPECT_EQ(look.Lights[0].Position[2], 1.0f); // the direction towards the light
  EXPECT_EQ(look.Lights[0].Diffuse[0], 0.5f);
  EXPECT_EQ(look.Lights[0].IsSpot, 0);
  EXPECT_EQ(look.Lights[1].IsPositional, 1);
  EXPECT_EQ(look.Lights[1].Position[1], 2.0f);
  EXPECT_EQ(look.Lights[1].IsSpot, 1);
  EXPECT_NEAR(look.Lights[1].ConeCosine, 0.5, 1e-7);
}

TEST_F(LookTranslation, InTheDarkAmbientLightIsLeft)
{
  TranslateIsovalues(this->Property, this->Volume, this->Scene);
  TranslateMaterial(this->Property, this->Scene.Look);
  vtkNew<vtkLightCollection> lights;
  TranslateShading(lights, glsl::ONE_SIDED, this->WorldToEye, this->Scene);
  EXPECT_EQ(this->Scene.Look.NumberOfLights, 0);
  EXPECT_EQ(this->Scene.Look.LitSides, glsl::ONE_SIDED);
  EXPECT_EQ(this->Scene.Look.Colors[0].Rgb[1], 0.25f);
}

TEST_F(LookTranslation, LikeMeshesDiffuseLightIsLeftToo)
{
  TranslateIsovalues(this->Property, this->Volume, this->Scene);
  this->Scene.Look.Ambient = 0.25f;
  this->Scene.Look.Diffuse = 0.5f;
  const float color = this->Scene.Look.Colors[0].Rgb[1];
  vtkNew<vtkLightCollection> lights;
  TranslateShading(lights, glsl::LIT_LIKE_MESHES, this->WorldToEye, this->Scene);
  EXPECT_EQ(this->Scene.Look.Colors[0].Rgb[1], 0.75f * color);
}
