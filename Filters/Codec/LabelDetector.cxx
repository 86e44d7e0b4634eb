// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelDetector.h"

#include "Codec/BlockGatherer.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr std::size_t FewInAll = 16;
constexpr int FewInBlock = 8;
constexpr vtkTypeInt64 EnoughBlocks = 1024; // with different values, to judge by

bool IsWhole(float value)
{
  return std::floor(value) == value;
}
}

//------------------------------------------------------------------------------
struct LabelDetector::Worker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, LabelDetector& self, const BlockStream& blocks, vtkTypeInt64 first,
    vtkTypeInt64 last, int component) const
  {
    const BlockGatherer<ArrayT> gatherer(
      blocks.GetDimensions(), first, array, component, SampleUnits(), self.Hidden);
    BlockStream::Block block = blocks.GetBlock(first * blocks.GetBlocksPerSlab());
    const vtkTypeInt64 count = (last - first) * blocks.GetBlocksPerSlab();
    for (vtkTypeInt64 i = 0; i < count && !self.HasOthers; ++i, blocks.GoToNext(block))
    {
      float samples[BlockSamples], visible[BlockSamples];
      SampleSummary found;
      const vtkTypeUInt64 hidden = gatherer.Gather(block, samples, found);
      int seen = 0;
      for (int at = 0; at < BlockSamples; ++at)
      {
        const bool isInside = at % BlockSide < block.Size[0] &&
          at / BlockSide % BlockSide < block.Size[1] && at / BlockSlice < block.Size[2];
        if (isInside && !(hidden >> at & 1))
        {
          visible[seen++] = samples[at];
        }
      }
      self.AddBlock(visible, seen);
    }
  }
};

//------------------------------------------------------------------------------
void LabelDetector::AddBlock(const float* samples, int count)
{
  if (count == 0)
  {
    return;
  }
  float values[BlockSamples];
  std::copy_n(samples, count, values);
  float* end = std::unique(values, values + count);
  if (!std::all_of(values, end, IsWhole)) // false of NaN and infinity, too
  {
    this->HasOthers = true;
    return;
  }
  std::sort(values, end);
  end = std::unique(values, end);
  for (const float* value = values; value < end && this->Values.size() <= FewInAll; ++value)
  {
    this->Values.insert(*value);
  }
  if (end - values > 1)
  {
    ++this->Blocks;
    this->BlockValues += end - values;
    this->Spans += static_cast<double>(end[-1]) - values[0];
    this->HasOthers = this->Blocks >= EnoughBlocks && this->AreCrowded();
  }
}

//------------------------------------------------------------------------------
// Whether the blocks have too many different values.
bool LabelDetector::AreCrowded() const
{
  return this->BlockValues > FewInBlock * this->Blocks;
}

//------------------------------------------------------------------------------
bool LabelDetector::FindsLabels() const
{
  const bool areFar = this->Spans >= 2.0 * static_cast<double>(this->BlockValues);
  return !this->HasOthers && this->Blocks > 0 && !this->AreCrowded() &&
    (this->Values.size() <= FewInAll || areFar);
}

//------------------------------------------------------------------------------
void LabelDetector::AddSlabs(
  const int dims[3], vtkTypeInt64 first, vtkTypeInt64 last, vtkDataArray* array, int component)
{
  const BlockStream blocks(dims, 2048, nullptr, 1);
  Worker worker;
  if (!vtkArrayDispatch::Dispatch::Execute(array, worker, *this, blocks, first, last, component))
  {
    worker(array, *this, blocks, first, last, component);
  }
}
