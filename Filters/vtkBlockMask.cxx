// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBlockMask.h"

#include "Codec/BlockGeometry.h"

#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkTypeUInt64Array.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
// Runs as tuples. VTK asks arrays of tuples for the range of their lengths, and writes it into
// files. It squares and adds integers as such, which may overflow to a length that is not a number;
// no VTK reads such files without an error. To everybody else this is a vtkTypeUInt64Array.
class RunArray : public vtkTypeUInt64Array
{
public:
  static RunArray* New() { VTK_STANDARD_NEW_BODY(RunArray); }

protected:
  vtkObjectBase* NewInstanceInternal() const override { return RunArray::New(); }

  ///@{
  // Field data have no ghosts.
  bool ComputeVectorRange(double range[2]) override { return this->FindLengths(range); }
  bool ComputeVectorRange(double range[2], const unsigned char*, unsigned char) override
  {
    return this->FindLengths(range);
  }
  bool ComputeFiniteVectorRange(double range[2]) override { return this->FindLengths(range); }
  bool ComputeFiniteVectorRange(double range[2], const unsigned char*, unsigned char) override
  {
    return this->FindLengths(range);
  }
  ///@}

private:
  bool FindLengths(double range[2])
  {
    range[0] = std::numeric_limits<double>::max();
    range[1] = 0.0;
    for (vtkIdType i = 0; i < this->GetNumberOfTuples(); ++i)
    {
      const double length = std::hypot(this->GetComponent(i, 0), this->GetComponent(i, 1));
      range[0] = std::min(range[0], length);
      range[1] = std::max(range[1], length);
    }
    return this->GetNumberOfTuples() > 0;
  }
};

// The first samples along each axis in a block's bits: those with x = 0, y = 0, z = 0.
constexpr vtkTypeUInt64 FirstSamples[3] = { 0x1111111111111111, 0x000F000F000F000F,
  0x000000000000FFFF };

//------------------------------------------------------------------------------
// Adds to each sample's bit that of the next sample along an axis; `next` is the next block.
vtkTypeUInt64 SpreadBits(vtkTypeUInt64 bits, vtkTypeUInt64 next, int axis)
{
  const vtkTypeUInt64 first = FirstSamples[axis];
  const int stride = BlockStrides[axis];
  return bits | ((bits & ~first) >> stride) | ((next & first) << (BlockSide - 1) * stride);
}

//------------------------------------------------------------------------------
// Walks along a row of blocks without a search for each block.
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

  // Counts the blocks from the current one on that have the same bits, up to `limit`.
  vtkTypeInt64 CountAlike(vtkTypeInt64 limit) const
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
  std::size_t Next; // the first run behind the current block
  vtkTypeUInt64 Block;
};

//------------------------------------------------------------------------------
// A row of blocks, and the rows that its cells reach into: the next along y, along z, and along
// both. Rows beyond the volume hide nothing.
class CellRow
{
public:
  CellRow(const std::vector<vtkBlockMask::Run>& runs, const int blocks[3], int y, int z)
    : HasNextY(y + 1 < blocks[1])
    , HasNextZ(z + 1 < blocks[2])
    , Rows{ { runs, Start(blocks, y, z) }, { runs, Start(blocks, y + this->HasNextY, z) },
      { runs, Start(blocks, y, z + this->HasNextZ) },
      { runs, Start(blocks, y + this->HasNextY, z + this->HasNextZ) } }
  {
  }

  vtkTypeInt64 CountAlike(vtkTypeInt64 limit) const
  {
    for (const RowReader& row : this->Rows)
    {
      limit = std::min(limit, row.CountAlike(limit));
    }
    return limit;
  }

  // Skips some blocks that are alike, and returns the cells of each that have a hidden corner. The
  // bits of cells beyond the volume are undefined.
  vtkTypeUInt64 TakeCells(vtkTypeInt64 count, bool isLast)
  {
    vtkTypeUInt64 spread[4];
    for (int i = 0; i < 4; ++i)
    {
      const vtkTypeUInt64 bits = this->Rows[i].Bits();
      this->Rows[i].Skip(count);
      const vtkTypeUInt64 next = count > 1 ? bits : isLast ? 0 : this->Rows[i].Bits();
      spread[i] = SpreadBits(bits, next, 0);
    }
    const vtkTypeUInt64 lower = SpreadBits(spread[0], this->HasNextY ? spread[1] : 0, 1);
    const vtkTypeUInt64 upper = SpreadBits(spread[2], this->HasNextY ? spread[3] : 0, 1);
    return SpreadBits(lower, this->HasNextZ ? upper : 0, 2);
  }

private:
  static vtkTypeUInt64 Start(const int blocks[3], int y, int z)
  {
    return BlockIndex(0, y, z, blocks);
  }

  bool HasNextY;
  bool HasNextZ;
  RowReader Rows[4];
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
  const vtkTypeInt64 block =
    BlockIndex(position[0] / BlockSide, position[1] / BlockSide, position[2] / BlockSide, blocks);
  int bit = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    bit += position[axis] % BlockSide * BlockStrides[axis];
  }
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
  for (int z = 0; z < blocks[2]; ++z)
  {
    for (int y = 0; y < blocks[1]; ++y)
    {
      CellRow row(this->Runs, blocks, y, z);
      RowReader added(other.Runs, BlockIndex(0, y, z, blocks));
      for (vtkTypeInt64 x = 0; x < blocks[0];)
      {
        const vtkTypeInt64 alike = row.CountAlike(added.CountAlike(blocks[0] - x));
        const bool isLast = x + alike == blocks[0];
        // the last of them differs if the next block does
        const vtkTypeInt64 count = std::max<vtkTypeInt64>(isLast ? alike : alike - 1, 1);
        cells.Append(row.TakeCells(count, isLast) | added.Bits(), count);
        added.Skip(count);
        x += count;
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
      RowReader reader(this->Runs, BlockIndex(first[0], y, z, blocks));
      for (vtkTypeInt64 x = 0; x < count[0];)
      {
        const vtkTypeInt64 length = reader.CountAlike(count[0] - x);
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
  vtkSmartPointer<vtkTypeUInt64Array> array = vtkSmartPointer<RunArray>::New();
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
vtkSmartPointer<vtkTypeUInt64Array> vtkBlockMask::CopyArray(vtkDataArray* array)
{
  auto copy = vtkSmartPointer<RunArray>::New();
  copy->DeepCopy(array);
  copy->GetInformation()->Clear(); // of what VTK found of the other
  return copy;
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
