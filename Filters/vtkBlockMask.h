// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBlockMask
 * @brief   which samples, or cells, of a volume of 4x4x4 blocks are hidden
 *
 * Each block has 64 bits. Bit x + 4y + 16z is set if that sample is hidden, or, in a mask of cells,
 * the cell whose lowest corner is that sample. Blocks are in x-fastest order. Equal neighbours are
 * stored as one run of 16 bytes, so that the size of a mask depends on the border of what is
 * hidden; a mask that hides nothing is empty.
 *
 * Not a vtkObject: a mask is copied and compared by value.
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
   * The blocks from First to the beginning of the next run all have these bits.
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
   * Adds the next `count` blocks, all with the same bits.
   */
  void Append(vtkTypeUInt64 bits, vtkTypeInt64 count = 1);

  /**
   * Returns a block's bits; those of the last run beyond the end, 0 if the mask is empty.
   */
  vtkTypeUInt64 Get(vtkTypeInt64 block) const;

  /**
   * The runs in order; the first begins at block 0. Empty if nothing is hidden.
   */
  const std::vector<Run>& GetRuns() const { return this->Runs; }

  /**
   * Whether a sample, or cell, at a position in samples is hidden in a volume of so many blocks per
   * axis.
   */
  bool Hides(const int position[3], const int blocks[3]) const;

  /**
   * Makes of this mask of samples the mask of the cells that have a hidden corner, or that are
   * hidden in `other`, a mask of cells.
   */
  vtkBlockMask ToCells(const int blocks[3], const vtkBlockMask& other) const;

  /**
   * Cuts out the mask of `count` blocks per axis from `first` on. The volume has `blocks` per axis.
   */
  vtkBlockMask Crop(const int first[3], const int count[3], const int blocks[3]) const;

  ///@{
  /**
   * Converts the runs to tuples (first block, bits), and back. FromArray() checks them for a volume
   * of so many blocks, and returns an error as the end of a sentence that begins with the array's
   * name, or an empty string.
   */
  vtkSmartPointer<vtkTypeUInt64Array> ToArray() const;
  std::string FromArray(vtkDataArray* array, vtkTypeInt64 blocks);
  ///@}

  /**
   * Copies an array of such tuples, which a reader made, to one as ToArray() makes it: VTK's
   * writers may make files of others that no reader reads without an error.
   */
  static vtkSmartPointer<vtkTypeUInt64Array> CopyArray(vtkDataArray* array);

  bool operator==(const vtkBlockMask& other) const { return this->Runs == other.Runs; }

private:
  std::vector<Run> Runs;
  vtkTypeUInt64 Blocks = 0; // appended so far
};

#endif
