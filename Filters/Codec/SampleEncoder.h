// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   SampleEncoder
 * @brief   encodes the samples of an array into a stream, block by block (internal)
 *
 * Blocks whose values are all smaller than SampleSummary::TinyMagnitude, for which zfp yields
 * arbitrary values, are encoded as zero, and counted. After a visible value that is not finite (as
 * float32), values are still counted but no longer encoded.
 *
 * Hidden samples get values that cost zfp little, and the summary leaves them out. Every block is
 * decoded again, to tell its error and the range of its values.
 */
#ifndef SampleEncoder_h
#define SampleEncoder_h

#include "Codec/BlockRangeFinder.h"
#include "Codec/HiddenSamples.h"
#include "Codec/MacrocellErrors.h"
#include "Codec/Progress.h"
#include "Codec/SampleSummary.h"
#include "Codec/SampleUnits.h"

#include "vtkBlockMask.h"
#include "vtkType.h"

#include <memory>

class BlockStream;
class vtkDataArray;

class SampleEncoder
{
public:
  SampleUnits Units;
  HiddenSamples Hidden;

  /**
   * Makes room for what is kept of each block of a volume; an error where there is no memory, as
   * the end of "There is ...". Comes before EncodeSlabs().
   */
  Status Allocate(const BlockStream& blocks);

  /**
   * Encodes the slabs [first, last) of a stream from one component of an array, whose first tuple
   * is the first sample of slab `first`. Slabs must be encoded in order, each once. Returns false
   * when stopped.
   */
  bool EncodeSlabs(BlockStream& blocks, vtkTypeInt64 first, vtkTypeInt64 last, vtkDataArray* array,
    int component, const ProgressCallback& progress);

  ///@{
  /**
   * Of the samples encoded so far.
   */
  const SampleSummary& GetSummary() const { return this->Summary; }
  const vtkBlockMask& GetMask() const { return this->Mask; }
  const MacrocellErrors& GetErrors() const { return *this->Errors; }
  ///@}

  /**
   * Of all samples, once they are encoded.
   */
  BlockRangeFinder& GetRanges() { return *this->Ranges; }

private:
  struct Worker;

  SampleSummary Summary;
  vtkBlockMask Mask;
  std::unique_ptr<MacrocellErrors> Errors;  // null before Allocate()
  std::unique_ptr<BlockRangeFinder> Ranges; // likewise
};

#endif
