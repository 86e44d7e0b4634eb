// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   BrickContour
 * @brief   the part of an isosurface that lies in one brick (internal)
 *
 * Extract() lets vtkFlyingEdges3D triangulate the brick, and finds for every corner the edge of the
 * volume's grid on which it lies. Exactly one brick owns an edge, and hence a point, so that parts
 * join without a search for coincident points: WriteCorners() finds the points of neighbouring
 * bricks by their edges.
 *
 * vtkFlyingEdges3D sees 0 and 1, whether samples reach the isovalue, instead of the samples: its
 * points are then the middles of edges, which identify the edges exactly, even where an isosurface
 * passes through samples. Points, normals and gradients are computed here, also from samples beyond
 * the brick's faces, as vtkFlyingEdges3D would compute them for the whole volume.
 */
#ifndef BrickContour_h
#define BrickContour_h

#include "Contour/Bricks.h"

#include "vtkType.h"

#include <memory>
#include <utility>
#include <vector>

class vtkBlockMask;
class vtkPolyData;

class BrickContour
{
public:
  /**
   * An edge of the grid: 3 * (index of the sample that it begins at) + axis.
   */
  using Edge = vtkTypeInt64;

  /**
   * The part of one isosurface that one brick owns.
   */
  struct Part
  {
    vtkIdType Brick = 0;
    std::vector<float> Points; ///< 3 values each, in index coordinates
    std::vector<float> Normals;
    std::vector<float> Gradients;
    std::vector<int> Corners; ///< 3 a triangle: index of a point; if negative, ~index in Others
    std::vector<Edge> Others; ///< edges of the corners that are points of other parts
    std::vector<std::pair<Edge, int>> Shared; ///< points that may be corners of other parts, sorted

    vtkIdType FirstPoint = 0; ///< index of its first point in the whole mesh
    vtkIdType FirstTriangle = 0;

    vtkIdType GetNumberOfPoints() const { return static_cast<vtkIdType>(this->Points.size() / 3); }
    vtkIdType GetNumberOfTriangles() const
    {
      return static_cast<vtkIdType>(this->Corners.size() / 3);
    }
  };

  /**
   * Contours bricks of a volume whose first sample has these index coordinates.
   */
  BrickContour(const Bricks& bricks, const int extentStart[3]);

  ///@{
  /**
   * What to compute beside points and triangles. Both need the samples next to the brick's faces.
   */
  bool ComputeNormals = true;
  bool ComputeGradients = false;
  double Scale = 1.0; ///< from the stream's units to those of gradients
  ///@}

  /**
   * Cells without a surface, see vtkCompressedVolume::GetCellsWithoutSurface(); null: none.
   */
  const vtkBlockMask* Hidden = nullptr;

  /**
   * The cells that are contoured, by the samples that they begin at, both ends included. Default:
   * all. Samples beyond still count for normals and gradients.
   */
  Bricks::Box Cells;

  /**
   * Whether a brick has such cells, or points of triangles in them.
   */
  bool Touches(vtkIdType brick) const;

  /**
   * Samples that are needed around a brick.
   */
  int GetHalo() const { return this->ComputeNormals || this->ComputeGradients ? 1 : 0; }

  /**
   * Contours a decoded brick. Threads may share this object.
   */
  std::unique_ptr<Part> Extract(
    vtkIdType brick, const Bricks::Samples& samples, double isovalue) const;

  /**
   * Writes the 3 corners of each of a part's triangles, as points of the whole mesh. Needs the
   * FirstPoint of all parts; parts[b] is the part in brick b, or null.
   */
  void WriteCorners(
    const Part& part, const std::unique_ptr<Part>* parts, vtkTypeInt64* corners) const;

private:
  struct EdgePlace
  {
    int Sample[3];
    int Axis;
  };
  static EdgePlace FindPlace(const double middle[3], const Bricks::Box& box);
  Edge GetEdge(const EdgePlace& place) const;
  vtkIdType FindOwner(Edge edge) const;
  bool IsShared(const EdgePlace& place, const Bricks::Box& box) const;
  bool IsHidden(const int cell[3]) const;
  bool IsContoured(const int cell[3]) const;
  bool ContoursAll() const;
  template <typename Predicate>
  bool IsAnyCellAround(const EdgePlace& place, Predicate predicate) const;
  bool IsInContouredCell(
    vtkPolyData* surface, const vtkIdType corners[3], const Bricks::Box& box) const;
  bool HasNeighbor(const int sample[3], int axis, int side) const;
  void AddPoint(
    const EdgePlace& place, const Bricks::Samples& samples, double isovalue, Part& part) const;
  void FindGradient(const int sample[3], const Bricks::Samples& samples, float gradient[3]) const;
  std::vector<int> AddPoints(
    vtkPolyData* surface, const Bricks::Samples& samples, double isovalue, Part& part) const;

  const Bricks& AllBricks;
  int ExtentStart[3];
};

#endif
