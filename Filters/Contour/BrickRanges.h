// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   BrickRanges
 * @brief   ranges of the bricks of a volume that have been decoded once (internal)
 *
 * vtkZFPContour keeps them from one update to the next.
 */
#ifndef BrickRanges_h
#define BrickRanges_h

#include "Contour/Bricks.h"

#include "vtkType.h"

#include <vector>

class vtkCompressedVolume;

class BrickRanges
{
public:
  /// Forgets all ranges unless they are those of this volume, cut into bricks of this size.
  void Prepare(vtkCompressedVolume* volume, int brickSize, vtkIdType bricks);

  /// Whether a brick contains any of the isovalues, or is not known yet.
  bool MayContain(vtkIdType brick, const std::vector<double>& isovalues) const;

  /// Threads may set the ranges of different bricks at a time.
  void Set(vtkIdType brick, const Bricks::Range& range);

private:
  bool IsOf(vtkCompressedVolume* volume, int brickSize) const;

  vtkMTimeType StreamTime = 0; // identifies the stream: VTK gives no modified time twice
  int BrickSize = 0;
  int BlockBits = 0;
  int Dimensions[3] = { 0, 0, 0 };
  std::vector<Bricks::Range> Ranges;
  std::vector<unsigned char> Known; // not vector<bool>: threads write side by side
};

#endif
