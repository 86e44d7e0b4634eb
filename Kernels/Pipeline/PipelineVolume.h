// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PipelineVolume_h
#define PipelineVolume_h

#include "Store/CompressedStream.h"
#include "Store/StoredRanges.h"

#include <cstdint>
#include <vector>

/// Samples on a grid, and optionally others on the same grid that give the colours.
struct PipelineLevel
{
  int Samples[3] = { 0, 0, 0 };
  int Halvings[3] = { 0, 0, 0 }; ///< of each axis: every second sample, of these every second, ...
  CompressedStream Values;
  CompressedStream Colors; ///< without data: none
  RangeReader Ranges;      ///< of the values' blocks; empty: they are to be found
};

/// A volume, which is level 0, and its coarser levels of detail. Blocks are numbered through all.
struct PipelineVolume : PipelineLevel
{
  std::vector<PipelineLevel> Coarser;      ///< each with ranges
  std::vector<std::uint32_t> Hidden;       ///< cells: see HiddenCells in Buffers.glsl; empty: none
  std::vector<std::uint32_t> HiddenColors; ///< likewise, samples of the colours
};

#endif
