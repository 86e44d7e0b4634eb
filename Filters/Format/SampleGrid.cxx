// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleGrid.h"

#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace
{
//------------------------------------------------------------------------------
std::string Describe(const SampleGrid& grid)
{
  const double* const v = grid.Values;
  std::ostringstream text;
  text << "spacing " << v[0] << " " << v[1] << " " << v[2] << ", origin " << v[3] << " " << v[4]
       << " " << v[5];
  const SampleGrid usual;
  if (!std::equal(v + 6, v + SampleGrid::Size, usual.Values + 6))
  {
    text << ", directions";
    std::for_each(v + 6, v + SampleGrid::Size, [&](double value) { text << " " << value; });
  }
  return text.str();
}

//------------------------------------------------------------------------------
// Returns how far a coordinate may be off, in samples: files keep some 11 digits, old ones 6.
double Tolerance(const SampleGrid& grid, int axis)
{
  const double* const origin = grid.Values + 3;
  const double farthest =
    std::max({ std::abs(origin[0]), std::abs(origin[1]), std::abs(origin[2]) });
  return std::min(0.02 + 1e-6 * farthest / std::abs(grid.Values[axis]), 0.25);
}
}

//------------------------------------------------------------------------------
SampleGrid SampleGrid::Of(vtkImageData* image)
{
  SampleGrid grid;
  std::copy_n(image->GetSpacing(), 3, grid.Values);
  std::copy_n(image->GetOrigin(), 3, grid.Values + 3);
  std::copy_n(image->GetDirectionMatrix()->GetData(), 9, grid.Values + 6);
  return grid;
}

//------------------------------------------------------------------------------
bool SampleGrid::IsRegular() const
{
  const double determinant = vtkMatrix3x3::Determinant(this->Values + 6);
  return std::all_of(
           this->Values, this->Values + Size, [](double value) { return std::isfinite(value); }) &&
    std::none_of(this->Values, this->Values + 3, [](double value) { return value == 0.0; }) &&
    std::isnormal(determinant);
}

//------------------------------------------------------------------------------
Status SampleGrid::FindShift(vtkImageData* image, int shift[3]) const
{
  const SampleGrid other = Of(image);
  std::fill_n(shift, 3, 0);
  if (!this->IsRegular() || !other.IsRegular() ||
    std::equal(this->Values, this->Values + Size, other.Values))
  {
    return {};
  }
  double inverse[9];
  vtkMatrix3x3::Invert(this->Values + 6, inverse);
  const int* const extent = image->GetExtent();
  for (int corner = 0; corner < 8; ++corner)
  {
    const int index[3] = { extent[corner & 1], extent[2 + (corner >> 1 & 1)],
      extent[4 + (corner >> 2)] };
    double place[3], offset[3];
    vtkImageData::TransformContinuousIndexToPhysicalPoint(
      index[0], index[1], index[2], other.Values + 3, other.Values, other.Values + 6, place);
    vtkMath::Subtract(place, this->Values + 3, offset);
    vtkMatrix3x3::MultiplyPoint(inverse, offset, offset);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double found = offset[axis] / this->Values[axis] - index[axis];
      const double whole = std::round(found);
      const bool fits = std::abs(found - whole) <= Tolerance(*this, axis) &&
        std::abs(whole) < VTK_INT_MAX && (corner == 0 || whole == shift[axis]);
      if (!fits)
      {
        return Status::Error("its samples were compressed with ", Describe(*this),
          ", and the image now has ", Describe(other),
          ": a filter moved or resampled the image, which cannot be done to compressed samples: "
          "apply it before compression, or to the decompressed volume. Where SetOrigin, SetSpacing "
          "or SetDirectionMatrix moved it, samples and all, call vtkCompressedVolume::Place(image) "
          "after them (Python: progiso.vtkCompressedVolume.Place(image))");
      }
      shift[axis] = static_cast<int>(whole);
    }
  }
  return {};
}
