// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkImageZFPDecompress against libzfp, on compressed volumes from filters and files.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkFieldData.h>
#include <vtkImageZFPDecompress.h>
#include <vtkIntArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

namespace
{
using namespace test;

vtkDataArray* Scalars(vtkImageData* image, bool cells)
{
  return cells ? image->GetCellData()->GetScalars() : image->GetPointData()->GetScalars();
}

bool SameValues(vtkDataArray* array, const std::vector<float>& values)
{
  auto* floats = vtkArrayDownCast<vtkFloatArray>(array);
  return floats && floats->GetNumberOfValues() == static_cast<vtkIdType>(values.size()) &&
    memcmp(floats->GetPointer(0), values.data(), sizeof(float) * values.size()) == 0;
}

//------------------------------------------------------------------------------
TEST(ImageZFPDecompress, RoundTrips)
{
  const Dims shapes[] = { { 2, 2, 2 }, { 5, 3, 7 }, { 9, 4, 6 }, { 64, 65, 63 }, { 301, 299, 9 } };
  bool cells = false;
  for (const Dims& dims : shapes)
  {
    for (double rate : { 0.01, 1.03, 8.0, 31.99 })
    {
      cells = !cells;
      const auto image = FloatImage(dims, cells);
      vtkNew<vtkImageZFPDecompress> decompress;
      decompress->SetInputData(Compress(image, rate));
      decompress->SetNumberOfThreads(cells ? 3 : 0);
      decompress->Update();
      vtkImageData* output = decompress->GetOutput();
      const Reference reference(dims, Samples(dims), rate);
      vtkDataArray* array = Scalars(output, cells);
      EXPECT_TRUE(SameValues(array, reference.Decoded)) << dims[0] << " wide at rate " << rate;
      EXPECT_TRUE(array && std::string(array->GetName()) == "density") << "name";
      EXPECT_TRUE(SameGeometry(image, output)) << "geometry";
    }
  }
}

//------------------------------------------------------------------------------
TEST(ImageZFPDecompress, ThroughVTI)
{
  const Dims dims = { 9, 4, 6 };
  const auto image = FloatImage(dims);
  vtkNew<vtkIntArray> field;
  field->SetName("patient");
  image->GetFieldData()->AddArray(field);
  const char* const fileName = "TestImageZFPDecompress.vti";
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetFileName(fileName);
  writer->SetInputData(Compress(image, 2.7));
  writer->Write();
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(fileName);
  vtkNew<vtkImageZFPDecompress> decompress;
  decompress->SetInputConnection(reader->GetOutputPort());
  decompress->Update();
  vtkImageData* output = decompress->GetOutput();
  EXPECT_TRUE(SameValues(Scalars(output, false), Reference(dims, Samples(dims), 2.7).Decoded))
    << "values";
  EXPECT_TRUE(SameGeometry(image, output)) << "geometry";
  EXPECT_TRUE(output->GetFieldData()->GetNumberOfArrays() == 1)
    << "only the original field data is left";
}

//------------------------------------------------------------------------------
TEST(ImageZFPDecompress, Errors)
{
  vtkNew<vtkImageZFPDecompress> decompress;
  const Errors errors(decompress);
  const auto image = FloatImage({ 4, 4, 4 });
  decompress->SetInputData(image);
  decompress->Update();
  EXPECT_TRUE(errors.IsOne("no field data array ProgIso.ZFP.Stream")) << errors.Describe();
  EXPECT_FALSE(decompress->GetOutput()->GetPointData()->GetScalars()) << "no array";
  EXPECT_TRUE(SameGeometry(image, decompress->GetOutput())) << "geometry";
}
}
