// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   BlockRangeFinder
 * @brief   finds the ranges of a volume's blocks while they are encoded or decoded (internal)
 *
 * The cells of a block reach into the first samples of its upper neighbours, so that each block
 * adds to the range of those before it. Only the slabs that are not complete are kept.
 */
#ifndef BlockRangeFinder_h
#define BlockRangeFinder_h

#include "Codec/BlockStream.h"
#include "Codec/RangeLayout.h"
#include "Codec/RangeRecords.h"
#include "Status.h"

#include "vtkNew.h"
#include "vtkTypeUInt64Array.h"

#include <atomic>
#include <deque>
#include <memory>
#include <vector>

struct SampleSummary;
class vtkBlockMask;
class vtkBlockRanges;

class BlockRangeFinder
{
public:
  /// Of a stream's volume, with its number of threads.
  explicit BlockRangeFinder(const BlockStream& blocks);

  /// Makes room for the result; an error where there is no memory, as the end of "There is ...".
  Status Allocate();

  /// Adds a whole stream, by decoding all of it, and summarises its samples, too. Returns false
  /// when stopped.
  bool AddAll(const BlockStream& blocks, SampleSummary& summary, const ProgressCallback& progress);

  /// Makes room for all slabs before `last`, which follow those added.
  void OpenSlabs(vtkTypeInt64 last);

  /// Adds a decoded block of a slab that is open. Threads may do so at the same time.
  void Add(const BlockStream::Block& block, const float decoded[BlockSamples]);

  /// Forgets what no further block can change, once all blocks of the open slabs are added.
  void CloseSlabs();

  /// Makes the result, once all slabs are added. `hidden` are the cells without surface: what is
  /// near them is decoded again. Nothing else can be done afterwards.
  vtkBlockRanges Finish(const BlockStream& blocks, const vtkBlockMask& hidden);

private:
  // Of a block; every thread may extend it.
  struct Accumulator
  {
    std::atomic<vtkTypeInt32> Low{ RangeSteps::KeyRange().Low };
    std::atomic<vtkTypeInt32> High{ RangeSteps::KeyRange().High };
    void Extend(const RangeSteps::KeyRange& range);
  };

  Accumulator& At(const vtkTypeInt64 block[3]);
  vtkTypeUInt64* RecordOf(const RangeLayout::Page& page, vtkTypeInt64 number);
  void Store(const vtkTypeInt64 macrocell[3], const RangeSteps::KeyRange ranges[]);
  void CloseLayers(vtkTypeInt64 first, vtkTypeInt64 last);
  void CloseMacrocell(const vtkTypeInt64 macrocell[3]);
  std::vector<vtkTypeInt64> FindMacrocellsNear(const vtkBlockMask& hidden) const;
  void FindVisible(
    const BlockStream& blocks, const vtkBlockMask& hidden, const vtkTypeInt64 macrocell[3]);
  vtkBlockRanges Pack();

  RangeLayout Layout;
  int Threads;
  std::deque<std::unique_ptr<Accumulator[]>> Slabs;
  vtkTypeInt64 FirstSlab = 0; // of those kept
  vtkNew<vtkTypeUInt64Array> Records;
};

#endif
