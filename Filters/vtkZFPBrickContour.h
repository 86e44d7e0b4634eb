// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkZFPBrickContour
 * @brief   the part of an isosurface that lies in one brick (internal)
 *
 * Extract() has vtkFlyingEdges3D triangulate the brick, and says of every corner on which edge of
 * the volume's grid it lies. Every edge, hence every point, is owned by one brick alone, so that
 * parts join without a search for coincident points: Join() finds the points that lie in
 * neighbouring bricks by their edges.
 *
 * vtkFlyingEdges3D sees whether samples reach the isovalue, as 0 and 1, instead of the samples: its
 * points are then the middles of the edges, which tell the edges exactly, even where an isosurface
 * passes through samples. Points, normals and gradients are computed here, from samples beyond the
 * brick's faces too, as vtkFlyingEdges3D would compute them for the whole volume.
 */
#ifndef vtkZFPBrickContour_h
#define vtkZFPBrickContour_h

#include "vtkType.h"
#include "vtkZFPBricks.h"

#include <memory> // for parts
#include <vector> // for what is extracted

class vtkBlockMask;
class vtkPolyData;

class vtkZFPBrickContour
{
public:
  /**
   * An edge of the grid: 3 * (number of the sample that it begins at) + axis.
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
    std::vector<int> Corners; ///< 3 a triangle: a point of this part; if negative, ~ one of Others
    std::vector<Edge> Others; ///< where other parts' points lie that are corners here
    std::vector<std::pair<Edge, int>> Shared; ///< points that may be corners of other parts, sorted

    vtkIdType FirstPoint = 0; ///< number of its first point in the whole surface
    vtkIdType FirstTriangle = 0;

    vtkIdType GetNumberOfPoints() const { return static_cast<vtkIdType>(this->Points.size() / 3); }
    vtkIdType GetNumberOfTriangles() const
    {
      return static_cast<vtkIdType>(this->Corners.size() / 3);
    }
  };

  /**
   * For bricks of a volume whose first sample has these index coordinates.
   */
  vtkZFPBrickContour(const vtkZFPBricks& bricks, const int extentStart[3])
    : Bricks(bricks)
    , ExtentStart{ extentStart[0], extentStart[1], extentStart[2] }
  {
  }

  ///@{
  /**
   * What to compute beside points and triangles. Either needs samples one beyond the brick's faces.
   */
  bool ComputeNormals = true;
  bool ComputeGradients = false;
  double Scale = 1.0; ///< of samples' units to those of gradients
  ///@}

  /**
   * Cells that have no surface, see vtkCompressedVolume::GetCellsWithoutSurface(); null: every cell
   * may have one.
   */
  const vtkBlockMask* Hidden = nullptr;

  int GetHalo() const { return this->ComputeNormals || this->ComputeGradients ? 1 : 0; }

  /**
   * Contour a decoded brick. Threads may share this object.
   */
  std::unique_ptr<Part> Extract(
    vtkIdType brick, const vtkZFPBricks::Samples& samples, double isovalue) const;

  /**
   * Write the 3 corners of each of a part's triangles, as points of the whole surface, when the
   * FirstPoint of all parts is known. parts[b] is the part of brick b, or null.
   */
  void Join(const Part& part, const std::unique_ptr<Part>* parts, vtkTypeInt64* corners) const;

private:
  struct EdgePlace
  {
    int Sample[3];
    int Axis;
  };
  Edge GetEdge(const EdgePlace& place) const;
  vtkIdType FindOwner(Edge edge) const;
  bool IsShared(const EdgePlace& place, const vtkZFPBricks::Box& box) const;
  bool IsHidden(const int cell[3]) const;
  bool IsVisible(const EdgePlace& place) const;
  bool IsInVisibleCell(
    vtkPolyData* surface, const vtkIdType corners[3], const vtkZFPBricks::Box& box) const;
  bool HasNeighbour(const int sample[3], int axis, int side) const;
  void AddPoint(const EdgePlace& place, const vtkZFPBricks::Samples& samples, double isovalue,
    Part& part) const;
  void FindGradient(
    const int sample[3], const vtkZFPBricks::Samples& samples, float gradient[3]) const;
  std::vector<int> AddPoints(
    vtkPolyData* surface, const vtkZFPBricks::Samples& samples, double isovalue, Part& part) const;

  const vtkZFPBricks& Bricks;
  int ExtentStart[3];
};

#endif
