// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RangeSteps.h"

#include <cmath>

namespace
{
// Steps are no shorter than this, so that the numbers between them are not subnormal.
constexpr float LeastUnit = 0x1p-100f;

//------------------------------------------------------------------------------
// As the shaders' RangeUnit() in Grid.glsl, whose sums and products are not contracted either: see
// CMakeLists.txt.
float UnitOf(float low, float high)
{
  const float highPart = high * (1.0f / 256.0f);
  const float lowPart = low * (1.0f / 256.0f);
  return highPart - lowPart;
}

float At(float low, float unit, int steps)
{
  const float way = static_cast<float>(steps) * unit;
  return steps == 0 ? low : low + way;
}

int Guess(float value, float low, float unit)
{
  return static_cast<int>(std::min(std::max((value - low) / unit, 0.0f), 255.0f));
}
}

//------------------------------------------------------------------------------
float RangeSteps::LowOf(float low, float high, int steps)
{
  return At(low, UnitOf(low, high), steps);
}

//------------------------------------------------------------------------------
float RangeSteps::HighOf(float low, float high, int steps)
{
  return steps == 255 ? high : LowOf(low, high, steps);
}

//------------------------------------------------------------------------------
vtkTypeUInt16 RangeSteps::Find(const KeyRange& block, const KeyRange& macrocell)
{
  if (block.IsEmpty())
  {
    return NoSteps;
  }
  const float wholeLow = ValueOf(macrocell.Low), wholeHigh = ValueOf(macrocell.High);
  const float unit = UnitOf(wholeLow, wholeHigh);
  if (!(unit >= LeastUnit) || std::isinf(unit)) // a damaged stream has infinite values
  {
    return AllSteps;
  }
  // begins near the result, which does not depend on where
  int low = Guess(ValueOf(block.Low), wholeLow, unit);
  int high = Guess(ValueOf(block.High), wholeLow, unit);
  while (low > 0 && KeyOf(At(wholeLow, unit, low)) > block.Low)
  {
    --low;
  }
  while (low < 255 && KeyOf(At(wholeLow, unit, low + 1)) <= block.Low)
  {
    ++low;
  }
  while (high < 255 && KeyOf(At(wholeLow, unit, high)) < block.High)
  {
    ++high;
  }
  while (high > 0 && KeyOf(At(wholeLow, unit, high - 1)) >= block.High)
  {
    --high;
  }
  return static_cast<vtkTypeUInt16>(low | high << 8);
}
