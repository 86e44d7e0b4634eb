// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MacrocellErrors.h"

#include "Codec/BlockGeometry.h"

#include "vtkFloatArray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
constexpr int MacrocellSide = 4; // in blocks

vtkTypeInt64 MacrocellsAlong(vtkTypeInt64 blocks)
{
  return (blocks + MacrocellSide - 1) / MacrocellSide;
}

//------------------------------------------------------------------------------
// Sets a target to a value that is better than what it holds.
template <typename IsBetter>
void Improve(std::atomic<float>& target, float value, const IsBetter& isBetter)
{
  float held = target.load(std::memory_order_relaxed);
  while (
    isBetter(value, held) && !target.compare_exchange_weak(held, value, std::memory_order_relaxed))
  {
  }
}
}

//------------------------------------------------------------------------------
MacrocellErrors::MacrocellErrors(const vtkTypeInt64 blocks[3])
  : Blocks{ blocks[0], blocks[1], blocks[2] }
  , Accumulators(
      MacrocellsAlong(blocks[0]) * MacrocellsAlong(blocks[1]) * MacrocellsAlong(blocks[2]))
{
  for (Accumulator& accumulator : this->Accumulators)
  {
    accumulator.Low = std::numeric_limits<float>::infinity();
    accumulator.High = -std::numeric_limits<float>::infinity();
    accumulator.Error = 0.0f;
  }
}

//------------------------------------------------------------------------------
vtkTypeInt64 MacrocellErrors::NumberFor(const int dims[3])
{
  vtkTypeInt64 number = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    number *= MacrocellsAlong(BlocksAlong<vtkTypeInt64>(dims[axis]));
  }
  return number;
}

//------------------------------------------------------------------------------
vtkTypeInt64 MacrocellErrors::IndexOf(const vtkTypeInt64 block[3], const vtkTypeInt64 blocks[3])
{
  return block[0] / MacrocellSide +
    MacrocellsAlong(blocks[0]) *
    (block[1] / MacrocellSide + MacrocellsAlong(blocks[1]) * (block[2] / MacrocellSide));
}

//------------------------------------------------------------------------------
void MacrocellErrors::Add(const vtkTypeInt64 block[3], float low, float high, float error)
{
  Accumulator& accumulator = this->Accumulators[IndexOf(block, this->Blocks)];
  const auto isLess = [](float a, float b) { return a < b; };
  const auto isGreater = [](float a, float b) { return a > b; };
  Improve(accumulator.Low, low, isLess);
  Improve(accumulator.High, high, isGreater);
  Improve(accumulator.Error, error, isGreater);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkFloatArray> MacrocellErrors::MakeArray() const
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(this->Accumulators.size()));
  float* values = array->GetPointer(0);
  for (const Accumulator& from : this->Accumulators)
  {
    const bool any = from.Low <= from.High;
    *values++ = any ? from.Low.load() : 1.0f;
    *values++ = any ? from.High.load() : 0.0f;
    *values++ = from.Error;
  }
  return array;
}

//------------------------------------------------------------------------------
// Comparisons with NaN, of a hostile file, are false.
MacrocellErrors::Doubt MacrocellErrors::Judge(vtkFloatArray* macrocells, double isovalue)
{
  Doubt doubt;
  vtkTypeInt64 parts = 0;
  std::vector<double> distances;
  const float* const values = macrocells->GetPointer(0);
  for (vtkIdType i = 0; i < macrocells->GetNumberOfTuples(); ++i)
  {
    const double low = values[3 * i], high = values[3 * i + 1], error = values[3 * i + 2];
    const double below = isovalue - low, above = high - isovalue;
    const double distance = std::min(std::abs(below), std::abs(above));
    if (low <= high && below > -error && above > -error && distance < error)
    {
      ++parts;
      distances.push_back(distance);
      doubt.Error = std::max(doubt.Error, error);
    }
    else if (low < high && below >= 0.0 && above >= 0.0)
    {
      ++parts;
    }
  }
  doubt.IsLikely = 2 * static_cast<vtkTypeInt64>(distances.size()) > parts;
  if (doubt.IsLikely)
  {
    const auto middle = distances.begin() + distances.size() / 2;
    std::nth_element(distances.begin(), middle, distances.end());
    doubt.Distance = *middle;
  }
  return doubt;
}
