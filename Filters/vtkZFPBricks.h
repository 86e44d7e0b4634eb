// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkZFPBricks
 * @brief   a compressed volume cut into bricks, for work that decodes one at a time (internal)
 *
 * A brick is a box of Size^3 cells, fewer at the upper borders, with all samples at their corners:
 * neighbours share a face of samples. Size is a multiple of 4, so that bricks begin where zfp's
 * blocks do. All positions count from the volume's first sample.
 */
#ifndef vtkZFPBricks_h
#define vtkZFPBricks_h

#include "vtkType.h"

#include <vector> // for samples

class BlockStream;

class vtkZFPBricks
{
public:
  /**
   * First sample along each axis, and the last, which is included.
   */
  struct Box
  {
    int First[3];
    int Last[3];
  };

  /**
   * Samples decoded of a box that begins and ends where blocks do. What lies outside of the volume
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
   * The smallest and largest of some samples; NaN counts as the smallest.
   */
  struct Range
  {
    float Minimum;
    float Maximum;

    /**
     * Whether an isosurface passes between the samples: one is below, another is not.
     */
    bool Holds(double isovalue) const
    {
      return this->Minimum < isovalue && this->Maximum >= isovalue;
    }
  };

  /**
   * For a volume of at least 2 samples along each axis; size is a multiple of 4.
   */
  vtkZFPBricks(const int dims[3], int size);

  const int* GetDimensions() const { return this->Dimensions; }
  vtkIdType GetNumberOfBricks() const;

  ///@{
  /**
   * A brick's samples; its place among the bricks along each axis; and the brick with a given
   * place.
   */
  Box GetBox(vtkIdType brick) const;
  void GetPlace(vtkIdType brick, int place[3]) const;
  vtkIdType GetBrick(const int place[3]) const;
  ///@}

  /**
   * The brick that owns what begins at a sample: the one furthest up among those that hold it.
   */
  vtkIdType FindOwner(const int sample[3]) const;

  /**
   * Decode a brick, and the samples up to `halo` around it where the volume has them.
   */
  void Decode(const BlockStream& blocks, vtkIdType brick, int halo, Samples& samples) const;

  /**
   * The range of a decoded brick's own samples.
   */
  Range FindRange(vtkIdType brick, const Samples& samples) const;

private:
  int Dimensions[3];
  int Size;
  int Bricks[3];
};

#endif
