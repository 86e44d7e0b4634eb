// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPReader.h"

#include "Codec/BlockRangeFinder.h"
#include "Codec/BlockStream.h"
#include "Codec/SampleSummary.h"
#include "Format/StreamArray.h"
#include "Format/ZFPFile.h"
#include "Status.h"

#include "vtkBlockRanges.h"
#include "vtkCompressedVolume.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <filesystem>

vtkStandardNewMacro(vtkZFPReader);

namespace
{
//------------------------------------------------------------------------------
// Decodes all blocks to find the ranges of their values, which zfp files do not hold.
Status FindRanges(const ZFPFile& file, vtkUnsignedCharArray* stream,
  const ProgressCallback& progress, double range[2], vtkBlockRanges& ofBlocks)
{
  const BlockStream blocks(file.GetDimensions(), file.GetBlockBits(), stream->GetPointer(0), 0);
  BlockRangeFinder finder(blocks);
  if (Status status = finder.Allocate(); !status)
  {
    return status.WithPrefix("cannot be read: there is ");
  }
  SampleSummary summary;
  if (!finder.AddAll(blocks, summary, progress))
  {
    return Status::Aborted();
  }
  if (!summary.IsFinite())
  {
    return Status::Error("decodes to values that are not finite: it is damaged",
      file.HasHeader() ? "" : ", or DataDimensions or Rate are wrong");
  }
  range[0] = summary.Minimum;
  range[1] = summary.Maximum;
  ofBlocks = finder.Finish(blocks, vtkBlockMask());
  return {};
}

//------------------------------------------------------------------------------
Status ReadVolume(
  const ZFPFile& file, const ProgressCallback& progress, vtkCompressedVolume* volume)
{
  vtkNew<StreamArray> stream;
  if (Status status = file.ReadStream(stream); !status)
  {
    return status;
  }
  double range[2];
  vtkBlockRanges ranges;
  if (Status status = FindRanges(file, stream, progress, range, ranges); !status)
  {
    return status;
  }
  const int* dims = file.GetDimensions();
  volume->SetBlockBits(file.GetBlockBits());
  volume->SetDimensions(dims[0], dims[1], dims[2]);
  volume->SetRange(range);
  volume->SetScalarType(VTK_FLOAT);
  volume->SetStream(stream);
  volume->SetRanges(ranges);
  return {};
}
}

//------------------------------------------------------------------------------
vtkZFPReader::vtkZFPReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetArrayName("scalars");
}

//------------------------------------------------------------------------------
vtkZFPReader::~vtkZFPReader()
{
  this->SetFileName(nullptr);
  this->SetArrayName(nullptr);
}

//------------------------------------------------------------------------------
bool vtkZFPReader::HasReadableHeader(const char* fileName)
{
  const int none[3] = { 0, 0, 0 };
  return ZFPFile().Open(fileName, none, this->Rate).IsOk();
}

//------------------------------------------------------------------------------
int vtkZFPReader::CanReadFile(const char* fileName)
{
  const std::filesystem::path path(fileName ? fileName : "");
  std::error_code ignored;
  const bool isNamed =
    path.extension() == ".zfp" && std::filesystem::is_regular_file(path, ignored);
  return isNamed || this->HasReadableHeader(fileName) ? 1 : 0;
}

//------------------------------------------------------------------------------
// Shows an error once, though the pipeline asks again for data that did not come.
void vtkZFPReader::ShowError(const std::string& error)
{
  if (error != this->ShownError)
  {
    vtkErrorMacro("File '" << (this->FileName ? this->FileName : "") << "' " << error << ".");
  }
  this->ShownError = error;
  this->SetErrorCode(vtkErrorCode::FileFormatError);
}

//------------------------------------------------------------------------------
// Announces an empty image if the file cannot be opened; RequestData() says why. Until then
// dimensions and rate may come, as in ParaView's panel.
int vtkZFPReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  this->ShownError.clear();
  this->SetErrorCode(vtkErrorCode::NoError);
  ZFPFile file;
  if (file.Open(this->FileName, this->DataDimensions, this->Rate))
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      extent[2 * axis + 1] = file.GetDimensions()[axis] - 1;
    }
  }
  vtkInformation* out = outputVector->GetInformationObject(0);
  out->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  out->Set(vtkDataObject::SPACING(), this->DataSpacing, 3);
  out->Set(vtkDataObject::ORIGIN(), this->DataOrigin, 3);
  return 1;
}

//------------------------------------------------------------------------------
int vtkZFPReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkImageData* output = vtkImageData::GetData(outputVector);
  output->Initialize();
  vtkNew<vtkCompressedVolume> volume;
  ZFPFile file;
  Status status = file.Open(this->FileName, this->DataDimensions, this->Rate);
  if (status)
  {
    status = ReadVolume(file, ProgressOf(this), volume);
  }
  if (status)
  {
    output->SetDimensions(volume->GetDimensions());
    output->SetSpacing(this->DataSpacing);
    output->SetOrigin(this->DataOrigin);
    volume->SetArrayName(this->ArrayName && *this->ArrayName ? this->ArrayName : "scalars");
    volume->Write(output);
  }
  else if (!status.IsAborted())
  {
    this->ShowError(status.GetMessage());
  }
  return 1; // the executive need not add a message of its own
}

//------------------------------------------------------------------------------
void vtkZFPReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto print = [&](const char* name, const auto* v)
  { os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << "\n"; };
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "ArrayName: " << (this->ArrayName ? this->ArrayName : "(none)") << "\n";
  print("DataDimensions", this->DataDimensions);
  os << indent << "Rate: " << this->Rate << "\n";
  print("DataSpacing", this->DataSpacing);
  print("DataOrigin", this->DataOrigin);
}
