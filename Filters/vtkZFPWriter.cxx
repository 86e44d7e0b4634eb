// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPWriter.h"

#include "Codec/BitCopy.h"
#include "Format/ZFPHeader.h"

#include "vtkCompressedVolume.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

vtkStandardNewMacro(vtkZFPWriter);

namespace
{
//------------------------------------------------------------------------------
// Removes a file that could not be completed, unless it is a device or a pipe.
void RemoveFile(const char* name)
{
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored))
  {
    std::filesystem::remove(name, ignored);
  }
}

//------------------------------------------------------------------------------
// Writes one stream of bits to a file right behind the last bit of another.
class BitWriter
{
public:
  explicit BitWriter(std::ostream& file)
    : File(file)
    , Words(BufferWords)
  {
  }

  void Append(const void* stream, vtkTypeInt64 bits)
  {
    for (vtkTypeInt64 done = 0; done < bits;)
    {
      const vtkTypeInt64 taken = std::min(bits - done, 64 * BufferWords - this->PendingBits);
      CopyBits(stream, done, this->Words.data(), this->PendingBits, taken);
      this->PendingBits += taken;
      done += taken;
      if (this->PendingBits == 64 * BufferWords)
      {
        this->Flush();
      }
    }
  }

  // Writes what is pending, in whole words.
  void Flush()
  {
    this->File.write(
      reinterpret_cast<const char*>(this->Words.data()), (this->PendingBits + 63) / 64 * 8);
    this->PendingBits = 0;
  }

private:
  static constexpr vtkTypeInt64 BufferWords = 1 << 16;

  std::ostream& File;
  std::vector<vtkTypeUInt64> Words;
  vtkTypeInt64 PendingBits = 0; // in Words
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
  else if (volume->HasUnits())
  {
    vtkErrorMacro("The input's stream has units of its own (an offset and a scale), and a zfp file "
                  "has no place for them: write it as .vti.");
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
  vtkTypeUInt64 header[ZFPHeader::MaximumWords] = {};
  const int headerBits =
    this->WriteHeader ? MakeZFPHeader(volume->GetDimensions(), volume->GetBlockBits(), header) : 0;
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
  writer.Append(header, headerBits);
  writer.Append(
    volume->GetStream()->GetPointer(0), volume->GetNumberOfBlocks() * volume->GetBlockBits());
  writer.Flush();
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
