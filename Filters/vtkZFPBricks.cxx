// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPBricks.h"

#include "Codec/BlockStream.h"

#include <algorithm>
#include <limits>

//------------------------------------------------------------------------------
vtkZFPBricks::vtkZFPBricks(const int dims[3], int size)
  : Size(size)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int cells = dims[axis] - 1;
    this->Dimensions[axis] = dims[axis];
    this->Bricks[axis] = cells / size + (cells % size != 0);
  }
}

//------------------------------------------------------------------------------
vtkIdType vtkZFPBricks::GetNumberOfBricks() const
{
  return static_cast<vtkIdType>(this->Bricks[0]) * this->Bricks[1] * this->Bricks[2];
}

//------------------------------------------------------------------------------
void vtkZFPBricks::GetPlace(vtkIdType brick, int place[3]) const
{
  place[0] = static_cast<int>(brick % this->Bricks[0]);
  place[1] = static_cast<int>(brick / this->Bricks[0] % this->Bricks[1]);
  place[2] = static_cast<int>(brick / this->Bricks[0] / this->Bricks[1]);
}

//------------------------------------------------------------------------------
vtkIdType vtkZFPBricks::GetBrick(const int place[3]) const
{
  return place[0] +
    this->Bricks[0] * (place[1] + static_cast<vtkIdType>(this->Bricks[1]) * place[2]);
}

//------------------------------------------------------------------------------
vtkZFPBricks::Box vtkZFPBricks::GetBox(vtkIdType brick) const
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
vtkIdType vtkZFPBricks::FindOwner(const int sample[3]) const
{
  int place[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    // the volume's last sample begins no brick
    place[axis] = std::min(sample[axis] / this->Size, this->Bricks[axis] - 1);
  }
  return this->GetBrick(place);
}

//------------------------------------------------------------------------------
void vtkZFPBricks::Decode(
  const BlockStream& blocks, vtkIdType brick, int halo, Samples& samples) const
{
  const Box box = this->GetBox(brick);
  int first[3];
  int last[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    first[axis] = std::max(box.First[axis] - halo, 0) / 4;
    last[axis] = std::min(box.Last[axis] + halo, this->Dimensions[axis] - 1) / 4 + 1;
    samples.First[axis] = 4 * first[axis];
  }
  samples.Stride[1] = 4 * static_cast<vtkIdType>(last[0] - first[0]);
  samples.Stride[2] = 4 * samples.Stride[1] * (last[1] - first[1]);
  samples.Values.resize(4 * samples.Stride[2] * (last[2] - first[2]));
  blocks.DecodeBox(first, last, samples.Values.data());
}

//------------------------------------------------------------------------------
vtkZFPBricks::Range vtkZFPBricks::FindRange(vtkIdType brick, const Samples& samples) const
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
