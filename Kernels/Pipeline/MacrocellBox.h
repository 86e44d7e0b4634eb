// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Cuts macrocells, in their order, into boxes whose decoded blocks fit the cache. The larger a box,
// the fewer blocks are decoded twice: to each belong the neighbours behind it.
#ifndef MacrocellBox_h
#define MacrocellBox_h

#include "GL/VolumeSlice.h"
#include "Store/CompressedStream.h"

#include <cstdint>

/// Macrocells that follow each other, and their blocks with the neighbours behind.
struct MacrocellBox
{
  VolumeSlice Macrocells;
  glsl::BlockBox Blocks;

  std::int64_t GetNumberOfBlocks() const;
};

/// The whole volume.
MacrocellBox WholeBox(const VolumeSize& size);

/// The largest box that begins with the first of these macrocells and has no more blocks than
/// `most`: a part of a row, else whole rows, else whole layers. One macrocell is always in it.
MacrocellBox FirstBox(const VolumeSize& size, const VolumeSlice& macrocells, std::int64_t most);

/// How many of these macrocells to take at a time, at most `most`: if possible they end with a row,
/// or even a layer, so that the next box can be large.
std::int64_t MacrocellsAtATime(
  const VolumeSize& size, const VolumeSlice& macrocells, std::int64_t most);

#endif
