// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PartExtractor.h"

#include "vtkAlgorithm.h"
#include "vtkCompressedVolume.h"
#include "vtkSMPTools.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

//------------------------------------------------------------------------------
// Decoded samples, whose bytes are counted while they are held.
struct PartExtractor::CountedSamples : Bricks::Samples
{
  explicit CountedSamples(PartExtractor& owner)
    : Owner(owner)
  {
  }
  ~CountedSamples() { this->Owner.SampleBytes -= this->Counted; }
  CountedSamples(const CountedSamples&) = delete;
  void operator=(const CountedSamples&) = delete;

  // Counts the bytes that are held now.
  void UpdateCount()
  {
    const auto capacity = static_cast<vtkTypeInt64>(this->Values.capacity());
    const vtkTypeInt64 bytes = capacity * static_cast<vtkTypeInt64>(sizeof(float));
    const vtkTypeInt64 now = this->Owner.SampleBytes += bytes - this->Counted;
    this->Counted = bytes;
    vtkTypeInt64 peak = this->Owner.PeakSampleBytes;
    while (now > peak && !this->Owner.PeakSampleBytes.compare_exchange_weak(peak, now))
    {
    }
  }

  PartExtractor& Owner;
  vtkTypeInt64 Counted = 0;
};

//------------------------------------------------------------------------------
PartExtractor::PartExtractor(vtkCompressedVolume* volume, const Bricks& bricks,
  const BrickContour& contour, const std::vector<double>& isovalues, BrickRanges& ranges)
  : Stream(BlockStream::Align(volume->GetStream()))
  , Blocks(volume->GetDimensions(), volume->GetBlockBits(), this->Stream->GetPointer(0), 1)
  , AllBricks(bricks)
  , Contour(contour)
  , Isovalues(isovalues)
  , Ranges(ranges)
{
}

//------------------------------------------------------------------------------
bool PartExtractor::Extract(vtkAlgorithm* algorithm, SurfaceParts& parts)
{
  const std::vector<vtkIdType> bricks = this->FindBricks();
  const vtkIdType number = static_cast<vtkIdType>(bricks.size());
  parts.NumberOfBricks = this->AllBricks.GetNumberOfBricks();
  parts.Parts.resize(parts.NumberOfBricks * this->Isovalues.size());
  // Works in batches, so that only this thread reports progress: observers need not expect others.
  // In smaller batches, threads would often wait for one another.
  constexpr vtkIdType bricksPerThread = 16;
  const vtkIdType batch = bricksPerThread * vtkSMPTools::GetEstimatedNumberOfThreads();
  for (vtkIdType first = 0; first < number && !algorithm->GetAbortExecute(); first += batch)
  {
    const vtkIdType last = std::min(first + batch, number);
    vtkSMPTools::For(first, last, 1,
      [&](vtkIdType begin, vtkIdType end)
      {
        CountedSamples samples(*this);
        std::for_each(bricks.begin() + begin, bricks.begin() + end,
          [&](vtkIdType brick) { this->ExtractBrick(brick, samples, parts); });
      });
    algorithm->UpdateProgress(ProgressFraction * static_cast<double>(last) / number);
  }
  return !algorithm->GetAbortExecute();
}

//------------------------------------------------------------------------------
// Returns the bricks that must be decoded.
std::vector<vtkIdType> PartExtractor::FindBricks() const
{
  std::vector<vtkIdType> bricks;
  for (vtkIdType brick = 0; brick < this->AllBricks.GetNumberOfBricks(); ++brick)
  {
    if (this->Contour.Touches(brick) && this->Ranges.MayContain(brick, this->Isovalues))
    {
      bricks.push_back(brick);
    }
  }
  return bricks;
}

//------------------------------------------------------------------------------
void PartExtractor::ExtractBrick(vtkIdType brick, CountedSamples& samples, SurfaceParts& parts)
{
  this->AllBricks.Decode(this->Blocks, brick, this->Contour.GetHalo(), samples);
  samples.UpdateCount();
  ++this->Decoded;
  const Bricks::Range range = this->AllBricks.FindRange(brick, samples);
  this->Ranges.Set(brick, range);
  for (std::size_t i = 0; i < this->Isovalues.size(); ++i)
  {
    if (range.Contains(this->Isovalues[i]))
    {
      parts.Parts[i * parts.NumberOfBricks + brick] =
        this->Contour.Extract(brick, samples, this->Isovalues[i]);
    }
  }
}
