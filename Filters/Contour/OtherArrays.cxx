// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OtherArrays.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{
// Two neighbouring samples, and how far from the first to the second a point lies.
struct Edge
{
  vtkIdType Begin;
  vtkIdType End;
  double Fraction;
};

//------------------------------------------------------------------------------
// Finds the edge of a point: along the axis on which it is farthest from a sample.
Edge FindEdge(const double point[3], const int extent[6])
{
  double place[3], farthest = 0.0;
  int along = 0;
  vtkIdType strides[3], stride = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = extent[2 * axis], high = extent[2 * axis + 1];
    place[axis] = std::min(std::max(point[axis], low), high) - low;
    strides[axis] = stride;
    stride *= extent[2 * axis + 1] - extent[2 * axis] + 1;
    const double off = std::abs(place[axis] - std::round(place[axis]));
    if (off > farthest)
    {
      farthest = off;
      along = axis;
    }
  }
  Edge edge = { 0, 0, place[along] - std::floor(place[along]) };
  for (int axis = 0; axis < 3; ++axis)
  {
    const double sample = axis == along ? std::floor(place[axis]) : std::round(place[axis]);
    edge.Begin += strides[axis] * static_cast<vtkIdType>(sample);
  }
  edge.End = edge.Fraction > 0.0 ? edge.Begin + strides[along] : edge.Begin;
  return edge;
}

//------------------------------------------------------------------------------
void InterpolateArray(
  vtkDataArray* from, const int extent[6], vtkPoints* points, vtkDataArray* values)
{
  const auto interpolate = [&](vtkIdType begin, vtkIdType end)
  {
    for (vtkIdType i = begin; i < end; ++i)
    {
      double point[3];
      points->GetPoint(i, point);
      const Edge edge = FindEdge(point, extent);
      values->InterpolateTuple(i, edge.Begin, from, edge.End, from, edge.Fraction);
    }
  };
  const vtkIdType number = points->GetNumberOfPoints();
  if (from->GetDataType() == VTK_BIT)
  {
    interpolate(0, number); // threads would share bytes
    return;
  }
  vtkSMPTools::For(0, number, interpolate);
}
}

//------------------------------------------------------------------------------
void OtherArrays::Interpolate(
  vtkDataSetAttributes* arrays, const int extent[6], vtkPolyData* surface)
{
  vtkPointData* const target = surface->GetPointData();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = arrays->GetArray(i);
    const char* const name = array ? array->GetName() : nullptr;
    if (!name || target->HasArray(name) || !strcmp(name, vtkDataSetAttributes::GhostArrayName()))
    {
      continue;
    }
    const auto values = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    values->SetName(name);
    values->SetNumberOfComponents(array->GetNumberOfComponents());
    values->CopyComponentNames(array);
    values->SetNumberOfTuples(surface->GetNumberOfPoints());
    InterpolateArray(array, extent, surface->GetPoints(), values);
    target->AddArray(values);
  }
}
