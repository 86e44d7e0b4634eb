// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleEncoder.h"

#include "Codec/BlockLoop.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"

#include <algorithm>
#include <vector>

namespace
{
using Block = BlockStream::Block;

bool HasBit(vtkTypeUInt64 bits, int i)
{
  return (bits >> i & 1) != 0;
}

//------------------------------------------------------------------------------
// Finds the mean of the visible samples next to a sample of a block; false if there are none.
bool FindVisibleMean(
  const float samples[BlockSamples], vtkTypeUInt64 hidden, const int size[3], int i, float& mean)
{
  double sum = 0.0;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int stride = BlockStrides[axis];
    const int at = i / stride % BlockSide;
    for (const int next : { at > 0 ? i - stride : i, at + 1 < size[axis] ? i + stride : i })
    {
      if (!HasBit(hidden, next))
      {
        sum += samples[next];
        ++count;
      }
    }
  }
  mean = count > 0 ? static_cast<float>(sum / count) : 0.0f;
  return count > 0;
}

//------------------------------------------------------------------------------
// Gives a block's hidden samples the mean of their neighbours, from the visible ones inwards: the
// smoother a block is, the better zfp keeps what is visible.
void FillHidden(float samples[BlockSamples], vtkTypeUInt64 hidden, const int size[3])
{
  while (hidden != 0)
  {
    vtkTypeUInt64 left = hidden;
    for (int i = 0; i < BlockSamples; ++i)
    {
      float mean;
      if (HasBit(hidden, i) && FindVisibleMean(samples, hidden, size, i, mean))
      {
        samples[i] = mean;
        left &= ~(vtkTypeUInt64(1) << i);
      }
    }
    if (left == hidden) // all of them are
    {
      std::fill_n(samples, BlockSamples, 0.0f);
      return;
    }
    hidden = left;
  }
}

//------------------------------------------------------------------------------
// Encodes blocks of one component of an array, converted to float block by block.
template <typename ArrayT>
class ArrayEncoder
{
public:
  // `masks` has room for the hidden samples of every block from slab `first` on, or is empty if no
  // sample may be hidden.
  ArrayEncoder(const BlockStream& blocks, vtkTypeInt64 first, ArrayT* array, int component,
    const SampleUnits& units, const HiddenSamples& hidden, std::vector<vtkTypeUInt64>& masks)
    : Values(vtk::DataArrayValueRange(array))
    , Stride(array->GetNumberOfComponents())
    , Row(blocks.GetDimensions()[0] * this->Stride)
    , Slice(blocks.GetDimensions()[1] * this->Row)
    , Origin(component - BlockSide * first * this->Slice)
    , Blocks{ blocks.GetBlocks()[0], blocks.GetBlocks()[1] }
    , FirstSlab(first)
    , Units(units)
    , IsIdentity(units.IsIdentity())
    , Hidden(hidden)
    , Masks(masks)
  {
  }

  void operator()(zfp_stream* stream, const Block& block, SampleSummary& summary) const
  {
    float samples[BlockSamples];
    SampleSummary found;
    this->Masks.empty() ? this->Gather(block, samples, found)
                        : this->GatherVisible(block, samples, found);
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
    if (block.IsWhole())
    {
      zfp_encode_block_float_3(stream, samples);
    }
    else
    {
      zfp_encode_partial_block_strided_float_3(
        stream, samples, block.Size[0], block.Size[1], block.Size[2], 1, BlockSide, BlockSlice);
    }
  }

private:
  void Gather(const Block& block, float samples[BlockSamples], SampleSummary& found) const
  {
    const vtkTypeInt64 first = this->FirstValue(block);
    if (block.IsWhole() && this->IsIdentity)
    {
      for (int i = 0; i < BlockSamples; ++i)
      {
        samples[i] = static_cast<float>(
          this->At(first, i % BlockSide, i / BlockSide % BlockSide, i / BlockSlice));
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
          const float value = this->Convert(this->At(first, x, y, z));
          samples[BlockSlice * z + BlockSide * y + x] = value;
          found.Add(value);
        }
      }
    }
  }

  // Gathers a block whose samples may be hidden, and records in Masks which are.
  void GatherVisible(const Block& block, float samples[BlockSamples], SampleSummary& found) const
  {
    const vtkTypeInt64 first = this->FirstValue(block);
    vtkTypeUInt64 hidden = 0;
    for (int z = 0; z < block.Size[2]; ++z)
    {
      for (int y = 0; y < block.Size[1]; ++y)
      {
        for (int x = 0; x < block.Size[0]; ++x)
        {
          const int i = BlockSlice * z + BlockSide * y + x;
          samples[i] = this->Convert(this->At(first, x, y, z));
          if (this->Hidden.IsHidden(this->Index(first, x, y, z) / this->Stride, samples[i]))
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
    this->Masks[this->IndexInMasks(block)] = hidden;
    FillHidden(samples, hidden, block.Size);
  }

  vtkTypeInt64 IndexInMasks(const Block& block) const
  {
    const vtkTypeInt64* const position = block.Position;
    return position[0] +
      this->Blocks[0] * (position[1] + this->Blocks[1] * (position[2] - this->FirstSlab));
  }

  vtkTypeInt64 FirstValue(const Block& block) const
  {
    return block.Sample * this->Stride + this->Origin;
  }

  vtkTypeInt64 Index(vtkTypeInt64 first, int x, int y, int z) const
  {
    return first + x * this->Stride + y * this->Row + z * this->Slice;
  }

  auto At(vtkTypeInt64 first, int x, int y, int z) const
  {
    return this->Values[this->Index(first, x, y, z)];
  }

  template <typename ValueT>
  float Convert(ValueT value) const
  {
    return this->IsIdentity
      ? static_cast<float>(value)
      : static_cast<float>((static_cast<double>(value) - this->Units.Offset) / this->Units.Scale);
  }

  decltype(vtk::DataArrayValueRange(std::declval<ArrayT*>())) Values;
  vtkTypeInt64 Stride, Row, Slice; // from a sample to its neighbours, in values
  vtkTypeInt64 Origin;             // index of the volume's first value in the array
  vtkTypeInt64 Blocks[2];          // along x and y
  vtkTypeInt64 FirstSlab;
  SampleUnits Units;
  bool IsIdentity;
  const HiddenSamples& Hidden;
  std::vector<vtkTypeUInt64>& Masks;
};
}

//------------------------------------------------------------------------------
struct SampleEncoder::Worker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, SampleEncoder& self, BlockStream& blocks, SlabRange slabs,
    int component, const ProgressCallback& progress, bool& complete) const
  {
    const vtkTypeInt64 number = (slabs.Last - slabs.First) * blocks.GetBlocksPerSlab();
    std::vector<vtkTypeUInt64> masks(self.Hidden.MayHide() ? number : 0);
    const ArrayEncoder<ArrayT> encoder(
      blocks, slabs.First, array, component, self.Units, self.Hidden, masks);
    complete = ForEachBlock(blocks, slabs, StreamAccess::Write, self.Summary, progress, encoder);
    for (const vtkTypeUInt64 mask : masks)
    {
      self.Mask.Append(mask);
    }
    self.Mask.Append(0, masks.empty() ? number : 0);
  }
};

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
