// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HidingFlags.h"

#include "Codec/BlockGeometry.h"

#include "vtkImageData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace
{
//------------------------------------------------------------------------------
// Returns a ghost array if any of `number` tuples has one of some flags, else null.
vtkUnsignedCharArray* FindFlags(
  vtkUnsignedCharArray* ghosts, vtkIdType number, unsigned char hiding)
{
  if (!ghosts || ghosts->GetNumberOfComponents() != 1 || ghosts->GetNumberOfTuples() != number)
  {
    return nullptr;
  }
  const unsigned char* begin = ghosts->GetPointer(0);
  const unsigned char* end = begin + ghosts->GetNumberOfValues();
  const bool found =
    std::any_of(begin, end, [=](unsigned char flags) { return (flags & hiding) != 0; });
  return found ? ghosts : nullptr;
}

//------------------------------------------------------------------------------
// Returns the flags of the 8 points from `first` on together.
unsigned char FlagsOfCorners(
  vtkUnsignedCharArray* points, vtkIdType first, vtkIdType row, vtkIdType slice)
{
  unsigned char flags = 0;
  for (int corner = 0; corner < 8; ++corner)
  {
    flags |=
      points->GetValue(first + (corner & 1) + row * (corner >> 1 & 1) + slice * (corner >> 2));
  }
  return flags;
}

//------------------------------------------------------------------------------
// The flags of an image's points, or cells, by indices.
class PlacedFlags
{
public:
  PlacedFlags(vtkUnsignedCharArray* flags, const int extent[6], bool ofCells)
    : Flags(flags)
    , Hiding(ofCells ? HidingFlags::OfCells : HidingFlags::OfPoints)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->First[axis] = extent[2 * axis];
      this->Size[axis] = extent[2 * axis + 1] - extent[2 * axis] + (ofCells ? 0 : 1);
    }
  }

  // Whether the image has the point, or cell, and hides it.
  bool Hides(const int index[3]) const
  {
    vtkIdType at[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] = static_cast<vtkIdType>(index[axis]) - this->First[axis];
      if (at[axis] < 0 || at[axis] >= this->Size[axis])
      {
        return false;
      }
    }
    return this->Flags->GetValue(at[0] + this->Size[0] * (at[1] + this->Size[1] * at[2])) &
      this->Hiding;
  }

private:
  vtkUnsignedCharArray* Flags;
  unsigned char Hiding;
  int First[3];
  vtkIdType Size[3];
};

//------------------------------------------------------------------------------
// Returns a bit for each cell of the block whose lowest corner is given: whether it is hidden.
vtkTypeUInt64 HiddenCellsOfBlock(
  vtkUnsignedCharArray* cells, const int size[3], int x, int y, int z)
{
  const vtkIdType row = size[0] - 1, slice = row * (size[1] - 1);
  vtkTypeUInt64 bits = 0;
  for (int i = 0; i < BlockSamples; ++i)
  {
    const int at[3] = { x + i % BlockSide, y + i / BlockSide % BlockSide, z + i / BlockSlice };
    const bool exists = at[0] + 1 < size[0] && at[1] + 1 < size[1] && at[2] + 1 < size[2];
    if (exists && (cells->GetValue(at[0] + row * at[1] + slice * at[2]) & HidingFlags::OfCells))
    {
      bits |= vtkTypeUInt64(1) << i;
    }
  }
  return bits;
}
}

//------------------------------------------------------------------------------
vtkUnsignedCharArray* HidingFlags::FindForPoints(vtkImageData* image)
{
  return FindFlags(image->GetPointGhostArray(), image->GetNumberOfPoints(), OfPoints);
}

//------------------------------------------------------------------------------
vtkUnsignedCharArray* HidingFlags::FindForCells(vtkImageData* image)
{
  return FindFlags(image->GetCellGhostArray(), image->GetNumberOfCells(), OfCells);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnsignedCharArray> HidingFlags::MergeIntoCells(
  vtkUnsignedCharArray* points, vtkUnsignedCharArray* cells, const int extent[6])
{
  if (!points)
  {
    return cells;
  }
  const vtkIdType dims[3] = { extent[1] - extent[0], extent[3] - extent[2], extent[5] - extent[4] };
  auto merged = vtkSmartPointer<vtkUnsignedCharArray>::New();
  merged->SetNumberOfValues(dims[0] * dims[1] * dims[2]);
  const vtkIdType row = dims[0] + 1, slice = row * (dims[1] + 1);
  for (vtkIdType i = 0; i < merged->GetNumberOfValues(); ++i)
  {
    const vtkIdType first =
      i % dims[0] + row * (i / dims[0] % dims[1]) + slice * (i / dims[0] / dims[1]);
    const bool hides = (FlagsOfCorners(points, first, row, slice) & OfPoints) ||
      (cells && (cells->GetValue(i) & OfCells));
    merged->SetValue(i, hides ? vtkDataSetAttributes::HIDDENCELL : 0);
  }
  return merged;
}

//------------------------------------------------------------------------------
vtkBlockMask HidingFlags::AddToMask(const vtkBlockMask& mask, const int blocks[3],
  const int streamExtent[6], vtkUnsignedCharArray* flags, const int imageExtent[6], bool ofCells)
{
  const PlacedFlags placed(flags, imageExtent, ofCells);
  const vtkTypeInt64 row = blocks[0], slab = row * blocks[1], all = slab * blocks[2];
  vtkBlockMask sum;
  for (vtkTypeInt64 block = 0; block < all; ++block)
  {
    vtkTypeUInt64 bits = mask.Get(block);
    const int start[3] = { streamExtent[0] + static_cast<int>(BlockSide * (block % row)),
      streamExtent[2] + static_cast<int>(BlockSide * (block / row % blocks[1])),
      streamExtent[4] + static_cast<int>(BlockSide * (block / slab)) };
    for (int i = 0; i < BlockSamples; ++i)
    {
      const int index[3] = { start[0] + i % BlockSide, start[1] + i / BlockSide % BlockSide,
        start[2] + i / BlockSlice };
      bits |= static_cast<vtkTypeUInt64>(placed.Hides(index)) << i;
    }
    sum.Append(bits);
  }
  return sum;
}

//------------------------------------------------------------------------------
vtkBlockMask HidingFlags::MakeCellMask(vtkUnsignedCharArray* cells, const int size[3])
{
  vtkBlockMask mask;
  for (int z = 0; z < size[2]; z += BlockSide)
  {
    for (int y = 0; y < size[1]; y += BlockSide)
    {
      for (int x = 0; x < size[0]; x += BlockSide)
      {
        mask.Append(HiddenCellsOfBlock(cells, size, x, y, z));
      }
    }
  }
  return mask;
}
