// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Shaders/BufferTable.h"

namespace
{
std::int64_t ControlBytes(const PipelineExtent&)
{
  return sizeof(ControlBlock);
}

std::int64_t StatisticsBytes(const PipelineExtent&)
{
  return PassRecords * sizeof(PassRecord);
}

std::int64_t StreamBytes(const PipelineExtent&)
{
  return 0; // see Device::UploadStream
}

// two floats, two bytes for each of its 64 blocks; with a cache a map page and a bit for each block
std::int64_t MacrocellBytes(const PipelineExtent& e)
{
  return (8 + 2 * 64 + (e.Cached ? 4 + 64 / 8 : 0)) * e.Macrocells;
}

std::int64_t HiddenBytes(const PipelineExtent& e)
{
  return 4 * e.HiddenWords;
}

// of the hit the key and the depth; see Hits.glsl for the rest
std::int64_t HitBytes(const PipelineExtent& e)
{
  return 4 * (2 + e.SeveralIsovalues + e.Colored + e.Obstructed) * e.Pixels;
}

// the hits of a translucent image are lit at once
std::int64_t NormalBytes(const PipelineExtent& e)
{
  return e.Lit && !e.Translucent ? 4 * e.Pixels : 0;
}

std::int64_t LayerBytes(const PipelineExtent& e)
{
  return e.Translucent ? 8 * e.Pixels : 0;
}

std::int64_t RayBytes(const PipelineExtent& e)
{
  return e.IsSinglePass() ? 0 : 3 * 4 * e.Pixels;
}

std::int64_t ValueBytes(const PipelineExtent& e)
{
  return BytesPerSlot(e) * e.Slots;
}

std::int64_t MapBytes(const PipelineExtent& e)
{
  return e.Cached ? (16 + 4 * 64) * e.Pages : 0;
}

// a ring with room for what comes back before the rest has left
std::int64_t FreeSlotBytes(const PipelineExtent& e)
{
  return e.Cached ? 2 * 4 * e.Slots : 0;
}

std::int64_t RequestBytes(const PipelineExtent& e)
{
  return e.Cached ? 4 * e.Slots : 0;
}

std::int64_t SeenBytes(const PipelineExtent& e)
{
  return e.Detailed ? 2 * 4 * e.Slots : 0;
}
}

const std::array<BufferInfo, NumberOfBuffers>& PipelineBuffers()
{
  // clang-format off
  static const std::array<BufferInfo, NumberOfBuffers> buffers = { {
    { Buffer::Control,        "control",          "CONTROL",          Lifetime::Pipeline, ControlBytes,    "all stages",                            "all stages" },
    { Buffer::PassStatistics, "pass_statistics",  "PASS_STATISTICS",  Lifetime::Pipeline, StatisticsBytes, "PlanPass",                              "the mapper" },
    { Buffer::Stream,        "compressed",       "STREAM",          Lifetime::Volume,   StreamBytes,    "the mapper",                            "BlockRanges, DecodeBlocks" },
    { Buffer::ColorStream,   "compressed_colors", "STREAM",         Lifetime::Volume,   StreamBytes,    "the mapper",                            "DecodeColors" },
    { Buffer::Macrocells,     "macrocells",       "MACROCELLS",       Lifetime::Volume,   MacrocellBytes,  "BlockRanges, FinishHits, RequestBlocks, DecodeBlocks, CacheEvict, CacheReset", "CastRays, CastFewRays, FinishHits, RequestBlocks, DecodeBlocks" },
    { Buffer::HiddenCells,    "hidden_cells",     "HIDDEN_CELLS",     Lifetime::Volume,   HiddenBytes,     "the mapper",                            "BlockRanges, DecodeBlocks" },
    { Buffer::Hits,           "hits",             "HITS",             Lifetime::Image,    HitBytes,        "CastRays, CastFewRays, the mapper",     "all stages that cast rays, Composite, Select" },
    { Buffer::Normals,        "normals",          "NORMALS",          Lifetime::Image,    NormalBytes,     "FinishHits",                           "FinishHits, Composite" },
    { Buffer::Layers,         "layers",           "LAYERS",           Lifetime::Image,    LayerBytes,      "FinishHits",                           "FinishHits, Composite" },
    { Buffer::Rays,           "rays",             "RAYS",             Lifetime::Image,    RayBytes,        "CastRays, CastFewRays",                 "RequestBlocks, CastRays, CastFewRays" },
    { Buffer::CacheValues,    "cache_values",     "CACHE_VALUES",     Lifetime::Cache,    ValueBytes,      "DecodeBlocks",                          "CastRays, CastFewRays, FinishHits, BlockRanges" },
    { Buffer::CacheMap,       "cache_map",        "CACHE_MAP",        Lifetime::Cache,    MapBytes,        "CastRays, CastFewRays, FinishHits, RequestBlocks, DecodeBlocks, CacheEvict, CacheReset", "CastRays, CastFewRays, FinishHits, RequestBlocks, CacheAges, CacheEvict" },
    { Buffer::CacheFreeSlots, "cache_free_slots", "CACHE_FREE_SLOTS", Lifetime::Cache,    FreeSlotBytes,   "DecodeBlocks, CacheEvict, CacheReset",  "DecodeBlocks" },
    { Buffer::CacheRequests,  "cache_requests",   "CACHE_REQUESTS",   Lifetime::Cache,    RequestBytes,    "FinishHits, RequestBlocks",            "DecodeBlocks" },
    { Buffer::CacheSeen,      "cache_seen",       "CACHE_SEEN",       Lifetime::Cache,    SeenBytes,       "CastRays, CastFewRays",                 "CastRays, CastFewRays" },
  } };
  // clang-format on
  return buffers;
}

std::int64_t BytesPerSlot(const PipelineExtent& extent)
{
  return (extent.Colored ? 2 * 256 : 256) + (extent.HiddenWords > 0 ? 16 : 0);
}

std::int64_t BytesOf(Lifetime lifetime, const PipelineExtent& extent)
{
  std::int64_t bytes = 0;
  for (const BufferInfo& info : PipelineBuffers())
  {
    bytes += info.Life == lifetime ? info.Bytes(extent) : 0;
  }
  return bytes;
}
