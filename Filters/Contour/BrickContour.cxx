// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BrickContour.h"

#include "Codec/BlockGeometry.h"

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
// Makes an image of a box of samples: 1 where they reach the isovalue, else 0.
vtkSmartPointer<vtkImageData> Classify(
  const Bricks::Box& box, const Bricks::Samples& samples, double isovalue)
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
BrickContour::BrickContour(const Bricks& bricks, const int extentStart[3])
  : AllBricks(bricks)
  , ExtentStart{ extentStart[0], extentStart[1], extentStart[2] }
{
  const int* const dims = bricks.GetDimensions();
  this->Cells = { { 0, 0, 0 }, { dims[0] - 2, dims[1] - 2, dims[2] - 2 } };
}

//------------------------------------------------------------------------------
// A brick owns points of its neighbours' triangles where they touch.
bool BrickContour::Touches(vtkIdType brick) const
{
  const Bricks::Box box = this->AllBricks.GetBox(brick);
  const auto touches = [&](int axis)
  {
    return box.First[axis] <= this->Cells.Last[axis] + 1 &&
      this->Cells.First[axis] <= box.Last[axis];
  };
  return touches(0) && touches(1) && touches(2);
}

//------------------------------------------------------------------------------
std::unique_ptr<BrickContour::Part> BrickContour::Extract(
  vtkIdType brick, const Bricks::Samples& samples, double isovalue) const
{
  const auto surface = Triangulate(Classify(this->AllBricks.GetBox(brick), samples, isovalue));
  auto part = std::make_unique<Part>();
  part->Brick = brick;
  const std::vector<int> numbers = this->AddPoints(surface, samples, isovalue, *part);
  const bool contoursAll = this->ContoursAll();
  vtkCellArray* const triangles = surface->GetPolys();
  part->Corners.reserve(3 * triangles->GetNumberOfCells());
  const auto iterator = vtk::TakeSmartPointer(triangles->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    iterator->GetCurrentCell(size, corners);
    if (!contoursAll && !this->IsInContouredCell(surface, corners, this->AllBricks.GetBox(brick)))
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
// Finds the edge whose middle is a point of a brick's triangulation.
BrickContour::EdgePlace BrickContour::FindPlace(const double middle[3], const Bricks::Box& box)
{
  EdgePlace place = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const int whole = static_cast<int>(middle[axis]);
    place.Sample[axis] = box.First[axis] + whole;
    place.Axis = middle[axis] > whole ? axis : place.Axis;
  }
  return place;
}

//------------------------------------------------------------------------------
// Fills all of a part but its triangles. Returns for each point of the surface what Corners hold.
std::vector<int> BrickContour::AddPoints(
  vtkPolyData* surface, const Bricks::Samples& samples, double isovalue, Part& part) const
{
  const Bricks::Box box = this->AllBricks.GetBox(part.Brick);
  const bool contoursAll = this->ContoursAll();
  std::vector<int> numbers(surface->GetNumberOfPoints());
  part.Points.reserve(3 * numbers.size());
  part.Normals.reserve(this->ComputeNormals ? 3 * numbers.size() : 0);
  part.Gradients.reserve(this->ComputeGradients ? 3 * numbers.size() : 0);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double middle[3];
    surface->GetPoint(i, middle);
    const EdgePlace place = FindPlace(middle, box);
    const auto isContoured = [this](const int cell[3]) { return this->IsContoured(cell); };
    if (!contoursAll && !this->IsAnyCellAround(place, isContoured))
    {
      continue; // no triangle that is kept has this corner
    }
    const Edge edge = this->GetEdge(place);
    if (this->AllBricks.FindOwner(place.Sample) != part.Brick)
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
BrickContour::Edge BrickContour::GetEdge(const EdgePlace& place) const
{
  const int* const dims = this->AllBricks.GetDimensions();
  const Edge sample =
    place.Sample[0] + dims[0] * (place.Sample[1] + static_cast<Edge>(dims[1]) * place.Sample[2]);
  return 3 * sample + place.Axis;
}

//------------------------------------------------------------------------------
vtkIdType BrickContour::FindOwner(Edge edge) const
{
  const int* const dims = this->AllBricks.GetDimensions();
  const Edge number = edge / 3;
  const int sample[3] = { static_cast<int>(number % dims[0]),
    static_cast<int>(number / dims[0] % dims[1]), static_cast<int>(number / dims[0] / dims[1]) };
  return this->AllBricks.FindOwner(sample);
}

//------------------------------------------------------------------------------
// Whether an edge that a brick owns lies in a face that it shares with another brick.
bool BrickContour::IsShared(const EdgePlace& place, const Bricks::Box& box) const
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
bool BrickContour::IsHidden(const int cell[3]) const
{
  const int* const dims = this->AllBricks.GetDimensions();
  const int blocks[3] = { BlocksAlong(dims[0]), BlocksAlong(dims[1]), BlocksAlong(dims[2]) };
  return this->Hidden->Hides(cell, blocks);
}

//------------------------------------------------------------------------------
bool BrickContour::IsContoured(const int cell[3]) const
{
  const auto isWithin = [&](int axis)
  { return this->Cells.First[axis] <= cell[axis] && cell[axis] <= this->Cells.Last[axis]; };
  return isWithin(0) && isWithin(1) && isWithin(2) && !(this->Hidden && this->IsHidden(cell));
}

//------------------------------------------------------------------------------
// Whether all cells are contoured, so that none need be looked at.
bool BrickContour::ContoursAll() const
{
  bool all = !this->Hidden;
  for (int axis = 0; axis < 3; ++axis)
  {
    all = all && this->Cells.First[axis] <= 0 &&
      this->Cells.Last[axis] >= this->AllBricks.GetDimensions()[axis] - 2;
  }
  return all;
}

//------------------------------------------------------------------------------
// Whether a predicate is true of any of the cells around an edge.
template <typename Predicate>
bool BrickContour::IsAnyCellAround(const EdgePlace& place, Predicate predicate) const
{
  const int* const dims = this->AllBricks.GetDimensions();
  for (int side = 0; side < 4; ++side)
  {
    int cell[3] = { place.Sample[0], place.Sample[1], place.Sample[2] };
    cell[(place.Axis + 1) % 3] -= side & 1;
    cell[(place.Axis + 2) % 3] -= side >> 1;
    const auto exists = [&](int axis) { return cell[axis] >= 0 && cell[axis] + 1 < dims[axis]; };
    if (exists(0) && exists(1) && exists(2) && predicate(cell))
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
// Whether a triangle belongs to a cell that is contoured. Its corners are middles of a cell's
// edges, so that its centre lies in the cell, or, rarely, in the face between two cells.
bool BrickContour::IsInContouredCell(
  vtkPolyData* surface, const vtkIdType corners[3], const Bricks::Box& box) const
{
  const int* const dims = this->AllBricks.GetDimensions();
  double sum[3] = { 0.0, 0.0, 0.0 };
  for (int i = 0; i < 3; ++i)
  {
    double point[3];
    surface->GetPoint(corners[i], point);
    vtkMath::Add(sum, point, sum);
  }
  int high[3], low[3]; // the cells around the centre; the same cell unless it lies in a face
  for (int axis = 0; axis < 3; ++axis)
  {
    const int sixths = static_cast<int>(2.0 * sum[axis]); // exact: coordinates are halves
    high[axis] = std::min(box.First[axis] + sixths / 6, dims[axis] - 2);
    low[axis] = sixths % 6 == 0 && sixths > 0 ? box.First[axis] + sixths / 6 - 1 : high[axis];
  }
  return this->IsContoured(high) || this->IsContoured(low);
}

//------------------------------------------------------------------------------
// Computes a point with the operations and precision of vtkFlyingEdges3D, so that every bit agrees.
void BrickContour::AddPoint(
  const EdgePlace& place, const Bricks::Samples& samples, double isovalue, Part& part) const
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
// Takes central differences, one-sided at the volume's borders and beside hidden samples.
void BrickContour::FindGradient(
  const int sample[3], const Bricks::Samples& samples, float gradient[3]) const
{
  const float* const value = samples.At(sample[0], sample[1], sample[2]);
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool low = !this->HasNeighbor(sample, axis, -1);
    const bool high = !this->HasNeighbor(sample, axis, 1);
    const float below = low ? *value : value[-samples.Stride[axis]];
    const float above = high ? *value : value[samples.Stride[axis]];
    const float difference = above - below;
    gradient[axis] = low || high ? difference : static_cast<float>(0.5 * difference);
  }
}

//------------------------------------------------------------------------------
bool BrickContour::HasNeighbor(const int sample[3], int axis, int side) const
{
  const int next = sample[axis] + side;
  EdgePlace place = { { sample[0], sample[1], sample[2] }, axis };
  place.Sample[axis] = std::min(next, sample[axis]);
  const auto isVisible = [this](const int cell[3]) { return !this->IsHidden(cell); };
  return next >= 0 && next < this->AllBricks.GetDimensions()[axis] &&
    (!this->Hidden || this->IsAnyCellAround(place, isVisible));
}

//------------------------------------------------------------------------------
void BrickContour::WriteCorners(
  const Part& part, const std::unique_ptr<Part>* parts, vtkTypeInt64* corners) const
{
  std::vector<vtkTypeInt64> others; // in the whole mesh
  others.reserve(part.Others.size());
  for (const Edge edge : part.Others)
  {
    // the owner has this point: the edge's ends are its samples, on either side of the isovalue
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
