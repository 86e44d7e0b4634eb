// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleEncoder.h"

#include "Codec/BlockGatherer.h"
#include "Codec/BlockLoop.h"
#include "Codec/BlockTrial.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"

#include <algorithm>
#include <vector>

namespace
{
using Block = BlockStream::Block;

//------------------------------------------------------------------------------
// Encodes blocks of one component of an array, converted to float block by block.
template <typename ArrayT>
class ArrayEncoder
{
public:
  // The array begins with slab `first`. `masks` has room for the hidden samples of every block from
  // slab `firstMask` on, or is empty if no sample may be hidden.
  ArrayEncoder(const BlockStream& blocks, vtkTypeInt64 first, vtkTypeInt64 firstMask, ArrayT* array,
    int component, const SampleUnits& units, const HiddenSamples& hidden,
    std::vector<vtkTypeUInt64>& masks, MacrocellErrors& errors, BlockRangeFinder& ranges)
    : Gatherer(blocks.GetDimensions(), first, array, component, units, hidden)
    , BlockBits(blocks.GetBlockBits())
    , FirstBlock(firstMask * blocks.GetBlocksPerSlab())
    , BlocksAlongX(blocks.GetBlocks()[0])
    , BlocksPerSlab(blocks.GetBlocksPerSlab())
    , Scale(units.Scale)
    , Masks(masks)
    , Errors(errors)
    , Ranges(ranges)
  {
  }

  void operator()(zfp_stream* stream, const Block& block, SampleSummary& summary) const
  {
    float samples[BlockSamples];
    SampleSummary found;
    const vtkTypeUInt64 hidden = this->Gatherer.Gather(block, samples, found);
    if (!this->Masks.empty())
    {
      this->Masks[this->IndexInMasks(block)] = hidden;
    }
    if (found.IsFinite() && found.GetMagnitude() < SampleSummary::TinyMagnitude &&
      found.GetMagnitude() > 0.0f)
    {
      std::fill_n(samples, BlockSamples, 0.0f);
      found.TinyBlocks = 1;
    }
    summary.Add(found);
    if (!summary.IsFinite())
    {
      return;
    }
    BlockTrial& trial = BlockTrial::OfThread();
    trial.Run(samples, block.Size, this->BlockBits);
    trial.CopyTo(stream);
    this->Ranges.Add(block, trial.GetDecoded());
    if (found.Minimum <= found.Maximum)
    {
      const BlockError error = this->Gatherer.FindError(block, hidden, samples, trial.GetDecoded());
      summary.AddError(error.Largest, error.Sum, error.Count);
      this->Errors.Add(block.Position, found.Minimum, found.Maximum,
        static_cast<float>(error.Largest / this->Scale));
    }
  }

private:
  vtkTypeInt64 IndexInMasks(const Block& block) const
  {
    const vtkTypeInt64* const position = block.Position;
    return position[0] + this->BlocksAlongX * position[1] + this->BlocksPerSlab * position[2] -
      this->FirstBlock;
  }

  BlockGatherer<ArrayT> Gatherer;
  int BlockBits;
  vtkTypeInt64 FirstBlock;
  vtkTypeInt64 BlocksAlongX;
  vtkTypeInt64 BlocksPerSlab;
  double Scale;
  std::vector<vtkTypeUInt64>& Masks;
  MacrocellErrors& Errors;
  BlockRangeFinder& Ranges;
};
}

//------------------------------------------------------------------------------
struct SampleEncoder::Worker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, SampleEncoder& self, BlockStream& blocks, SlabRange slabs,
    int component, const ProgressCallback& progress, bool& complete) const
  {
    complete = ForEachPart(blocks, slabs, progress,
      [&](SlabRange part, const ProgressCallback& progressOfPart)
      {
        const vtkTypeInt64 number = (part.Last - part.First) * blocks.GetBlocksPerSlab();
        std::vector<vtkTypeUInt64> masks(self.Hidden.MayHide() ? number : 0);
        const ArrayEncoder<ArrayT> encoder(blocks, slabs.First, part.First, array, component,
          self.Units, self.Hidden, masks, *self.Errors, *self.Ranges);
        self.Ranges->OpenSlabs(part.Last);
        const bool isComplete =
          ForEachBlock(blocks, part, StreamAccess::Write, self.Summary, progressOfPart, encoder);
        self.Ranges->CloseSlabs();
        for (const vtkTypeUInt64 mask : masks)
        {
          self.Mask.Append(mask);
        }
        self.Mask.Append(0, masks.empty() ? number : 0);
        return isComplete;
      });
  }
};

//------------------------------------------------------------------------------
Status SampleEncoder::Allocate(const BlockStream& blocks)
{
  this->Errors = std::make_unique<MacrocellErrors>(blocks.GetBlocks());
  this->Ranges = std::make_unique<BlockRangeFinder>(blocks);
  return this->Ranges->Allocate();
}

//------------------------------------------------------------------------------
bool SampleEncoder::EncodeSlabs(BlockStream& blocks, vtkTypeInt64 first, vtkTypeInt64 last,
  vtkDataArray* array, int component, const ProgressCallback& progress)
{
  Worker worker;
  const SlabRange slabs = { first, last };
  bool complete = false;
  if (!vtkArrayDispatch::Dispatch::Execute(
        array, worker, *this, blocks, slabs, component, progress, complete))
  {
    // array classes that VTK does not dispatch to (bits, implicit arrays): through doubles
    worker(array, *this, blocks, slabs, component, progress, complete);
  }
  return complete;
}
