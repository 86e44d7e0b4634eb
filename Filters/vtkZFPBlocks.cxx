// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPBlocks.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"

#include <omp.h>
#include <zfp.h>

#include <algorithm>
#include <cmath>

namespace
{
// Blocks in a group that starts and ends on a 64-bit word whatever the bits per block.
constexpr vtkTypeInt64 GroupSize = 64;
// Groups that a thread takes at a time.
constexpr int GroupsPerTurn = 8;
// Blocks in a step that are worth starting the threads for.
constexpr vtkTypeInt64 BlocksPerStep = 1 << 15;
}

//------------------------------------------------------------------------------
void vtkZFPBlocks::Summary::Add(float value)
{
  if (std::isfinite(value))
  {
    this->Minimum = std::min(this->Minimum, value);
    this->Maximum = std::max(this->Maximum, value);
  }
  else if (std::isnan(value))
  {
    ++this->NaNs;
  }
  else
  {
    ++this->Infinities;
  }
}

//------------------------------------------------------------------------------
void vtkZFPBlocks::Summary::Add(const Summary& other)
{
  this->Minimum = std::min(this->Minimum, other.Minimum);
  this->Maximum = std::max(this->Maximum, other.Maximum);
  this->NaNs += other.NaNs;
  this->Infinities += other.Infinities;
  this->TinyBlocks += other.TinyBlocks;
}

//------------------------------------------------------------------------------
float vtkZFPBlocks::Summary::Magnitude() const
{
  return std::max(std::abs(this->Minimum), std::abs(this->Maximum));
}

//------------------------------------------------------------------------------
// One thread's view of the stream.
struct vtkZFPBlocks::Codec
{
  Codec(void* words, int blockBits)
    : Bits(stream_open(words, 0)) // zfp does not look at the size
    , Stream(zfp_stream_open(this->Bits))
  {
    zfp_stream_set_params(this->Stream, blockBits, blockBits, ZFP_MAX_PREC, ZFP_MIN_EXP);
  }
  ~Codec()
  {
    zfp_stream_close(this->Stream);
    stream_close(this->Bits);
  }
  Codec(const Codec&) = delete;
  void operator=(const Codec&) = delete;

  bitstream* Bits;
  zfp_stream* Stream;
};

//------------------------------------------------------------------------------
vtkZFPBlocks::vtkZFPBlocks(const int dims[3], int blockBits, void* words, int threads)
  : BlockBits(blockBits)
  , Words(words)
  , Threads(threads > 0 ? threads : omp_get_max_threads())
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Dimensions[axis] = dims[axis];
    this->Blocks[axis] = (this->Dimensions[axis] + 3) / 4;
  }
}

//------------------------------------------------------------------------------
// About a hundredth of the volume, but enough blocks to keep the threads busy.
vtkTypeInt64 vtkZFPBlocks::GetLayersPerStep() const
{
  const vtkTypeInt64 perLayer = this->Blocks[0] * this->Blocks[1];
  const vtkTypeInt64 worthwhile = (BlocksPerStep + perLayer - 1) / perLayer;
  return std::max(worthwhile, this->Blocks[2] / 100);
}

//------------------------------------------------------------------------------
vtkZFPBlocks::Block vtkZFPBlocks::GetBlock(vtkTypeInt64 index) const
{
  const vtkTypeInt64 position[3] = { index % this->Blocks[0],
    index / this->Blocks[0] % this->Blocks[1], index / this->Blocks[0] / this->Blocks[1] };
  Block block;
  for (int axis = 0; axis < 3; ++axis)
  {
    block.Start[axis] = 4 * position[axis];
    block.Size[axis] =
      static_cast<int>(std::min<vtkTypeInt64>(4, this->Dimensions[axis] - block.Start[axis]));
  }
  return block;
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkZFPBlocks::SampleIndex(const Block& block) const
{
  return block.Start[0] +
    this->Dimensions[0] * (block.Start[1] + this->Dimensions[1] * block.Start[2]);
}

//------------------------------------------------------------------------------
// Calls body(zfp stream positioned at the block, block, summary of the thread) for all blocks of
// the layers [first, last), in parallel over groups of blocks that share no word of the stream.
template <typename Body>
void vtkZFPBlocks::ForEachBlock(
  vtkTypeInt64 first, vtkTypeInt64 last, Summary& summary, bool write, Body body)
{
  const vtkTypeInt64 perLayer = this->Blocks[0] * this->Blocks[1];
  const vtkTypeInt64 begin = first * perLayer;
  const vtkTypeInt64 end = last * perLayer;
  const vtkTypeInt64 firstGroup = begin / GroupSize;
  const vtkTypeInt64 lastGroup = (end + GroupSize - 1) / GroupSize;
  const Summary before = summary;

#pragma omp parallel num_threads(this->Threads)
  {
    Codec codec(this->Words, this->BlockBits);
    Summary mine = before;
#pragma omp for schedule(dynamic, GroupsPerTurn)
    for (vtkTypeInt64 group = firstGroup; group < lastGroup; ++group)
    {
      // layers may begin and end inside a group: then its first word is completed by the seek
      const vtkTypeInt64 from = std::max(begin, group * GroupSize);
      const vtkTypeInt64 to = std::min(end, (group + 1) * GroupSize);
      const bitstream_offset offset = static_cast<bitstream_offset>(from) * this->BlockBits;
      write ? stream_wseek(codec.Bits, offset) : stream_rseek(codec.Bits, offset);
      for (vtkTypeInt64 index = from; index < to; ++index)
      {
        body(codec.Stream, this->GetBlock(index), mine);
      }
      if (write)
      {
        stream_flush(codec.Bits);
      }
    }
    mine.NaNs -= before.NaNs;
    mine.Infinities -= before.Infinities;
    mine.TinyBlocks -= before.TinyBlocks;
#pragma omp critical(vtkZFPBlocksSummary)
    summary.Add(mine);
  }
}

//------------------------------------------------------------------------------
// Encodes blocks of one component of an array, converted to float block by block.
template <typename ArrayT>
struct vtkZFPBlocks::Encoder
{
  Encoder(const vtkZFPBlocks& blocks, ArrayT* array, int component)
    : Blocks(blocks)
    , Tuples(vtk::DataArrayTupleRange(array))
    , Component(component)
  {
  }

  void operator()(zfp_stream* stream, const Block& block, Summary& summary) const
  {
    float samples[64];
    Summary found;
    this->Gather(block, samples, found);
    if (found.IsFinite() && found.Magnitude() < TinyMagnitude() && found.Magnitude() > 0.0f)
    {
      std::fill_n(samples, 64, 0.0f);
      found.TinyBlocks = 1;
    }
    summary.Add(found);
    if (!summary.IsFinite())
    {
      return;
    }
    if (block.IsWhole())
    {
      zfp_encode_block_float_3(stream, samples);
    }
    else
    {
      zfp_encode_partial_block_strided_float_3(
        stream, samples, block.Size[0], block.Size[1], block.Size[2], 1, 4, 16);
    }
  }

  void Gather(const Block& block, float samples[64], Summary& found) const
  {
    const vtkTypeInt64 origin = this->Blocks.SampleIndex(block);
    for (int z = 0; z < block.Size[2]; ++z)
    {
      for (int y = 0; y < block.Size[1]; ++y)
      {
        const vtkTypeInt64 row =
          origin + this->Blocks.Dimensions[0] * (y + this->Blocks.Dimensions[1] * z);
        for (int x = 0; x < block.Size[0]; ++x)
        {
          const float value = static_cast<float>(this->Tuples[row + x][this->Component]);
          found.Add(value);
          samples[16 * z + 4 * y + x] = value;
        }
      }
    }
  }

  const vtkZFPBlocks& Blocks;
  decltype(vtk::DataArrayTupleRange(std::declval<ArrayT*>())) Tuples;
  int Component;
};

//------------------------------------------------------------------------------
struct vtkZFPBlocks::EncodeWorker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, vtkZFPBlocks& blocks, int component, vtkTypeInt64 first,
    vtkTypeInt64 last, Summary& summary) const
  {
    blocks.ForEachBlock(first, last, summary, true, Encoder<ArrayT>(blocks, array, component));
  }
};

//------------------------------------------------------------------------------
void vtkZFPBlocks::Encode(
  vtkDataArray* array, int component, vtkTypeInt64 first, vtkTypeInt64 last, Summary& summary)
{
  EncodeWorker worker;
  if (!vtkArrayDispatch::Dispatch::Execute(array, worker, *this, component, first, last, summary))
  {
    // array classes that VTK does not dispatch to (bits, implicit arrays): through doubles
    worker(array, *this, component, first, last, summary);
  }
}

//------------------------------------------------------------------------------
void vtkZFPBlocks::Decode(float* samples, vtkTypeInt64 first, vtkTypeInt64 last)
{
  const vtkTypeInt64 row = this->Dimensions[0];
  const vtkTypeInt64 slice = row * this->Dimensions[1];
  Summary unused;
  this->ForEachBlock(first, last, unused, false,
    [=](zfp_stream* stream, const Block& block, Summary&)
    {
      float* const target = samples + this->SampleIndex(block);
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
void vtkZFPBlocks::Summarise(vtkTypeInt64 first, vtkTypeInt64 last, Summary& summary)
{
  this->ForEachBlock(first, last, summary, false,
    [](zfp_stream* stream, const Block& block, Summary& mine)
    {
      float samples[64];
      zfp_decode_block_float_3(stream, samples);
      for (int z = 0; z < block.Size[2]; ++z)
      {
        for (int y = 0; y < block.Size[1]; ++y)
        {
          for (int x = 0; x < block.Size[0]; ++x)
          {
            mine.Add(samples[16 * z + 4 * y + x]);
          }
        }
      }
    });
}
