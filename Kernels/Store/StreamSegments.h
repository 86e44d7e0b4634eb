// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Splits a stream that is longer than one GPU buffer can be into segments.
#ifndef StreamSegments_h
#define StreamSegments_h

#include "Store/CompressedStream.h"

#include <cstdint>
#include <vector>

class Status;

/// A part of a stream in one GPU buffer: whole layers of macrocells, and one more layer of blocks,
/// because the last macrocells also look at their neighbours' samples.
struct StreamSegment
{
  std::int64_t FirstByte = 0; ///< in the stream, a multiple of 4
  std::int64_t Bytes = 0;
  std::uint32_t FirstBlock = 0; ///< of those that this segment decodes
  std::uint32_t Blocks = 0;
  std::uint32_t FirstBit = 0; ///< of the first block in the first word, 0 … 31
  std::uint32_t FirstMacrocell = 0;
  std::uint32_t Macrocells = 0;
};

/// Splits into as few segments as the largest buffer (bytes) allows. An error where five layers of
/// blocks, the least that a segment holds, do not fit.
Status SplitStream(const CompressedStream& stream, const VolumeSize& size,
  std::int64_t largestBuffer, std::vector<StreamSegment>& segments);

#endif
