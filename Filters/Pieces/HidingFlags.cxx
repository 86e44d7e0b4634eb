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
