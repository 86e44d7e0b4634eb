// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Calls vtkCompressedVolumeBuilder in any order with slabs of any size and type. The result must be
// that of vtkImageZFPCompress for the same samples.
#include "HostileImage.h"

#include <vtkCompressedVolumeBuilder.h>

namespace
{
using namespace fuzz;

// The slabs that a builder took after its last Start().
struct Taken
{
  vtkSmartPointer<vtkDataArray> Samples;
  int Dimensions[3];
  double Rate;
  bool MaskNonFinite;
  int Component;
};

//------------------------------------------------------------------------------
void Start(vtkCompressedVolumeBuilder* builder, Taken& taken, Bytes& bytes)
{
  const bool hostile = bytes.Byte() >= 224;
  std::generate_n(taken.Dimensions, 3,
    [&]() { return hostile ? static_cast<int>(bytes.Integer()) : 2 + bytes.Below(12); });
  taken.Rate = bytes.Number();
  taken.Samples = nullptr;
  taken.MaskNonFinite = bytes.Flag();
  const bool units = bytes.Byte() >= 240;
  builder->SetOffset(units ? bytes.Number() : 0.0);
  builder->SetScale(units ? bytes.Number() : 1.0);
  builder->SetMaskNonFinite(taken.MaskNonFinite);
  const bool started = builder->Start(taken.Dimensions, taken.Rate);
  CHECK(started == builder->GetErrorMessage().empty(), builder->GetErrorMessage());
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataArray> MakeSlab(const int dims[3], Bytes& bytes)
{
  const int type = ArrayTypes[bytes.Below(13)]; // the types of numbers
  auto slab = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  const int slices = bytes.Flag() ? 4 * (1 + bytes.Below(3)) : bytes.Below(16);
  const vtkIdType perSlice = std::min<vtkIdType>(
    static_cast<vtkIdType>(std::abs(dims[0] % 64)) * std::abs(dims[1] % 64), 200);
  const bool odd = bytes.Byte() >= 240;
  slab->SetNumberOfComponents(1 + bytes.Below(3));
  slab->SetNumberOfTuples(slices * perSlice + (odd ? 1 : 0));
  const bool hostile = bytes.Byte() >= 240;
  for (vtkIdType i = 0; i < slab->GetNumberOfTuples(); ++i)
  {
    for (int j = 0; j < slab->GetNumberOfComponents(); ++j)
    {
      const bool one = hostile && i == slab->GetNumberOfTuples() / 2;
      slab->SetComponent(i, j, one ? bytes.Number() : static_cast<double>((37 * i + j) % 101));
    }
  }
  return slab;
}

//------------------------------------------------------------------------------
void AddSlab(vtkCompressedVolumeBuilder* builder, Taken& taken, Bytes& bytes)
{
  const auto slab = MakeSlab(taken.Dimensions, bytes);
  const int component = bytes.Below(4) - 1;
  const bool added = builder->AddSlab(bytes.Byte() == 255 ? nullptr : slab.Get(), component);
  CHECK(added == builder->GetErrorMessage().empty(), builder->GetErrorMessage());
  if (!added)
  {
    return;
  }
  if (!taken.Samples)
  {
    taken.Samples = vtkSmartPointer<vtkDataArray>::Take(slab->NewInstance());
    taken.Component = component;
  }
  // not through doubles, which cannot hold all integers
  const vtkIdType tuples = slab->GetNumberOfTuples();
  const auto one = vtkSmartPointer<vtkDataArray>::Take(slab->NewInstance());
  one->SetNumberOfTuples(tuples);
  one->CopyComponent(0, slab, component);
  taken.Samples->InsertTuples(taken.Samples->GetNumberOfTuples(), tuples, 0, one);
}

//------------------------------------------------------------------------------
void Finish(vtkCompressedVolumeBuilder* builder, Taken& taken)
{
  vtkNew<vtkImageData> image;
  const bool finished = builder->Finish(image);
  CHECK(finished == builder->GetErrorMessage().empty(), builder->GetErrorMessage());
  CHECK(finished == vtkCompressedVolume::IsCompressed(image), "output");
  if (!finished)
  {
    return;
  }
  vtkNew<vtkImageData> plain;
  plain->SetDimensions(taken.Dimensions);
  plain->GetPointData()->SetScalars(taken.Samples);
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetInputData(plain);
  compress->SetRate(taken.Rate);
  compress->SetMaskNonFinite(taken.MaskNonFinite);
  CHECK(Update(compress), "not compressed");
  vtkNew<vtkCompressedVolume> expected, made;
  CHECK(expected->Read(compress->GetOutput()), expected->GetErrorMessage());
  CHECK(made->Read(image), made->GetErrorMessage());
  CHECK(made->GetComponent() == taken.Component, made->GetComponent());
  if (expected->HasUnits() || made->HasUnits()) // only the builder is told units
  {
    return;
  }
  const vtkIdType size = made->GetStream()->GetNumberOfValues();
  CHECK(size == expected->GetStream()->GetNumberOfValues() &&
      std::memcmp(made->GetStream()->GetPointer(0), expected->GetStream()->GetPointer(0), size) ==
        0,
    "another stream");
  CHECK(made->GetHiddenSamples() == expected->GetHiddenSamples(), "another mask");
}
}

//------------------------------------------------------------------------------
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  vtkNew<vtkCompressedVolumeBuilder> builder;
  Taken taken = {};
  for (int i = 0; i < 24 && bytes.Left() > 0; ++i)
  {
    const int what = bytes.Below(8);
    if (what == 0)
    {
      Start(builder, taken, bytes);
    }
    else if (what == 1)
    {
      Finish(builder, taken);
    }
    else if (what == 2)
    {
      builder->SetNumberOfThreads(bytes.Below(3));
      builder->SetArrayName(bytes.Flag() ? "name" : "");
    }
    else
    {
      AddSlab(builder, taken, bytes);
    }
  }
  Finish(builder, taken);
  return 0;
}
