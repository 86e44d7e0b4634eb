// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Magnitude.h"

#include "Codec/ArrayMemory.h"

#include "vtkArrayDispatch.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"

#include <cmath>
#include <limits>

namespace
{
//------------------------------------------------------------------------------
// Length of a vector, also where the sum of its squares leaves the range of doubles.
template <typename ValuesT>
double Length(const ValuesT& values, vtkTypeInt64 first, int components)
{
  double squares = 0.0;
  for (int i = 0; i < components; ++i)
  {
    const double value = static_cast<double>(values[first + i]);
    squares += value * value;
  }
  if (squares > std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon() &&
    squares <= std::numeric_limits<double>::max())
  {
    return std::sqrt(squares);
  }
  double length = 0.0;
  for (int i = 0; i < components; ++i)
  {
    length = std::hypot(length, static_cast<double>(values[first + i]));
  }
  return std::isnan(squares) ? squares : length;
}

//------------------------------------------------------------------------------
struct MagnitudeWorker
{
  template <typename ArrayT, typename ValueT>
  void operator()(ArrayT* array, ValueT* lengths) const
  {
    const auto values = vtk::DataArrayValueRange(array);
    const int components = array->GetNumberOfComponents();
    const vtkTypeInt64 tuples = array->GetNumberOfTuples();
#pragma omp parallel for
    for (vtkTypeInt64 tuple = 0; tuple < tuples; ++tuple)
    {
      lengths[tuple] = static_cast<ValueT>(Length(values, tuple * components, components));
    }
  }
};

//------------------------------------------------------------------------------
template <typename LengthsT>
Status ComputeMagnitude(vtkDataArray* array, ChosenSamples& samples)
{
  auto lengths = vtkSmartPointer<LengthsT>::New();
  lengths->SetName(array->GetName());
  const vtkIdType tuples = array->GetNumberOfTuples();
  if (!TryAllocate(lengths.Get(), tuples))
  {
    return Status::Error("not enough memory for the magnitudes of ", tuples, " samples");
  }
  MagnitudeWorker worker;
  if (!vtkArrayDispatch::Dispatch::Execute(array, worker, lengths->GetPointer(0)))
  {
    worker(array, lengths->GetPointer(0));
  }
  samples = { lengths, 0, vtkCompressedVolume::Magnitude };
  return {};
}
}

//------------------------------------------------------------------------------
bool HasComponent(vtkDataArray* array, int component)
{
  return component == vtkCompressedVolume::Magnitude ||
    (component >= 0 && component < array->GetNumberOfComponents());
}

//------------------------------------------------------------------------------
bool HasNonFinite(vtkDataArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

//------------------------------------------------------------------------------
Status ChooseSamples(vtkDataArray* array, int component, ChosenSamples& samples)
{
  const bool single = array->GetNumberOfComponents() == 1;
  if (component != vtkCompressedVolume::Magnitude || single)
  {
    const int chosen = single ? 0 : component;
    samples = { array, chosen, chosen };
    return {};
  }
  const bool isFloat = array->GetDataType() == VTK_FLOAT || array->GetDataTypeSize() <= 2;
  return isFloat ? ComputeMagnitude<vtkFloatArray>(array, samples)
                 : ComputeMagnitude<vtkDoubleArray>(array, samples);
}
