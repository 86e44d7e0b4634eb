// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Store/StreamSegments.h"

#include "Shaders/Glsl.h"
#include "Status.h"

#include <algorithm>

namespace
{
// The shaders count a segment's bits up to 2^36.
constexpr std::int64_t LargestSegment = 1LL << 33;

std::int64_t DivideUp(std::int64_t a, std::int64_t b)
{
  return (a + b - 1) / b;
}

// The segment of the layers of macrocells [first, last).
StreamSegment MakeSegment(
  const CompressedStream& stream, const VolumeSize& size, std::int64_t first, std::int64_t last)
{
  const std::int64_t layerBlocks = size.Blocks[0] * size.Blocks[1];
  const std::int64_t layerMacrocells = size.Macrocells[0] * size.Macrocells[1];
  const std::int64_t begin = glsl::MACROCELL_SIDE * first * layerBlocks;
  const std::int64_t end =
    std::min(glsl::MACROCELL_SIDE * last * layerBlocks, size.GetNumberOfBlocks());
  const std::int64_t held = std::min(end + layerBlocks, size.GetNumberOfBlocks());
  const std::int64_t bits = stream.BlockBits;
  StreamSegment segment;
  segment.FirstByte = begin * bits / 32 * 4;
  segment.Bytes = std::min(DivideUp(held * bits, 32) * 4, stream.Size) - segment.FirstByte;
  segment.FirstBlock = static_cast<std::uint32_t>(begin);
  segment.Blocks = static_cast<std::uint32_t>(end - begin);
  segment.FirstBit = static_cast<std::uint32_t>(begin * bits % 32);
  segment.FirstMacrocell = static_cast<std::uint32_t>(first * layerMacrocells);
  segment.Macrocells = static_cast<std::uint32_t>((last - first) * layerMacrocells);
  return segment;
}
}

Status SplitStream(const CompressedStream& stream, const VolumeSize& size,
  std::int64_t largestBuffer, std::vector<StreamSegment>& segments)
{
  const std::int64_t largest = std::min(largestBuffer, LargestSegment);
  const std::int64_t layerBits = size.Blocks[0] * size.Blocks[1] * stream.BlockBits;
  // beside the macrocells' own layers: one layer of blocks, and a word before the first bit
  const std::int64_t layers = (8 * (largest - 8) / layerBits - 1) / glsl::MACROCELL_SIDE;
  if (layers < 1)
  {
    return Status::Error("five layers of the compressed volume's blocks have ",
      DivideUp((glsl::MACROCELL_SIDE + 1) * layerBits, 8),
      " bytes, more than one GPU buffer can hold (", largest, " bytes): lower the rate");
  }
  segments.clear();
  for (std::int64_t first = 0; first < size.Macrocells[2]; first += layers)
  {
    const std::int64_t last = std::min(first + layers, size.Macrocells[2]);
    segments.push_back(MakeSegment(stream, size, first, last));
  }
  return Status();
}
