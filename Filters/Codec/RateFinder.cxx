// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RateFinder.h"

#include "Codec/BlockGatherer.h"
#include "Codec/BlockTrial.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"

#include <omp.h>

#include <algorithm>
#include <atomic>

namespace
{
constexpr int MostBits = 2048;

//------------------------------------------------------------------------------
// Raises a value to another that is larger.
template <typename T>
void Raise(std::atomic<T>& target, T value)
{
  T held = target;
  while (held < value && !target.compare_exchange_weak(held, value))
  {
  }
}

//------------------------------------------------------------------------------
// Returns bits of a block, more than too few, with which its error is within a tolerance.
template <typename Error>
int Bisect(const Error& errorOf, int tooFew, double tolerance)
{
  int enough = MostBits;
  while (enough - tooFew > 1)
  {
    const int middle = (enough + tooFew) / 2;
    (errorOf(middle) > tolerance ? tooFew : enough) = middle;
  }
  return enough;
}
}

//------------------------------------------------------------------------------
struct RateFinder::Worker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, RateFinder& self, const BlockStream& blocks, vtkTypeInt64 first,
    vtkTypeInt64 last, int component) const
  {
    const BlockGatherer<ArrayT> gatherer(
      blocks.GetDimensions(), first, array, component, self.Units, self.Hidden);
    for (vtkTypeInt64 slab = first; slab < last; ++slab)
    {
      SearchSlab(gatherer, self, blocks, slab);
    }
  }

  // All blocks of a slab begin with the same rate, so that the result does not depend on threads.
  template <typename Gatherer>
  static void SearchSlab(
    const Gatherer& gatherer, RateFinder& self, const BlockStream& blocks, vtkTypeInt64 slab)
  {
    const int tried = self.BlockBits;
    std::atomic<int> bits{ tried };
    std::atomic<double> leastError{ self.LeastError };
    const vtkTypeInt64 begin = slab * blocks.GetBlocksPerSlab();
    const vtkTypeInt64 end = begin + blocks.GetBlocksPerSlab();
#pragma omp parallel for schedule(dynamic, 64) num_threads(blocks.GetNumberOfThreads())
    for (vtkTypeInt64 index = begin; index < end; ++index)
    {
      const BlockStream::Block block = blocks.GetBlock(index);
      float samples[BlockSamples];
      SampleSummary found;
      const vtkTypeUInt64 hidden = gatherer.Gather(block, samples, found);
      if (!found.IsFinite())
      {
        continue; // whoever compresses the samples says so
      }
      BlockTrial& trial = BlockTrial::OfThread();
      const auto errorOf = [&](int blockBits)
      {
        trial.Run(samples, block.Size, blockBits);
        return gatherer.FindError(block, hidden, samples, trial.GetDecoded()).Largest;
      };
      if (errorOf(tried) <= self.Tolerance)
      {
        continue;
      }
      const double least = errorOf(MostBits);
      least > self.Tolerance ? Raise(leastError, least)
                             : Raise(bits, Bisect(errorOf, tried, self.Tolerance));
    }
    self.BlockBits = bits;
    self.LeastError = leastError;
  }
};

//------------------------------------------------------------------------------
void RateFinder::AddSlabs(
  const int dims[3], vtkTypeInt64 first, vtkTypeInt64 last, vtkDataArray* array, int component)
{
  const BlockStream blocks(dims, MostBits, nullptr, this->Threads);
  Worker worker;
  if (!vtkArrayDispatch::Dispatch::Execute(array, worker, *this, blocks, first, last, component))
  {
    worker(array, *this, blocks, first, last, component);
  }
}

//------------------------------------------------------------------------------
bool RateFinder::Find(const int dims[3], vtkDataArray* array, int component)
{
  int before = 0;
  while (this->BlockBits != before && this->LeastError == 0.0)
  {
    before = this->BlockBits;
    this->AddSlabs(dims, 0, BlocksAlong<vtkTypeInt64>(dims[2]), array, component);
  }
  return this->LeastError == 0.0;
}
