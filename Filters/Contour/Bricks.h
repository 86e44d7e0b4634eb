// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   Bricks
 * @brief   a compressed volume cut into bricks, to decode one at a time (internal)
 *
 * A brick is a box of Size^3 cells, fewer at the upper borders, with all samples at their corners:
 * neighbours share a face of samples. Size is a multiple of 4, so that bricks begin where zfp's
 * blocks do. Positions count from the volume's first sample.
 */
#ifndef Bricks_h
#define Bricks_h

#include "vtkType.h"

#include <vector>

class BlockStream;

class Bricks
{
public:
  /**
   * The first and the last sample along each axis, both included.
   */
  struct Box
  {
    int First[3];
    int Last[3];
  };

  /**
   * Decoded samples of a box that begins and ends where blocks do. What lies outside of the volume
   * is zfp's padding.
   */
  struct Samples
  {
    int First[3] = { 0, 0, 0 };
    vtkIdType Stride[3] = { 1, 1, 1 }; ///< from a sample to the next along each axis
    std::vector<float> Values;

    const float* At(int x, int y, int z) const
    {
      return this->Values.data() + (x - this->First[0]) + (y - this->First[1]) * this->Stride[1] +
        (z - this->First[2]) * this->Stride[2];
    }
  };

  /**
   * The smallest and the largest of some samples; NaN counts as the smallest.
   */
  struct Range
  {
    float Minimum;
    float Maximum;

    /**
     * Whether an isosurface passes between the samples: one is below the isovalue, another is not.
     */
    bool Contains(double isovalue) const
    {
      return this->Minimum < isovalue && this->Maximum >= isovalue;
    }
  };

  /**
   * Cuts a volume of at least 2 samples along each axis; size is a multiple of 4.
   */
  Bricks(const int dims[3], int size);

  const int* GetDimensions() const { return this->Dimensions; }
  vtkIdType GetNumberOfBricks() const;

  ///@{
  /**
   * A brick's samples, its place among the bricks along each axis, and the brick with a place.
   */
  Box GetBox(vtkIdType brick) const;
  void GetPlace(vtkIdType brick, int place[3]) const;
  vtkIdType GetBrick(const int place[3]) const;
  ///@}

  /**
   * Returns the brick that owns the edges that begin at a sample: of those with this sample, the
   * one furthest up along each axis.
   */
  vtkIdType FindOwner(const int sample[3]) const;

  /**
   * Decodes a brick, and the samples up to `halo` around it that the volume has.
   */
  void Decode(const BlockStream& blocks, vtkIdType brick, int halo, Samples& samples) const;

  /**
   * Finds the range of a decoded brick's samples, without those around it.
   */
  Range FindRange(vtkIdType brick, const Samples& samples) const;

private:
  int Dimensions[3];
  int Size;
  int BricksPerAxis[3];
};

#endif
