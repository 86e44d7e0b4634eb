// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   MacrocellErrors
 * @brief   range and error of the samples of every macrocell of a volume (internal)
 *
 * A macrocell is 4x4x4 blocks, 16x16x16 samples. Its range is that of its visible samples before
 * encoding, its error the largest that encoding left, all three in the stream's units. Threads may
 * add blocks at the same time.
 */
#ifndef MacrocellErrors_h
#define MacrocellErrors_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <atomic>
#include <vector>

class vtkFloatArray;

class MacrocellErrors
{
public:
  /// What becomes of an isosurface in a lossy volume.
  struct Doubt
  {
    bool IsLikely = false; ///< that the surface is not the one asked for
    double Distance = 0.0; ///< from the isovalue to the samples that are mistaken
    double Error = 0.0;    ///< largest error of these
  };

  /// Makes room for a volume of so many blocks per axis.
  explicit MacrocellErrors(const vtkTypeInt64 blocks[3]);

  /// Returns the number of macrocells of a volume of so many samples per axis.
  static vtkTypeInt64 NumberFor(const int dims[3]);

  /// Returns the number of the macrocell of a block, in a volume of so many blocks.
  static vtkTypeInt64 IndexOf(const vtkTypeInt64 block[3], const vtkTypeInt64 blocks[3]);

  void Add(const vtkTypeInt64 block[3], float low, float high, float error);

  /// Returns low, high and error of every macrocell, x fastest; without visible samples 1, 0, 0.
  vtkSmartPointer<vtkFloatArray> MakeArray() const;

  /**
   * Judges an isovalue by what MakeArray() made. A macrocell may hold a part of the decoded surface
   * if the isovalue is within its range, widened by its error. The part is doubtful if the smallest
   * or the largest sample there is nearer to the isovalue than the error: where samples vary
   * smoothly few are, and what is off is within a small part of a cell; of plateaus, such as
   * labels, masks and empty space, nearly all are, and anything may become of their surface. So
   * more than half of the parts have to be doubtful.
   */
  static Doubt Judge(vtkFloatArray* macrocells, double isovalue);

private:
  struct Accumulator
  {
    std::atomic<float> Low, High, Error;
  };

  vtkTypeInt64 Blocks[3];
  std::vector<Accumulator> Accumulators;
};

#endif
