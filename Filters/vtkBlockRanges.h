// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBlockRanges
 * @brief   the range of values of every block of a volume, grouped by pages
 *
 * A block is 4x4x4 samples, a macrocell 4x4x4 blocks, a page 4x4x4 macrocells. The range of a block
 * is that of the corners of its cells, decoded: of its own samples, and of the first ones of its
 * upper neighbours. Corners of hidden cells do not count. A macrocell's range is that of its
 * blocks, as two float32; a block's is told in 8 + 8 bits, steps within its macrocell's, rounded
 * outwards (see RangeSteps.h). A range that holds nothing is upside down.
 *
 * Pages, macrocells and blocks are in x-fastest order. A page's record consists of 64-bit words:
 *
 * - a bit for each of its macrocells, which says whether the steps of its blocks are stored
 * - a word for each macrocell: the bits of the lowest value, and 2^32 times those of the highest
 * - for each macrocell with a bit 16 words: its 64 blocks' steps, 16 bits each, the lowest step in
 *   the lower eight
 *
 * Steps are not stored where they are 0 to 255 for each block that has cells, by the dimensions of
 * the volume, and else 255 to 0; or if the macrocell's range is empty. A page of which this is so,
 * and whose macrocells all have its own range, or none if they have no cells, has no record.
 *
 * The directory tells of each page, in four 32-bit integers: the bits of the lowest and of the
 * highest value of its macrocells, the number of words of its record plus 65536 times flags, and
 * zlib's CRC-32 of the record, little-endian.
 *
 * Not a vtkObject: it is copied by value. Copies share the arrays.
 */
#ifndef vtkBlockRanges_h
#define vtkBlockRanges_h

#include "vtkProgIsoFiltersModule.h" // for export macro
#include "vtkType.h"

#include <memory> // for what copies share
#include <string> // for error messages

class vtkDataArray;

class VTKPROGISOFILTERS_EXPORT vtkBlockRanges
{
public:
  enum
  {
    BlocksPerMacrocell = 64,
    StepsPerWord = 2, ///< of 32 bits, as GetMacrocell() returns them
  };

  /**
   * Flags of a page: no block has a range; all that have one have the same single value.
   */
  enum
  {
    EmptyPage = 1,
    ConstantPage = 2,
  };

  /**
   * Whether nothing is known.
   */
  bool IsEmpty() const { return !this->Shared; }

  /**
   * Takes the arrays of a volume of so many samples per axis, and checks all but their checksums.
   * Returns what is wrong as a sentence that begins with "its directory" or "its records", and then
   * changes nothing; else an empty string.
   */
  std::string FromArrays(vtkDataArray* directory, vtkDataArray* records, const int dims[3]);

  /**
   * Compares the records with their checksums. Returns a sentence as FromArrays() does.
   */
  std::string CheckRecords() const;

  ///@{
  /**
   * The arrays; null if nothing is known.
   */
  vtkDataArray* GetDirectory() const;
  vtkDataArray* GetRecords() const;
  ///@}

  /**
   * Whether these are of a volume of so many samples per axis.
   */
  bool Fit(const int dims[3]) const;

  /**
   * The number of macrocells of the volume.
   */
  vtkTypeInt64 GetNumberOfMacrocells() const;

  /**
   * Gets the bits of the lowest and highest value of a macrocell, and the steps of its blocks, two
   * a word.
   */
  void GetMacrocell(vtkTypeInt64 macrocell, vtkTypeUInt32 range[2],
    vtkTypeUInt32 steps[BlocksPerMacrocell / StepsPerWord]) const;

  /**
   * Counts the pages of the volume, and those of them that have no record.
   */
  vtkTypeInt64 GetNumberOfPages() const;
  vtkTypeInt64 GetNumberOfPagesWithoutRecord() const;

  /**
   * Returns the bytes of both arrays.
   */
  vtkTypeInt64 GetBytes() const;

  /**
   * Whether both have the same ranges.
   */
  bool operator==(const vtkBlockRanges& other) const;

private:
  struct Arrays;

  std::shared_ptr<const Arrays> Shared;
};

#endif
