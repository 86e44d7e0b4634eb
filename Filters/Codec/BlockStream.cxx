// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockStream.h"

#include "Codec/BlockLoop.h"
#include "Codec/SampleSummary.h"

#include "vtkUnsignedCharArray.h"

#include <omp.h>
#include <zfp.h>

#include <algorithm>
#include <cstdint>

//------------------------------------------------------------------------------
BlockStream::BlockStream(const int dims[3], int blockBits, void* words, int threads)
  : BlockBits(blockBits)
  , Words(words)
  , Threads(threads > 0 ? threads : omp_get_max_threads())
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Dimensions[axis] = dims[axis];
    this->Blocks[axis] = BlocksAlong(this->Dimensions[axis]);
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnsignedCharArray> BlockStream::Align(vtkUnsignedCharArray* stream)
{
  if (reinterpret_cast<std::uintptr_t>(stream->GetPointer(0)) % sizeof(vtkTypeUInt64) == 0)
  {
    return stream;
  }
  auto copy = vtkSmartPointer<vtkUnsignedCharArray>::New();
  copy->DeepCopy(stream);
  return copy;
}

//------------------------------------------------------------------------------
BlockStream::Block BlockStream::GetBlock(vtkTypeInt64 index) const
{
  Block block;
  block.Position[0] = index % this->Blocks[0];
  block.Position[1] = index / this->Blocks[0] % this->Blocks[1];
  block.Position[2] = index / this->Blocks[0] / this->Blocks[1];
  this->FindSamples(block);
  return block;
}

//------------------------------------------------------------------------------
void BlockStream::GoToNext(Block& block) const
{
  for (int axis = 0; axis < 2; ++axis)
  {
    if (++block.Position[axis] < this->Blocks[axis])
    {
      this->FindSamples(block);
      return;
    }
    block.Position[axis] = 0;
  }
  ++block.Position[2];
  this->FindSamples(block);
}

//------------------------------------------------------------------------------
void BlockStream::FindSamples(Block& block) const
{
  const vtkTypeInt64* const position = block.Position;
  block.Sample = BlockSide *
    (position[0] + this->Dimensions[0] * (position[1] + this->Dimensions[1] * position[2]));
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 left = this->Dimensions[axis] - BlockSide * position[axis];
    block.Size[axis] = static_cast<int>(std::min<vtkTypeInt64>(BlockSide, left));
  }
}

//------------------------------------------------------------------------------
bool BlockStream::Decode(float* samples, const ProgressCallback& progress) const
{
  const vtkTypeInt64 row = this->Dimensions[0];
  const vtkTypeInt64 slice = row * this->Dimensions[1];
  SampleSummary unused;
  return ForEachBlock(*this, { 0, this->GetNumberOfSlabs() }, StreamAccess::Read, unused, progress,
    [=](zfp_stream* stream, const Block& block, SampleSummary&)
    {
      float* const target = samples + block.Sample;
      if (block.IsWhole())
      {
        zfp_decode_block_strided_float_3(stream, target, 1, row, slice);
      }
      else
      {
        zfp_decode_partial_block_strided_float_3(
          stream, target, block.Size[0], block.Size[1], block.Size[2], 1, row, slice);
      }
    });
}

//------------------------------------------------------------------------------
void BlockStream::DecodeBox(const int first[3], const int last[3], float* samples) const
{
  BlockCodec codec(*this);
  const vtkTypeInt64 row = BlockSide * static_cast<vtkTypeInt64>(last[0] - first[0]);
  const vtkTypeInt64 slice = BlockSide * row * (last[1] - first[1]);
  for (vtkTypeInt64 z = first[2]; z < last[2]; ++z)
  {
    for (vtkTypeInt64 y = first[1]; y < last[1]; ++y)
    {
      codec.SeekToRead(first[0] + this->Blocks[0] * (y + this->Blocks[1] * z));
      float* const target = samples + BlockSide * ((z - first[2]) * slice + (y - first[1]) * row);
      for (int x = 0; x < last[0] - first[0]; ++x)
      {
        zfp_decode_block_strided_float_3(codec.GetStream(), target + BlockSide * x, 1, row, slice);
      }
    }
  }
}

//------------------------------------------------------------------------------
bool BlockStream::Summarize(SampleSummary& summary, const ProgressCallback& progress) const
{
  return ForEachBlock(*this, { 0, this->GetNumberOfSlabs() }, StreamAccess::Read, summary, progress,
    [](zfp_stream* stream, const Block& block, SampleSummary& mine)
    {
      float samples[BlockSamples];
      zfp_decode_block_float_3(stream, samples);
      AddTo(mine, block, samples);
    });
}

//------------------------------------------------------------------------------
void BlockStream::AddTo(SampleSummary& summary, const Block& block, const float samples[])
{
  if (block.IsWhole())
  {
    summary.AddBlock(samples);
    return;
  }
  for (int z = 0; z < block.Size[2]; ++z)
  {
    for (int y = 0; y < block.Size[1]; ++y)
    {
      for (int x = 0; x < block.Size[0]; ++x)
      {
        summary.Add(samples[BlockSlice * z + BlockSide * y + x]);
      }
    }
  }
}
