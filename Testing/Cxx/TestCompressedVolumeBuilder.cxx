// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkCompressedVolumeBuilder against one call of libzfp, for slabs of different sizes; and its
// errors.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkCompressedVolumeBuilder.h>
#include <vtkDoubleArray.h>

#include <cmath>

namespace
{
using namespace test;

// Makes slices [first, last) of an array of three components, the second of which has the values.
vtkSmartPointer<vtkFloatArray> Slab(
  const Dims& dims, const std::vector<float>& values, int first, int last)
{
  const vtkIdType perSlice = static_cast<vtkIdType>(dims[0]) * dims[1];
  auto slab = vtkSmartPointer<vtkFloatArray>::New();
  slab->SetName("density");
  slab->SetNumberOfComponents(3);
  slab->SetNumberOfTuples((last - first) * perSlice);
  slab->Fill(-1.0);
  for (vtkIdType i = 0; i < slab->GetNumberOfTuples(); ++i)
  {
    slab->SetTypedComponent(i, 1, values[first * perSlice + i]);
  }
  return slab;
}

//------------------------------------------------------------------------------
void ExpectReference(const Dims& dims, double rate, int depth)
{
  const std::vector<float> values = Samples(dims);
  vtkNew<vtkCompressedVolumeBuilder> builder;
  EXPECT_TRUE(builder->Start(dims.data(), rate)) << builder->GetErrorMessage();
  for (int z = 0; z < dims[2]; z += depth)
  {
    const int last = std::min(z + depth, dims[2]);
    EXPECT_TRUE(builder->AddSlab(Slab(dims, values, z, last), 1)) << builder->GetErrorMessage();
    EXPECT_TRUE(builder->GetNumberOfSlices() == last) << builder->GetNumberOfSlices();
  }
  vtkNew<vtkImageData> image;
  image->SetSpacing(1, 2, 3);
  EXPECT_TRUE(builder->Finish(image)) << builder->GetErrorMessage();

  vtkNew<vtkCompressedVolume> volume;
  EXPECT_TRUE(volume->Read(image)) << volume->GetErrorMessage();
  EXPECT_TRUE(Reference(dims, values, rate).Equals(volume->GetStream())) << "depth " << depth;
  const auto range = std::minmax_element(values.begin(), values.end());
  EXPECT_TRUE(volume->GetRange()[0] == *range.first && volume->GetRange()[1] == *range.second)
    << rate;
  EXPECT_TRUE(volume->GetArrayName() == "density" && volume->GetComponent() == 1 &&
    volume->GetScalarType() == VTK_FLOAT && volume->GetAssociation() == 0)
    << "metadata";
  EXPECT_TRUE(image->GetSpacing()[2] == 3.0 && image->GetDimensions()[1] == dims[1]) << "geometry";
}

//------------------------------------------------------------------------------
// Expects an error with these words, and that nothing succeeds until the next Start().
void ExpectRefusal(vtkCompressedVolumeBuilder* builder, bool result, const std::string& words)
{
  EXPECT_TRUE(!result && builder->GetErrorMessage().find(words) != std::string::npos)
    << words << " not in: " << builder->GetErrorMessage();
  vtkNew<vtkImageData> image;
  EXPECT_TRUE(!builder->Finish(image) && !builder->GetErrorMessage().empty()) << words;
  EXPECT_FALSE(vtkCompressedVolume::IsCompressed(image)) << words;
}

//------------------------------------------------------------------------------
TEST(CompressedVolumeBuilder, Refusals)
{
  const Dims dims = { 5, 6, 9 };
  const int flat[3] = { 5, 6, 1 };
  const std::vector<float> values = Samples(dims);
  const auto all = Slab(dims, values, 0, 9);
  const auto four = Slab(dims, values, 0, 4);
  vtkNew<vtkCompressedVolumeBuilder> builder;
  ExpectRefusal(builder, builder->AddSlab(all), "started");
  ExpectRefusal(builder, builder->Start(dims.data(), 33.0), "33");
  ExpectRefusal(builder, builder->Start(flat, 8.0), "5 x 6 x 1");

  const auto refuses = [&](vtkDataArray* slab, int component, const char* words)
  {
    builder->Start(dims.data(), 8.0);
    EXPECT_TRUE(builder->AddSlab(four)) << builder->GetErrorMessage();
    ExpectRefusal(builder, builder->AddSlab(slab, component), words);
  };
  refuses(all, 0, "9 slices where 5 are left");
  refuses(Slab(dims, values, 4, 7), 0, "multiple of 4");
  refuses(four, 3, "omponent");
  refuses(nullptr, 0, "0 samples");
  vtkNew<vtkDoubleArray> odd;
  odd->SetNumberOfValues(31);
  refuses(odd, 0, "5 x 6");
  odd->SetNumberOfValues(120);
  refuses(odd, 0, "double");
  const auto bad = Slab(dims, values, 4, 8);
  bad->SetValue(7, std::nanf(""));
  bad->SetValue(10, -HUGE_VALF);
  builder->MaskNonFiniteOff();
  refuses(bad, 1, "Slices 4 to 7 have 1 NaN and 1 infinite");

  builder->Start(dims.data(), 8.0);
  EXPECT_TRUE(builder->AddSlab(four)) << builder->GetErrorMessage();
  vtkNew<vtkImageData> image;
  ExpectRefusal(builder, builder->Finish(image), "4 slices of 9");

  builder->Start(dims.data(), 8.0);
  all->Fill(1e-31);
  EXPECT_TRUE(builder->AddSlab(all)) << builder->GetErrorMessage();
  ExpectRefusal(builder, builder->Finish(image), "too small");
}

//------------------------------------------------------------------------------
TEST(CompressedVolumeBuilder, EqualsReference)
{
  for (const double rate : { 9.0 / 64.0, 1.0, 3.0, 5.25, 16.0, 32.0 })
  {
    for (const Dims& dims : { Dims{ 5, 6, 9 }, Dims{ 16, 12, 20 }, Dims{ 7, 13, 30 } })
    {
      for (const int depth : { 4, 8, 32 })
      {
        ExpectReference(dims, rate, depth);
      }
    }
  }
}

//------------------------------------------------------------------------------
TEST(CompressedVolumeBuilder, Prints)
{
  vtkNew<vtkCompressedVolumeBuilder> builder;
  builder->Print(std::cout);
}
}
