// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPBrickContour.h"

#include "vtkBlockMask.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkFloatArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSignedCharArray.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cassert>

namespace
{
//------------------------------------------------------------------------------
// Of every sample of a box whether it reaches the isovalue: 1, or 0.
vtkSmartPointer<vtkImageData> Classify(
  const vtkZFPBricks::Box& box, const vtkZFPBricks::Samples& samples, double isovalue)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  const int width = box.Last[0] - box.First[0] + 1;
  image->SetDimensions(width, box.Last[1] - box.First[1] + 1, box.Last[2] - box.First[2] + 1);
  vtkNew<vtkSignedCharArray> classes;
  classes->SetNumberOfValues(image->GetNumberOfPoints());
  signed char* target = classes->GetPointer(0);
  for (int z = box.First[2]; z <= box.Last[2]; ++z)
  {
    for (int y = box.First[1]; y <= box.Last[1]; ++y, target += width)
    {
      const float* const row = samples.At(box.First[0], y, z);
      for (int x = 0; x < width; ++x)
      {
        target[x] = row[x] >= isovalue ? 1 : 0;
      }
    }
  }
  image->GetPointData()->SetScalars(classes);
  return image;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> Triangulate(vtkImageData* classes)
{
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(classes);
  contour->SetValue(0, 0.5);
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOff();
  contour->Update();
  return contour->GetOutput();
}
}

//------------------------------------------------------------------------------
std::unique_ptr<vtkZFPBrickContour::Part> vtkZFPBrickContour::Extract(
  vtkIdType brick, const vtkZFPBricks::Samples& samples, double isovalue) const
{
  const auto surface = Triangulate(Classify(this->Bricks.GetBox(brick), samples, isovalue));
  auto part = std::make_unique<Part>();
  part->Brick = brick;
  const std::vector<int> numbers = this->AddPoints(surface, samples, isovalue, *part);
  vtkCellArray* const triangles = surface->GetPolys();
  part->Corners.reserve(3 * triangles->GetNumberOfCells());
  const auto iterator = vtk::TakeSmartPointer(triangles->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    iterator->GetCurrentCell(size, corners);
    if (this->Hidden && !this->IsInVisibleCell(surface, corners, this->Bricks.GetBox(brick)))
    {
      continue;
    }
    for (vtkIdType i = 0; i < size; ++i)
    {
      part->Corners.push_back(numbers[corners[i]]);
    }
  }
  return part;
}

//------------------------------------------------------------------------------
// Fills all of a part but its triangles; returns what the surface's points are called there.
std::vector<int> vtkZFPBrickContour::AddPoints(
  vtkPolyData* surface, const vtkZFPBricks::Samples& samples, double isovalue, Part& part) const
{
  const vtkZFPBricks::Box box = this->Bricks.GetBox(part.Brick);
  std::vector<int> numbers(surface->GetNumberOfPoints());
  part.Points.reserve(3 * numbers.size());
  part.Normals.reserve(this->ComputeNormals ? 3 * numbers.size() : 0);
  part.Gradients.reserve(this->ComputeGradients ? 3 * numbers.size() : 0);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double middle[3];
    surface->GetPoint(i, middle);
    EdgePlace place = {};
    for (int axis = 0; axis < 3; ++axis)
    {
      const int whole = static_cast<int>(middle[axis]);
      place.Sample[axis] = box.First[axis] + whole;
      place.Axis = middle[axis] > whole ? axis : place.Axis;
    }
    if (this->Hidden && !this->IsVisible(place))
    {
      continue; // no triangle that is left has it
    }
    const Edge edge = this->GetEdge(place);
    if (this->Bricks.FindOwner(place.Sample) != part.Brick)
    {
      numbers[i] = ~static_cast<int>(part.Others.size());
      part.Others.push_back(edge);
      continue;
    }
    numbers[i] = static_cast<int>(part.GetNumberOfPoints());
    if (this->IsShared(place, box))
    {
      part.Shared.emplace_back(edge, numbers[i]);
    }
    this->AddPoint(place, samples, isovalue, part);
  }
  std::sort(part.Shared.begin(), part.Shared.end());
  return numbers;
}

//------------------------------------------------------------------------------
vtkZFPBrickContour::Edge vtkZFPBrickContour::GetEdge(const EdgePlace& place) const
{
  const int* const dims = this->Bricks.GetDimensions();
  const Edge sample =
    place.Sample[0] + dims[0] * (place.Sample[1] + static_cast<Edge>(dims[1]) * place.Sample[2]);
  return 3 * sample + place.Axis;
}

//------------------------------------------------------------------------------
vtkIdType vtkZFPBrickContour::FindOwner(Edge edge) const
{
  const int* const dims = this->Bricks.GetDimensions();
  const Edge number = edge / 3;
  const int sample[3] = { static_cast<int>(number % dims[0]),
    static_cast<int>(number / dims[0] % dims[1]), static_cast<int>(number / dims[0] / dims[1]) };
  return this->Bricks.FindOwner(sample);
}

//------------------------------------------------------------------------------
// Whether an edge that a brick owns lies in a face that another brick has too.
bool vtkZFPBrickContour::IsShared(const EdgePlace& place, const vtkZFPBricks::Box& box) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (axis != place.Axis && place.Sample[axis] == box.First[axis] && box.First[axis] > 0)
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
bool vtkZFPBrickContour::IsHidden(const int cell[3]) const
{
  const int* const dims = this->Bricks.GetDimensions();
  const int blocks[3] = { (dims[0] + 3) / 4, (dims[1] + 3) / 4, (dims[2] + 3) / 4 };
  return this->Hidden->Hides(cell, blocks);
}

//------------------------------------------------------------------------------
// Whether any of the cells around an edge is visible.
bool vtkZFPBrickContour::IsVisible(const EdgePlace& place) const
{
  const int* const dims = this->Bricks.GetDimensions();
  for (int side = 0; side < 4; ++side)
  {
    int cell[3] = { place.Sample[0], place.Sample[1], place.Sample[2] };
    cell[(place.Axis + 1) % 3] -= side & 1;
    cell[(place.Axis + 2) % 3] -= side >> 1;
    const auto exists = [&](int axis) { return cell[axis] >= 0 && cell[axis] + 1 < dims[axis]; };
    if (exists(0) && exists(1) && exists(2) && !this->IsHidden(cell))
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
// A triangle between the middles of a cell's edges has its centre in the cell, or, seldom, in the
// face that it shares with another.
bool vtkZFPBrickContour::IsInVisibleCell(
  vtkPolyData* surface, const vtkIdType corners[3], const vtkZFPBricks::Box& box) const
{
  const int* const dims = this->Bricks.GetDimensions();
  double sum[3] = { 0.0, 0.0, 0.0 };
  for (int i = 0; i < 3; ++i)
  {
    double point[3];
    surface->GetPoint(corners[i], point);
    vtkMath::Add(sum, point, sum);
  }
  int high[3], low[3]; // alike but where the centre is in a face
  for (int axis = 0; axis < 3; ++axis)
  {
    const int sixths = static_cast<int>(2.0 * sum[axis]); // exact: coordinates are halves
    high[axis] = std::min(box.First[axis] + sixths / 6, dims[axis] - 2);
    low[axis] = sixths % 6 == 0 && sixths > 0 ? box.First[axis] + sixths / 6 - 1 : high[axis];
  }
  return !this->IsHidden(high) || !this->IsHidden(low);
}

//------------------------------------------------------------------------------
// In the operations and precision of vtkFlyingEdges3D, so that every bit agrees.
void vtkZFPBrickContour::AddPoint(
  const EdgePlace& place, const vtkZFPBricks::Samples& samples, double isovalue, Part& part) const
{
  const int* const start = place.Sample;
  int end[3] = { start[0], start[1], start[2] };
  ++end[place.Axis];
  const float s0 = *samples.At(start[0], start[1], start[2]);
  const float s1 = *samples.At(end[0], end[1], end[2]);
  const double t = (isovalue - s0) / (s1 - s0);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double along = axis == place.Axis ? t : 0.0;
    part.Points.push_back(static_cast<float>(start[axis] + along + this->ExtentStart[axis]));
  }
  if (this->GetHalo() == 0)
  {
    return;
  }
  float g0[3], g1[3], gradient[3];
  this->FindGradient(start, samples, g0);
  this->FindGradient(end, samples, g1);
  for (int axis = 0; axis < 3; ++axis)
  {
    gradient[axis] = static_cast<float>(g0[axis] + t * (g1[axis] - g0[axis]));
  }
  if (this->ComputeGradients)
  {
    for (const float component : gradient)
    {
      part.Gradients.push_back(static_cast<float>(this->Scale * component));
    }
  }
  if (this->ComputeNormals)
  {
    float normal[3] = { -gradient[0], -gradient[1], -gradient[2] };
    vtkMath::Normalize(normal);
    part.Normals.insert(part.Normals.end(), normal, normal + 3);
  }
}

//------------------------------------------------------------------------------
// Central differences, one-sided at the volume's borders and where the next samples are hidden.
void vtkZFPBrickContour::FindGradient(
  const int sample[3], const vtkZFPBricks::Samples& samples, float gradient[3]) const
{
  const float* const value = samples.At(sample[0], sample[1], sample[2]);
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool low = !this->HasNeighbour(sample, axis, -1);
    const bool high = !this->HasNeighbour(sample, axis, 1);
    const float below = low ? *value : value[-samples.Stride[axis]];
    const float above = high ? *value : value[samples.Stride[axis]];
    const float difference = above - below;
    gradient[axis] = low || high ? difference : static_cast<float>(0.5 * difference);
  }
}

//------------------------------------------------------------------------------
bool vtkZFPBrickContour::HasNeighbour(const int sample[3], int axis, int side) const
{
  const int next = sample[axis] + side;
  EdgePlace place = { { sample[0], sample[1], sample[2] }, axis };
  place.Sample[axis] = std::min(next, sample[axis]);
  return next >= 0 && next < this->Bricks.GetDimensions()[axis] &&
    (!this->Hidden || this->IsVisible(place));
}

//------------------------------------------------------------------------------
void vtkZFPBrickContour::Join(
  const Part& part, const std::unique_ptr<Part>* parts, vtkTypeInt64* corners) const
{
  std::vector<vtkTypeInt64> others;
  others.reserve(part.Others.size());
  for (const Edge edge : part.Others)
  {
    // there: the edge's ends are samples of its owner, one on either side of the isovalue
    const Part& owner = *parts[this->FindOwner(edge)];
    const auto found =
      std::lower_bound(owner.Shared.begin(), owner.Shared.end(), std::make_pair(edge, 0));
    assert(found != owner.Shared.end() && found->first == edge);
    others.push_back(owner.FirstPoint + found->second);
  }
  for (const int corner : part.Corners)
  {
    *corners++ = corner >= 0 ? part.FirstPoint + corner : others[~corner];
  }
}
