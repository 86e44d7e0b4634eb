// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PipelineVolume_h
#define PipelineVolume_h

#include "Store/CompressedStream.h"
#include "Store/StoredRanges.h"

#include <cstdint>
#include <vector>

/// Samples on a grid, and optionally others on the same grid that give the colours.
struct PipelineVolume
{
  int Samples[3] = { 0, 0, 0 };
  CompressedStream Values;
  CompressedStream Colors;                 ///< without data: none
  std::vector<std::uint32_t> Hidden;       ///< cells: see HiddenCells in Buffers.glsl; empty: none
  std::vector<std::uint32_t> HiddenColors; ///< likewise, samples of the colours
  RangeReader Ranges;                      ///< of the values' blocks; empty: they are to be found
};

#endif
