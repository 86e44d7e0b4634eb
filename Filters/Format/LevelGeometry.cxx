// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LevelGeometry.h"

#include "vtkCompressedVolume.h"
#include "vtkImageData.h"

//------------------------------------------------------------------------------
void LevelGeometry::Set(
  const int first[3], const int dims[3], const int steps[3], bool cellData, vtkImageData* image)
{
  double start[3], spacing[3], origin[3];
  int extent[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    start[axis] = first[axis] + (cellData ? 0.5 - 0.5 * steps[axis] : 0.0);
    spacing[axis] = image->GetSpacing()[axis] * steps[axis];
    extent[2 * axis] = 0;
    extent[2 * axis + 1] = dims[axis] - (cellData ? 0 : 1);
  }
  image->TransformContinuousIndexToPhysicalPoint(start, origin);
  image->SetExtent(extent);
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
}

//------------------------------------------------------------------------------
void LevelGeometry::Set(
  vtkCompressedVolume* volume, vtkCompressedVolume* level, vtkImageData* image)
{
  const int* const extent = volume->GetExtent();
  const int first[3] = { extent[0], extent[2], extent[4] };
  Set(first, level->GetDimensions(), level->GetSteps(),
    level->GetAssociation() == vtkCompressedVolume::CellData, image);
}
