// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ZFPFile.h"

#include "Codec/ArrayMemory.h"
#include "Codec/BitCopy.h"

#include "vtkCompressedVolume.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <fstream>
#include <vector>

//------------------------------------------------------------------------------
Status ZFPFile::Open(const char* fileName, const int dims[3], double rate)
{
  this->FileName = fileName ? fileName : "";
  std::ifstream file(this->FileName, std::ios::binary | std::ios::ate);
  if (!file)
  {
    return Status::Error("cannot be opened");
  }
  this->FileBytes = static_cast<vtkTypeInt64>(file.tellg());
  this->Layout = ZFPHeader();
  const bool hasHeader = std::all_of(dims, dims + 3, [](int n) { return n == 0; });
  if (hasHeader)
  {
    file.seekg(0);
    if (Status status = ZFPHeader::Read(file, this->FileBytes, this->Layout); !status)
    {
      return status;
    }
  }
  else
  {
    std::copy_n(dims, 3, this->Layout.Dimensions);
    this->Layout.BlockBits = vtkCompressedVolume::BlockBitsForRate(rate);
  }
  return this->CheckLayout();
}

//------------------------------------------------------------------------------
Status ZFPFile::CheckLayout() const
{
  const int* dims = this->GetDimensions();
  const int blockBits = this->GetBlockBits();
  if (blockBits == 0)
  {
    return Status::Error("cannot be read with this Rate: it must be in (0, 32] bits per sample");
  }
  if (*std::min_element(dims, dims + 3) < 2)
  {
    return Status::Error("has ", dims[0], " x ", dims[1], " x ", dims[2],
      " samples, at least 2 along each axis are needed");
  }
  const vtkTypeInt64 streamBytes = vtkCompressedVolume::StreamBytesFor(dims, blockBits);
  const bool fits = streamBytes >= 0;
  const vtkTypeInt64 needed = fits ? (this->Layout.Bits + this->GetStreamBits() + 7) / 8 : 0;
  // without header, only the size shows a wrong dimension or rate
  const bool tooLong = !this->HasHeader() && this->FileBytes > streamBytes;
  if (!fits || this->FileBytes < needed || tooLong)
  {
    return Status::Error("has ", this->FileBytes, " bytes where ", dims[0], " x ", dims[1], " x ",
      dims[2], " samples at ", blockBits / 64.0, " bits need ",
      fits ? std::to_string(needed) : "more than 2^60",
      this->HasHeader() ? ": it is truncated" : ": check DataDimensions and Rate");
  }
  return {};
}

//------------------------------------------------------------------------------
// Returns the length of the stream without padding; must fit, see CheckLayout().
vtkTypeInt64 ZFPFile::GetStreamBits() const
{
  return vtkCompressedVolume::NumberOfBlocksFor(this->GetDimensions()) * this->GetBlockBits();
}

//------------------------------------------------------------------------------
Status ZFPFile::ReadStream(vtkUnsignedCharArray* stream) const
{
  const vtkTypeInt64 bytes =
    vtkCompressedVolume::StreamBytesFor(this->GetDimensions(), this->GetBlockBits());
  if (Status status = AllocateArray(stream, bytes, "the stream", this->GetDimensions()); !status)
  {
    return status.WithPrefix("cannot be read: there is ");
  }
  auto* const words = reinterpret_cast<vtkTypeUInt64*>(stream->GetPointer(0));
  if (!this->ReadWords(words, bytes / 8))
  {
    return Status::Error("could not be read to the end");
  }
  if (const int used = this->GetStreamBits() % 64)
  {
    words[bytes / 8 - 1] &= (vtkTypeUInt64(1) << used) - 1;
  }
  return {};
}

//------------------------------------------------------------------------------
// Reads the words that begin behind the header; the file may end in the middle of one. All threads
// take parts that fit their caches, and move each into place at once.
bool ZFPFile::ReadWords(vtkTypeUInt64* words, vtkTypeInt64 count) const
{
  constexpr vtkTypeInt64 partWords = 1 << 15;
  const vtkTypeInt64 firstBit = this->Layout.Bits;
  bool complete = true;
#pragma omp parallel reduction(&& : complete)
  {
    std::ifstream file(this->FileName, std::ios::binary);
    std::vector<vtkTypeUInt64> part(partWords + 1);
#pragma omp for schedule(dynamic)
    for (vtkTypeInt64 begin = 0; begin < count; begin += partWords)
    {
      const vtkTypeInt64 end = std::min(begin + partWords, count);
      const vtkTypeInt64 offset = 8 * (firstBit / 64 + begin);
      const vtkTypeInt64 bytes = std::min(8 * (end - begin + 1), this->FileBytes - offset);
      std::fill(part.begin() + bytes / 8, part.end(), 0); // where the file ends
      file.clear();
      file.seekg(offset);
      complete = file.read(reinterpret_cast<char*>(part.data()), bytes) && complete;
      CopyBits(part.data(), firstBit % 64, words + begin, 0, 64 * (end - begin));
    }
  }
  return complete;
}
