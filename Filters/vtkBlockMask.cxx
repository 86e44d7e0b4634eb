// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBlockMask.h"

#include "vtkDataArray.h"
#include "vtkTypeUInt64Array.h"

#include <algorithm>

namespace
{
// In a block's bits: those with x = 0 (y = 0, z = 0), and all others.
constexpr vtkTypeUInt64 FirstX = 0x1111111111111111;
constexpr vtkTypeUInt64 FirstY = 0x000F000F000F000F;
constexpr vtkTypeUInt64 FirstZ = 0x000000000000FFFF;

// Adds to every place what the next one along an axis has; `next` is the next block.
vtkTypeUInt64 SpreadX(vtkTypeUInt64 bits, vtkTypeUInt64 next)
{
  return bits | ((bits & ~FirstX) >> 1) | ((next & FirstX) << 3);
}

vtkTypeUInt64 SpreadY(vtkTypeUInt64 bits, vtkTypeUInt64 next)
{
  return bits | ((bits & ~FirstY) >> 4) | ((next & FirstY) << 12);
}

vtkTypeUInt64 SpreadZ(vtkTypeUInt64 bits, vtkTypeUInt64 next)
{
  return bits | ((bits & ~FirstZ) >> 16) | ((next & FirstZ) << 48);
}

//------------------------------------------------------------------------------
// Walks along a row of blocks without a search for each.
class RowReader
{
public:
  RowReader(const std::vector<vtkBlockMask::Run>& runs, vtkTypeUInt64 block)
    : Runs(runs)
    , Next(std::upper_bound(runs.begin(), runs.end(), block,
             [](vtkTypeUInt64 value, const vtkBlockMask::Run& run) { return value < run.First; }) -
        runs.begin())
    , Block(block)
  {
  }

  // Blocks from the present one on that have the same bits, at most `limit`.
  vtkTypeInt64 Length(vtkTypeInt64 limit) const
  {
    return this->Next < this->Runs.size()
      ? std::min<vtkTypeInt64>(limit, this->Runs[this->Next].First - this->Block)
      : limit;
  }
  vtkTypeUInt64 Bits() const { return this->Next > 0 ? this->Runs[this->Next - 1].Bits : 0; }
  void Skip(vtkTypeInt64 count)
  {
    this->Block += count;
    while (this->Next < this->Runs.size() && this->Runs[this->Next].First <= this->Block)
    {
      ++this->Next;
    }
  }

private:
  const std::vector<vtkBlockMask::Run>& Runs;
  std::size_t Next; // the first run behind the present block
  vtkTypeUInt64 Block;
};
}

//------------------------------------------------------------------------------
void vtkBlockMask::Append(vtkTypeUInt64 bits, vtkTypeInt64 count)
{
  if (count > 0 && (this->Runs.empty() ? bits != 0 : bits != this->Runs.back().Bits))
  {
    if (this->Runs.empty() && this->Blocks > 0)
    {
      this->Runs.push_back({ 0, 0 });
    }
    this->Runs.push_back({ this->Blocks, bits });
  }
  this->Blocks += count;
}

//------------------------------------------------------------------------------
vtkTypeUInt64 vtkBlockMask::Get(vtkTypeInt64 block) const
{
  return RowReader(this->Runs, block).Bits();
}

//------------------------------------------------------------------------------
bool vtkBlockMask::Hides(const int position[3], const int blocks[3]) const
{
  const vtkTypeInt64 block = position[0] / 4 +
    blocks[0] * (position[1] / 4 + static_cast<vtkTypeInt64>(blocks[1]) * (position[2] / 4));
  const int bit = position[0] % 4 + 4 * (position[1] % 4) + 16 * (position[2] % 4);
  return (this->Get(block) >> bit & 1) != 0;
}

//------------------------------------------------------------------------------
vtkBlockMask vtkBlockMask::ToCells(const int blocks[3], const vtkBlockMask& other) const
{
  if (this->IsEmpty())
  {
    return other;
  }
  vtkBlockMask cells;
  const vtkTypeInt64 row = blocks[0], slice = row * blocks[1];
  for (int z = 0; z < blocks[2]; ++z)
  {
    for (int y = 0; y < blocks[1]; ++y)
    {
      // the row of blocks itself, and those that its cells reach into; beyond the volume there are
      // no cells, whatever their bits
      const vtkTypeInt64 first = row * y + slice * z;
      const vtkTypeInt64 up = y + 1 < blocks[1] ? row : 0, behind = z + 1 < blocks[2] ? slice : 0;
      RowReader rows[] = { { this->Runs, static_cast<vtkTypeUInt64>(first) },
        { this->Runs, static_cast<vtkTypeUInt64>(first + up) },
        { this->Runs, static_cast<vtkTypeUInt64>(first + behind) },
        { this->Runs, static_cast<vtkTypeUInt64>(first + up + behind) } };
      RowReader added(other.Runs, first);
      for (vtkTypeInt64 x = 0; x < row;)
      {
        // as far as no row changes before the block after it, all blocks are alike
        vtkTypeInt64 alike = added.Length(row - x);
        vtkTypeUInt64 own[4], next[4];
        for (int i = 0; i < 4; ++i)
        {
          alike = std::min(alike, rows[i].Length(row - x));
        }
        const bool last = x + alike == row;
        alike = std::max<vtkTypeInt64>(last ? alike : alike - 1, 1);
        for (int i = 0; i < 4; ++i)
        {
          own[i] = rows[i].Bits();
          rows[i].Skip(alike);
          next[i] = alike > 1 ? own[i] : last ? 0 : rows[i].Bits();
          own[i] = SpreadX(own[i], next[i]);
        }
        const vtkTypeUInt64 lower = SpreadY(own[0], up > 0 ? own[1] : 0);
        const vtkTypeUInt64 upper = SpreadY(own[2], up > 0 ? own[3] : 0);
        cells.Append(SpreadZ(lower, behind > 0 ? upper : 0) | added.Bits(), alike);
        added.Skip(alike);
        x += alike;
      }
    }
  }
  return cells;
}

//------------------------------------------------------------------------------
vtkBlockMask vtkBlockMask::Crop(const int first[3], const int count[3], const int blocks[3]) const
{
  vtkBlockMask cropped;
  for (vtkTypeInt64 z = first[2]; z < first[2] + count[2] && !this->IsEmpty(); ++z)
  {
    for (vtkTypeInt64 y = first[1]; y < first[1] + count[1]; ++y)
    {
      RowReader reader(this->Runs, first[0] + blocks[0] * (y + blocks[1] * z));
      for (vtkTypeInt64 x = 0; x < count[0];)
      {
        const vtkTypeInt64 length = reader.Length(count[0] - x);
        cropped.Append(reader.Bits(), length);
        reader.Skip(length);
        x += length;
      }
    }
  }
  return cropped;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkTypeUInt64Array> vtkBlockMask::ToArray() const
{
  auto array = vtkSmartPointer<vtkTypeUInt64Array>::New();
  array->SetNumberOfComponents(2);
  array->SetNumberOfTuples(static_cast<vtkIdType>(this->Runs.size()));
  vtkIdType value = 0;
  for (const Run& run : this->Runs)
  {
    array->SetValue(value++, run.First);
    array->SetValue(value++, run.Bits);
  }
  return array;
}

//------------------------------------------------------------------------------
std::string vtkBlockMask::FromArray(vtkDataArray* array, vtkTypeInt64 blocks)
{
  this->Runs.clear();
  this->Blocks = 0;
  // readers may know 64 unsigned bits by another class
  if (array->GetNumberOfComponents() != 2 || array->GetDataTypeSize() != 8 ||
    array->GetDataTypeMin() < 0.0 || array->GetDataType() == VTK_DOUBLE)
  {
    return "is not of pairs of unsigned 64-bit integers";
  }
  vtkBlockMask read;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    const vtkTypeUInt64 first = array->GetVariantValue(2 * i).ToTypeUInt64();
    const vtkTypeUInt64 bits = array->GetVariantValue(2 * i + 1).ToTypeUInt64();
    const bool follows = i == 0 ? first == 0 : first > read.Runs.back().First;
    if (!follows || first >= static_cast<vtkTypeUInt64>(blocks))
    {
      return "does not name blocks of the volume in their order, from the first one on";
    }
    read.Runs.push_back({ first, bits });
  }
  read.Blocks = blocks;
  *this = read;
  return {};
}
