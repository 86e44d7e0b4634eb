// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs vtkImageZFPCompress on images with any values, flags and settings. The output must
// decompress to an image that compresses again.
#include "HostileImage.h"

#include <vtkImageZFPDecompress.h>

#include <algorithm>

namespace
{
using namespace fuzz;

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> PlainImage(Bytes& bytes)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  int dims[3];
  std::generate_n(dims, 3, [&]() { return 1 + bytes.Below(12); });
  image->SetDimensions(dims);
  const int kinds = bytes.Byte();
  const bool cells = kinds & 1;
  vtkDataSetAttributes* attributes = image->GetPointData();
  if (cells)
  {
    attributes = image->GetCellData();
  }
  const vtkIdType tuples = cells ? image->GetNumberOfCells() : image->GetNumberOfPoints();
  const int type = ArrayTypes[bytes.Below(13)]; // the types of numbers
  const auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  values->SetName(kinds & 2 ? "density" : nullptr);
  values->SetNumberOfComponents(1 + (kinds >> 2) % 3);
  const int others = bytes.Byte() == 255 ? bytes.Below(3) - 1 : 0;
  values->SetNumberOfTuples(std::max<vtkIdType>(tuples + others, 0));
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    for (int j = 0; j < values->GetNumberOfComponents(); ++j)
    {
      values->SetComponent(i, j, static_cast<double>((37 * i + j) % 101));
    }
  }
  for (int i = bytes.Below(8); i > 0 && values->GetNumberOfTuples() > 0; --i)
  {
    const vtkIdType at = bytes.Take<std::uint16_t>() % values->GetNumberOfTuples();
    const bool floating = type == VTK_FLOAT || type == VTK_DOUBLE;
    values->SetComponent(at, 0, floating ? bytes.Number() : bytes.Below(100));
  }
  attributes->SetScalars(values);
  if (kinds & 32)
  {
    AddGhosts(image->GetPointData(), image->GetNumberOfPoints(), bytes);
  }
  if (kinds & 64)
  {
    AddGhosts(image->GetCellData(), image->GetNumberOfCells(), bytes);
  }
  return image;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> Decompress(vtkImageData* image)
{
  vtkNew<vtkImageZFPDecompress> decompress;
  decompress->SetInputData(image);
  CHECK(Update(decompress), "not decompressed");
  return decompress->GetOutput();
}
}

//------------------------------------------------------------------------------
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetRate(bytes.Flag() ? bytes.Number() : (1 + bytes.Below(128)) / 4.0);
  compress->SetComponent(bytes.Byte() > 240 ? bytes.Below(5) - 1 : 0);
  compress->SetMaskNonFinite(bytes.Flag());
  compress->SetInputData(PlainImage(bytes));
  if (!Update(compress) || compress->GetOutput()->GetNumberOfPoints() == 0)
  {
    CHECK(!vtkCompressedVolume::IsCompressed(compress->GetOutput()), "output");
    return 0;
  }
  vtkNew<vtkCompressedVolume> volume, again;
  CHECK(volume->Read(compress->GetOutput()), volume->GetErrorMessage());
  vtkNew<vtkImageZFPCompress> repeat;
  repeat->SetRate(compress->GetRate());
  repeat->MaskNonFiniteOff(); // values that overflowed are to be refused, not hidden
  repeat->SetInputData(Decompress(compress->GetOutput()));
  if (Update(repeat))
  {
    CHECK(again->Read(repeat->GetOutput()), again->GetErrorMessage());
    // a piece comes back without the samples around it, and without their marks
    const bool isWhole =
      std::equal(volume->GetExtent(), volume->GetExtent() + 6, again->GetExtent());
    CHECK(!isWhole ||
        (again->GetHiddenSamples() == volume->GetHiddenSamples() &&
          again->GetHiddenCells() == volume->GetHiddenCells()),
      "another mask");
    Decompress(repeat->GetOutput());
  }
  return 0;
}
