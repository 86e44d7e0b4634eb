// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPReader.h"

#include "vtkCompressedVolume.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkZFPBlocks.h"
#include "vtkZFPMemory.h"

#include <zfp.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkZFPReader);

//------------------------------------------------------------------------------
// What a file holds and where.
struct vtkZFPReader::Layout
{
  std::string FileName;
  vtkTypeInt64 FileBytes = 0;
  int Dimensions[3] = { 0, 0, 0 };
  int BlockBits = 0;
  int HeaderBits = 0; // the stream begins right behind them

  // where CheckLayout() finds nothing wrong
  vtkTypeInt64 PayloadBits() const
  {
    return vtkCompressedVolume::NumberOfBlocksFor(this->Dimensions) * this->BlockBits;
  }
};

namespace
{
constexpr int HeaderWords = (ZFP_HEADER_MAX_BITS + 63) / 64;

const char* ModeName(zfp_mode mode)
{
  switch (mode)
  {
    case zfp_mode_fixed_precision:
      return "fixed precision";
    case zfp_mode_fixed_accuracy:
      return "fixed accuracy";
    case zfp_mode_reversible:
      return "reversible";
    default:
      return "expert";
  }
}

//------------------------------------------------------------------------------
// What zfp's header says, if it is something that a compressed volume can hold.
std::string ReadHeader(
  std::istream& file, vtkTypeInt64 fileBytes, int dims[3], int& blockBits, int& headerBits)
{
  vtkTypeUInt64 words[HeaderWords] = {}; // zero where the file is shorter
  file.read(reinterpret_cast<char*>(words), sizeof(words));
  bitstream* bits = stream_open(words, HeaderWords * sizeof(vtkTypeUInt64));
  zfp_stream* zfp = zfp_stream_open(bits);
  zfp_field* field = zfp_field_alloc();
  headerBits = static_cast<int>(zfp_read_header(zfp, field, ZFP_HEADER_FULL));
  const zfp_field found = *field;
  const zfp_mode mode = zfp_stream_compression_mode(zfp);
  const unsigned int maximumBits = zfp->maxbits;
  zfp_field_free(field);
  zfp_stream_close(zfp);
  stream_close(bits);

  std::ostringstream message;
  if (headerBits == 0 || headerBits > 8 * fileBytes)
  {
    message << "does not start with zfp's header (codec " << zfp_codec_version
            << "); for a file without header give DataDimensions and Rate";
    return message.str();
  }
  if (found.type != zfp_type_float || zfp_field_dimensionality(&found) != 3)
  {
    const char* const types[] = { "none", "int32", "int64", "float", "double" };
    message << "holds a " << zfp_field_dimensionality(&found) << "-D " << types[found.type]
            << " array, only 3-D float can be read";
    return message.str();
  }
  if (mode != zfp_mode_fixed_rate)
  {
    message << "is compressed in " << ModeName(mode)
            << " mode, only fixed rate can be read: compress it with 'zfp -r RATE'";
    return message.str();
  }
  if (maximumBits < vtkCompressedVolume::MinimumBlockBits ||
    maximumBits > vtkCompressedVolume::MaximumBlockBits)
  {
    message << "has a rate of " << maximumBits / 64.0 << " bits per sample, not in 9/64..32";
    return message.str();
  }
  dims[0] = static_cast<int>(found.nx);
  dims[1] = static_cast<int>(found.ny);
  dims[2] = static_cast<int>(found.nz);
  blockBits = static_cast<int>(maximumBits);
  return {};
}

//------------------------------------------------------------------------------
// Reads the words of a stream that begins at a bit of a file, and may end in the middle of a word.
// All threads take parts that fit their caches, each moved into place at once.
bool ReadWords(const std::string& fileName, vtkTypeInt64 fileBytes, vtkTypeInt64 firstBit,
  vtkTypeUInt64* words, vtkTypeInt64 count)
{
  constexpr vtkTypeInt64 part = 1 << 15;
  const int shift = static_cast<int>(firstBit % 64);
  bool complete = true;
#pragma omp parallel reduction(&& : complete)
  {
    std::ifstream file(fileName, std::ios::binary);
    std::vector<vtkTypeUInt64> source(part + 1);
#pragma omp for schedule(dynamic)
    for (vtkTypeInt64 begin = 0; begin < count; begin += part)
    {
      const vtkTypeInt64 end = std::min(begin + part, count);
      const vtkTypeInt64 offset = 8 * (firstBit / 64 + begin);
      const vtkTypeInt64 bytes = std::min(8 * (end - begin + 1), fileBytes - offset);
      std::fill(source.begin() + bytes / 8, source.end(), 0); // where the file ends
      file.clear();
      file.seekg(offset);
      complete = file.read(reinterpret_cast<char*>(source.data()), bytes) && complete;
      for (vtkTypeInt64 i = 0; i < end - begin; ++i)
      {
        words[begin + i] = shift ? source[i] >> shift | source[i + 1] << (64 - shift) : source[i];
      }
    }
  }
  return complete;
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
std::string vtkZFPReader::FindLayout(
  const char* fileName, const int dims[3], double rate, Layout& layout)
{
  layout.FileName = fileName ? fileName : "";
  std::ifstream file(layout.FileName, std::ios::binary | std::ios::ate);
  if (!file)
  {
    return "cannot be opened";
  }
  layout.FileBytes = static_cast<vtkTypeInt64>(file.tellg());

  const bool hasHeader = std::all_of(dims, dims + 3, [](int n) { return n == 0; });
  if (hasHeader)
  {
    file.seekg(0);
    const std::string error =
      ReadHeader(file, layout.FileBytes, layout.Dimensions, layout.BlockBits, layout.HeaderBits);
    if (!error.empty())
    {
      return error;
    }
  }
  else
  {
    std::copy_n(dims, 3, layout.Dimensions);
    layout.BlockBits = vtkCompressedVolume::BlockBitsForRate(rate);
  }
  return CheckLayout(layout);
}

//------------------------------------------------------------------------------
std::string vtkZFPReader::CheckLayout(const Layout& layout)
{
  std::ostringstream message;
  const int* dims = layout.Dimensions;
  if (layout.BlockBits == 0)
  {
    return "cannot be read with this Rate: it must be in (0, 32] bits per sample";
  }
  if (*std::min_element(dims, dims + 3) < 2)
  {
    message << "has " << dims[0] << " x " << dims[1] << " x " << dims[2]
            << " samples, at least 2 along each axis are needed";
    return message.str();
  }
  const vtkTypeInt64 streamBytes = vtkCompressedVolume::StreamBytesFor(dims, layout.BlockBits);
  const vtkTypeInt64 needed =
    streamBytes < 0 ? 0 : (layout.HeaderBits + layout.PayloadBits() + 7) / 8;
  // without header the size is all that shows a wrong dimension or rate
  const bool tooLong = layout.HeaderBits == 0 && layout.FileBytes > streamBytes;
  if (streamBytes < 0 || layout.FileBytes < needed || tooLong)
  {
    message << "has " << layout.FileBytes << " bytes where " << dims[0] << " x " << dims[1] << " x "
            << dims[2] << " samples at " << layout.BlockBits / 64.0 << " bits need ";
    streamBytes < 0 ? message << "more than 2^60" : message << needed;
    message << (layout.HeaderBits ? ": it is truncated" : ": check DataDimensions and Rate");
    return message.str();
  }
  return {};
}

//------------------------------------------------------------------------------
int vtkZFPReader::CanReadFile(const char* fileName)
{
  const int none[3] = { 0, 0, 0 };
  Layout layout;
  return FindLayout(fileName, none, this->Rate, layout).empty() ? 1 : 0;
}

//------------------------------------------------------------------------------
// An error is reported once, though the pipeline asks twice (for information, then for data).
void vtkZFPReader::Report(const std::string& error)
{
  if (error != this->ReportedError)
  {
    vtkErrorMacro("File '" << (this->FileName ? this->FileName : "") << "' " << error << ".");
  }
  this->ReportedError = error;
  this->SetErrorCode(vtkErrorCode::FileFormatError);
}

//------------------------------------------------------------------------------
int vtkZFPReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* out = outputVector->GetInformationObject(0);
  Layout layout;
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  this->ReportedError.clear();
  this->SetErrorCode(vtkErrorCode::NoError);
  const std::string error = FindLayout(this->FileName, this->DataDimensions, this->Rate, layout);
  if (error.empty())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      extent[2 * axis + 1] = layout.Dimensions[axis] - 1;
    }
  }
  else
  {
    this->Report(error);
  }
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
  Layout layout;
  std::string error = FindLayout(this->FileName, this->DataDimensions, this->Rate, layout);
  if (error.empty())
  {
    error = this->Load(layout, output);
  }
  if (!error.empty())
  {
    output->Initialize();
    this->Report(error);
  }
  return 1; // the message is out already: the executive need not add its own
}

//------------------------------------------------------------------------------
std::string vtkZFPReader::Load(const Layout& layout, vtkImageData* output)
{
  const vtkTypeInt64 bytes =
    vtkCompressedVolume::StreamBytesFor(layout.Dimensions, layout.BlockBits);
  vtkNew<vtkUnsignedCharArray> stream;
  if (!vtkZFPMemory::Allocate(stream.Get(), bytes))
  {
    return "cannot be read: there is " +
      vtkZFPMemory::Objection("the stream", layout.Dimensions, bytes);
  }
  auto* const words = reinterpret_cast<vtkTypeUInt64*>(stream->GetPointer(0));
  if (!ReadWords(layout.FileName, layout.FileBytes, layout.HeaderBits, words, bytes / 8))
  {
    return "could not be read to the end";
  }
  if (const int used = layout.PayloadBits() % 64)
  {
    words[bytes / 8 - 1] &= (vtkTypeUInt64(1) << used) - 1;
  }

  std::string error;
  double range[2];
  if (!this->FindRange(layout, words, range, error))
  {
    return error;
  }

  output->SetDimensions(layout.Dimensions);
  output->SetSpacing(this->DataSpacing);
  output->SetOrigin(this->DataOrigin);
  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(layout.BlockBits);
  volume->SetDimensions(layout.Dimensions[0], layout.Dimensions[1], layout.Dimensions[2]);
  volume->SetRange(range);
  volume->SetScalarType(VTK_FLOAT);
  volume->SetArrayName(this->ArrayName && *this->ArrayName ? this->ArrayName : "scalars");
  volume->SetStream(stream);
  volume->Write(output);
  return {};
}

//------------------------------------------------------------------------------
// zfp files hold no range of values: decode all blocks, keeping none. False when aborted or in
// error.
bool vtkZFPReader::FindRange(const Layout& layout, void* words, double range[2], std::string& error)
{
  vtkZFPBlocks blocks(layout.Dimensions, layout.BlockBits, words, 0);
  vtkZFPBlocks::Summary summary;
  if (!blocks.Summarise(summary, vtkZFPBlocks::ReportOf(this)))
  {
    return false;
  }
  if (!summary.IsFinite())
  {
    error = "decodes to values that are not finite: it is damaged";
    error += layout.HeaderBits ? "" : ", or DataDimensions or Rate are wrong";
    return false;
  }
  range[0] = summary.Minimum;
  range[1] = summary.Maximum;
  return true;
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
