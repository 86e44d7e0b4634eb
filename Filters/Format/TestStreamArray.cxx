// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Format/StreamArray.h"

#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <sys/mman.h>

#include <vector>

namespace
{
using Range = std::vector<double>;

Range RangeOf(vtkDataArray* array, int component = 0)
{
  Range range(2);
  array->GetRange(range.data(), component);
  Range finite(2);
  array->GetFiniteRange(finite.data(), component);
  EXPECT_EQ(range, finite);
  return range;
}

// As newer ParaView asks.
Range RangeInFields(vtkDataArray* array)
{
  vtkNew<vtkFieldData> fields;
  array->SetName("bytes");
  fields->AddArray(array);
  Range range(2), finite(2);
  EXPECT_TRUE(fields->GetRange("bytes", range.data()));
  EXPECT_TRUE(fields->GetFiniteRange("bytes", finite.data()));
  EXPECT_EQ(range, finite);
  return range;
}

// Memory that cannot be read but for its first page, which has bytes from 0 to 255.
class Forbidden
{
public:
  static constexpr std::size_t Page = 4096, Size = 256 * Page;

  Forbidden()
    : Memory(mmap(nullptr, Size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))
    , Bytes(static_cast<unsigned char*>(this->Memory))
  {
    for (std::size_t i = 0; i < Page; ++i)
    {
      this->Bytes[i] = static_cast<unsigned char>(i);
    }
    mprotect(this->Bytes + Page, Size - Page, PROT_NONE);
  }
  ~Forbidden() { munmap(this->Memory, Size); }
  Forbidden(const Forbidden&) = delete;
  void operator=(const Forbidden&) = delete;

  void* Memory;
  unsigned char* Bytes;
};
}

TEST(StreamArray, RangesOfAllBytes)
{
  for (const int last : { 0, 7, 4095, 4096, 9999 })
  {
    vtkNew<StreamArray> array;
    array->SetNumberOfValues(10000);
    array->Fill(100);
    EXPECT_EQ(RangeOf(array), (Range{ 100, 100 }));
    array->SetValue(last, 3);
    array->SetValue(9999 - last, 254);
    array->Modified();
    EXPECT_EQ(RangeOf(array), (Range{ 3, 254 })) << last;
    EXPECT_EQ(RangeOf(array, -1), (Range{ 3, 254 })) << last;
    EXPECT_EQ(RangeInFields(array), (Range{ 3, 254 })) << last;
  }
}

// What is not a list of bytes is VTK's to answer.
TEST(StreamArray, TuplesAndNothing)
{
  vtkNew<StreamArray> array;
  vtkNew<vtkUnsignedCharArray> usual;
  EXPECT_EQ(RangeOf(array), RangeOf(usual));
  array->SetNumberOfComponents(2);
  array->InsertNextTuple2(3, 4);
  EXPECT_EQ(RangeOf(array, 1), (Range{ 4, 4 }));
  EXPECT_EQ(RangeOf(array, -1), (Range{ 5, 5 }));
}

// A read beyond the first page ends the process.
TEST(StreamArray, LooksAtFewBytes)
{
  const Forbidden memory;
  vtkNew<StreamArray> array;
  array->SetArray(memory.Bytes, Forbidden::Size, 1);
  EXPECT_EQ(RangeOf(array), (Range{ 0, 255 }));
  EXPECT_EQ(RangeOf(array, -1), (Range{ 0, 255 }));
  EXPECT_EQ(RangeInFields(array), (Range{ 0, 255 }));
  const auto shallow = vtk::TakeSmartPointer(array->NewInstance());
  shallow->ShallowCopy(array);
  shallow->Modified();
  EXPECT_EQ(RangeOf(shallow), (Range{ 0, 255 }));
}

TEST(StreamArray, IsOneOfVTKsToOthers)
{
  vtkNew<StreamArray> array;
  EXPECT_STREQ(array->GetClassName(), "vtkUnsignedCharArray");
  EXPECT_EQ(vtkArrayDownCast<vtkUnsignedCharArray>(array.Get()), array.Get());
}
