// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Store/StreamStore.h"

#include "Store/StreamSegments.h"

namespace
{
BoundSegment Describe(
  GLuint buffer, const StreamSegment& segment, const LevelGrid& grid, int blockBits)
{
  BoundSegment bound = { buffer, {}, {} };
  bound.Place.FirstBlock = static_cast<std::uint32_t>(grid.FirstBlock + segment.FirstBlock);
  bound.Place.Blocks = segment.Blocks;
  bound.Place.FirstBit = segment.FirstBit;
  bound.Place.Words = static_cast<std::uint32_t>(segment.Bytes / 4);
  bound.Place.BlockBits = static_cast<std::uint32_t>(blockBits);
  bound.Macrocells.First = grid.FirstMacrocell + segment.FirstMacrocell;
  bound.Macrocells.End = bound.Macrocells.First + segment.Macrocells;
  return bound;
}
}

// The stages only read a stream, and it may be too large for a second copy: no staging.
Status StreamStore::Upload(
  Context& context, Buffer buffer, const CompressedStream& stream, const LevelGrid& grid)
{
  std::vector<StreamSegment> segments;
  const Status split = SplitStream(stream, grid.Size, context.GetLimits().LargestBuffer, segments);
  if (!split)
  {
    return context.Fail(split);
  }
  Stream& uploaded = this->Streams[buffer];
  for (const StreamSegment& segment : segments)
  {
    GLuint name = 0;
    const Status made =
      MakeStorageBuffer(context, name, segment.Bytes, "the compressed volume", LargestPlainBuffer);
    if (!made)
    {
      return made;
    }
    uploaded.Segments.push_back(Describe(name, segment, grid, stream.BlockBits));
    uploaded.Bytes += segment.Bytes;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(segment.Bytes),
      stream.Data.get() + segment.FirstByte);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  }
  return Status();
}

void StreamStore::Free()
{
  for (const auto& entry : this->Streams)
  {
    for (const BoundSegment& segment : entry.second.Segments)
    {
      glDeleteBuffers(1, &segment.Buffer);
    }
  }
  this->Streams.clear();
}

const std::vector<BoundSegment>& StreamStore::GetSegments(Stage stage) const
{
  for (const BufferUse& use : InfoOf(stage).Buffers)
  {
    const auto found = this->Streams.find(use.Id);
    if (found != this->Streams.end())
    {
      return found->second.Segments;
    }
  }
  static const std::vector<BoundSegment> none;
  return none;
}

std::int64_t StreamStore::GetBytes(Buffer buffer) const
{
  const auto found = this->Streams.find(buffer);
  return found == this->Streams.end() ? 0 : found->second.Bytes;
}
