// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkZFPContour against vtkFlyingEdges3D on the decoded image: the same triangles, bit for bit.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkFieldData.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageZFPDecompress.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkZFPContour.h>

#include <limits>

namespace
{
using namespace test;

const char* const ArrayNames[] = { "Normals", "Gradients", "density" };

// A point's coordinates and its values in all arrays, as bits.
std::vector<vtkTypeUInt32> BitsOfPoint(vtkPolyData* surface, vtkIdType point)
{
  std::vector<float> values;
  double x[3];
  surface->GetPoint(point, x);
  values.insert(values.end(), x, x + 3);
  for (const char* name : ArrayNames)
  {
    vtkDataArray* array = surface->GetPointData()->GetArray(name);
    for (int i = 0; array && i < array->GetNumberOfComponents(); ++i)
    {
      values.push_back(static_cast<float>(array->GetComponent(point, i)));
    }
  }
  std::vector<vtkTypeUInt32> bits(values.size());
  memcpy(bits.data(), values.data(), sizeof(float) * values.size());
  return bits;
}

// Collects all triangles, sorted; each keeps the order of its corners.
std::vector<std::vector<vtkTypeUInt32>> Triangles(vtkPolyData* surface)
{
  std::vector<std::vector<vtkTypeUInt32>> triangles(surface->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    vtkNew<vtkIdList> corners;
    surface->GetCellPoints(cell, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
    {
      const auto bits = BitsOfPoint(surface, corners->GetId(i));
      triangles[cell].insert(triangles[cell].end(), bits.begin(), bits.end());
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

bool SameSurface(vtkPolyData* a, vtkPolyData* b)
{
  return a->GetNumberOfPoints() == b->GetNumberOfPoints() && Triangles(a) == Triangles(b);
}

template <typename ContourT>
void SetValues(ContourT* contour, const std::vector<double>& values)
{
  contour->SetNumberOfContours(static_cast<int>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    contour->SetValue(static_cast<int>(i), values[i]);
  }
  contour->ComputeGradientsOn();
}

//------------------------------------------------------------------------------
TEST(ZFPContour, EqualsFlyingEdges)
{
  const Dims shapes[] = { { 2, 2, 2 }, { 5, 9, 13 }, { 9, 2, 17 }, { 33, 10, 7 }, { 21, 22, 23 } };
  const std::vector<double> values = { 10.0, -100.25, 1e9, 10.0 };
  for (const Dims& dims : shapes)
  {
    const auto compressed = Compress(FloatImage(dims));
    vtkNew<vtkImageZFPDecompress> decompress;
    decompress->SetInputData(compressed);
    vtkNew<vtkFlyingEdges3D> expected;
    expected->SetInputConnection(decompress->GetOutputPort());
    SetValues(expected.Get(), values);
    expected->Update();
    for (int brickSize : { 4, 8, 64 })
    {
      vtkNew<vtkZFPContour> contour;
      contour->SetInputData(compressed);
      contour->SetBrickSize(brickSize);
      SetValues(contour.Get(), values);
      contour->Update();
      EXPECT_TRUE(contour->GetOutput()->GetNumberOfCells() > 0) << dims[0] << " wide";
      EXPECT_TRUE(SameSurface(contour->GetOutput(), expected->GetOutput()))
        << dims[0] << " wide in bricks of " << brickSize;
      EXPECT_TRUE(contour->GetOutput()->GetFieldData()->GetNumberOfArrays() == 0)
        << "no stream is left";
    }
  }
}

//------------------------------------------------------------------------------
// The same mesh, in the same order, for any number of threads and any backend.
TEST(ZFPContour, ThreadsDoNotShow)
{
  const auto compressed = Compress(FloatImage({ 40, 41, 42 }));
  std::vector<vtkSmartPointer<vtkPolyData>> surfaces;
  for (const char* backend : { "Sequential", "STDThread" })
  {
    for (int threads : { 0, 1, 3 })
    {
      vtkSMPTools::SetBackend(backend);
      vtkNew<vtkZFPContour> contour;
      contour->SetInputData(compressed);
      contour->SetBrickSize(8);
      contour->SetNumberOfThreads(threads);
      contour->Update();
      surfaces.emplace_back(contour->GetOutput());
      EXPECT_TRUE(std::string(vtkSMPTools::GetBackend()) == backend) << "the backend is as it was";
    }
  }
  for (const auto& surface : surfaces)
  {
    bool same = SameSurface(surface, surfaces[0]);
    for (vtkIdType point = 0; same && point < surface->GetNumberOfPoints(); ++point)
    {
      same = BitsOfPoint(surface, point) == BitsOfPoint(surfaces[0], point);
    }
    EXPECT_TRUE(same) << "another number of threads";
  }
}

//------------------------------------------------------------------------------
TEST(ZFPContour, DecodesWhatItNeeds)
{
  vtkNew<vtkFloatArray> ramp;
  for (int i = 0; i < 33 * 33 * 33; ++i)
  {
    ramp->InsertNextValue(static_cast<float>(i % 33));
  }
  vtkNew<vtkZFPContour> contour;
  contour->SetInputData(Compress(Image({ 33, 33, 33 }, ramp), 32.0));
  contour->SetBrickSize(8);
  contour->SetNumberOfThreads(1);
  contour->SetValue(0, 20.5);
  contour->Update();
  EXPECT_TRUE(contour->GetNumberOfBricks() == 64) << contour->GetNumberOfBricks();
  EXPECT_TRUE(contour->GetNumberOfDecodedBricks() == 64) << "ranges are not known at first";
  // one brick: 8 cells have 9 samples, with one more on either side 11, in whole blocks 16
  EXPECT_TRUE(contour->GetPeakSampleBytes() == 4 * 16 * 16 * 16) << contour->GetPeakSampleBytes();
  contour->SetValue(0, 10.5);
  contour->Update();
  EXPECT_TRUE(contour->GetNumberOfDecodedBricks() == 16) << contour->GetNumberOfDecodedBricks();
  contour->SetValue(0, 100.0);
  contour->Update();
  EXPECT_TRUE(contour->GetNumberOfDecodedBricks() == 0) << contour->GetNumberOfDecodedBricks();
  contour->SetInputData(Compress(FloatImage({ 33, 33, 33 })));
  contour->Update();
  EXPECT_TRUE(contour->GetNumberOfDecodedBricks() == 64) << "another volume";
}

//------------------------------------------------------------------------------
TEST(ZFPContour, Abort)
{
  vtkNew<vtkZFPContour> contour;
  contour->SetInputData(Compress(FloatImage({ 40, 40, 40 })));
  contour->SetBrickSize(4);
  contour->SetNumberOfThreads(1);
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(true); });
  const auto tag = contour->AddObserver("ProgressEvent", abort);
  contour->Update();
  EXPECT_TRUE(contour->GetOutput()->GetNumberOfPoints() == 0) << "aborted";
  EXPECT_TRUE(contour->GetNumberOfDecodedBricks() < contour->GetNumberOfBricks())
    << "stopped early";
  contour->RemoveObserver(tag);
  contour->SetAbortExecute(false);
  contour->Update();
  EXPECT_TRUE(contour->GetOutput()->GetNumberOfPoints() > 0) << "taken up again";
}

//------------------------------------------------------------------------------
TEST(ZFPContour, Errors)
{
  vtkNew<vtkZFPContour> contour;
  Errors errors(contour);
  contour->SetInputData(FloatImage({ 4, 4, 4 }));
  contour->Update();
  EXPECT_TRUE(errors.IsOne("ProgIso.ZFP.Stream (compress it first)")) << errors.Describe();
  EXPECT_TRUE(contour->GetOutput()->GetNumberOfPoints() == 0) << "empty";
  errors.Texts.clear();
  contour->SetInputData(Compress(FloatImage({ 4, 4, 4 })));
  contour->SetValue(0, std::numeric_limits<double>::quiet_NaN());
  contour->Update();
  EXPECT_TRUE(errors.IsOne("must be finite")) << errors.Describe();
}

//------------------------------------------------------------------------------
// Collects triangles by their points alone.
std::vector<std::vector<float>> Places(vtkPolyData* surface)
{
  std::vector<std::vector<float>> triangles(surface->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    vtkNew<vtkIdList> corners;
    surface->GetCellPoints(cell, corners);
    for (const vtkIdType corner : *corners)
    {
      double x[3];
      surface->GetPoint(corner, x);
      triangles[cell].insert(triangles[cell].end(), x, x + 3);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

vtkSmartPointer<vtkPolyData> FlyingEdges(vtkImageData* image, bool cells)
{
  vtkNew<vtkImageData> samples;
  samples->ShallowCopy(image);
  if (cells)
  {
    int extent[6];
    double origin[3];
    image->GetExtent(extent);
    image->TransformContinuousIndexToPhysicalPoint(0.5, 0.5, 0.5, origin);
    const vtkSmartPointer<vtkDataArray> values = image->GetCellData()->GetScalars();
    samples->Initialize();
    samples->CopyStructure(image);
    samples->SetExtent(
      extent[0], extent[1] - 1, extent[2], extent[3] - 1, extent[4], extent[5] - 1);
    samples->SetOrigin(origin);
    samples->GetPointData()->SetScalars(values);
  }
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(samples);
  contour->SetValue(0, 10.0);
  contour->Update();
  return contour->GetOutput();
}

// A subset has its own triangles, the same as VTK's of the decompressed subset, and no others.
TEST(ZFPContour, Subsets)
{
  const int parts[][6] = { { 4, 20, -2, 9, 7, 21 }, { 3, 5, -1, 1, 6, 8 },
    { 19, 25, 3, 19, 5, 27 } };
  for (const bool cells : { false, true })
  {
    const auto compressed = Compress(FloatImage({ 23, 22, 23 }, cells));
    vtkNew<vtkImageZFPDecompress> decompress;
    decompress->SetInputData(compressed);
    decompress->Update();
    for (const auto& part : parts)
    {
      vtkNew<vtkImageData> subset, expected;
      subset->ShallowCopy(compressed);
      subset->Crop(part);
      expected->ShallowCopy(decompress->GetOutput());
      expected->Crop(part);
      vtkNew<vtkImageZFPDecompress> again;
      again->SetInputData(subset);
      again->Update();
      EXPECT_TRUE(SameGeometry(again->GetOutput(), expected));
      EXPECT_FALSE(again->GetOutput()->HasAnyGhostCells());
      for (int brickSize : { 4, 64 })
      {
        vtkNew<vtkZFPContour> contour;
        contour->SetInputData(subset);
        contour->SetBrickSize(brickSize);
        contour->SetValue(0, 10.0);
        contour->Update();
        vtkPolyData* const surface = contour->GetOutput();
        EXPECT_TRUE(Places(surface) == Places(FlyingEdges(expected, cells))) << brickSize;
        EXPECT_TRUE(surface->GetNumberOfCells() > 0);
        EXPECT_FALSE(surface->HasAnyGhostCells()) << "no others";
        double bounds[6], own[6];
        surface->GetBounds(bounds);
        expected->GetBounds(own);
        for (int axis = 0; axis < 3; ++axis)
        {
          EXPECT_TRUE(
            own[2 * axis] <= bounds[2 * axis] && bounds[2 * axis + 1] <= own[2 * axis + 1]);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
// Other arrays come along as vtkFlyingEdges3D interpolates them, whatever their type.
TEST(ZFPContour, CarriesOtherArrays)
{
  const Dims dims = { 13, 14, 15 };
  const auto image = FloatImage(dims);
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("flow");
  vectors->SetNumberOfComponents(3);
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetName("bytes");
  for (int i = 0; i < Product(dims); ++i)
  {
    vectors->InsertNextTuple3(i % 13, i / 13 % 14, i / (13 * 14));
    bytes->InsertNextValue(static_cast<unsigned char>(i % 13 * 10));
  }
  image->GetPointData()->AddArray(vectors);
  image->GetPointData()->AddArray(bytes);
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetInputData(image);
  compress->PassOtherArraysOn();
  compress->Update();
  EXPECT_TRUE(compress->GetOutput()->GetPointData()->GetNumberOfArrays() == 2);
  EXPECT_TRUE(compress->GetOutput()->GetPointData()->GetScalars() == nullptr);
  vtkNew<vtkZFPContour> contour;
  contour->SetInputConnection(compress->GetOutputPort());
  contour->SetValue(0, 10.0);
  contour->Update();
  vtkPolyData* const surface = contour->GetOutput();
  vtkDataArray* const flow = surface->GetPointData()->GetArray("flow");
  vtkDataArray* const found = surface->GetPointData()->GetArray("bytes");
  ASSERT_TRUE(flow && found && surface->GetNumberOfPoints() > 100);
  EXPECT_TRUE(found->GetDataType() == VTK_UNSIGNED_CHAR);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3], index[3];
    surface->GetPoint(i, x);
    image->TransformPhysicalPointToContinuousIndex(x, index);
    const double* const v = flow->GetTuple3(i);
    EXPECT_NEAR(v[0], index[0] - 3, 1e-4);
    EXPECT_NEAR(v[1], index[1] + 2, 1e-4);
    EXPECT_NEAR(v[2], index[2] - 5, 1e-4);
    EXPECT_NEAR(found->GetComponent(i, 0), 10 * (index[0] - 3), 0.51);
  }
}
}
