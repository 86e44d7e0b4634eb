// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BrickRanges.h"

#include "vtkCompressedVolume.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

//------------------------------------------------------------------------------
bool BrickRanges::IsOf(vtkCompressedVolume* volume, int brickSize) const
{
  return this->StreamTime == volume->GetStream()->GetMTime() && this->BrickSize == brickSize &&
    this->BlockBits == volume->GetBlockBits() &&
    std::equal(this->Dimensions, this->Dimensions + 3, volume->GetDimensions());
}

//------------------------------------------------------------------------------
void BrickRanges::Prepare(vtkCompressedVolume* volume, int brickSize, vtkIdType bricks)
{
  if (this->IsOf(volume, brickSize))
  {
    return;
  }
  this->StreamTime = volume->GetStream()->GetMTime();
  this->BrickSize = brickSize;
  this->BlockBits = volume->GetBlockBits();
  volume->GetDimensions(this->Dimensions);
  this->Ranges.assign(bricks, { 0.0f, 0.0f });
  this->Known.assign(bricks, 0);
}

//------------------------------------------------------------------------------
bool BrickRanges::MayContain(vtkIdType brick, const std::vector<double>& isovalues) const
{
  const Bricks::Range range = this->Ranges[brick];
  return !this->Known[brick] ||
    std::any_of(isovalues.begin(), isovalues.end(),
      [&](double isovalue) { return range.Contains(isovalue); });
}

//------------------------------------------------------------------------------
void BrickRanges::Set(vtkIdType brick, const Bricks::Range& range)
{
  this->Ranges[brick] = range;
  this->Known[brick] = 1;
}
