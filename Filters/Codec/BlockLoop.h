// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The parallel loop over a stream's blocks (internal).
//
// zfp_compress() with zfp's OpenMP policy would not do: it encodes into one buffer per thread,
// which a single thread concatenates, and there is no parallel decoder. 64 blocks always fill whole
// 64-bit words, so that threads that take blocks in groups of 64 write in place, and decode alike.
#ifndef BlockLoop_h
#define BlockLoop_h

#include "Codec/BlockStream.h"
#include "Codec/SampleSummary.h"

#include <omp.h>
#include <zfp.h>

#include <algorithm>
#include <atomic>

/// One thread's access to a stream.
class BlockCodec
{
public:
  explicit BlockCodec(const BlockStream& blocks)
    : BlockBits(blocks.GetBlockBits())
    , Bits(stream_open(blocks.GetWords(), 0)) // zfp does not look at the size
    , Stream(zfp_stream_open(this->Bits))
  {
    zfp_stream_set_params(
      this->Stream, this->BlockBits, this->BlockBits, ZFP_MAX_PREC, ZFP_MIN_EXP);
  }
  ~BlockCodec()
  {
    zfp_stream_close(this->Stream);
    stream_close(this->Bits);
  }
  BlockCodec(const BlockCodec&) = delete;
  void operator=(const BlockCodec&) = delete;

  void SeekToRead(vtkTypeInt64 block) { stream_rseek(this->Bits, this->OffsetOf(block)); }
  void SeekToWrite(vtkTypeInt64 block) { stream_wseek(this->Bits, this->OffsetOf(block)); }
  void Flush() { stream_flush(this->Bits); }
  zfp_stream* GetStream() { return this->Stream; }

private:
  bitstream_offset OffsetOf(vtkTypeInt64 block) const
  {
    return static_cast<bitstream_offset>(block) * this->BlockBits;
  }

  int BlockBits;
  bitstream* Bits;
  zfp_stream* Stream;
};

/// The slabs [First, Last) of a stream.
struct SlabRange
{
  vtkTypeInt64 First;
  vtkTypeInt64 Last;
};

enum class StreamAccess
{
  Read,
  Write
};

/**
 * Calls body(slabs, progress of these) for some slabs after the other, so many at a time that what
 * is kept of each block of a part is small beside a volume, and the threads' waiting for one
 * another at its end beside the work. Returns false when stopped.
 */
template <typename Body>
bool ForEachPart(
  const BlockStream& blocks, SlabRange slabs, const ProgressCallback& progress, const Body& body)
{
  constexpr vtkTypeInt64 BlocksPerPart = 1 << 20;
  const double all = static_cast<double>(slabs.Last - slabs.First);
  const vtkTypeInt64 step = std::max<vtkTypeInt64>(BlocksPerPart / blocks.GetBlocksPerSlab(), 1);
  for (SlabRange part = { slabs.First, slabs.First }; part.First < slabs.Last;
       part.First = part.Last)
  {
    part.Last = std::min(part.First + step, slabs.Last);
    const double before = static_cast<double>(part.First - slabs.First) / all;
    const double share = static_cast<double>(part.Last - part.First) / all;
    if (!body(part, [&](double fraction) { return progress(before + share * fraction); }))
    {
      return false;
    }
  }
  return true;
}

/// Calls the body of ForEachBlock() for the blocks [first, last).
template <typename Body>
void VisitBlocks(const BlockStream& blocks, vtkTypeInt64 first, vtkTypeInt64 last,
  StreamAccess access, BlockCodec& codec, SampleSummary& summary, const Body& body)
{
  access == StreamAccess::Write ? codec.SeekToWrite(first) : codec.SeekToRead(first);
  BlockStream::Block block = blocks.GetBlock(first);
  for (vtkTypeInt64 index = first; index < last; ++index, blocks.GoToNext(block))
  {
    body(codec.GetStream(), block, summary);
  }
  if (access == StreamAccess::Write)
  {
    codec.Flush();
  }
}

/**
 * Calls body(zfp stream positioned at the block, block, summary of the thread) for all blocks of
 * some slabs, in parallel, and adds the threads' summaries to `summary`. Each thread begins with
 * the counts of `summary`, so that a body knows what was found before. Returns false when stopped.
 */
template <typename Body>
bool ForEachBlock(const BlockStream& blocks, SlabRange slabs, StreamAccess access,
  SampleSummary& summary, const ProgressCallback& progress, Body body)
{
  constexpr vtkTypeInt64 GroupSize = 64; // blocks that begin and end on a 64-bit word
  constexpr int GroupsPerTurn = 8;       // that a thread takes at a time
  constexpr double ReportedStep = 0.01;  // of the work, after which progress is reported
  const vtkTypeInt64 begin = slabs.First * blocks.GetBlocksPerSlab();
  const vtkTypeInt64 end = slabs.Last * blocks.GetBlocksPerSlab();
  const vtkTypeInt64 firstGroup = begin / GroupSize;
  const vtkTypeInt64 lastGroup = (end + GroupSize - 1) / GroupSize;
  const SampleSummary before = summary;
  std::atomic<vtkTypeInt64> done{ 0 };
  std::atomic<bool> stopped{ false };

  // Threads never wait for one another before the end: another program may hold up any of them.
#pragma omp parallel num_threads(blocks.GetNumberOfThreads())
  {
    BlockCodec codec(blocks);
    SampleSummary mine = before.BeginWithCounts();
    double reported = 0.0;
#pragma omp for schedule(dynamic, GroupsPerTurn)
    for (vtkTypeInt64 group = firstGroup; group < lastGroup; ++group)
    {
      if (stopped)
      {
        continue;
      }
      // slabs may begin and end inside a group: then the seek completes its first word
      const vtkTypeInt64 from = std::max(begin, group * GroupSize);
      const vtkTypeInt64 to = std::min(end, (group + 1) * GroupSize);
      VisitBlocks(blocks, from, to, access, codec, mine, body);
      const double fraction = static_cast<double>(++done) / (lastGroup - firstGroup);
      if (omp_get_thread_num() == 0 && fraction - reported >= ReportedStep)
      {
        reported = fraction;
        stopped = !progress(fraction);
      }
    }
    mine.SubtractCounts(before);
#pragma omp critical(BlockLoopSummary)
    summary.Add(mine);
  }
  return !stopped && progress(1.0);
}

#endif
