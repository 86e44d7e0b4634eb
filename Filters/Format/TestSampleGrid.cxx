// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Format/SampleGrid.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace
{
vtkSmartPointer<vtkImageData> Image()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(3, 12, -2, 9, 5, 20);
  image->SetSpacing(0.5, 0.1, 3.0);
  image->SetOrigin(100.0, -2.0, 1.0 / 3.0);
  image->SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1);
  return image;
}

struct Outcome
{
  bool Fits;
  int Shift[3];
};

// Finds the shift of an image that was changed.
Outcome Find(const std::function<void(vtkImageData*)>& change)
{
  const auto image = Image();
  const SampleGrid grid = SampleGrid::Of(image);
  change(image);
  Outcome outcome;
  const Status status = grid.FindShift(image, outcome.Shift);
  outcome.Fits = status.IsOk();
  for (const char* words :
    { "moved or resampled", "SetOrigin", "call vtkCompressedVolume::Place(" })
  {
    EXPECT_TRUE(status || status.GetMessage().find(words) != std::string::npos) << words;
  }
  return outcome;
}

void ExpectShift(const Outcome& outcome, int x, int y, int z)
{
  EXPECT_TRUE(outcome.Fits);
  EXPECT_TRUE(outcome.Shift[0] == x && outcome.Shift[1] == y && outcome.Shift[2] == z)
    << outcome.Shift[0] << " " << outcome.Shift[1] << " " << outcome.Shift[2];
}
}

TEST(SampleGrid, SamePlaces)
{
  ExpectShift(Find([](vtkImageData*) {}), 0, 0, 0);
  ExpectShift(Find([](vtkImageData* image) { image->SetExtent(4, 6, 0, 9, 5, 5); }), 0, 0, 0);
  // as a text with 11 digits tells them
  ExpectShift(Find([](vtkImageData* image) { image->SetOrigin(100, -2, 0.33333333333); }), 0, 0, 0);
  // the same axes, described otherwise
  const auto otherwise = [](vtkImageData* image)
  {
    image->SetSpacing(-0.5, 0.1, 3.0);
    image->SetDirectionMatrix(0, -1, 0, -1, 0, 0, 0, 0, 1);
  };
  ExpectShift(Find(otherwise), 0, 0, 0);
}

// Files and filters that count from 0 move the origin to the first sample.
TEST(SampleGrid, OtherIndices)
{
  const auto countFromZero = [](vtkImageData* image)
  {
    double first[3];
    image->TransformIndexToPhysicalPoint(3, -2, 5, first);
    image->SetOrigin(first);
    image->SetExtent(0, 9, 0, 11, 0, 15);
  };
  ExpectShift(Find(countFromZero), 3, -2, 5);
}

TEST(SampleGrid, OtherPlaces)
{
  const std::function<void(vtkImageData*)> changes[] = {
    [](vtkImageData* image) { image->SetSpacing(1.0, 0.2, 6.0); },
    [](vtkImageData* image) { image->SetSpacing(0.5, 0.101, 3.0); },
    [](vtkImageData* image) { image->SetOrigin(100.0, -2.0, 1.0); },
    [](vtkImageData* image) { image->SetSpacing(-0.5, 0.1, 3.0); },
    [](vtkImageData* image) { image->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1); },
    [](vtkImageData* image) { image->SetOrigin(1e300, -2.0, 0.0); },
  };
  for (const auto& change : changes)
  {
    EXPECT_FALSE(Find(change).Fits);
  }
}

// Whoever needs places says what is wrong with such a grid.
TEST(SampleGrid, NoPlaces)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ExpectShift(Find([=](vtkImageData* image) { image->SetOrigin(nan, 0, 0); }), 0, 0, 0);
  ExpectShift(Find([](vtkImageData* image) { image->SetSpacing(1, 0, 1); }), 0, 0, 0);
}
