// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkImageZFPCompress against one call of libzfp, for rates, shapes, types, components and threads;
// and its use of the pipeline.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkBitArray.h>
#include <vtkCommand.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkSampleRateFinder.h>

#include <limits>

namespace
{
using namespace test;

vtkSmartPointer<vtkCompressedVolume> Read(vtkImageData* image)
{
  auto volume = vtkSmartPointer<vtkCompressedVolume>::New();
  EXPECT_TRUE(volume->Read(image)) << volume->GetErrorMessage();
  return volume;
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, RatesShapesThreads)
{
  const double rates[] = { 0.01, 0.5, 1.0, 1.03, 2.7, 8.0, 9.99, 16.0, 31.99, 32.0 };
  const Dims shapes[] = { { 2, 2, 2 }, { 5, 3, 7 }, { 4, 4, 4 }, { 9, 4, 6 }, { 3, 17, 33 },
    { 33, 31, 12 }, { 64, 65, 63 } };
  int threads = 0;
  for (const Dims& dims : shapes)
  {
    for (double rate : rates)
    {
      threads = (threads + 1) % 6;
      vtkNew<vtkImageZFPCompress> compress;
      compress->SetInputData(FloatImage(dims, threads % 2));
      compress->SetRate(rate);
      compress->SetNumberOfThreads(threads);
      compress->Update();
      const Reference reference(dims, Samples(dims), rate);
      const auto volume = Read(compress->GetOutput());
      EXPECT_TRUE(reference.Equals(volume->GetStream())) << dims[0] << " wide at rate " << rate;
      EXPECT_TRUE(volume->GetRate() == reference.Rate) << rate;
      EXPECT_TRUE(compress->GetActualRate() == reference.Rate) << rate;
    }
  }
}

//------------------------------------------------------------------------------
// A volume of many groups of blocks, which threads share.
TEST(ImageZFPCompress, Steps)
{
  const Dims dims = { 301, 299, 41 };
  for (double rate : { 0.2, 2.5 })
  {
    const auto volume = Read(Compress(FloatImage(dims), rate));
    EXPECT_TRUE(Reference(dims, Samples(dims), rate).Equals(volume->GetStream())) << rate;
  }
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, Types)
{
  const Dims dims = { 6, 7, 5 };
  for (int type : { VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT,
         VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG,
         VTK_UNSIGNED_LONG_LONG, VTK_ID_TYPE, VTK_FLOAT, VTK_DOUBLE, VTK_BIT })
  {
    auto array = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(type));
    array->SetNumberOfComponents(1);
    array->SetNumberOfTuples(Product(dims));
    std::vector<float> values;
    for (vtkIdType i = 0; i < Product(dims); ++i)
    {
      array->SetComponent(i, 0, type == VTK_BIT ? i % 3 == 0 : i % 100);
      values.push_back(static_cast<float>(array->GetComponent(i, 0)));
    }
    const auto volume = Read(Compress(Image(dims, array)));
    EXPECT_TRUE(Reference(dims, values, 8.0).Equals(volume->GetStream())) << array->GetClassName();
    EXPECT_TRUE(volume->GetScalarType() == type) << array->GetClassName();
  }
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, ComponentsAndChoice)
{
  const Dims dims = { 6, 7, 5 };
  const std::vector<float> values = Samples(dims, 2);
  const auto interleaved = vtkSmartPointer<vtkDoubleArray>::New();
  const auto separate = vtkSmartPointer<vtkSOADataArrayTemplate<float>>::New();
  for (vtkDataArray* array :
    { static_cast<vtkDataArray*>(interleaved), static_cast<vtkDataArray*>(separate) })
  {
    array->SetName("velocity");
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(Product(dims));
    for (vtkIdType i = 0; i < Product(dims); ++i)
    {
      array->SetTuple3(i, 0.0, -1.0, values[i]);
    }
    const auto image = FloatImage(dims);
    image->GetPointData()->AddArray(array);
    vtkNew<vtkImageZFPCompress> compress;
    compress->SetInputData(image);
    compress->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
    compress->SetComponent(2);
    compress->Update();
    const auto volume = Read(compress->GetOutput());
    EXPECT_TRUE(Reference(dims, values, 8.0).Equals(volume->GetStream())) << array->GetClassName();
    EXPECT_TRUE(volume->GetArrayName() == "velocity" && volume->GetComponent() == 2) << "metadata";
  }
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, Magnitude)
{
  const Dims dims = { 6, 7, 5 };
  const std::vector<float> values = Samples(dims, 2);
  const struct
  {
    int Type, StoredType;
    double Scale; // of vectors (2, -3, 6), whose length is 7
  } cases[] = { { VTK_FLOAT, VTK_FLOAT, 1.0 }, { VTK_DOUBLE, VTK_DOUBLE, 1.0 },
    { VTK_DOUBLE, VTK_DOUBLE, 1e250 }, { VTK_DOUBLE, VTK_DOUBLE, 1e-250 },
    { VTK_INT, VTK_DOUBLE, 1.0 }, { VTK_SHORT, VTK_FLOAT, 1.0 } };
  for (const auto& one : cases)
  {
    auto vectors = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(one.Type));
    vtkNew<vtkDoubleArray> lengths; // what is expected
    vectors->SetName("velocity");
    vectors->SetNumberOfComponents(3);
    vectors->SetNumberOfTuples(Product(dims));
    lengths->SetNumberOfTuples(Product(dims));
    for (vtkIdType i = 0; i < Product(dims); ++i)
    {
      const double factor = one.Scale * std::round(values[i]);
      vectors->SetTuple3(i, 2.0 * factor, -3.0 * factor, 6.0 * factor);
      lengths->SetValue(i, std::abs(7.0 * factor));
    }
    const auto compress = [&](vtkDataArray* array, int component)
    {
      const auto image = FloatImage(dims);
      image->GetPointData()->SetScalars(array);
      vtkNew<vtkImageZFPCompress> filter;
      filter->SetInputData(image);
      filter->SetComponent(component);
      filter->SetRate(32.0);
      filter->Update();
      return Read(filter->GetOutput());
    };
    const auto volume = compress(vectors, -1);
    const auto expected = compress(lengths, 0);
    const double tolerance = 1e-6 * expected->GetRange()[1];
    EXPECT_NEAR(volume->GetRange()[0], expected->GetRange()[0], tolerance) << one.Scale;
    EXPECT_NEAR(volume->GetRange()[1], expected->GetRange()[1], tolerance) << one.Scale;
    double decoded[2], wanted[2];
    ASSERT_TRUE(volume->FindDecodedRange(decoded) && expected->FindDecodedRange(wanted));
    EXPECT_NEAR(decoded[1], wanted[1], 2 * tolerance) << one.Scale;
    EXPECT_EQ(volume->GetComponent(), vtkCompressedVolume::Magnitude);
    EXPECT_EQ(volume->GetScalarType(), one.StoredType);
    EXPECT_EQ(volume->GetArrayName(), "velocity");
    // of one component it is the values, with their signs
    EXPECT_EQ(compress(lengths, -1)->GetComponent(), 0);
  }
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, Output)
{
  const Dims dims = { 6, 7, 5 };
  const auto image = FloatImage(dims);
  vtkNew<vtkIntArray> field;
  field->SetName("patient");
  image->GetFieldData()->AddArray(field);
  const auto output = Compress(image);
  EXPECT_TRUE(SameGeometry(image, output)) << "geometry";
  EXPECT_TRUE(output->GetPointData()->GetNumberOfArrays() == 0) << "point arrays";
  EXPECT_TRUE(output->GetCellData()->GetNumberOfArrays() == 0) << "cell arrays";
  EXPECT_TRUE(output->GetFieldData()->HasArray("patient")) << "field data is kept";
  EXPECT_TRUE(image->GetFieldData()->GetNumberOfArrays() == 1) << "the input is untouched";

  const std::vector<float> values = Samples(dims);
  const auto volume = Read(output);
  EXPECT_TRUE(volume->GetRange()[0] == *std::min_element(values.begin(), values.end()))
    << "minimum";
  EXPECT_TRUE(volume->GetRange()[1] == *std::max_element(values.begin(), values.end()))
    << "maximum";
  EXPECT_TRUE(volume->GetArrayName() == "density") << volume->GetArrayName();
  EXPECT_TRUE(volume->GetNumberOfBlocks() == 2 * 2 * 2) << volume->GetNumberOfBlocks();
}

//------------------------------------------------------------------------------
template <typename Prepare>
void ExpectError(const std::string& words, vtkImageData* image, Prepare prepare)
{
  vtkNew<vtkImageZFPCompress> compress;
  const Errors errors(compress);
  compress->SetInputData(image);
  prepare(compress.Get());
  compress->Update();
  EXPECT_TRUE(errors.IsOne(words)) << "expected '" << words << "', got " << errors.Describe();
  EXPECT_FALSE(vtkCompressedVolume::IsCompressed(compress->GetOutput())) << words;
}

TEST(ImageZFPCompress, Errors)
{
  const auto nothing = [](vtkImageZFPCompress*) {};
  const auto image = FloatImage({ 6, 7, 5 });
  for (double rate : { 0.0, -1.0, 32.1, std::numeric_limits<double>::quiet_NaN() })
  {
    ExpectError("Rate is", image, [=](vtkImageZFPCompress* c) { c->SetRate(rate); });
  }
  ExpectError("Component is 1", image, [](vtkImageZFPCompress* c) { c->SetComponent(1); });
  ExpectError("Component is -2", image, [](vtkImageZFPCompress* c) { c->SetComponent(-2); });
  ExpectError("array 'pressure' to compress; the input's arrays: density", image,
    [](vtkImageZFPCompress* c)
    { c->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "pressure"); });
  ExpectError("7 x 1 x 5 samples", FloatImage({ 7, 1, 5 }), nothing);
  ExpectError("1 x 7 x 5 samples", FloatImage({ 1, 7, 5 }, true), nothing);
  vtkNew<vtkImageData> empty;
  ExpectError("no array", empty, nothing);
  ExpectError("compressed volume already", Compress(image), nothing);

  std::vector<float> values = Samples({ 6, 7, 5 });
  values[17] = values[209] = std::numeric_limits<float>::quiet_NaN();
  values[3] = -std::numeric_limits<float>::infinity();
  const auto holes = Image({ 6, 7, 5 }, FloatArray(values));
  ExpectError("2 NaN and 1 infinite", holes, [](vtkImageZFPCompress* c) { c->MaskNonFiniteOff(); });
}

//------------------------------------------------------------------------------
// Blocks below 2^-98, for which zfp's encoder overflows, become zero, unless that would show.
TEST(ImageZFPCompress, TinyValues)
{
  const Dims dims = { 8, 4, 4 }; // two blocks
  std::vector<float> values(Product(dims));
  for (vtkIdType i = 0; i < Product(dims); ++i)
  {
    values[i] = i % 8 < 4 ? 1.0f : 1e-31f;
  }
  std::vector<float> zeroed = values;
  std::replace(zeroed.begin(), zeroed.end(), 1e-31f, 0.0f);
  const auto volume = Read(Compress(Image(dims, FloatArray(values))));
  EXPECT_TRUE(Reference(dims, zeroed, 8.0).Equals(volume->GetStream())) << "tiny block";
  EXPECT_TRUE(volume->GetRange()[0] == 1e-31f) << "the range is the original's";

  std::replace(values.begin(), values.end(), 1.0f, 1e-25f);
  const auto scaled = Read(Compress(Image(dims, FloatArray(values))));
  EXPECT_TRUE(scaled->GetScale() == std::ldexp(1.0, -84) && scaled->GetOffset() == 0.0) << "scale";
  std::replace(values.begin(), values.end(), 1e-25f, 6e-23f); // above 2^-74: zero does not show
  const auto small = Read(Compress(Image(dims, FloatArray(values))));
  EXPECT_TRUE(small->GetScale() == 1.0) << "small block";
}

//------------------------------------------------------------------------------
// A ball of 4000 in 0.
std::vector<float> Ball(const Dims& dims)
{
  std::vector<float> values;
  for (vtkIdType i = 0; i < Product(dims); ++i)
  {
    const double x = i % dims[0] - 0.5 * dims[0], y = i / dims[0] % dims[1] - 0.5 * dims[1];
    const double z = i / dims[0] / dims[1] - 0.5 * dims[2];
    values.push_back(x * x + y * y + z * z < 100.0 ? 4000.0f : 0.0f);
  }
  return values;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkCompressedVolume> CompressWith(
  vtkImageData* image, double rate, bool keepLabels, double tolerance)
{
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetInputData(image);
  compress->SetRate(rate);
  compress->SetKeepLabels(keepLabels);
  compress->SetTolerance(tolerance);
  compress->Update();
  return Read(compress->GetOutput());
}

//------------------------------------------------------------------------------
// Labels get the rate that they need, from the filter and from the finder for slabs; what is too
// low for an isovalue is told.
TEST(ImageZFPCompress, LabelsAndTolerances)
{
  const Dims dims = { 26, 25, 27 };
  const std::vector<float> values = Ball(dims);
  const auto image = Image(dims, FloatArray(values));
  vtkNew<vtkDoubleArray> isovalues;
  isovalues->InsertNextValue(0.5);
  const auto given = CompressWith(image, 8.0, false, 0.0);
  EXPECT_EQ(given->GetRate(), 8.0);
  EXPECT_GT(given->GetLargestError(), 0.5);
  EXPECT_GT(given->GetMeanError(), 0.0);
  EXPECT_NE(given->DescribeDoubts(isovalues).find("Isovalue 0.5 may"), std::string::npos);
  const auto kept = CompressWith(image, 8.0, true, 0.0);
  EXPECT_GT(kept->GetRate(), 8.0);
  EXPECT_LT(kept->GetLargestError(), 0.5);
  EXPECT_EQ(kept->DescribeDoubts(isovalues), "");
  EXPECT_EQ(CompressWith(FloatImage(dims), 8.0, true, 0.0)->GetRate(), 8.0) << "no labels";

  const auto array = FloatArray(values);
  vtkNew<vtkSampleRateFinder> finder;
  finder->Start(dims.data());
  EXPECT_TRUE(finder->AddForLabels(array));
  EXPECT_TRUE(finder->FindsLabels());
  finder->SetRate(8.0);
  for (double before = 0.0; before != finder->GetRate();)
  {
    before = finder->GetRate();
    finder->Start(dims.data());
    EXPECT_TRUE(finder->AddSlab(array));
  }
  EXPECT_EQ(finder->GetRate(), kept->GetRate());
  EXPECT_EQ(CompressWith(image, 4.0, false, 0.49)->GetRate(), kept->GetRate());
  ExpectError("No rate keeps the samples within 1e-30", FloatImage(dims),
    [](vtkImageZFPCompress* compress) { compress->SetTolerance(1e-30); });
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, Pipeline)
{
  int runs = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&runs);
  count->SetCallback(
    [](vtkObject*, unsigned long, void* runs, void*) { ++*static_cast<int*>(runs); });
  const auto image = FloatImage({ 6, 7, 5 });
  vtkNew<vtkImageZFPCompress> compress;
  compress->AddObserver(vtkCommand::StartEvent, count);
  compress->SetInputData(image);
  compress->Update();
  compress->Update();
  compress->SetRate(compress->GetRate());
  compress->Update();
  EXPECT_TRUE(runs == 1) << "unchanged: " << runs;
  compress->SetRate(4.0);
  compress->Update();
  EXPECT_TRUE(runs == 2) << "rate: " << runs;
  image->Modified();
  compress->Update();
  EXPECT_TRUE(runs == 3) << "input: " << runs;
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, ProgressAndAbort)
{
  vtkNew<vtkCallbackCommand> watch;
  std::vector<double> seen;
  watch->SetClientData(&seen);
  watch->SetCallback(
    [](vtkObject* caller, unsigned long, void* seen, void*)
    {
      auto* algorithm = static_cast<vtkAlgorithm*>(caller);
      static_cast<std::vector<double>*>(seen)->push_back(algorithm->GetProgress());
    });
  vtkNew<vtkImageZFPCompress> compress;
  compress->AddObserver(vtkCommand::ProgressEvent, watch);
  compress->SetInputData(FloatImage({ 301, 299, 41 }));
  compress->Update();
  EXPECT_TRUE(seen.size() > 3 && std::is_sorted(seen.begin(), seen.end()))
    << seen.size() << " events";

  watch->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1); });
  compress->SetRate(4.0);
  compress->Update();
  EXPECT_FALSE(vtkCompressedVolume::IsCompressed(compress->GetOutput())) << "aborted";
}
//------------------------------------------------------------------------------
// Ghost flags of another number than cells or points, or in disorder: nothing is read beyond them,
// and extents stay valid.
TEST(ImageZFPCompress, OddMarks)
{
  const auto marked = [](bool cells, vtkIdType number, std::initializer_list<vtkIdType> own)
  {
    const auto image = FloatImage({ 6, 7, 5 }, cells);
    vtkNew<vtkUnsignedCharArray> marks;
    marks->SetName(vtkDataSetAttributes::GhostArrayName());
    marks->SetNumberOfValues(number);
    marks->Fill(vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL);
    for (const vtkIdType at : own)
    {
      marks->SetValue(at, 0);
    }
    image->GetCellData()->AddArray(marks);
    vtkNew<vtkImageZFPCompress> compress;
    const Errors errors(compress);
    compress->SetInputData(image);
    compress->Update();
    EXPECT_TRUE(errors.Texts.size() <= 1) << errors.Describe();
    return vtkSmartPointer<vtkImageData>(compress->GetOutput());
  };
  vtkNew<vtkCompressedVolume> volume;
  for (const bool cells : { false, true })
  {
    const vtkIdType number = cells ? 6 * 7 * 5 : 5 * 6 * 4;
    for (const vtkIdType other : { vtkIdType(0), vtkIdType(1), number - 1, number + 1 })
    {
      EXPECT_TRUE(volume->Read(marked(cells, other, {}))) << volume->GetErrorMessage();
      EXPECT_FALSE(volume->HidesAny()) << "marks of " << other << " cells";
    }
    // the first cell that is no ghost has greater x and y than the last
    const vtkIdType row = cells ? 6 : 5;
    EXPECT_TRUE(volume->Read(marked(cells, number, { 3 + 3 * row, number - 3 * row })))
      << volume->GetErrorMessage();
  }
}

//------------------------------------------------------------------------------
TEST(ImageZFPCompress, LargestDoubles)
{
  const double most = std::numeric_limits<double>::max();
  vtkNew<vtkDoubleArray> values;
  values->SetNumberOfValues(64);
  for (const double low : { -most, 0.0, most })
  {
    values->Fill(low);
    values->SetValue(7, most);
    const auto image = Compress(Image({ 4, 4, 4 }, values));
    vtkNew<vtkCompressedVolume> volume;
    EXPECT_TRUE(volume->Read(image)) << low << ": " << volume->GetErrorMessage();
    EXPECT_TRUE(volume->GetRange()[1] == most) << volume->GetRange()[1];
  }
}
}
