// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CompressedPart.h"

#include "Pieces/HidingFlags.h"
#include "Pieces/PieceExtents.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace
{
//------------------------------------------------------------------------------
// Returns an array's tuples within `part` of `extent`, both counted in tuples.
vtkSmartPointer<vtkDataArray> CutTuples(vtkDataArray* array, const int extent[6], const int part[6])
{
  if (std::equal(part, part + 6, extent))
  {
    return array;
  }
  const vtkIdType row = part[1] - part[0] + 1;
  const vtkIdType rows[2] = { extent[1] - extent[0] + 1, extent[3] - extent[2] + 1 };
  auto cut = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
  cut->SetName(array->GetName());
  cut->SetNumberOfComponents(array->GetNumberOfComponents());
  cut->SetNumberOfTuples(row * (part[3] - part[2] + 1) * (part[5] - part[4] + 1));
  vtkIdType end = 0;
  for (int z = part[4]; z <= part[5]; ++z)
  {
    for (int y = part[2]; y <= part[3]; ++y)
    {
      const vtkIdType begin =
        part[0] - extent[0] + rows[0] * (y - extent[2] + rows[1] * (z - extent[4]));
      cut->InsertTuples(end, row, begin, array);
      end += row;
    }
  }
  return cut;
}
}

//------------------------------------------------------------------------------
CompressedPart::CompressedPart(vtkImageData* input, vtkInformation* information, bool cellData)
  : CellData(cellData)
{
  input->GetExtent(this->Input);
  PieceExtents::GetExtentWithoutGhosts(input, this->WithoutGhosts);
  std::copy_n(this->Input, 6, this->Covered);
  if (!std::equal(this->WithoutGhosts, this->WithoutGhosts + 6, this->Input))
  {
    int whole[6]; // of all processes' pieces
    information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
    PieceExtents::GetCoveringExtent(this->WithoutGhosts, whole, cellData, this->Covered);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    int* covered = this->Covered + 2 * axis;
    covered[0] = std::max(covered[0], this->Input[2 * axis]);
    covered[1] = std::min(covered[1], this->Input[2 * axis + 1]);
    this->Size[axis] = covered[1] - covered[0] + (cellData ? 0 : 1);
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataArray> CompressedPart::CutSamples(vtkDataArray* array) const
{
  return this->Cut(array, this->CellData);
}

//------------------------------------------------------------------------------
// Cuts an array of points, or of cells.
vtkSmartPointer<vtkDataArray> CompressedPart::Cut(vtkDataArray* array, bool cellData) const
{
  int given[6], covered[6];
  for (int i = 0; i < 6; ++i)
  {
    const int fewer = cellData ? i % 2 : 0;
    given[i] = this->Input[i] - fewer;
    covered[i] = this->Covered[i] - fewer;
  }
  return CutTuples(array, given, covered);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnsignedCharArray> CompressedPart::FindHiddenSamples(vtkImageData* input) const
{
  vtkSmartPointer<vtkUnsignedCharArray> flags = HidingFlags::FindForPoints(input);
  if (this->CellData)
  {
    flags = HidingFlags::MergeIntoCells(flags, HidingFlags::FindForCells(input), this->Input);
  }
  return flags ? vtkUnsignedCharArray::SafeDownCast(this->CutSamples(flags)) : nullptr;
}

//------------------------------------------------------------------------------
vtkBlockMask CompressedPart::FindHiddenCells(vtkImageData* input) const
{
  vtkUnsignedCharArray* flags = this->CellData ? nullptr : HidingFlags::FindForCells(input);
  if (!flags)
  {
    return vtkBlockMask();
  }
  const vtkSmartPointer<vtkDataArray> cut = this->Cut(flags, true);
  return HidingFlags::MakeCellMask(vtkUnsignedCharArray::SafeDownCast(cut), this->Size);
}
