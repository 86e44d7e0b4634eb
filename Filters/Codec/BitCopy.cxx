// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BitCopy.h"

#include <algorithm>
#include <cstring>

namespace
{
constexpr int WordBits = 64;
constexpr int WordBytes = 8;

vtkTypeUInt64 LoadWord(const unsigned char* stream, vtkTypeInt64 word)
{
  vtkTypeUInt64 bits;
  std::memcpy(&bits, stream + WordBytes * word, WordBytes);
  return bits;
}

void StoreWord(unsigned char* stream, vtkTypeInt64 word, vtkTypeUInt64 bits)
{
  std::memcpy(stream + WordBytes * word, &bits, WordBytes);
}

// Keeps the lowest bits of a word, fewer than all.
vtkTypeUInt64 LowBits(vtkTypeUInt64 bits, int count)
{
  return bits & ((vtkTypeUInt64(1) << count) - 1);
}

// Loads fewer bits than a word has, from any bit on.
vtkTypeUInt64 LoadBits(const unsigned char* stream, vtkTypeInt64 first, int count)
{
  const vtkTypeInt64 word = first / WordBits;
  const int shift = static_cast<int>(first % WordBits);
  vtkTypeUInt64 bits = LoadWord(stream, word) >> shift;
  if (shift + count > WordBits)
  {
    bits |= LoadWord(stream, word + 1) << (WordBits - shift);
  }
  return LowBits(bits, count);
}

// Copies bits to whole words.
void CopyToWords(
  const unsigned char* from, vtkTypeInt64 fromBit, unsigned char* to, vtkTypeInt64 words)
{
  from += fromBit / WordBits * WordBytes;
  const int shift = static_cast<int>(fromBit % WordBits);
  if (shift == 0)
  {
    std::memcpy(to, from, WordBytes * words);
    return;
  }
  for (vtkTypeInt64 i = 0; i < words; ++i)
  {
    StoreWord(to, i, LoadWord(from, i) >> shift | LoadWord(from, i + 1) << (WordBits - shift));
  }
}
}

//------------------------------------------------------------------------------
void CopyBits(
  const void* from, vtkTypeInt64 fromBit, void* to, vtkTypeInt64 toBit, vtkTypeInt64 count)
{
  const auto* source = static_cast<const unsigned char*>(from);
  auto* target = static_cast<unsigned char*>(to) + toBit / WordBits * WordBytes;
  const int offset = static_cast<int>(toBit % WordBits);
  if (offset > 0 && count > 0)
  {
    const int taken = static_cast<int>(std::min<vtkTypeInt64>(WordBits - offset, count));
    const vtkTypeUInt64 kept = LowBits(LoadWord(target, 0), offset);
    StoreWord(target, 0, kept | LoadBits(source, fromBit, taken) << offset);
    target += WordBytes;
    fromBit += taken;
    count -= taken;
  }
  const vtkTypeInt64 words = count / WordBits;
  CopyToWords(source, fromBit, target, words);
  if (const int rest = static_cast<int>(count % WordBits))
  {
    StoreWord(target, words, LoadBits(source, fromBit + words * WordBits, rest));
  }
}
