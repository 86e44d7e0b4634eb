// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Checksums.h"

#include "Codec/BlockGeometry.h"

#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationObjectBaseKey.h"
#include "vtkStringArray.h"
#include "vtkTypeUInt32Array.h"
#include "vtkTypeUInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <string>

namespace
{
constexpr vtkTypeInt64 PageBytes = vtkCompressedVolume::PageBytes;

//------------------------------------------------------------------------------
// Adds bytes to a checksum; zlib takes at most 2^32 - 1 at a time.
vtkTypeUInt32 Add(vtkTypeUInt32 sum, const void* data, std::size_t bytes)
{
  return static_cast<vtkTypeUInt32>(crc32_z(sum, static_cast<const Bytef*>(data), bytes));
}

vtkTypeUInt32 AddText(vtkTypeUInt32 sum, const std::string& text)
{
  return Add(sum, text.c_str(), text.size() + 1); // with the 0 at its end
}

//------------------------------------------------------------------------------
vtkTypeUInt32 OfPage(vtkUnsignedCharArray* stream, vtkTypeInt64 bytes, vtkTypeInt64 page)
{
  const vtkTypeInt64 begin = page * PageBytes;
  return Add(0, stream->GetPointer(begin), std::min(PageBytes, bytes - begin));
}

//------------------------------------------------------------------------------
// Adds an array's values as 64-bit integers, doubles, or texts: readers may give back integers of
// another width.
vtkTypeUInt32 AddValues(vtkTypeUInt32 sum, vtkAbstractArray* array)
{
  const vtkIdType number = array->GetNumberOfValues();
  sum = AddText(sum, std::to_string(number));
  if (auto* const texts = vtkArrayDownCast<vtkStringArray>(array))
  {
    for (vtkIdType i = 0; i < number; ++i)
    {
      sum = AddText(sum, texts->GetValue(i));
    }
    return sum;
  }
  auto* const numbers = vtkArrayDownCast<vtkDataArray>(array);
  if (numbers && number > 0 && numbers->GetDataTypeSize() == 8 &&
    numbers->HasStandardMemoryLayout())
  {
    return Add(sum, numbers->GetVoidPointer(0), 8 * static_cast<std::size_t>(number));
  }
  const int components = array->GetNumberOfComponents();
  for (vtkIdType i = 0; numbers && i < number; ++i)
  {
    const double value = numbers->GetComponent(i / components, static_cast<int>(i % components));
    const bool isReal = numbers->GetDataType() == VTK_FLOAT || numbers->GetDataType() == VTK_DOUBLE;
    const vtkTypeInt64 integer = isReal ? 0 : static_cast<vtkTypeInt64>(value);
    sum = isReal ? Add(sum, &value, sizeof(value)) : Add(sum, &integer, sizeof(integer));
  }
  return sum;
}

//------------------------------------------------------------------------------
// What a stream that is known to be intact carries: its address and modified time, and the checksum
// of its checksums.
vtkInformationObjectBaseKey* IntactKey()
{
  static auto* const key =
    vtkInformationObjectBaseKey::MakeKey("IntactStream", "vtkCompressedVolume", "vtkObjectBase");
  return key;
}

vtkSmartPointer<vtkTypeUInt64Array> MakeStamp(
  vtkUnsignedCharArray* stream, vtkTypeUInt32Array* checksums)
{
  auto stamp = vtkSmartPointer<vtkTypeUInt64Array>::New();
  stamp->InsertNextValue(reinterpret_cast<std::uintptr_t>(stream->GetPointer(0)));
  stamp->InsertNextValue(stream->GetMTime());
  stamp->InsertNextValue(Checksums::OfChecksums(checksums));
  return stamp;
}
}

//------------------------------------------------------------------------------
vtkTypeInt64 Checksums::NumberOfPages(vtkTypeInt64 bytes)
{
  return (bytes + PageBytes - 1) / PageBytes;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkTypeUInt32Array> Checksums::OfPages(
  vtkUnsignedCharArray* stream, vtkTypeInt64 bytes)
{
  auto sums = vtkSmartPointer<vtkTypeUInt32Array>::New();
  const vtkTypeInt64 pages = NumberOfPages(bytes);
  sums->SetNumberOfValues(pages);
  vtkTypeUInt32* const values = sums->GetPointer(0);
#pragma omp parallel for schedule(static)
  for (vtkTypeInt64 page = 0; page < pages; ++page)
  {
    values[page] = OfPage(stream, bytes, page);
  }
  return sums;
}

//------------------------------------------------------------------------------
Status Checksums::CheckPages(vtkCompressedVolume* volume, vtkTypeUInt32Array* expected)
{
  vtkUnsignedCharArray* const stream = volume->GetStream();
  const vtkTypeInt64 blockBits = volume->GetBlockBits();
  const vtkTypeInt64 bytes =
    vtkCompressedVolume::StreamBytesFor(volume->GetDimensions(), volume->GetBlockBits());
  const vtkTypeInt64 pages = NumberOfPages(bytes);
  const vtkTypeUInt32* const sums = expected->GetPointer(0);
  vtkTypeInt64 damaged = 0, first = pages;
#pragma omp parallel for schedule(static) reduction(+ : damaged) reduction(min : first)
  for (vtkTypeInt64 page = 0; page < pages; ++page)
  {
    if (OfPage(stream, bytes, page) != sums[page])
    {
      ++damaged;
      first = std::min(first, page);
    }
  }
  if (damaged == 0)
  {
    return {};
  }
  int blocks[3];
  volume->GetBlocks(blocks);
  const vtkTypeInt64 begin = first * PageBytes, end = std::min(begin + PageBytes, bytes);
  const vtkTypeInt64 slab = static_cast<vtkTypeInt64>(blocks[0]) * blocks[1];
  const vtkTypeInt64 lastBlock = std::min(8 * end / blockBits, slab * blocks[2] - 1);
  const vtkTypeInt64 lastSlice = BlockSide * (lastBlock / slab) + BlockSide - 1;
  return Status::Error("is damaged: ", damaged, " of its ", pages, " pages of ", PageBytes,
    " bytes do not match their checksums, the first from byte ", begin, " to ", end - 1,
    " (in slices ", BlockSide * (8 * begin / blockBits / slab), " to ",
    std::min<vtkTypeInt64>(lastSlice, volume->GetDimensions()[2] - 1), " of the samples)");
}

//------------------------------------------------------------------------------
void Checksums::SetIntact(vtkUnsignedCharArray* stream, vtkTypeUInt32Array* checksums)
{
  stream->GetInformation()->Set(IntactKey(), MakeStamp(stream, checksums));
}

//------------------------------------------------------------------------------
bool Checksums::IsKnownIntact(vtkUnsignedCharArray* stream, vtkTypeUInt32Array* checksums)
{
  auto* const known = stream->HasInformation()
    ? vtkTypeUInt64Array::SafeDownCast(stream->GetInformation()->Get(IntactKey()))
    : nullptr;
  const auto now = MakeStamp(stream, checksums);
  return known &&
    std::equal(
      now->GetPointer(0), now->GetPointer(0) + now->GetNumberOfValues(), known->GetPointer(0));
}

//------------------------------------------------------------------------------
vtkTypeUInt32 Checksums::OfChecksums(vtkTypeUInt32Array* checksums)
{
  const std::size_t bytes = sizeof(vtkTypeUInt32) * checksums->GetNumberOfValues();
  return Add(0, checksums->GetPointer(0), bytes);
}

//------------------------------------------------------------------------------
vtkTypeUInt32 Checksums::OfArrays(vtkFieldData* fields, const std::vector<std::string>& names)
{
  vtkTypeUInt32 sum = 0;
  for (const std::string& name : names)
  {
    if (vtkAbstractArray* const array = fields->GetAbstractArray(name.c_str()))
    {
      sum = AddValues(AddText(sum, name), array);
    }
  }
  return sum;
}

//------------------------------------------------------------------------------
vtkTypeUInt32 Checksums::OfFields(
  vtkFieldData* fields, const char* prefix, const char* without, const char* andWithout)
{
  std::map<std::string, vtkAbstractArray*> arrays;
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = fields->GetAbstractArray(i);
    const std::string name = array && array->GetName() ? array->GetName() : "";
    if (name.rfind(prefix, 0) == 0 && name != without && name != andWithout)
    {
      arrays[name] = array;
    }
  }
  vtkTypeUInt32 sum = 0;
  for (const auto& [name, array] : arrays)
  {
    sum = AddValues(AddText(sum, name), array);
  }
  return sum;
}
