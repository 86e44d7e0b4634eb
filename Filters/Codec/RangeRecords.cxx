// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RangeRecords.h"

#include <zlib.h>

#include <algorithm>
#include <bitset>
#include <cstring>

namespace
{
using RangeRecords::Macrocell;
using RangeRecords::WordsOfSteps;
using RangeSteps::KeyRange;

int CountBits(vtkTypeUInt64 bits)
{
  return static_cast<int>(std::bitset<64>(bits).count());
}

bool AreAlike(const KeyRange& a, const KeyRange& b)
{
  return a.Low == b.Low && a.High == b.High;
}

//------------------------------------------------------------------------------
// Calls visit(place, number in the page) for the macrocells of a page.
template <typename Visit>
void ForEachMacrocell(const RangeLayout::Page& page, const Visit& visit)
{
  const int* const size = page.Size;
  for (int i = 0; i < page.GetNumber(); ++i)
  {
    const vtkTypeInt64 place[3] = { page.First[0] + i % size[0],
      page.First[1] + i / size[0] % size[1], page.First[2] + i / (size[0] * size[1]) };
    visit(place, i);
  }
}

//------------------------------------------------------------------------------
KeyRange RangeOf(vtkTypeUInt64 word)
{
  return { RangeRecords::KeyOfBits(static_cast<vtkTypeUInt32>(word)),
    RangeRecords::KeyOfBits(static_cast<vtkTypeUInt32>(word >> 32)) };
}

//------------------------------------------------------------------------------
void StoreSteps(const Macrocell& macrocell, vtkTypeUInt64* words)
{
  for (int i = 0; i < WordsOfSteps; ++i)
  {
    const vtkTypeUInt16* const steps = macrocell.Steps + 4 * i;
    words[i] = steps[0] | static_cast<vtkTypeUInt64>(steps[1]) << 16 |
      static_cast<vtkTypeUInt64>(steps[2]) << 32 | static_cast<vtkTypeUInt64>(steps[3]) << 48;
  }
}

void LoadSteps(const vtkTypeUInt64* words, Macrocell& macrocell)
{
  for (int i = 0; i < RangeLayout::Count; ++i)
  {
    macrocell.Steps[i] = static_cast<vtkTypeUInt16>(words[i / 4] >> 16 * (i % 4));
  }
}

//------------------------------------------------------------------------------
// The steps of a block that need not be stored.
vtkTypeUInt16 ImpliedSteps(
  const RangeLayout& layout, const KeyRange& macrocell, const vtkTypeInt64 block[3])
{
  return !macrocell.IsEmpty() && layout.HasCells(block) ? RangeSteps::AllSteps
                                                        : RangeSteps::NoSteps;
}

//------------------------------------------------------------------------------
// A macrocell has cells if its first block has.
KeyRange ImpliedRange(
  const RangeLayout& layout, const KeyRange& page, const vtkTypeInt64 macrocell[3])
{
  vtkTypeInt64 first[3];
  RangeLayout::FindBlock(macrocell, 0, first);
  return layout.HasCells(first) ? page : KeyRange();
}

//------------------------------------------------------------------------------
bool AreImplied(const RangeLayout& layout, const vtkTypeInt64 place[3], const Macrocell& macrocell)
{
  for (int i = 0; i < RangeLayout::Count; ++i)
  {
    vtkTypeInt64 block[3];
    RangeLayout::FindBlock(place, i, block);
    if (macrocell.Steps[i] != ImpliedSteps(layout, macrocell.Range, block))
    {
      return false;
    }
  }
  return true;
}
}

//------------------------------------------------------------------------------
vtkTypeInt64 RangeRecords::CountWords(int macrocells, vtkTypeUInt64 mask)
{
  return 1 + macrocells + WordsOfSteps * CountBits(mask);
}

//------------------------------------------------------------------------------
void RangeRecords::ImplySteps(
  const RangeLayout& layout, const vtkTypeInt64 place[3], Macrocell& macrocell)
{
  RangeLayout::ForEachBlock(place,
    [&](int i, const vtkTypeInt64 block[3])
    { macrocell.Steps[i] = ImpliedSteps(layout, macrocell.Range, block); });
}

//------------------------------------------------------------------------------
void RangeRecords::Store(
  const RangeLayout::Page& page, int index, const Macrocell& macrocell, vtkTypeUInt64* record)
{
  const int number = page.GetNumber();
  record[1 + index] = WordOf(macrocell.Range);
  StoreSteps(macrocell, record + 1 + number + WordsOfSteps * index);
}

//------------------------------------------------------------------------------
void RangeRecords::Load(const RangeLayout& layout, const RangeLayout::Page& page,
  const vtkTypeInt64 place[3], const vtkTypeUInt64* record, Macrocell& macrocell)
{
  const int index = RangeLayout::PlaceIn(page, place);
  const vtkTypeUInt64 bit = vtkTypeUInt64(1) << index;
  macrocell.Range = RangeOf(record[1 + index]);
  if (record[0] & bit)
  {
    const int before = CountBits(record[0] & (bit - 1));
    LoadSteps(record + 1 + page.GetNumber() + WordsOfSteps * before, macrocell);
  }
  else
  {
    ImplySteps(layout, place, macrocell);
  }
}

//------------------------------------------------------------------------------
void RangeRecords::Imply(const RangeLayout& layout, const KeyRange& page,
  const vtkTypeInt64 place[3], Macrocell& macrocell)
{
  macrocell.Range = ImpliedRange(layout, page, place);
  ImplySteps(layout, place, macrocell);
}

//------------------------------------------------------------------------------
vtkTypeInt64 RangeRecords::Pack(const RangeLayout& layout, vtkTypeInt64 number,
  const vtkTypeUInt64* record, vtkTypeUInt64* target, KeyRange& range)
{
  const RangeLayout::Page page = layout.GetPage(number);
  const int count = page.GetNumber();
  const vtkTypeUInt64* const steps = record + 1 + count;
  vtkTypeUInt64 mask = 0;
  Macrocell stored;
  range = KeyRange();
  ForEachMacrocell(page,
    [&](const vtkTypeInt64 place[3], int i)
    {
      stored.Range = RangeOf(record[1 + i]);
      LoadSteps(steps + WordsOfSteps * i, stored);
      mask |= static_cast<vtkTypeUInt64>(!AreImplied(layout, place, stored)) << i;
      range.Add(stored.Range);
    });
  bool isImplied = mask == 0 && (range.IsEmpty() || range.Low == range.High);
  ForEachMacrocell(page,
    [&](const vtkTypeInt64 place[3], int i) {
      isImplied = isImplied && AreAlike(ImpliedRange(layout, range, place), RangeOf(record[1 + i]));
    });
  if (isImplied)
  {
    return 0;
  }
  target[0] = mask;
  std::memmove(target + 1, record + 1, sizeof(*target) * static_cast<std::size_t>(count));
  vtkTypeUInt64* end = target + 1 + count;
  for (int i = 0; i < count; ++i)
  {
    if (mask >> i & 1)
    {
      std::memmove(end, steps + WordsOfSteps * i, sizeof(*target) * WordsOfSteps);
      end += WordsOfSteps;
    }
  }
  return end - target;
}

//------------------------------------------------------------------------------
vtkTypeUInt32 RangeRecords::ChecksumOf(const vtkTypeUInt64* record, vtkTypeInt64 words)
{
  const auto* const bytes = reinterpret_cast<const Bytef*>(record);
  return static_cast<vtkTypeUInt32>(
    crc32_z(0, bytes, sizeof(*record) * static_cast<std::size_t>(words)));
}
