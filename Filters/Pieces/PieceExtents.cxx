// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PieceExtents.h"

#include "Codec/BlockGeometry.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace
{
bool IsDuplicate(unsigned char flags)
{
  return (flags & vtkDataSetAttributes::DUPLICATECELL) != 0;
}

//------------------------------------------------------------------------------
// Shrinks an extent to the smallest one with two of its cells. Not by vtkStructuredData, whose
// number of cells in a slice overflows 32 bits.
void ShrinkToCells(vtkTypeInt64 first, vtkTypeInt64 last, int extent[6])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 start = extent[2 * axis], end = extent[2 * axis + 1];
    const vtkTypeInt64 cells = std::max<vtkTypeInt64>(end - start, 1);
    const auto place = std::minmax({ first % cells, last % cells }); // flags may be in disorder
    extent[2 * axis] = static_cast<int>(start + place.first);
    extent[2 * axis + 1] = static_cast<int>(std::min(start + place.second + 1, end));
    first /= cells;
    last /= cells;
  }
}
}

//------------------------------------------------------------------------------
bool PieceExtents::IsEmptyPiece(vtkInformation* input)
{
  vtkImageData* image = vtkImageData::GetData(input);
  return image && image->GetNumberOfPoints() == 0 &&
    input->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
}

//------------------------------------------------------------------------------
void PieceExtents::GetExtentWithoutGhosts(vtkImageData* image, int extent[6])
{
  image->GetExtent(extent);
  vtkUnsignedCharArray* ghosts = image->GetCellGhostArray();
  // flags of another image say nothing about this one
  if (!ghosts || image->GetNumberOfPoints() <= 0 ||
    ghosts->GetNumberOfValues() != image->GetNumberOfCells())
  {
    return;
  }
  const unsigned char* begin = ghosts->GetPointer(0);
  const unsigned char* end = begin + ghosts->GetNumberOfValues();
  const unsigned char* first = std::find_if_not(begin, end, IsDuplicate);
  if (first == end)
  {
    extent[1] = extent[0] - 1;
    return;
  }
  const unsigned char* last = end - 1;
  while (IsDuplicate(*last))
  {
    --last;
  }
  ShrinkToCells(first - begin, last - begin, extent);
}

//------------------------------------------------------------------------------
void PieceExtents::GetCoveringExtent(
  const int piece[6], const int whole[6], bool cellData, int covering[6])
{
  const int cells = cellData ? 1 : 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int begin = whole[2 * axis];
    // of cell data, the sample at the piece's upper face is the next piece's first
    const int low = std::max(piece[2 * axis] - 1 - begin, 0) / BlockSide * BlockSide;
    const int high = ((piece[2 * axis + 1] + 1 - begin) / BlockSide + 1) * BlockSide - 1 + cells;
    covering[2 * axis] = begin + low;
    covering[2 * axis + 1] = std::min(begin + high, whole[2 * axis + 1]);
  }
}
