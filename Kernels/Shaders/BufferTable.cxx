// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Shaders/BufferTable.h"

#include "Shaders/Glsl.h"
#include "Shaders/HitSections.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace
{
// A macrocell knows of the cache only where there is one.
constexpr std::int64_t CacheBytesOfMacrocell =
  offsetof(glsl::Macrocell, Ranges) - offsetof(glsl::Macrocell, Page);

std::int64_t BytesOfMacrocell(const SceneNeeds& needs)
{
  const std::int64_t bytes = sizeof(glsl::Macrocell);
  return needs.Cached ? bytes : bytes - CacheBytesOfMacrocell;
}

// Bytes of a block's samples.
constexpr std::int64_t BytesOfBlock = glsl::SAMPLES_PER_BLOCK * sizeof(float);
// Bytes that tell which cells of a block are hidden: a row of the buffer of decoded samples.
constexpr std::int64_t BytesOfHiddenRow = glsl::BLOCK_SIDE * sizeof(float);

// What the parts of the buffer of decoded samples have for a slot, in the order of SlotLayout.glsl.
std::vector<std::int64_t> BytesInParts(const SceneNeeds& needs)
{
  std::vector<std::int64_t> bytes(needs.Colored ? 2 : 1, BytesOfBlock);
  if (needs.HiddenCells)
  {
    bytes.push_back(BytesOfHiddenRow);
  }
  return bytes;
}

std::int64_t RoundUp(std::int64_t bytes, std::int64_t multiple)
{
  return (bytes + multiple - 1) / multiple * multiple;
}

SceneNeeds AtCapacity(const SceneNeeds& needs)
{
  SceneNeeds full = needs;
  full.Slots = needs.SlotCapacity;
  full.MapPages = needs.MapPageCapacity;
  return full;
}
}

const std::array<BufferInfo, NumberOfBuffers>& PipelineBuffers()
{
  using E = SceneNeeds;
  using namespace Conditions;
  static const std::array<BufferInfo, NumberOfBuffers> buffers = { {
    { Buffer::Control, "control", "CONTROL", Lifetime::Pipeline, Always, "about 1 KB",
      [](const E&) -> std::int64_t { return sizeof(glsl::Control); }, Access::ReadWrite,
      "what the pass does and has done: counts, dispatch sizes, the cache's rings" },
    { Buffer::PassStatistics, "pass_statistics", "PASS_STATISTICS", Lifetime::Pipeline, Always,
      "3 KB",
      [](const E&) -> std::int64_t { return glsl::PASS_RECORDS * sizeof(glsl::PassRecord); },
      Access::Read, "ring of the last passes' records" },
    { Buffer::Stream, "compressed", "STREAM", Lifetime::Volume, Always, "the ZFP stream",
      [](const E&) -> std::int64_t { return 0; }, // it has segments of its own: StreamStore
      Access::Write,
      "the compressed volume, in as many segments as it takes; without a cache, "
      "while it is decoded" },
    { Buffer::ColorStream, "compressed_colors", "STREAM", Lifetime::Volume, Colored,
      "the colours' ZFP stream", [](const E&) -> std::int64_t { return 0; }, Access::Write,
      "likewise, of the volume that gives the colours" },
    { Buffer::Macrocells, "macrocells", "MACROCELLS", Lifetime::Volume, Always,
      "2.1 *B*, with a cache 2.3 *B*",
      [](const E& e) { return BytesOfMacrocell(e) * e.Macrocells; }, Access::Write,
      "ranges of values of macrocells and their blocks; with a cache the map page, "
      "and which blocks are requested" },
    { Buffer::BlockMarks, "block_marks", "BLOCK_MARKS", Lifetime::Volume, Always,
      "0.13 *B*, with levels of detail 0.38 *B*",
      [](const E& e) { return (e.Levels ? 24 : 8) * e.Macrocells; }, Access::None,
      "which blocks' ranges hold one of the isovalues, a bit each; with levels of detail "
      "also those with what they blend with on the next level, and those of the volume's "
      "own samples there" },
    { Buffer::HiddenCells, "hidden_cells", "HIDDEN_CELLS", Lifetime::Volume, Hidden,
      "12 for each run of blocks that are alike", [](const E& e) { return 4 * e.HiddenWords; },
      Access::Write, "which cells have no surface" },
    { Buffer::HiddenColors, "hidden_colors", "HIDDEN_COLORS", Lifetime::Volume,
      Conditions::HiddenColors, "likewise", [](const E& e) { return 4 * e.HiddenColorWords; },
      Access::Write, "which samples of the volume that gives the colours have no value" },
    { Buffer::Hits, "hits", "HITS", Lifetime::Image, Always,
      "8 *P*, and 4 *P* each for several isovalues, colours, and obstacles of a translucent image",
      [](const E& e) { return 4 * HitSections(e).Count * e.Pixels; }, Access::ReadWrite,
      "what each pixel's ray has met, see Hits.glsl" },
    { Buffer::Normals, "normals", "NORMALS", Lifetime::Image, StoredNormals, "4 *P*",
      [](const E& e) { return 4 * e.Pixels; }, Access::Write, "the hits' normals" },
    { Buffer::Layers, "layers", "LAYERS", Lifetime::Image, Translucent, "8 *P*",
      [](const E& e) { return 8 * e.Pixels; }, Access::Write,
      "the sum of the hits that are blended so far" },
    { Buffer::Rays, "rays", "RAYS", Lifetime::Image, SeveralPasses, "12 *P*",
      [](const E& e) { return 3 * 4 * e.Pixels; }, Access::None,
      "the queues of rays and of pending hits, see RayQueues.glsl" },
    { Buffer::CacheValues, "cache_values", "CACHE_VALUES", Lifetime::Cache, Always,
      "256 *S*, with colours 512 *S*, and 16 *S* for hidden cells; without a cache *S* = *B*",
      [](const E& e) { return BytesPerSlot(e) * e.Slots; }, Access::Read,
      "decoded samples, and which of their cells are hidden" },
    { Buffer::CellMarks, "cache_cell_marks", "CELL_MARKS", Lifetime::Cache, Decoded, "8 *S*",
      [](const E& e) { return 8 * e.Slots; }, Access::None,
      "which cells of a marked block an isosurface crosses, a bit each" },
    { Buffer::CacheMap, "cache_map", "CACHE_MAP", Lifetime::Cache, Cached, "about 34 *S*",
      [](const E& e) -> std::int64_t { return sizeof(glsl::MapPage) * e.MapPages; }, Access::None,
      "map pages: the cache slots of a macrocell's blocks" },
    { Buffer::CacheFreeSlots, "cache_free_slots", "CACHE_FREE_SLOTS", Lifetime::Cache, Cached,
      "8 *S*", [](const E& e) { return 2 * 4 * e.Slots; }, Access::None,
      "ring of free slots, with room for those that come back before the rest has left" },
    { Buffer::CacheRequests, "cache_requests", "CACHE_REQUESTS", Lifetime::Cache, Cached, "4 *S*",
      [](const E& e) { return 4 * e.Slots; }, Access::None, "blocks that this pass asks for" },
    { Buffer::CacheSeen, "cache_seen", "CACHE_SEEN", Lifetime::Cache, Detailed, "8 *S*",
      [](const E& e) { return 2 * 4 * e.Slots; }, Access::None,
      "the last passes that intersected and that needed a slot's block" },
  } };
  return buffers;
}

std::int64_t BytesPerSlot(const SceneNeeds& needs)
{
  const std::vector<std::int64_t> parts = BytesInParts(needs);
  return std::accumulate(parts.begin(), parts.end(), std::int64_t(0));
}

std::int64_t LeastBytesInPart(const SceneNeeds& needs)
{
  const std::vector<std::int64_t> parts = BytesInParts(needs);
  return *std::min_element(parts.begin(), parts.end());
}

std::int64_t BufferInfo::Bytes(const SceneNeeds& needs) const
{
  std::int64_t bytes = 0;
  for (const ByteRange& part : this->Parts(needs))
  {
    bytes += part.Bytes;
  }
  return bytes;
}

std::int64_t BufferInfo::ReservedBytes(const SceneNeeds& needs) const
{
  return RoundUp(this->SizeInBytes(AtCapacity(needs)), needs.CommitBytes);
}

std::vector<ByteRange> BufferInfo::Parts(const SceneNeeds& needs) const
{
  if (!this->IsNeeded(needs))
  {
    return {};
  }
  const std::int64_t multiple = this->IsReserved(needs) ? needs.CommitBytes : 1;
  if (this->Id != Buffer::CacheValues)
  {
    return { { 0, RoundUp(this->SizeInBytes(needs), multiple) } };
  }
  const std::int64_t capacity = this->IsReserved(needs) ? needs.SlotCapacity : needs.Slots;
  std::vector<ByteRange> parts;
  std::int64_t begin = 0;
  for (const std::int64_t bytes : BytesInParts(needs))
  {
    parts.push_back({ begin, RoundUp(bytes * needs.Slots, multiple) });
    begin += bytes * capacity;
  }
  return parts;
}

std::int64_t BytesOf(Lifetime lifetime, const SceneNeeds& needs)
{
  std::int64_t bytes = 0;
  for (const BufferInfo& info : PipelineBuffers())
  {
    bytes += info.Life == lifetime ? info.Bytes(needs) : 0;
  }
  return bytes;
}
