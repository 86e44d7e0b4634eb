// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LevelShape.h"

#include "Codec/BlockGeometry.h"

#include "vtkCompressedVolume.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
/// Bits per sample that level 1 gets beyond level 0's; each level after it gets one more.
constexpr int MoreBits = 3;

//------------------------------------------------------------------------------
bool CanHalve(const LevelShape& shape, int axis)
{
  return shape.Dimensions[axis] > 2;
}

//------------------------------------------------------------------------------
bool IsUsable(double spacing)
{
  return std::isfinite(spacing) && spacing != 0.0;
}

//------------------------------------------------------------------------------
double DistanceAlong(const LevelShape& shape, const double spacing[3], int axis)
{
  return shape.Steps[axis] * std::abs(spacing[axis]);
}

//------------------------------------------------------------------------------
// Chooses the axes to halve; false if there is none.
bool ChooseAxes(const LevelShape& shape, const double spacing[3], bool halves[3])
{
  double least = std::numeric_limits<double>::infinity();
  bool any = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    any = any || CanHalve(shape, axis);
    if (CanHalve(shape, axis) && IsUsable(spacing[axis]))
    {
      least = std::min(least, DistanceAlong(shape, spacing, axis));
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    halves[axis] = CanHalve(shape, axis) &&
      (!IsUsable(spacing[axis]) || DistanceAlong(shape, spacing, axis) < std::sqrt(2.0) * least);
  }
  return any;
}
}

//------------------------------------------------------------------------------
LevelShape LevelShape::OfVolume(const int dims[3])
{
  return { { dims[0], dims[1], dims[2] }, { false, false, false }, { 1, 1, 1 } };
}

//------------------------------------------------------------------------------
LevelShape LevelShape::Halve(const bool halves[3]) const
{
  LevelShape next = *this;
  for (int axis = 0; axis < 3; ++axis)
  {
    next.Halves[axis] = halves[axis];
    if (halves[axis])
    {
      next.Dimensions[axis] = HalvedCount(next.Dimensions[axis]);
      next.Steps[axis] *= 2;
    }
  }
  return next;
}

//------------------------------------------------------------------------------
std::vector<LevelShape> PlanLevels(const int dims[3], const double spacing[3], int levels)
{
  std::vector<LevelShape> shapes;
  LevelShape shape = LevelShape::OfVolume(dims);
  bool halves[3];
  while (static_cast<int>(shapes.size()) < levels &&
    *std::max_element(shape.Dimensions, shape.Dimensions + 3) > PageSide &&
    ChooseAxes(shape, spacing, halves))
  {
    shape = shape.Halve(halves);
    shapes.push_back(shape);
  }
  return shapes;
}

//------------------------------------------------------------------------------
int BlockBitsOfLevel(int level, int blockBits)
{
  return std::min(
    blockBits + BlockSamples * (MoreBits - 1 + level), +vtkCompressedVolume::MaximumBlockBits);
}
