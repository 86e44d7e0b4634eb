// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/RegionTranslation.h"

#include "vtkCompressedVolume.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkVolume.h"

#include <gtest/gtest.h>

namespace
{
// 11 x 21 x 31 points from index (5, 0, 0) on, of 2 x 1 x 0.5, with the origin at (100, 0, 0).
class RegionTranslation : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Image->SetExtent(5, 15, 0, 20, 0, 30);
    this->Image->SetSpacing(2.0, 1.0, 0.5);
    this->Image->SetOrigin(100.0, 0.0, 0.0);
    this->UsePoints();
  }

  void UsePoints()
  {
    const int dims[3] = { 11, 21, 31 };
    this->Volume->SetExtent(this->Image->GetExtent());
    this->Volume->SetDimensions(dims);
    this->Volume->SetAssociation(vtkCompressedVolume::PointData);
  }

  void UseCells()
  {
    const int dims[3] = { 10, 20, 30 };
    this->Volume->SetDimensions(dims);
    this->Volume->SetAssociation(vtkCompressedVolume::CellData);
  }

  vtkNew<vtkImageData> Image;
  vtkNew<vtkCompressedVolume> Volume;
  ViewGeometry View = {};
};

void ExpectPoint(vtkMatrix4x4* matrix, const double from[3], double x, double y, double z)
{
  double point[4] = { from[0], from[1], from[2], 1.0 };
  matrix->MultiplyPoint(point, point);
  EXPECT_DOUBLE_EQ(point[0], x);
  EXPECT_DOUBLE_EQ(point[1], y);
  EXPECT_DOUBLE_EQ(point[2], z);
}
}

TEST_F(RegionTranslation, FirstSampleIsTheOriginOfIndexSpace)
{
  vtkNew<vtkVolume> prop;
  prop->SetPosition(0.0, 7.0, 0.0);
  vtkNew<vtkMatrix4x4> indexToWorld;
  const double first[3] = { 0.0, 0.0, 0.0 }, other[3] = { 1.0, 2.0, 4.0 };
  FindIndexToWorld(prop, this->Image, this->Volume, indexToWorld);
  ExpectPoint(indexToWorld, first, 110.0, 7.0, 0.0);
  ExpectPoint(indexToWorld, other, 112.0, 9.0, 2.0);
  this->UseCells(); // whose samples lie in their middle
  FindIndexToWorld(prop, this->Image, this->Volume, indexToWorld);
  ExpectPoint(indexToWorld, first, 111.0, 7.5, 0.25);
}

TEST_F(RegionTranslation, DrawsTheImagesPartOfTheStream)
{
  const int covered[6] = { 4, 19, 0, 20, 0, 30 };
  const int dims[3] = { 16, 21, 31 };
  this->Volume->SetExtent(covered);
  this->Volume->SetDimensions(dims);
  TranslateExtent(this->Image, this->Volume, this->View);
  EXPECT_EQ(this->View.FirstDrawn[0], 1);
  EXPECT_EQ(this->View.LastDrawn[0], 11);
  EXPECT_EQ(this->View.FirstDrawn[1], 0);
  EXPECT_EQ(this->View.LastDrawn[1], 20);
}

TEST_F(RegionTranslation, DrawsNoFurtherThanTheLastCell)
{
  this->UseCells();
  TranslateExtent(this->Image, this->Volume, this->View);
  EXPECT_EQ(this->View.LastDrawn[0], 9);
  EXPECT_EQ(this->View.LastDrawn[2], 29);
}

TEST_F(RegionTranslation, ClippingPlanesKeepTheirSides)
{
  vtkNew<vtkVolume> prop;
  vtkNew<vtkMatrix4x4> worldToIndex;
  FindIndexToWorld(prop, this->Image, this->Volume, worldToIndex);
  worldToIndex->Invert();
  vtkNew<vtkPlaneCollection> planes;
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(114.0, 0.0, 0.0); // index 2
  plane->SetNormal(1.0, 0.0, 0.0);
  planes->AddItem(plane);
  TranslateClipping(planes, worldToIndex, this->View);
  ASSERT_EQ(this->View.NumberOfClippingPlanes, 1);
  const ClippingPlane& translated = this->View.ClippingPlanes[0];
  EXPECT_NEAR(translated.Normal[0] * 2.0 + translated.Offset, 0.0, 1e-12);
  EXPECT_GT(translated.Normal[0] * 3.0 + translated.Offset, 0.0);
  EXPECT_NEAR(translated.Normal[1], 0.0, 1e-12);
}

TEST_F(RegionTranslation, NoPlanesClipNothing)
{
  vtkNew<vtkMatrix4x4> identity;
  TranslateClipping(nullptr, identity, this->View);
  EXPECT_EQ(this->View.NumberOfClippingPlanes, 0);
}

TEST_F(RegionTranslation, AllRegionsAreDrawnWithoutCropping)
{
  vtkNew<vtkProgressiveIsosurfaceMapper> mapper;
  mapper->SetCroppingRegionFlags(1);
  TranslateCropping(mapper, this->Image, this->Volume, this->View);
  EXPECT_EQ(this->View.DrawnRegions, glsl::ALL_REGIONS);
}

TEST_F(RegionTranslation, CroppingLiesInTheImagesAxes)
{
  vtkNew<vtkProgressiveIsosurfaceMapper> mapper;
  mapper->CroppingOn();
  mapper->SetCroppingRegionFlags(VTK_CROP_SUBVOLUME);
  mapper->SetCroppingRegionPlanes(114.0, 118.0, 3.0, 9.0, 1.0, 2.0);
  TranslateCropping(mapper, this->Image, this->Volume, this->View);
  EXPECT_EQ(this->View.DrawnRegions, VTK_CROP_SUBVOLUME);
  EXPECT_DOUBLE_EQ(this->View.CroppingLow[0], 2.0);
  EXPECT_DOUBLE_EQ(this->View.CroppingHigh[0], 4.0);
  EXPECT_DOUBLE_EQ(this->View.CroppingLow[1], 3.0);
  EXPECT_DOUBLE_EQ(this->View.CroppingHigh[2], 4.0);
}

TEST_F(RegionTranslation, NegativeSpacingSwapsTheCroppingPlanes)
{
  vtkNew<vtkProgressiveIsosurfaceMapper> mapper;
  mapper->CroppingOn();
  mapper->SetCroppingRegionPlanes(82.0, 86.0, 0.0, 1.0, 0.0, 1.0);
  this->Image->SetSpacing(-2.0, 1.0, 0.5);
  TranslateCropping(mapper, this->Image, this->Volume, this->View);
  EXPECT_DOUBLE_EQ(this->View.CroppingLow[0], 2.0);
  EXPECT_DOUBLE_EQ(this->View.CroppingHigh[0], 4.0);
}
