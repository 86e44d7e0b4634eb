// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBlockMask
 * @brief   which samples, or cells, of a volume of 4x4x4 blocks are hidden
 *
 * A bit for each of a block's 64 samples, bit x + 4y + 16z, set where it is hidden; or for each of
 * the 64 cells of its dual grid, named by their lowest corners. Blocks follow in x-fastest order,
 * and equal ones are kept as one run: a volume that hides nothing takes nothing, one with a hidden
 * part some bytes for each block at the part's border.
 *
 * Not a vtkObject: it is copied and compared like a number.
 */
#ifndef vtkBlockMask_h
#define vtkBlockMask_h

#include "vtkProgIsoFiltersModule.h" // for export macro
#include "vtkSmartPointer.h"         // for arrays
#include "vtkType.h"

#include <string> // for error messages
#include <vector> // for the runs

class vtkDataArray;
class vtkTypeUInt64Array;

class VTKPROGISOFILTERS_EXPORT vtkBlockMask
{
public:
  /**
   * Blocks from First on, up to the next run's, have these bits.
   */
  struct Run
  {
    vtkTypeUInt64 First;
    vtkTypeUInt64 Bits;
    bool operator==(const Run& other) const
    {
      return this->First == other.First && this->Bits == other.Bits;
    }
  };

  static constexpr vtkTypeUInt64 AllBits = ~vtkTypeUInt64(0);

  /**
   * Whether nothing is hidden.
   */
  bool IsEmpty() const { return this->Runs.empty(); }

  /**
   * Add the next blocks, `count` of them, all with the same bits.
   */
  void Append(vtkTypeUInt64 bits, vtkTypeInt64 count = 1);

  /**
   * A block's bits; 0 beyond the last one.
   */
  vtkTypeUInt64 Get(vtkTypeInt64 block) const;

  /**
   * The runs in order; the first begins at block 0. Empty where nothing is hidden.
   */
  const std::vector<Run>& GetRuns() const { return this->Runs; }

  /**
   * Whether a sample, or cell, of a volume of so many blocks per axis is hidden.
   */
  bool Hides(const int position[3], const int blocks[3]) const;

  /**
   * Of a mask of samples: the cells that have a hidden corner; `other`, of cells, is added.
   */
  vtkBlockMask ToCells(const int blocks[3], const vtkBlockMask& other) const;

  /**
   * The mask of `count` blocks per axis, from `first` on, of a volume of `blocks`.
   */
  vtkBlockMask Crop(const int first[3], const int count[3], const int blocks[3]) const;

  ///@{
  /**
   * The runs as tuples (first block, bits), and back: FromArray() returns what is wrong with them
   * for a volume of so many blocks, as the end of a sentence, or nothing.
   */
  vtkSmartPointer<vtkTypeUInt64Array> ToArray() const;
  std::string FromArray(vtkDataArray* array, vtkTypeInt64 blocks);
  ///@}

  bool operator==(const vtkBlockMask& other) const { return this->Runs == other.Runs; }

private:
  std::vector<Run> Runs;
  vtkTypeUInt64 Blocks = 0; ///< appended so far
};

#endif
