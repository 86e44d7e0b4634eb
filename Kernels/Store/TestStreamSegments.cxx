// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Store/StreamSegments.h"

#include "Status.h"

#include <gtest/gtest.h>

namespace
{
// 5x5 blocks in a layer, 11 layers of blocks, 3 layers of macrocells.
VolumeSize Tall()
{
  const int samples[3] = { 17, 20, 43 };
  return VolumeSize(samples);
}

CompressedStream StreamOf(const VolumeSize& size, int blockBits)
{
  CompressedStream stream;
  stream.BlockBits = blockBits;
  stream.Size = (size.GetNumberOfBlocks() * blockBits + 63) / 64 * 8;
  return stream;
}

std::vector<StreamSegment> Split(const CompressedStream& stream, std::int64_t largestBuffer)
{
  std::vector<StreamSegment> segments;
  const Status status = SplitStream(stream, Tall(), largestBuffer, segments);
  EXPECT_TRUE(status) << status.GetMessage();
  return segments;
}

// The least buffer that holds so many layers of macrocells in one segment.
std::int64_t BufferFor(const VolumeSize& size, int blockBits, std::int64_t layers)
{
  const std::int64_t bits = (4 * layers + 1) * size.Blocks[0] * size.Blocks[1] * blockBits;
  return (bits + 7) / 8 + 8;
}
}

TEST(VolumeSize, RoundsUp)
{
  const VolumeSize size = Tall();
  EXPECT_EQ(size.Blocks, (std::array<std::int64_t, 3>{ 5, 5, 11 }));
  EXPECT_EQ(size.Macrocells, (std::array<std::int64_t, 3>{ 2, 2, 3 }));
  EXPECT_EQ(size.GetNumberOfBlocks(), 275);
  EXPECT_EQ(size.GetNumberOfMacrocells(), 12);
}

TEST(StreamSegments, OneHoldsTheWholeStream)
{
  const VolumeSize size = Tall();
  const CompressedStream stream = StreamOf(size, 100);
  const auto segments = Split(stream, 1 << 20);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].FirstByte, 0);
  EXPECT_EQ(segments[0].Bytes, (275 * 100 + 31) / 32 * 4);
  EXPECT_EQ(segments[0].Blocks, 275u);
  EXPECT_EQ(segments[0].Macrocells, 12u);
}

TEST(StreamSegments, AsFewAsTheBufferAllows)
{
  const VolumeSize size = Tall();
  const CompressedStream stream = StreamOf(size, 100);
  EXPECT_EQ(Split(stream, BufferFor(size, 100, 3)).size(), 1u);
  EXPECT_EQ(Split(stream, BufferFor(size, 100, 3) - 1).size(), 2u);
  EXPECT_EQ(Split(stream, BufferFor(size, 100, 2) - 1).size(), 3u);
}

TEST(StreamSegments, CoverBlocksAndMacrocellsOnce)
{
  const VolumeSize size = Tall();
  const CompressedStream stream = StreamOf(size, 19); // segments begin within a word
  const std::int64_t largest = BufferFor(size, 19, 1);
  const auto segments = Split(stream, largest);
  ASSERT_EQ(segments.size(), 3u);
  std::uint32_t blocks = 0, macrocells = 0;
  for (const StreamSegment& segment : segments)
  {
    EXPECT_EQ(segment.FirstBlock, blocks);
    EXPECT_EQ(segment.FirstMacrocell, macrocells);
    EXPECT_EQ(segment.FirstByte % 4, 0);
    EXPECT_EQ(8 * segment.FirstByte + segment.FirstBit, 19 * std::int64_t(blocks));
    EXPECT_LT(segment.FirstBit, 32u);
    EXPECT_LE(segment.Bytes, largest);
    EXPECT_LE(segment.FirstByte + segment.Bytes, stream.Size);
    // the segment's own blocks and a layer more, as far as there is one
    const std::int64_t held =
      std::min<std::int64_t>(blocks + segment.Blocks + 25, size.GetNumberOfBlocks());
    EXPECT_GE(8 * (segment.FirstByte + segment.Bytes), 19 * held);
    blocks += segment.Blocks;
    macrocells += segment.Macrocells;
  }
  EXPECT_EQ(blocks, 275u);
  EXPECT_EQ(macrocells, 12u);
}

TEST(StreamSegments, FailsWhereFiveLayersDoNotFit)
{
  const VolumeSize size = Tall();
  const CompressedStream stream = StreamOf(size, 100);
  EXPECT_EQ(Split(stream, BufferFor(size, 100, 1)).size(), 3u);
  std::vector<StreamSegment> segments;
  const Status status = SplitStream(stream, size, BufferFor(size, 100, 1) - 1, segments);
  EXPECT_FALSE(status);
  EXPECT_EQ(status.GetMessage(),
    "five layers of the compressed volume's blocks have 1563 bytes, more than one GPU buffer can "
    "hold (1570 bytes): lower the rate");
}
