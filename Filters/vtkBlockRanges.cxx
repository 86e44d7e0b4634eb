// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBlockRanges.h"

#include "Codec/RangeLayout.h"
#include "Codec/RangeRecords.h"
#include "Status.h"

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace
{
constexpr int EntrySize = 4; // numbers in the directory of a page
constexpr vtkTypeUInt32 FlagUnit = 65536;

struct Entry
{
  RangeSteps::KeyRange Range;
  vtkTypeUInt32 Checksum;
  vtkTypeInt64 Begin; // of its record, in words
  vtkTypeInt64 Words;
};

//------------------------------------------------------------------------------
// Whether an array has integers of so many bytes, whatever its class: readers choose among several.
bool HasIntegers(vtkDataArray* array, int bytes)
{
  return array && array->GetDataTypeSize() == bytes && array->HasStandardMemoryLayout() &&
    array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
}

//------------------------------------------------------------------------------
bool IsAligned(vtkDataArray* array)
{
  const void* const words = array->GetVoidPointer(0);
  return reinterpret_cast<std::uintptr_t>(words) % sizeof(vtkTypeUInt64) == 0;
}

const vtkTypeUInt64* WordsOf(vtkDataArray* records)
{
  return static_cast<const vtkTypeUInt64*>(records->GetVoidPointer(0));
}
}

//------------------------------------------------------------------------------
// What copies share; not changed once it is made.
struct vtkBlockRanges::Arrays
{
  RangeLayout Layout;
  vtkSmartPointer<vtkDataArray> Directory;
  vtkSmartPointer<vtkDataArray> Records;
  std::vector<Entry> Entries;

  const vtkTypeUInt64* RecordOf(const Entry& entry) const
  {
    return WordsOf(this->Records) + entry.Begin;
  }

  Status ReadDirectory();
  Status CheckEntry(vtkTypeInt64 page) const;
};

//------------------------------------------------------------------------------
Status vtkBlockRanges::Arrays::ReadDirectory()
{
  const auto* const values = static_cast<const vtkTypeUInt32*>(this->Directory->GetVoidPointer(0));
  const vtkTypeInt64 pages = this->Layout.GetNumberOfPages();
  this->Entries.reserve(static_cast<std::size_t>(pages));
  vtkTypeInt64 begin = 0;
  for (vtkTypeInt64 page = 0; page < pages; ++page)
  {
    const vtkTypeUInt32* const value = values + EntrySize * page;
    const RangeSteps::KeyRange range = { RangeRecords::KeyOfBits(value[0]),
      RangeRecords::KeyOfBits(value[1]) };
    this->Entries.push_back({ range, value[3], begin, value[2] % FlagUnit });
    begin += this->Entries.back().Words;
  }
  return begin == this->Records->GetNumberOfValues()
    ? Status()
    : Status::Error("its records have ", this->Records->GetNumberOfValues(),
        " words, where its directory tells of ", begin);
}

//------------------------------------------------------------------------------
Status vtkBlockRanges::Arrays::CheckEntry(vtkTypeInt64 page) const
{
  const Entry& entry = this->Entries[static_cast<std::size_t>(page)];
  const int macrocells = this->Layout.GetPage(page).GetNumber();
  if (entry.Words == 0)
  {
    return entry.Range.IsEmpty() || entry.Range.Low == entry.Range.High
      ? Status()
      : Status::Error("its records lack page ", page, ", whose values vary");
  }
  const vtkTypeUInt64 mask = *this->RecordOf(entry);
  return RangeRecords::IsMask(macrocells, mask) &&
      RangeRecords::CountWords(macrocells, mask) == entry.Words
    ? Status()
    : Status::Error(
        "its records do not have page ", page, " as its ", macrocells, " macrocells need it");
}

//------------------------------------------------------------------------------
std::string vtkBlockRanges::FromArrays(
  vtkDataArray* directory, vtkDataArray* records, const int dims[3])
{
  auto made = std::make_shared<Arrays>();
  made->Layout = RangeLayout(dims);
  const vtkTypeInt64 pages = made->Layout.GetNumberOfPages();
  if (!HasIntegers(directory, 4) || directory->GetNumberOfValues() != EntrySize * pages)
  {
    return Status::Error("its directory is not ", pages, " times four 32-bit integers")
      .GetMessage();
  }
  if (!HasIntegers(records, 8))
  {
    return "its records are not 64-bit integers";
  }
  made->Directory = directory;
  made->Records = records;
  if (!IsAligned(records))
  {
    made->Records.TakeReference(records->NewInstance());
    made->Records->DeepCopy(records);
  }
  Status status = made->ReadDirectory();
  for (vtkTypeInt64 page = 0; page < pages && status; ++page)
  {
    status = made->CheckEntry(page);
  }
  if (status)
  {
    this->Shared = std::move(made);
  }
  return status.GetMessage();
}

//------------------------------------------------------------------------------
std::string vtkBlockRanges::CheckRecords() const
{
  const vtkTypeInt64 pages = this->GetNumberOfPages();
  vtkTypeInt64 damaged = 0, first = pages;
#pragma omp parallel for schedule(static) reduction(+ : damaged) reduction(min : first)
  for (vtkTypeInt64 page = 0; page < pages; ++page)
  {
    const Entry& entry = this->Shared->Entries[static_cast<std::size_t>(page)];
    if (RangeRecords::ChecksumOf(this->Shared->RecordOf(entry), entry.Words) != entry.Checksum)
    {
      ++damaged;
      first = std::min(first, page);
    }
  }
  return damaged == 0 ? std::string()
                      : Status::Error("its records are damaged: those of ", damaged, " of ", pages,
                          " pages do not match their checksums, the first that of page ", first)
                          .GetMessage();
}

//------------------------------------------------------------------------------
vtkDataArray* vtkBlockRanges::GetDirectory() const
{
  return this->Shared ? this->Shared->Directory.Get() : nullptr;
}

//------------------------------------------------------------------------------
vtkDataArray* vtkBlockRanges::GetRecords() const
{
  return this->Shared ? this->Shared->Records.Get() : nullptr;
}

//------------------------------------------------------------------------------
bool vtkBlockRanges::Fit(const int dims[3]) const
{
  return this->Shared && std::equal(dims, dims + 3, this->Shared->Layout.GetDimensions());
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkBlockRanges::GetNumberOfMacrocells() const
{
  return this->Shared ? this->Shared->Layout.GetNumberOfMacrocells() : 0;
}

//------------------------------------------------------------------------------
void vtkBlockRanges::GetMacrocell(
  vtkTypeInt64 number, vtkTypeUInt32 range[2], vtkTypeUInt32 steps[]) const
{
  const RangeLayout& layout = this->Shared->Layout;
  const vtkTypeInt64* const count = layout.GetMacrocells();
  const vtkTypeInt64 place[3] = { number % count[0], number / count[0] % count[1],
    number / (count[0] * count[1]) };
  const vtkTypeInt64 pageNumber = layout.PageOf(place);
  const Entry& entry = this->Shared->Entries[static_cast<std::size_t>(pageNumber)];
  RangeRecords::Macrocell macrocell;
  if (entry.Words == 0)
  {
    RangeRecords::Imply(layout, entry.Range, place, macrocell);
  }
  else
  {
    RangeRecords::Load(
      layout, layout.GetPage(pageNumber), place, this->Shared->RecordOf(entry), macrocell);
  }
  range[0] = RangeRecords::BitsOf(macrocell.Range.Low);
  range[1] = RangeRecords::BitsOf(macrocell.Range.High);
  for (int i = 0; i < BlocksPerMacrocell / StepsPerWord; ++i)
  {
    steps[i] =
      macrocell.Steps[2 * i] | static_cast<vtkTypeUInt32>(macrocell.Steps[2 * i + 1]) << 16;
  }
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkBlockRanges::GetNumberOfPages() const
{
  return this->Shared ? this->Shared->Layout.GetNumberOfPages() : 0;
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkBlockRanges::GetNumberOfPagesWithoutRecord() const
{
  return this->Shared ? std::count_if(this->Shared->Entries.begin(), this->Shared->Entries.end(),
                          [](const Entry& entry) { return entry.Words == 0; })
                      : 0;
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkBlockRanges::GetBytes() const
{
  return this->Shared ? 4 * this->Shared->Directory->GetNumberOfValues() +
      8 * this->Shared->Records->GetNumberOfValues()
                      : 0;
}

//------------------------------------------------------------------------------
bool vtkBlockRanges::operator==(const vtkBlockRanges& other) const
{
  if (!this->Shared || !other.Shared)
  {
    return this->Shared == other.Shared;
  }
  const auto same = [](vtkDataArray* a, vtkDataArray* b, int bytes)
  {
    const auto size = static_cast<std::size_t>(bytes) * a->GetNumberOfValues();
    return a->GetNumberOfValues() == b->GetNumberOfValues() &&
      std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), size) == 0;
  };
  return this->Fit(other.Shared->Layout.GetDimensions()) &&
    same(this->Shared->Directory, other.Shared->Directory, 4) &&
    same(this->Shared->Records, other.Shared->Records, 8);
}
