// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RectilinearImage.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkResampleToImage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
constexpr double Slack = 1e-6; // of a step: coordinates are often floats

vtkDataArray* CoordinatesOf(vtkRectilinearGrid* grid, int axis)
{
  vtkDataArray* const coordinates[3] = { grid->GetXCoordinates(), grid->GetYCoordinates(),
    grid->GetZCoordinates() };
  return coordinates[axis];
}

double LengthOf(vtkDataArray* coordinates)
{
  return coordinates->GetComponent(coordinates->GetNumberOfTuples() - 1, 0) -
    coordinates->GetComponent(0, 0);
}

bool IsEven(vtkDataArray* coordinates)
{
  const vtkIdType steps = coordinates->GetNumberOfTuples() - 1;
  const double first = coordinates->GetComponent(0, 0);
  const double step = LengthOf(coordinates) / static_cast<double>(std::max<vtkIdType>(steps, 1));
  // what floats round off is no unevenness
  const double rounding = std::numeric_limits<float>::epsilon() *
    std::max(std::abs(first), std::abs(first + LengthOf(coordinates)));
  const double tolerance = std::max(Slack * std::abs(step), rounding);
  for (vtkIdType i = 1; i < steps; ++i)
  {
    const double even = first + static_cast<double>(i) * step;
    if (std::abs(coordinates->GetComponent(i, 0) - even) > tolerance)
    {
      return false;
    }
  }
  return true;
}

int CountSamples(vtkDataArray* coordinates)
{
  const vtkIdType steps = coordinates->GetNumberOfTuples() - 1;
  double shortest = std::abs(LengthOf(coordinates));
  for (vtkIdType i = 0; i < steps; ++i)
  {
    const double step =
      std::abs(coordinates->GetComponent(i + 1, 0) - coordinates->GetComponent(i, 0));
    shortest = step > 0.0 ? std::min(shortest, step) : shortest;
  }
  if (!(shortest > 0.0))
  {
    return 1; // a flat grid
  }
  const double wanted = std::ceil(std::abs(LengthOf(coordinates)) / shortest - Slack);
  const double most = static_cast<double>(RectilinearImage::Refinement * steps);
  return static_cast<int>(std::min(wanted, most)) + 1;
}
}

//------------------------------------------------------------------------------
bool RectilinearImage::IsEven(vtkRectilinearGrid* grid)
{
  return ::IsEven(CoordinatesOf(grid, 0)) && ::IsEven(CoordinatesOf(grid, 1)) &&
    ::IsEven(CoordinatesOf(grid, 2));
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> RectilinearImage::Convert(vtkRectilinearGrid* grid)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(grid->GetExtent());
  double spacing[3], origin[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    vtkDataArray* coordinates = CoordinatesOf(grid, axis);
    const vtkIdType steps = coordinates->GetNumberOfTuples() - 1;
    spacing[axis] = steps > 0 ? LengthOf(coordinates) / static_cast<double>(steps) : 1.0;
    origin[axis] = coordinates->GetComponent(0, 0) - grid->GetExtent()[2 * axis] * spacing[axis];
  }
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  image->GetPointData()->ShallowCopy(grid->GetPointData());
  image->GetCellData()->ShallowCopy(grid->GetCellData());
  return image;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> RectilinearImage::Resample(vtkRectilinearGrid* grid)
{
  vtkNew<vtkResampleToImage> resample;
  resample->SetInputDataObject(grid);
  resample->SetSamplingDimensions(CountSamples(CoordinatesOf(grid, 0)),
    CountSamples(CoordinatesOf(grid, 1)), CountSamples(CoordinatesOf(grid, 2)));
  resample->Update();
  return resample->GetOutput();
}
