// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/InputArrays.h"

#include "vtkAbstractMapper.h"
#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
// 8 x 8 x 8 points without arrays.
class InputArraysOfImage : public testing::Test
{
protected:
  void SetUp() override { this->Image->SetDimensions(8, 8, 8); }

  void AddPoints(const char* name) { AddRamp(this->Image->GetPointData(), name, 8 * 8 * 8); }
  void AddCells(const char* name) { AddRamp(this->Image->GetCellData(), name, 7 * 7 * 7); }

  static void AddRamp(vtkDataSetAttributes* attributes, const char* name, vtkIdType count)
  {
    vtkNew<vtkFloatArray> array;
    array->SetName(name);
    for (vtkIdType i = 0; i < count; ++i)
    {
      array->InsertNextValue(static_cast<float>(i));
    }
    attributes->AddArray(array);
  }

  void ExpectValues(const char* name, int association)
  {
    const Status status = this->Inputs.UpdateValues(this->Choice, this->Image);
    ASSERT_TRUE(status) << status.GetMessage();
    vtkCompressedVolume* volume = this->Inputs.GetValues().GetVolume();
    EXPECT_EQ(volume->GetArrayName(), name);
    EXPECT_EQ(volume->GetAssociation(), association);
  }

  static void ExpectError(const Status& status, const char* text)
  {
    EXPECT_FALSE(status);
    EXPECT_NE(status.GetMessage().find(text), std::string::npos) << status.GetMessage();
  }

  vtkNew<vtkImageData> Image;
  ArrayChoice Choice;
  InputArrays Inputs;
};
}

TEST_F(InputArraysOfImage, ActiveScalarsGoBeforeFirstArrays)
{
  this->AddCells("cells");
  this->ExpectValues("cells", vtkCompressedVolume::CellData);
  this->AddPoints("first");
  this->AddPoints("second");
  this->ExpectValues("first", vtkCompressedVolume::PointData);
  this->Image->GetCellData()->SetActiveScalars("cells");
  this->ExpectValues("cells", vtkCompressedVolume::CellData);
  this->Image->GetPointData()->SetActiveScalars("second");
  this->ExpectValues("second", vtkCompressedVolume::PointData);
}

TEST_F(InputArraysOfImage, AChosenArrayGoesBeforeTheDefault)
{
  this->AddPoints("points");
  this->AddCells("cells");
  this->Choice.ScalarMode = VTK_SCALAR_MODE_USE_CELL_FIELD_DATA;
  this->Choice.ArrayAccessMode = VTK_GET_ARRAY_BY_NAME;
  this->Choice.ArrayName = "cells";
  this->ExpectValues("cells", vtkCompressedVolume::CellData);
  this->Choice.ArrayName = "none";
  ExpectError(this->Inputs.UpdateValues(this->Choice, this->Image), "no scalars");
}

TEST_F(InputArraysOfImage, TakesCompressedVolumesAsTheyAre)
{
  this->AddPoints("points");
  this->ExpectValues("points", vtkCompressedVolume::PointData);
  vtkImageData* compressed = this->Inputs.GetValues().GetImage();
  InputArrays others;
  ASSERT_TRUE(others.UpdateValues(this->Choice, compressed));
  EXPECT_EQ(others.GetValues().GetImage(), compressed);
}

TEST_F(InputArraysOfImage, CompressesAgainOnlyAfterAChange)
{
  this->AddPoints("points");
  this->ExpectValues("points", vtkCompressedVolume::PointData);
  const vtkMTimeType time = this->Inputs.GetTime();
  this->ExpectValues("points", vtkCompressedVolume::PointData);
  EXPECT_EQ(this->Inputs.GetTime(), time);
  this->Choice.Rate = 4.0;
  this->ExpectValues("points", vtkCompressedVolume::PointData);
  EXPECT_GT(this->Inputs.GetTime(), time);
  EXPECT_EQ(this->Inputs.GetValues().GetVolume()->GetRate(), 4.0);
}

TEST_F(InputArraysOfImage, TellsWhyAnArrayCannotBeCompressed)
{
  this->AddPoints("points");
  this->Image->GetPointData()->GetArray("points")->SetTuple1(
    0, std::numeric_limits<double>::quiet_NaN());
  this->Choice.MaskNonFinite = false;
  const Status status = this->Inputs.UpdateValues(this->Choice, this->Image);
  ExpectError(status, "finite");
  EXPECT_EQ(status.GetMessage().find("ERROR"), std::string::npos) << status.GetMessage();
  EXPECT_EQ(this->Inputs.GetValues().GetImage(), nullptr);
  this->Choice.MaskNonFinite = true;
  this->ExpectValues("points", vtkCompressedVolume::PointData);
}

TEST_F(InputArraysOfImage, TriesAgainWhatFailedOnlyAfterAChange)
{
  this->AddPoints("points");
  this->Choice.Component = 1;
  const auto fails = [this]() { return this->Inputs.UpdateValues(this->Choice, this->Image); };
  ExpectError(fails(), "Component is 1");
  const vtkMTimeType time = this->Inputs.GetTime();
  ExpectError(fails(), "Component is 1");
  EXPECT_EQ(this->Inputs.GetTime(), time);
  this->Choice.Component = 2;
  ExpectError(fails(), "Component is 2");
  EXPECT_GT(this->Inputs.GetTime(), time);
  this->Choice.Component = 0;
  this->ExpectValues("points", vtkCompressedVolume::PointData);
  vtkDataArray* array = this->Image->GetPointData()->GetArray("points");
  this->Choice.MaskNonFinite = false;
  array->SetTuple1(0, std::numeric_limits<double>::infinity());
  array->Modified();
  ExpectError(fails(), "1 infinite");
  array->SetTuple1(0, 5.0);
  array->Modified();
  this->ExpectValues("points", vtkCompressedVolume::PointData);
}

TEST_F(InputArraysOfImage, ColorsAreAnArrayOfTheSameImage)
{
  this->AddPoints("points");
  this->AddPoints("colors");
  this->AddCells("cells");
  this->ExpectValues("points", vtkCompressedVolume::PointData);
  EXPECT_EQ(this->Inputs.Describe().Colors.BlockBits, 0);
  this->Choice.ColorArrayName = "colors";
  ASSERT_TRUE(this->Inputs.UpdateColorsFromArray(this->Choice, this->Image));
  EXPECT_EQ(this->Inputs.GetColors().GetVolume()->GetArrayName(), "colors");
  EXPECT_EQ(this->Inputs.Describe().Colors.BlockBits, 8 * 64);
  this->Choice.ColorArrayName = "cells"; // not where the values are
  ExpectError(this->Inputs.UpdateColorsFromArray(this->Choice, this->Image), "\"cells\"");
  this->Inputs.RemoveColors();
  EXPECT_EQ(this->Inputs.GetColors().GetImage(), nullptr);
}

TEST_F(InputArraysOfImage, AnotherImageOfColorsNeedsTheSameSamples)
{
  this->AddPoints("points");
  this->ExpectValues("points", vtkCompressedVolume::PointData);
  EXPECT_TRUE(this->Inputs.UpdateColorsFromImage(this->Choice, this->Image));
  vtkNew<vtkImageData> other;
  ExpectError(this->Inputs.UpdateColorsFromImage(this->Choice, nullptr), "no scalars");
  other->SetDimensions(8, 8, 4);
  AddRamp(other->GetPointData(), "other", 8 * 8 * 4);
  ExpectError(this->Inputs.UpdateColorsFromImage(this->Choice, other), "dimensions");
}
