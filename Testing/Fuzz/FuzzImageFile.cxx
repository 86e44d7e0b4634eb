// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads a compressed volume's .vti file, with other values in it, by VTK's reader. Only values
// change: how VTK reads a file that is not XML, or announces a billion values, is not tested here.
#include "HostileImage.h"

#include <vtkImageZFPDecompress.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

#include <cctype>

namespace
{
using namespace fuzz;

//------------------------------------------------------------------------------
// Whether a character is a digit of an array's values, and not of text, whose end VTK's reader does
// not check.
bool IsDigitOfValue(const std::string& text, std::size_t at)
{
  const std::size_t tag = text.rfind('<', at);
  const std::size_t end = text.find('>', tag);
  const std::string name = text.substr(tag, end - tag);
  return end < at && std::isdigit(text[at]) && name.find("<DataArray ") == 0 &&
    name.find("\"String\"") == std::string::npos;
}

//------------------------------------------------------------------------------
// Replaces digits of the values of arrays from some position on.
void ChangeValues(std::string& text, Bytes& bytes)
{
  const std::string characters = "0123456789-+.eEnaif ";
  const std::size_t begin = text.find("<FieldData>");
  const std::size_t end = text.find("</FieldData>");
  if (begin == std::string::npos || end == std::string::npos)
  {
    return;
  }
  for (int i = bytes.Below(12); i > 0; --i)
  {
    std::size_t at = begin + bytes.Take<std::uint16_t>() % (end - begin);
    while (at < end && !IsDigitOfValue(text, at))
    {
      ++at;
    }
    if (at < end)
    {
      text[at] = characters[bytes.Below(static_cast<int>(characters.size()))];
    }
  }
}
}

//------------------------------------------------------------------------------
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  const vtkSmartPointer<vtkImageData> image = HostileImage(bytes);
  if (image->GetNumberOfPoints() <= 0 || image->GetNumberOfPoints() > MostSamples)
  {
    return 0;
  }
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  writer->SetDataModeToAscii();
  writer->WriteToOutputStringOn();
  writer->Write();
  std::string text = writer->GetOutputString();
  ChangeValues(text, bytes);

  vtkNew<vtkXMLImageDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(text);
  vtkNew<vtkImageZFPDecompress> decompress;
  decompress->SetInputConnection(reader->GetOutputPort());
  reader->Update();
  vtkNew<vtkCompressedVolume> volume;
  const bool accepted = volume->Read(reader->GetOutput());
  if (reader->GetErrorCode() == 0 && reader->GetOutput()->GetNumberOfPoints() > 0)
  {
    CHECK(Update(decompress) == accepted, volume->GetErrorMessage());
  }
  return 0;
}
