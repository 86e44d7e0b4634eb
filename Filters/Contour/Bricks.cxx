// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Bricks.h"

#include "Codec/BlockGeometry.h"
#include "Codec/BlockStream.h"

#include <algorithm>
#include <limits>

//------------------------------------------------------------------------------
Bricks::Bricks(const int dims[3], int size)
  : Size(size)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int cells = dims[axis] - 1;
    this->Dimensions[axis] = dims[axis];
    this->BricksPerAxis[axis] = cells / size + (cells % size != 0);
  }
}

//------------------------------------------------------------------------------
vtkIdType Bricks::GetNumberOfBricks() const
{
  return static_cast<vtkIdType>(this->BricksPerAxis[0]) * this->BricksPerAxis[1] *
    this->BricksPerAxis[2];
}

//------------------------------------------------------------------------------
void Bricks::GetPlace(vtkIdType brick, int place[3]) const
{
  place[0] = static_cast<int>(brick % this->BricksPerAxis[0]);
  place[1] = static_cast<int>(brick / this->BricksPerAxis[0] % this->BricksPerAxis[1]);
  place[2] = static_cast<int>(brick / this->BricksPerAxis[0] / this->BricksPerAxis[1]);
}

//------------------------------------------------------------------------------
vtkIdType Bricks::GetBrick(const int place[3]) const
{
  return place[0] +
    this->BricksPerAxis[0] * (place[1] + static_cast<vtkIdType>(this->BricksPerAxis[1]) * place[2]);
}

//------------------------------------------------------------------------------
Bricks::Box Bricks::GetBox(vtkIdType brick) const
{
  int place[3];
  this->GetPlace(brick, place);
  Box box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] = place[axis] * this->Size;
    const int left = this->Dimensions[axis] - 1 - box.First[axis];
    box.Last[axis] = box.First[axis] + std::min(this->Size, left);
  }
  return box;
}

//------------------------------------------------------------------------------
vtkIdType Bricks::FindOwner(const int sample[3]) const
{
  int place[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    // the volume's last sample begins no brick
    place[axis] = std::min(sample[axis] / this->Size, this->BricksPerAxis[axis] - 1);
  }
  return this->GetBrick(place);
}

//------------------------------------------------------------------------------
void Bricks::Decode(const BlockStream& blocks, vtkIdType brick, int halo, Samples& samples) const
{
  const Box box = this->GetBox(brick);
  int first[3];
  int last[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    first[axis] = std::max(box.First[axis] - halo, 0) / BlockSide;
    last[axis] = std::min(box.Last[axis] + halo, this->Dimensions[axis] - 1) / BlockSide + 1;
    samples.First[axis] = BlockSide * first[axis];
  }
  samples.Stride[1] = BlockSide * static_cast<vtkIdType>(last[0] - first[0]);
  samples.Stride[2] = BlockSide * samples.Stride[1] * (last[1] - first[1]);
  samples.Values.resize(BlockSide * samples.Stride[2] * (last[2] - first[2]));
  blocks.DecodeBox(first, last, samples.Values.data());
}

//------------------------------------------------------------------------------
Bricks::Range Bricks::FindRange(vtkIdType brick, const Samples& samples) const
{
  const Box box = this->GetBox(brick);
  const float infinity = std::numeric_limits<float>::infinity();
  Range range = { infinity, -infinity };
  bool nan = false;
  for (int z = box.First[2]; z <= box.Last[2]; ++z)
  {
    for (int y = box.First[1]; y <= box.Last[1]; ++y)
    {
      const float* const row = samples.At(box.First[0], y, z);
      for (int x = 0; x <= box.Last[0] - box.First[0]; ++x)
      {
        range.Minimum = row[x] < range.Minimum ? row[x] : range.Minimum;
        range.Maximum = row[x] > range.Maximum ? row[x] : range.Maximum;
        nan |= row[x] != row[x];
      }
    }
  }
  range.Minimum = nan ? -infinity : range.Minimum;
  return range;
}
