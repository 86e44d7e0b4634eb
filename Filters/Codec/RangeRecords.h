// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The words of a page's record of ranges: see vtkBlockRanges (internal).
#ifndef RangeRecords_h
#define RangeRecords_h

#include "Codec/RangeLayout.h"
#include "Codec/RangeSteps.h"

#include "vtkType.h"

namespace RangeRecords
{
constexpr int WordsOfSteps = RangeLayout::Count / 4; // 4 of 16 bits a word

/// What is known of a macrocell.
struct Macrocell
{
  RangeSteps::KeyRange Range;
  vtkTypeUInt16 Steps[RangeLayout::Count];
};

inline vtkTypeUInt32 BitsOf(vtkTypeInt32 key)
{
  return static_cast<vtkTypeUInt32>(key ^ (key >> 31 & 0x7FFFFFFF));
}

inline vtkTypeInt32 KeyOfBits(vtkTypeUInt32 bits)
{
  const auto key = static_cast<vtkTypeInt32>(bits);
  return key ^ (key >> 31 & 0x7FFFFFFF);
}

inline vtkTypeUInt64 WordOf(const RangeSteps::KeyRange& range)
{
  return BitsOf(range.Low) | static_cast<vtkTypeUInt64>(BitsOf(range.High)) << 32;
}

/// Counts the words of a record whose first word is `mask`.
vtkTypeInt64 CountWords(int macrocells, vtkTypeUInt64 mask);

/// Whether a first word has only bits of macrocells that there are.
inline bool IsMask(int macrocells, vtkTypeUInt64 mask)
{
  return macrocells == RangeLayout::Count || mask >> macrocells == 0;
}

/// Gives a macrocell the steps that need not be stored.
void ImplySteps(const RangeLayout& layout, const vtkTypeInt64 place[3], Macrocell& macrocell);

/// Stores a macrocell in a record that has steps for all.
void Store(
  const RangeLayout::Page& page, int index, const Macrocell& macrocell, vtkTypeUInt64* record);

/// Loads a macrocell of a record.
void Load(const RangeLayout& layout, const RangeLayout::Page& page, const vtkTypeInt64 place[3],
  const vtkTypeUInt64* record, Macrocell& macrocell);

/// Makes a macrocell of a page that has no record.
void Imply(const RangeLayout& layout, const RangeSteps::KeyRange& page, const vtkTypeInt64 place[3],
  Macrocell& macrocell);

/// Moves a record that has steps for all macrocells to `target`, not behind it, without what need
/// not be stored. Returns its words, which may be 0, and the range of the page.
vtkTypeInt64 Pack(const RangeLayout& layout, vtkTypeInt64 page, const vtkTypeUInt64* record,
  vtkTypeUInt64* target, RangeSteps::KeyRange& range);

/// zlib's CRC-32 of a record's words, little-endian.
vtkTypeUInt32 ChecksumOf(const vtkTypeUInt64* record, vtkTypeInt64 words);
}

#endif
