// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   SurfaceJoiner
 * @brief   joins the parts of isosurfaces to one mesh (internal)
 */
#ifndef SurfaceJoiner_h
#define SurfaceJoiner_h

#include "Contour/SurfaceParts.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

class vtkFloatArray;
class vtkPolyData;

class SurfaceJoiner
{
public:
  SurfaceJoiner(const BrickContour& contour, SurfaceParts& parts);

  /**
   * Sets the mesh's points, triangles and point arrays, and frees the parts on the way. Scalars are
   * the isovalue of every point, in an array of the given name; null: no scalars.
   */
  void Join(vtkPolyData* output, const char* scalarName, const std::vector<double>& isovalues);

private:
  struct Vectors;
  vtkSmartPointer<vtkFloatArray> MakeScalars(
    const char* name, const std::vector<double>& isovalues) const;
  void JoinPart(vtkIdType index, const Vectors& vectors, vtkTypeInt64* corners);

  const BrickContour& Contour;
  SurfaceParts& All;           // numbered: each part knows its first point and triangle
  std::vector<vtkIdType> Held; // indices of the parts that are not null
  vtkIdType NumberOfPoints = 0;
  vtkIdType NumberOfTriangles = 0;
};

#endif
