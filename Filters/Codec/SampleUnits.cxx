// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleUnits.h"

#include "Codec/HiddenSamples.h"
#include "Codec/SampleSummary.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"

#include <algorithm>
#include <cmath>

namespace
{
/// Tuples that are looked at before the finder asks whether it needs more.
constexpr vtkTypeInt64 TuplesPerStep = vtkTypeInt64(1) << 22;

//------------------------------------------------------------------------------
// Extends a range by a component's visible, finite values of some tuples.
struct ExtendRangeWorker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, int component, const HiddenSamples& hidden, vtkTypeInt64 first,
    vtkTypeInt64 last, double range[2]) const
  {
    const auto values = vtk::DataArrayValueRange(array);
    const vtkTypeInt64 stride = array->GetNumberOfComponents();
    double low = range[0], high = range[1];
#pragma omp parallel for reduction(min : low) reduction(max : high)
    for (vtkTypeInt64 tuple = first; tuple < last; ++tuple)
    {
      const double value = static_cast<double>(values[tuple * stride + component]);
      if (std::isfinite(value) && !hidden.IsFlagged(tuple))
      {
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
    range[0] = low;
    range[1] = high;
  }
};

//------------------------------------------------------------------------------
// Whether float32 holds all values of a type in a range.
bool IsExactInFloat(int type, double low, double high)
{
  const auto isExact = [](double value)
  { return static_cast<double>(static_cast<float>(value)) == value; };
  const double most = 16777216.0; // of whole numbers
  return type == VTK_DOUBLE ? low == high && isExact(low) : -most <= low && high <= most;
}
}

//------------------------------------------------------------------------------
SampleUnits SampleUnits::Find(vtkDataArray* array, int component, const HiddenSamples& hidden)
{
  UnitsFinder finder;
  finder.Add(array, component, hidden);
  return finder.GetUnits();
}

//------------------------------------------------------------------------------
void SampleUnits::Normalize(double magnitude)
{
  this->Scale *= std::ldexp(1.0, std::ilogb(magnitude));
}

//------------------------------------------------------------------------------
void UnitsFinder::Add(vtkDataArray* array, int component, const HiddenSamples& hidden)
{
  this->Type = array->GetDataType();
  this->IsSmallType = array->GetDataTypeSize() <= 2;
  const vtkTypeInt64 tuples = array->GetNumberOfTuples();
  ExtendRangeWorker worker;
  double range[2] = { this->Low, this->High };
  for (vtkTypeInt64 first = 0; first < tuples && !this->IsSettled(); first += TuplesPerStep)
  {
    const vtkTypeInt64 last = std::min(first + TuplesPerStep, tuples);
    if (!vtkArrayDispatch::Dispatch::Execute(array, worker, component, hidden, first, last, range))
    {
      worker(array, component, hidden, first, last, range);
    }
    this->Low = range[0];
    this->High = range[1];
  }
}

//------------------------------------------------------------------------------
double UnitsFinder::GetMagnitude() const
{
  return std::max(std::abs(this->Low), std::abs(this->High));
}

//------------------------------------------------------------------------------
// Once this is false of values that are not all the same, it stays false of more values.
bool UnitsFinder::NeedsOffset() const
{
  return this->Type != VTK_FLOAT && !IsExactInFloat(this->Type, this->Low, this->High) &&
    this->High - this->Low < this->GetMagnitude() / 16.0;
}

//------------------------------------------------------------------------------
bool UnitsFinder::IsSettled() const
{
  if (this->IsSmallType || this->Type == VTK_DOUBLE)
  {
    return this->IsSmallType; // any double may be too large for float32
  }
  return this->HasValues() &&
    (this->Type == VTK_FLOAT ? this->GetMagnitude() >= SampleSummary::SafeMagnitude
                             : this->High - this->Low >= this->GetMagnitude() / 16.0);
}

//------------------------------------------------------------------------------
SampleUnits UnitsFinder::GetUnits() const
{
  SampleUnits units;
  if (this->IsSmallType || !this->HasValues())
  {
    return units;
  }
  double magnitude = this->GetMagnitude();
  if (this->NeedsOffset())
  {
    units.Offset = this->Low + (this->High - this->Low) / 2.0;
    magnitude = std::max(std::abs(this->Low - units.Offset), std::abs(this->High - units.Offset));
  }
  if (magnitude > std::numeric_limits<float>::max() ||
    (magnitude > 0.0 && magnitude < SampleSummary::SafeMagnitude))
  {
    units.Normalize(magnitude);
  }
  return units;
}
