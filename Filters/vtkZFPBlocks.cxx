// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPBlocks.h"

#include "vtkAlgorithm.h"
#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkUnsignedCharArray.h"

#include <omp.h>
#include <zfp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <vector>

namespace
{
// Blocks in a group that starts and ends on a 64-bit word whatever the bits per block.
constexpr vtkTypeInt64 GroupSize = 64;
// Groups that a thread takes at a time.
constexpr int GroupsPerTurn = 8;
// Fraction of the work after which progress is reported.
constexpr double ReportedStep = 0.01;

//------------------------------------------------------------------------------
// Gives a block's hidden samples, a bit each, the mean of what is beside them, from the visible
// ones inwards: the smoother a block is, the better zfp keeps what is visible.
void FillHidden(float samples[64], vtkTypeUInt64 hidden, const int size[3])
{
  const int strides[] = { 1, 4, 16 };
  while (hidden != 0)
  {
    vtkTypeUInt64 left = hidden;
    for (int i = 0; i < 64; ++i)
    {
      if (!(hidden >> i & 1))
      {
        continue;
      }
      double sum = 0.0;
      int count = 0;
      for (int axis = 0; axis < 3; ++axis)
      {
        const int at = i / strides[axis] % 4;
        for (const int side :
          { at > 0 ? i - strides[axis] : i, at + 1 < size[axis] ? i + strides[axis] : i })
        {
          if (!(hidden >> side & 1))
          {
            sum += samples[side];
            ++count;
          }
        }
      }
      if (count > 0)
      {
        samples[i] = static_cast<float>(sum / count);
        left &= ~(vtkTypeUInt64(1) << i);
      }
    }
    if (left == hidden) // all of them are
    {
      std::fill_n(samples, 64, 0.0f);
      return;
    }
    hidden = left;
  }
}
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
// As if all were added one by one, four at a time: as often as not this is all that is done to a
// sample beside zfp's own work.
void vtkZFPBlocks::Summary::AddBlock(const float samples[64])
{
  float low[4], high[4], notFinite[4]; // the latter 0, or NaN if any sample was not finite
  for (int lane = 0; lane < 4; ++lane)
  {
    low[lane] = high[lane] = samples[lane];
    notFinite[lane] = 0.0f * samples[lane];
  }
  for (int i = 4; i < 64; i += 4)
  {
    for (int lane = 0; lane < 4; ++lane)
    {
      const float value = samples[i + lane];
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
      notFinite[lane] += 0.0f * value;
    }
  }
  if (notFinite[0] + notFinite[1] + notFinite[2] + notFinite[3] == 0.0f)
  {
    this->Minimum = std::min(this->Minimum, *std::min_element(low, low + 4));
    this->Maximum = std::max(this->Maximum, *std::max_element(high, high + 4));
    return;
  }
  for (int i = 0; i < 64; ++i)
  {
    this->Add(samples[i]);
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
std::array<double, 2> vtkZFPBlocks::Summary::GetRange() const
{
  const bool any = this->Minimum <= this->Maximum;
  return { { any ? this->Minimum : 0.0, any ? this->Maximum : 0.0 } };
}

//------------------------------------------------------------------------------
float vtkZFPBlocks::Summary::Magnitude() const
{
  return std::max(std::abs(this->Minimum), std::abs(this->Maximum));
}

//------------------------------------------------------------------------------
std::string vtkZFPBlocks::Summary::GetObjection() const
{
  std::ostringstream objection;
  // zero in place of a tiny value may not show in float32 beside the largest value: 2^24 times
  // larger
  const float enough = TinyMagnitude() * 16777216.0f;
  if (!this->IsFinite())
  {
    objection << this->NaNs << " NaN and " << this->Infinities
              << " infinite values (as float32), which ZFP cannot compress: replace them first, or "
                 "have them hidden (MaskNonFinite).";
  }
  else if (this->TinyBlocks > 0 && this->Magnitude() < enough)
  {
    objection << "values too small for ZFP: the largest is " << this->Magnitude()
              << ", and all are below 3.16e-30 in " << this->TinyBlocks
              << " blocks of 4x4x4. Scale them up first.";
  }
  return objection.str();
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
vtkSmartPointer<vtkUnsignedCharArray> vtkZFPBlocks::Align(vtkUnsignedCharArray* stream)
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
vtkZFPBlocks::Report vtkZFPBlocks::ReportOf(vtkAlgorithm* algorithm)
{
  return [=](double fraction)
  {
    algorithm->UpdateProgress(fraction);
    return !algorithm->GetAbortExecute();
  };
}

//------------------------------------------------------------------------------
vtkZFPBlocks::Block vtkZFPBlocks::GetBlock(vtkTypeInt64 index) const
{
  Block block;
  block.Position[0] = index % this->Blocks[0];
  block.Position[1] = index / this->Blocks[0] % this->Blocks[1];
  block.Position[2] = index / this->Blocks[0] / this->Blocks[1];
  this->FindSamples(block);
  return block;
}

//------------------------------------------------------------------------------
// What GetBlock() gives for the next index, without its divisions.
void vtkZFPBlocks::GoToNext(Block& block) const
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
void vtkZFPBlocks::FindSamples(Block& block) const
{
  const vtkTypeInt64* const position = block.Position;
  block.Sample =
    4 * (position[0] + this->Dimensions[0] * (position[1] + this->Dimensions[1] * position[2]));
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 left = this->Dimensions[axis] - 4 * position[axis];
    block.Size[axis] = static_cast<int>(std::min<vtkTypeInt64>(4, left));
  }
}

//------------------------------------------------------------------------------
// Calls body(zfp stream positioned at the block, block, summary of the thread) for all blocks of
// the layers [first, last), in parallel over groups of blocks that share no word of the stream.
// Threads never wait for one another before the end: any may be held up by another program.
template <typename Body>
bool vtkZFPBlocks::ForEachBlock(vtkTypeInt64 first, vtkTypeInt64 last, bool write, Summary& summary,
  const Report& report, Body body)
{
  const vtkTypeInt64 perLayer = this->Blocks[0] * this->Blocks[1];
  const vtkTypeInt64 begin = first * perLayer;
  const vtkTypeInt64 end = last * perLayer;
  const vtkTypeInt64 firstGroup = begin / GroupSize;
  const vtkTypeInt64 lastGroup = (end + GroupSize - 1) / GroupSize;
  const Summary before = summary;
  std::atomic<vtkTypeInt64> done{ 0 };
  std::atomic<bool> stopped{ false };

#pragma omp parallel num_threads(this->Threads)
  {
    Codec codec(this->Words, this->BlockBits);
    Summary mine = before;
    double reported = 0.0;
#pragma omp for schedule(dynamic, GroupsPerTurn)
    for (vtkTypeInt64 group = firstGroup; group < lastGroup; ++group)
    {
      if (stopped)
      {
        continue;
      }
      // layers may begin and end inside a group: then its first word is completed by the seek
      const vtkTypeInt64 from = std::max(begin, group * GroupSize);
      const vtkTypeInt64 to = std::min(end, (group + 1) * GroupSize);
      const bitstream_offset offset = static_cast<bitstream_offset>(from) * this->BlockBits;
      write ? stream_wseek(codec.Bits, offset) : stream_rseek(codec.Bits, offset);
      Block block = this->GetBlock(from);
      for (vtkTypeInt64 index = from; index < to; ++index, this->GoToNext(block))
      {
        body(codec.Stream, block, mine);
      }
      if (write)
      {
        stream_flush(codec.Bits);
      }
      const double fraction = static_cast<double>(++done) / (lastGroup - firstGroup);
      if (omp_get_thread_num() == 0 && fraction - reported >= ReportedStep)
      {
        reported = fraction;
        stopped = !report(fraction);
      }
    }
    mine.NaNs -= before.NaNs;
    mine.Infinities -= before.Infinities;
    mine.TinyBlocks -= before.TinyBlocks;
#pragma omp critical(vtkZFPBlocksSummary)
    summary.Add(mine);
  }
  return !stopped && report(1.0);
}

//------------------------------------------------------------------------------
// Encodes blocks of one component of an array, converted to float block by block.
template <typename ArrayT>
struct vtkZFPBlocks::Encoder
{
  Encoder(const vtkZFPBlocks& blocks, ArrayT* array, int component, vtkTypeInt64 first,
    const Hidden& hidden, std::vector<vtkTypeUInt64>& masks)
    : Values(vtk::DataArrayValueRange(array))
    , Stride(array->GetNumberOfComponents())
    , Row(blocks.Dimensions[0] * this->Stride)
    , Slice(blocks.Dimensions[1] * this->Row)
    , Offset(component - 4 * first * this->Slice)
    , Blocks{ blocks.Blocks[0], blocks.Blocks[1] }
    , FirstLayer(first)
    , HiddenSamples(hidden)
    , Masks(masks)
  {
  }

  void operator()(zfp_stream* stream, const Block& block, Summary& summary) const
  {
    float samples[64];
    Summary found;
    this->Masks.empty() ? this->Gather(block, samples, found)
                        : this->GatherVisible(block, samples, found);
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
    const vtkTypeInt64 first = block.Sample * this->Stride + this->Offset;
    if (block.IsWhole())
    {
      for (int i = 0; i < 64; ++i)
      {
        samples[i] = this->Value(first, i % 4, i / 4 % 4, i / 16);
      }
      found.AddBlock(samples);
      return;
    }
    for (int z = 0; z < block.Size[2]; ++z)
    {
      for (int y = 0; y < block.Size[1]; ++y)
      {
        for (int x = 0; x < block.Size[0]; ++x)
        {
          samples[16 * z + 4 * y + x] = this->Value(first, x, y, z);
          found.Add(samples[16 * z + 4 * y + x]);
        }
      }
    }
  }

  // The same where some may be hidden, which are kept in Masks.
  void GatherVisible(const Block& block, float samples[64], Summary& found) const
  {
    const vtkTypeInt64 first = block.Sample * this->Stride + this->Offset;
    vtkTypeUInt64 hidden = 0;
    for (int z = 0; z < block.Size[2]; ++z)
    {
      for (int y = 0; y < block.Size[1]; ++y)
      {
        for (int x = 0; x < block.Size[0]; ++x)
        {
          const int i = 16 * z + 4 * y + x;
          samples[i] = this->Value(first, x, y, z);
          if (this->Hides(first, x, y, z, samples[i]))
          {
            hidden |= vtkTypeUInt64(1) << i;
          }
          else
          {
            found.Add(samples[i]);
          }
        }
      }
    }
    const vtkTypeInt64* const position = block.Position;
    this->Masks[position[0] +
      this->Blocks[0] * (position[1] + this->Blocks[1] * (position[2] - this->FirstLayer))] =
      hidden;
    FillHidden(samples, hidden, block.Size);
  }

  bool Hides(vtkTypeInt64 first, int x, int y, int z, float value) const
  {
    const Hidden& hidden = this->HiddenSamples;
    const vtkTypeInt64 tuple =
      (first + x * this->Stride + y * this->Row + z * this->Slice) / this->Stride;
    return (hidden.Flags && (hidden.Flags[tuple] & hidden.Hiding)) ||
      (hidden.NotFinite && !std::isfinite(value));
  }

  float Value(vtkTypeInt64 first, int x, int y, int z) const
  {
    return static_cast<float>(
      this->Values[first + x * this->Stride + y * this->Row + z * this->Slice]);
  }

  decltype(vtk::DataArrayValueRange(std::declval<ArrayT*>())) Values;
  vtkTypeInt64 Stride, Row, Slice; // from a sample to its neighbours, in values
  vtkTypeInt64 Offset;             // of the volume's first value in the array
  vtkTypeInt64 Blocks[2];          // on x and y
  vtkTypeInt64 FirstLayer;
  const Hidden& HiddenSamples;
  std::vector<vtkTypeUInt64>& Masks; // of all blocks from FirstLayer on; empty: nothing may hide
};

//------------------------------------------------------------------------------
struct vtkZFPBlocks::EncodeWorker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, vtkZFPBlocks& blocks, int component, vtkTypeInt64 first,
    vtkTypeInt64 last, Hidden& hidden, Summary& summary, const Report& report, bool& complete) const
  {
    const vtkTypeInt64 number = (last - first) * blocks.Blocks[0] * blocks.Blocks[1];
    std::vector<vtkTypeUInt64> masks(hidden.MayHide() ? number : 0);
    const Encoder<ArrayT> encoder(blocks, array, component, first, hidden, masks);
    complete = blocks.ForEachBlock(first, last, true, summary, report, encoder);
    for (const vtkTypeUInt64 mask : masks)
    {
      hidden.Mask.Append(mask);
    }
    hidden.Mask.Append(0, masks.empty() ? number : 0);
  }
};

//------------------------------------------------------------------------------
bool vtkZFPBlocks::Encode(vtkDataArray* array, int component, vtkTypeInt64 first, vtkTypeInt64 last,
  Hidden& hidden, Summary& summary, const Report& report)
{
  EncodeWorker worker;
  bool complete = false;
  if (!vtkArrayDispatch::Dispatch::Execute(
        array, worker, *this, component, first, last, hidden, summary, report, complete))
  {
    // array classes that VTK does not dispatch to (bits, implicit arrays): through doubles
    worker(array, *this, component, first, last, hidden, summary, report, complete);
  }
  return complete;
}

//------------------------------------------------------------------------------
bool vtkZFPBlocks::Decode(float* samples, const Report& report)
{
  const vtkTypeInt64 row = this->Dimensions[0];
  const vtkTypeInt64 slice = row * this->Dimensions[1];
  Summary unused;
  return this->ForEachBlock(0, this->Blocks[2], false, unused, report,
    [=](zfp_stream* stream, const Block& block, Summary&)
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
void vtkZFPBlocks::DecodeBox(const int first[3], const int last[3], float* samples) const
{
  Codec codec(this->Words, this->BlockBits);
  const vtkTypeInt64 row = 4 * static_cast<vtkTypeInt64>(last[0] - first[0]);
  const vtkTypeInt64 slice = 4 * row * (last[1] - first[1]);
  for (vtkTypeInt64 z = first[2]; z < last[2]; ++z)
  {
    for (vtkTypeInt64 y = first[1]; y < last[1]; ++y)
    {
      const vtkTypeInt64 index = first[0] + this->Blocks[0] * (y + this->Blocks[1] * z);
      stream_rseek(codec.Bits, static_cast<bitstream_offset>(index) * this->BlockBits);
      float* const target = samples + 4 * ((z - first[2]) * slice + (y - first[1]) * row);
      for (int x = 0; x < last[0] - first[0]; ++x)
      {
        zfp_decode_block_strided_float_3(codec.Stream, target + 4 * x, 1, row, slice);
      }
    }
  }
}

//------------------------------------------------------------------------------
bool vtkZFPBlocks::Summarise(Summary& summary, const Report& report)
{
  return this->ForEachBlock(0, this->Blocks[2], false, summary, report,
    [](zfp_stream* stream, const Block& block, Summary& mine)
    {
      float samples[64];
      zfp_decode_block_float_3(stream, samples);
      if (block.IsWhole())
      {
        mine.AddBlock(samples);
        return;
      }
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
