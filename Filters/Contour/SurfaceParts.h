// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceParts_h
#define SurfaceParts_h

#include "Contour/BrickContour.h"

#include <memory>
#include <vector>

/// The parts of a volume's isosurfaces, before they are joined (internal).
struct SurfaceParts
{
  vtkIdType NumberOfBricks = 0;

  /// For each isovalue, one after the other, the part in every brick; null if there is none.
  std::vector<std::unique_ptr<BrickContour::Part>> Parts;

  /// The parts of the isovalue that one of them belongs to, brick by brick.
  const std::unique_ptr<BrickContour::Part>* GetPartsBeside(vtkIdType index) const
  {
    return this->Parts.data() + index / this->NumberOfBricks * this->NumberOfBricks;
  }
};

#endif
