// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   BlockGatherer
 * @brief   gathers blocks of one component of an array, in a stream's units (internal)
 *
 * The array's first tuple is the first sample of slab `firstSlab`.
 */
#ifndef BlockGatherer_h
#define BlockGatherer_h

#include "Codec/BlockStream.h"
#include "Codec/HiddenSamples.h"
#include "Codec/SampleSummary.h"
#include "Codec/SampleUnits.h"

#include "vtkDataArrayRange.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

/// Error of a block's visible samples, in their own units.
struct BlockError
{
  double Largest = 0.0;
  double Sum = 0.0;
  int Count = 0;
};

/// Gives a block's hidden samples values that cost zfp little.
void FillHidden(float samples[BlockSamples], vtkTypeUInt64 hidden, const int size[3]);

template <typename ArrayT>
class BlockGatherer
{
public:
  using Block = BlockStream::Block;

  BlockGatherer(const vtkTypeInt64 dims[3], vtkTypeInt64 firstSlab, ArrayT* array, int component,
    const SampleUnits& units, const HiddenSamples& hidden)
    : Values(vtk::DataArrayValueRange(array))
    , Stride(array->GetNumberOfComponents())
    , Row(dims[0] * this->Stride)
    , Slice(dims[1] * this->Row)
    , Origin(component - BlockSide * firstSlab * this->Slice)
    , Units(units)
    , IsIdentity(units.IsIdentity())
    , Hidden(hidden)
  {
  }

  /// Gathers a block, adds its visible samples to a summary, and returns the bits of those hidden,
  /// which get values that cost zfp little.
  vtkTypeUInt64 Gather(const Block& block, float samples[BlockSamples], SampleSummary& found) const
  {
    if (block.IsWhole() && this->IsIdentity && !this->Hidden.Flags)
    {
      const vtkTypeInt64 first = this->FirstValue(block);
      for (int i = 0; i < BlockSamples; ++i)
      {
        samples[i] = static_cast<float>(
          this->At(first, i % BlockSide, i / BlockSide % BlockSide, i / BlockSlice));
      }
      if (!this->Hidden.HideNonFinite || AreFinite(samples))
      {
        found.AddBlock(samples);
        return 0;
      }
    }
    return this->GatherVisible(block, samples, found);
  }

  /// Finds the error of what a gathered block was decoded to.
  BlockError FindError(const Block& block, vtkTypeUInt64 hidden, const float samples[BlockSamples],
    const float decoded[BlockSamples]) const
  {
    if (IsExact && this->IsIdentity && block.IsWhole() && hidden == 0)
    {
      return ErrorOfWhole(samples, decoded);
    }
    BlockError error;
    this->ForEachSample(block,
      [&](int i, vtkTypeInt64 index)
      {
        if (!(hidden >> i & 1))
        {
          const double value = static_cast<double>(this->Values[index]);
          const double off = std::abs(this->Units.Offset + this->Units.Scale * decoded[i] - value);
          error.Largest = std::max(error.Largest, off);
          error.Sum += off;
          ++error.Count;
        }
      });
    return error;
  }

private:
  using ValueT =
    typename std::decay<decltype(vtk::DataArrayValueRange(std::declval<ArrayT*>())[0])>::type;

  /// Whether float32 holds every value of the type.
  static constexpr bool IsExact = std::is_same<ValueT, float>::value || sizeof(ValueT) <= 2;

  // Products with 0 add up to 0 unless one of the samples is not finite.
  static bool AreFinite(const float samples[BlockSamples])
  {
    float sum[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    for (int i = 0; i < BlockSamples; i += 4)
    {
      for (int lane = 0; lane < 4; ++lane)
      {
        sum[lane] += 0.0f * samples[i + lane];
      }
    }
    return sum[0] + sum[1] + sum[2] + sum[3] == 0.0f;
  }

  // Four samples at a time, as this is done for every block.
  static BlockError ErrorOfWhole(const float samples[BlockSamples], const float decoded[])
  {
    float most[4] = { 0.0f, 0.0f, 0.0f, 0.0f }, sum[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    for (int i = 0; i < BlockSamples; i += 4)
    {
      for (int lane = 0; lane < 4; ++lane)
      {
        const float off = std::abs(decoded[i + lane] - samples[i + lane]);
        most[lane] = off > most[lane] ? off : most[lane];
        sum[lane] += off;
      }
    }
    return { *std::max_element(most, most + 4),
      static_cast<double>(sum[0]) + sum[1] + sum[2] + sum[3], BlockSamples };
  }

  vtkTypeUInt64 GatherVisible(
    const Block& block, float samples[BlockSamples], SampleSummary& found) const
  {
    vtkTypeUInt64 hidden = 0;
    this->ForEachSample(block,
      [&](int i, vtkTypeInt64 index)
      {
        samples[i] = this->Convert(this->Values[index]);
        if (this->Hidden.MayHide() && this->Hidden.IsHidden(index / this->Stride, samples[i]))
        {
          hidden |= vtkTypeUInt64(1) << i;
        }
        else
        {
          found.Add(samples[i]);
        }
      });
    FillHidden(samples, hidden, block.Size);
    return hidden;
  }

  // Calls visit(index in the block, index in the array) for the samples of a block.
  template <typename Visit>
  void ForEachSample(const Block& block, const Visit& visit) const
  {
    const vtkTypeInt64 first = this->FirstValue(block);
    for (int z = 0; z < block.Size[2]; ++z)
    {
      for (int y = 0; y < block.Size[1]; ++y)
      {
        for (int x = 0; x < block.Size[0]; ++x)
        {
          visit(BlockSlice * z + BlockSide * y + x, this->Index(first, x, y, z));
        }
      }
    }
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

  template <typename T>
  float Convert(T value) const
  {
    return this->IsIdentity
      ? static_cast<float>(value)
      : static_cast<float>((static_cast<double>(value) - this->Units.Offset) / this->Units.Scale);
  }

  decltype(vtk::DataArrayValueRange(std::declval<ArrayT*>())) Values;
  vtkTypeInt64 Stride, Row, Slice; // from a sample to its neighbours, in values
  vtkTypeInt64 Origin;             // index of the volume's first value in the array
  SampleUnits Units;
  bool IsIdentity;
  const HiddenSamples& Hidden;
};

#endif
