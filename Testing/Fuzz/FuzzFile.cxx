// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs vtkZFPReader on any file. What it reads must survive vtkZFPWriter and reading it again.
#include "FuzzTools.h"

#include <vtkImageZFPDecompress.h>
#include <vtkZFPReader.h>
#include <vtkZFPWriter.h>

namespace
{
using namespace fuzz;

//------------------------------------------------------------------------------
void CheckRange(vtkImageData* image, vtkCompressedVolume* volume)
{
  vtkNew<vtkImageZFPDecompress> decompress;
  decompress->SetInputData(image);
  CHECK(Update(decompress), "not decompressed");
  double range[2];
  decompress->GetOutput()->GetPointData()->GetScalars()->GetFiniteRange(range);
  CHECK(range[0] == volume->GetRange()[0] && range[1] == volume->GetRange()[1],
    range[0] << " " << range[1]);
}

//------------------------------------------------------------------------------
void CheckWriter(vtkImageData* image, vtkUnsignedCharArray* stream)
{
  const File file;
  vtkNew<vtkZFPWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(file.GetName());
  const test::Errors errors(writer);
  writer->Write();
  if (writer->GetErrorCode() != 0)
  {
    CHECK(errors.IsOne("65536"), errors.Describe());
    return;
  }
  vtkNew<vtkZFPReader> reader;
  reader->SetFileName(file.GetName());
  CHECK(Update(reader), "not read");
  vtkNew<vtkCompressedVolume> volume;
  CHECK(volume->Read(reader->GetOutput()), volume->GetErrorMessage());
  CHECK(volume->GetStream()->GetNumberOfValues() == stream->GetNumberOfValues() &&
      std::memcmp(volume->GetStream()->GetPointer(0), stream->GetPointer(0),
        stream->GetNumberOfValues()) == 0,
    "another stream");
}
}

//------------------------------------------------------------------------------
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  vtkNew<vtkZFPReader> reader;
  if (bytes.Flag()) // without header
  {
    int dims[3];
    std::generate_n(dims, 3, [&]() { return static_cast<int>(bytes.Integer()); });
    reader->SetDataDimensions(dims);
    reader->SetRate(bytes.Number());
  }
  const File file(bytes.Rest(), bytes.Left());
  reader->SetFileName(file.GetName());
  reader->CanReadFile(file.GetName());
  vtkImageData* image = reader->GetOutput();
  if (!Update(reader))
  {
    CHECK(!vtkCompressedVolume::IsCompressed(image) && image->GetNumberOfPoints() == 0, "output");
    return 0;
  }
  vtkNew<vtkCompressedVolume> volume;
  CHECK(volume->Read(image), volume->GetErrorMessage());
  CheckRange(image, volume);
  CheckWriter(image, volume->GetStream());
  return 0;
}
