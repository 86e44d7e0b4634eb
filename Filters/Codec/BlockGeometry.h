// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The shape of zfp's blocks (internal). A sample's index in its block is x + 4y + 16z.
#ifndef BlockGeometry_h
#define BlockGeometry_h

#include "vtkType.h"

constexpr int BlockSide = 4;
constexpr int BlockSlice = BlockSide * BlockSide;
constexpr int BlockSamples = BlockSide * BlockSlice;

/// Distances in a block between neighbours along each axis.
constexpr int BlockStrides[3] = { 1, BlockSide, BlockSlice };

/// Returns the number of blocks that hold so many samples along an axis.
template <typename T>
constexpr T BlocksAlong(T samples)
{
  return samples / BlockSide + (samples % BlockSide != 0);
}

/// Returns the place of a block among all blocks, of which there are `blocks` per axis.
inline vtkTypeInt64 BlockIndex(vtkTypeInt64 x, vtkTypeInt64 y, vtkTypeInt64 z, const int blocks[3])
{
  return x + blocks[0] * (y + blocks[1] * z);
}

#endif
