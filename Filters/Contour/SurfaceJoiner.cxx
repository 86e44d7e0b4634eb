// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceJoiner.h"

#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkTypeInt64Array.h"

#include <algorithm>

namespace
{
//------------------------------------------------------------------------------
vtkSmartPointer<vtkFloatArray> NewVectors(const char* name, vtkIdType number)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(number);
  return array;
}

//------------------------------------------------------------------------------
// Moves values to their place in an array, if there is one, and frees their memory.
void MoveInto(std::vector<float>& values, vtkFloatArray* array, vtkIdType firstTuple)
{
  if (array)
  {
    std::copy(values.begin(), values.end(), array->GetPointer(3 * firstTuple));
  }
  std::vector<float>().swap(values);
}
}

//------------------------------------------------------------------------------
// The mesh's arrays of vectors; null if not wanted.
struct SurfaceJoiner::Vectors
{
  vtkSmartPointer<vtkFloatArray> Points;
  vtkSmartPointer<vtkFloatArray> Normals;
  vtkSmartPointer<vtkFloatArray> Gradients;
};

//------------------------------------------------------------------------------
SurfaceJoiner::SurfaceJoiner(const BrickContour& contour, SurfaceParts& parts)
  : Contour(contour)
  , All(parts)
{
  for (std::size_t i = 0; i < parts.Parts.size(); ++i)
  {
    if (BrickContour::Part* const part = parts.Parts[i].get())
    {
      this->Held.push_back(static_cast<vtkIdType>(i));
      part->FirstPoint = this->NumberOfPoints;
      part->FirstTriangle = this->NumberOfTriangles;
      this->NumberOfPoints += part->GetNumberOfPoints();
      this->NumberOfTriangles += part->GetNumberOfTriangles();
    }
  }
}

//------------------------------------------------------------------------------
void SurfaceJoiner::Join(
  vtkPolyData* output, const char* scalarName, const std::vector<double>& isovalues)
{
  output->GetPointData()->SetScalars(
    scalarName ? this->MakeScalars(scalarName, isovalues) : nullptr);
  Vectors vectors;
  vectors.Points = NewVectors("Points", this->NumberOfPoints);
  if (this->Contour.ComputeNormals)
  {
    vectors.Normals = NewVectors("Normals", this->NumberOfPoints);
  }
  if (this->Contour.ComputeGradients)
  {
    vectors.Gradients = NewVectors("Gradients", this->NumberOfPoints);
  }
  vtkNew<vtkTypeInt64Array> corners;
  corners->SetNumberOfValues(3 * this->NumberOfTriangles);
  vtkSMPTools::For(0, static_cast<vtkIdType>(this->Held.size()), 1,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType i = begin; i < end; ++i)
      {
        this->JoinPart(this->Held[i], vectors, corners->GetPointer(0));
      }
    });
  vtkNew<vtkPoints> points;
  points->SetData(vectors.Points);
  output->SetPoints(points);
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(3, corners);
  output->SetPolys(triangles);
  output->GetPointData()->SetNormals(vectors.Normals);
  output->GetPointData()->SetVectors(vectors.Gradients);
}

//------------------------------------------------------------------------------
// Moves one part to its place in the mesh.
void SurfaceJoiner::JoinPart(vtkIdType index, const Vectors& vectors, vtkTypeInt64* corners)
{
  BrickContour::Part& part = *this->All.Parts[index];
  this->Contour.WriteCorners(
    part, this->All.GetPartsBeside(index), corners + 3 * part.FirstTriangle);
  MoveInto(part.Points, vectors.Points, part.FirstPoint);
  MoveInto(part.Normals, vectors.Normals, part.FirstPoint);
  MoveInto(part.Gradients, vectors.Gradients, part.FirstPoint);
  std::vector<int>().swap(part.Corners);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkFloatArray> SurfaceJoiner::MakeScalars(
  const char* name, const std::vector<double>& isovalues) const
{
  auto scalars = vtkSmartPointer<vtkFloatArray>::New();
  scalars->SetName(name);
  scalars->SetNumberOfValues(this->NumberOfPoints);
  for (const vtkIdType index : this->Held)
  {
    const BrickContour::Part& part = *this->All.Parts[index];
    std::fill_n(scalars->GetPointer(part.FirstPoint), part.GetNumberOfPoints(),
      static_cast<float>(isovalues[index / this->All.NumberOfBricks]));
  }
  return scalars;
}
