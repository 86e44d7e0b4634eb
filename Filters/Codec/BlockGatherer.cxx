// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockGatherer.h"

#include <algorithm>

namespace
{
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
