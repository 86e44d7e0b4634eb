// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleUnits.h"

#include "Codec/HiddenSamples.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
//------------------------------------------------------------------------------
// Finds the range of a component's visible, finite values; empty (low > high) if there are none.
struct FindRangeWorker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, int component, const HiddenSamples& hidden, double range[2]) const
  {
    const auto values = vtk::DataArrayValueRange(array);
    const vtkTypeInt64 stride = array->GetNumberOfComponents();
    const vtkTypeInt64 tuples = array->GetNumberOfTuples();
    double low = std::numeric_limits<double>::infinity(), high = -low;
#pragma omp parallel for reduction(min : low) reduction(max : high)
    for (vtkTypeInt64 tuple = 0; tuple < tuples; ++tuple)
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
void FindVisibleRange(
  vtkDataArray* array, int component, const HiddenSamples& hidden, double range[2])
{
  FindRangeWorker worker;
  if (!vtkArrayDispatch::Dispatch::Execute(array, worker, component, hidden, range))
  {
    worker(array, component, hidden, range);
  }
}

//------------------------------------------------------------------------------
// Whether float32 holds all values of a type in a range.
bool IsExactInFloat(int type, const double range[2])
{
  const auto isExact = [](double value)
  { return static_cast<double>(static_cast<float>(value)) == value; };
  const double most = 16777216.0; // of whole numbers
  return type == VTK_DOUBLE ? range[0] == range[1] && isExact(range[0])
                            : -most <= range[0] && range[1] <= most;
}
}

//------------------------------------------------------------------------------
SampleUnits SampleUnits::Find(vtkDataArray* array, int component, const HiddenSamples& hidden)
{
  SampleUnits units;
  if (array->GetDataTypeSize() <= 2 || array->GetDataType() == VTK_FLOAT)
  {
    return units;
  }
  double range[2];
  FindVisibleRange(array, component, hidden, range);
  const double extent = range[1] - range[0];
  double magnitude = std::max(std::abs(range[0]), std::abs(range[1]));
  if (!(extent >= 0.0) || IsExactInFloat(array->GetDataType(), range))
  {
    return units;
  }
  if (extent < magnitude / 16.0)
  {
    units.Offset = range[0] + extent / 2.0;
    magnitude = std::max(std::abs(range[0] - units.Offset), std::abs(range[1] - units.Offset));
  }
  using Float = std::numeric_limits<float>;
  if (magnitude > Float::max() || (magnitude > 0.0 && magnitude < Float::min()))
  {
    units.Normalize(magnitude); // what is too small for zfp alone is found when it is encoded
  }
  return units;
}

//------------------------------------------------------------------------------
void SampleUnits::Normalize(double magnitude)
{
  this->Scale *= std::ldexp(1.0, std::ilogb(magnitude));
}
