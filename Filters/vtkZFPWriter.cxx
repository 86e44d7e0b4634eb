// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPWriter.h"

#include "vtkCompressedVolume.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkUnsignedCharArray.h"

#include <zfp.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

vtkStandardNewMacro(vtkZFPWriter);

namespace
{
//------------------------------------------------------------------------------
// zfp's header for a volume, in whole words; returns its length in bits, 0 when it has no room for
// the dimensions.
size_t MakeHeader(vtkCompressedVolume* volume, vtkTypeUInt64 words[3])
{
  int dims[3];
  volume->GetDimensions(dims);
  const int bits = volume->GetBlockBits();
  bitstream* stream = stream_open(words, 3 * sizeof(vtkTypeUInt64));
  zfp_stream* zfp = zfp_stream_open(stream);
  zfp_field* field = zfp_field_3d(nullptr, zfp_type_float, dims[0], dims[1], dims[2]);
  zfp_stream_set_params(zfp, bits, bits, ZFP_MAX_PREC, ZFP_MIN_EXP);
  const size_t length = zfp_write_header(zfp, field, ZFP_HEADER_FULL);
  stream_flush(stream);
  zfp_field_free(field);
  zfp_stream_close(zfp);
  stream_close(stream);
  return length;
}

//------------------------------------------------------------------------------
// Half a file is of no use; but a device or pipe is not ours to remove.
void RemoveFile(const char* name)
{
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored))
  {
    std::filesystem::remove(name, ignored);
  }
}

//------------------------------------------------------------------------------
// Writes bits to a file, a word at a time: first a header, then the stream right behind its last
// bit.
class BitWriter
{
public:
  explicit BitWriter(std::ostream& file)
    : File(file)
  {
  }

  // `bits` bits in words that are zero behind them
  void Write(const unsigned char* bytes, vtkTypeInt64 bits)
  {
    constexpr vtkTypeInt64 chunk = 1 << 16;
    std::vector<vtkTypeUInt64> words;
    for (vtkTypeInt64 done = 0; done < bits; done += 64 * chunk)
    {
      const vtkTypeInt64 left = bits - done;
      words.resize(std::min(chunk, (left + 63) / 64));
      memcpy(words.data(), bytes + done / 8, words.size() * sizeof(vtkTypeUInt64));
      this->Append(words, std::min(left, 64 * chunk));
    }
  }

  void Finish()
  {
    if (this->Bits)
    {
      this->File.write(reinterpret_cast<const char*>(&this->Pending), sizeof(this->Pending));
    }
  }

private:
  void Append(std::vector<vtkTypeUInt64>& words, vtkTypeInt64 bits)
  {
    if (this->Bits)
    {
      for (vtkTypeUInt64& word : words)
      {
        const vtkTypeUInt64 next = word >> (64 - this->Bits);
        word = this->Pending | word << this->Bits;
        this->Pending = next;
      }
    }
    const vtkTypeInt64 total = this->Bits + bits;
    if (total / 64 < static_cast<vtkTypeInt64>(words.size()))
    {
      this->Pending = words.back(); // not full
      words.pop_back();
    }
    this->Bits = total % 64;
    this->File.write(
      reinterpret_cast<const char*>(words.data()), words.size() * sizeof(vtkTypeUInt64));
  }

  std::ostream& File;
  vtkTypeUInt64 Pending = 0; // the last, incomplete word
  int Bits = 0;              // its bits in use
};
}

//------------------------------------------------------------------------------
vtkZFPWriter::~vtkZFPWriter()
{
  this->SetFileName(nullptr);
}

//------------------------------------------------------------------------------
int vtkZFPWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
void vtkZFPWriter::WriteData()
{
  vtkNew<vtkCompressedVolume> volume;
  if (!this->FileName || !*this->FileName)
  {
    vtkErrorMacro("No FileName to write to.");
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
  }
  else if (!volume->Read(vtkImageData::SafeDownCast(this->GetInput())))
  {
    vtkErrorMacro("The input is " << volume->GetErrorMessage() << ".");
    this->SetErrorCode(vtkErrorCode::UserError);
  }
  else if (!volume->Covers(vtkImageData::SafeDownCast(this->GetInput())))
  {
    vtkErrorMacro("The input is a piece of a compressed volume, and a zfp file holds a whole one: "
                  "decompress it, compress it again and write that.");
    this->SetErrorCode(vtkErrorCode::UserError);
  }
  else if (volume->HidesAny())
  {
    vtkErrorMacro("The input has hidden samples or cells, and a zfp file has no place for them: "
                  "write it as .vti.");
    this->SetErrorCode(vtkErrorCode::UserError);
  }
  else
  {
    this->WriteFile(volume);
  }
}

//------------------------------------------------------------------------------
void vtkZFPWriter::WriteFile(vtkCompressedVolume* volume)
{
  vtkTypeUInt64 header[3] = { 0, 0, 0 };
  const size_t headerBits = this->WriteHeader ? MakeHeader(volume, header) : 0;
  if (this->WriteHeader && headerBits == 0)
  {
    vtkErrorMacro("zfp's header holds at most 65536 samples per axis: write without header.");
    this->SetErrorCode(vtkErrorCode::UserError);
    return;
  }
  std::ofstream file(this->FileName, std::ios::binary);
  if (!file)
  {
    vtkErrorMacro("Cannot open " << this->FileName << " for writing.");
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    return;
  }
  BitWriter writer(file);
  writer.Write(reinterpret_cast<const unsigned char*>(header), headerBits);
  writer.Write(
    volume->GetStream()->GetPointer(0), volume->GetNumberOfBlocks() * volume->GetBlockBits());
  writer.Finish();
  file.close();
  if (!file)
  {
    vtkErrorMacro("Could not write all of " << this->FileName << " (disk full?).");
    this->SetErrorCode(vtkErrorCode::OutOfDiskSpaceError);
    RemoveFile(this->FileName);
  }
}

//------------------------------------------------------------------------------
void vtkZFPWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "WriteHeader: " << (this->WriteHeader ? "on" : "off") << "\n";
}
