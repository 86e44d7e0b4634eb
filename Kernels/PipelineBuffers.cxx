// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PipelineBuffers.h"

namespace
{
template <int BytesPerPixel>
std::int64_t PerPixel(const PipelineExtent& e)
{
  return BytesPerPixel * e.Pixels;
}

template <int BytesPerSlot>
std::int64_t PerSlot(const PipelineExtent& e)
{
  return BytesPerSlot * e.Slots;
}

std::int64_t PayloadBytes(const PipelineExtent& e)
{
  return e.PayloadBytes;
}

// a coarse cell: two floats, and two bytes for each of its 64 blocks
std::int64_t CoarseRangeBytes(const PipelineExtent& e)
{
  return 8 * e.CoarseCells;
}

std::int64_t BlockRangeBytes(const PipelineExtent& e)
{
  return 2 * 64 * e.CoarseCells;
}

std::int64_t MapBytes(const PipelineExtent& e)
{
  return 20 * e.Entries();
}

std::int64_t VisibleBytes(const PipelineExtent& e)
{
  return 4 * e.Entries();
}

// every admitted block has a slot of its own; long runs are cut
std::int64_t WorkItemBytes(const PipelineExtent& e)
{
  return 12 * (e.Slots + e.Pixels / PipelineExtent::RaysPerWorkItem + 1);
}

std::int64_t ControlBytes(const PipelineExtent&)
{
  return sizeof(ControlBlock);
}

std::int64_t StatisticsBytes(const PipelineExtent&)
{
  return PassRecords * sizeof(PassRecord);
}
}

const std::array<BufferInfo, NumberOfBuffers>& PipelineBuffers()
{
  // clang-format off
  static const std::array<BufferInfo, NumberOfBuffers> buffers = { {
    { Buffer::Control,         "control",          "CONTROL",           Lifetime::Pipeline, ControlBytes,     "all stages",                       "all stages" },
    { Buffer::PassStatistics,  "pass_statistics",  "PASS_STATISTICS",   Lifetime::Pipeline, StatisticsBytes,  "BeginPass, BeginShading",          "the mapper" },
    { Buffer::Payload,         "compressed",       "PAYLOAD",           Lifetime::Volume,   PayloadBytes,     "the mapper",                       "BlockRanges, DecodeBlocks" },
    { Buffer::CoarseRanges,    "coarse_ranges",    "COARSE_RANGES",     Lifetime::Volume,   CoarseRangeBytes, "BlockRanges",                      "TraverseGrid" },
    { Buffer::BlockRanges,     "block_ranges",     "BLOCK_RANGES",      Lifetime::Volume,   BlockRangeBytes,  "BlockRanges",                      "TraverseGrid" },
    { Buffer::RayBlock,        "ray_block",        "RAY_BLOCK",         Lifetime::Image,    PerPixel<4>,      "InitialRays, TraverseGrid, NearestHit", "TraverseGrid, NearestHit, MarkShading, ShadeHits" },
    { Buffer::RayHit,          "ray_hit",          "RAY_HIT",           Lifetime::Image,    PerPixel<4>,      "InitialRays, IntersectBlocks, IntersectPairs", "TraverseGrid, IntersectBlocks, IntersectPairs, NearestHit, MarkShading, ShadeHits, Composite" },
    { Buffer::LiveRays,        "live_rays",        "LIVE_RAYS",         Lifetime::Image,    PerPixel<4>,      "InitialRays, NearestHit (as NextLiveRays)", "TraverseGrid, GroupRays, IntersectPairs, NearestHit" },
    { Buffer::NextLiveRays,    "next_live_rays",   "NEXT_LIVE_RAYS",    Lifetime::Image,    PerPixel<4>,      "InitialRays, NearestHit",          "the next pass (as LiveRays)" },
    { Buffer::PixelColor,      "pixel_color",      "PIXEL_COLOR",       Lifetime::Image,    PerPixel<4>,      "InitialRays, ShadeHits",           "MarkShading, ShadeHits, Composite" },
    { Buffer::PairBlock,       "pair_block",       "PAIR_BLOCK",        Lifetime::Image,    PerPixel<4>,      "TraverseGrid",                     "MarkBlocks, IntersectPairs, NearestHit" },
    { Buffer::PairEntry,       "pair_entry",       "PAIR_ENTRY",        Lifetime::Image,    PerPixel<4>,      "MarkBlocks, GroupRays, MarkShading", "GroupRays, IntersectPairs, NearestHit, ShadeHits" },
    { Buffer::GroupedRays,     "grouped_rays",     "GROUPED_RAYS",      Lifetime::Image,    PerPixel<4>,      "GroupRays",                        "IntersectBlocks" },
    { Buffer::CacheValues,     "cache_values",     "CACHE_VALUES",      Lifetime::Cache,    PerSlot<256>,     "DecodeBlocks",                     "IntersectBlocks, IntersectPairs, ShadeHits" },
    { Buffer::CacheMap,        "cache_map",        "CACHE_MAP",         Lifetime::Cache,    MapBytes,         "MarkBlocks, AdmitBlocks, GroupRays, MarkShading, CacheAges, CacheRebuild", "AdmitBlocks, GroupRays, IntersectBlocks, IntersectPairs, ShadeHits" },
    { Buffer::CacheSlotBlock,  "cache_slot_block", "CACHE_SLOT_BLOCK",  Lifetime::Cache,    PerSlot<4>,       "AdmitBlocks, CacheEvict, CacheRebuild", "DecodeBlocks, CacheAges, CacheEvict, CacheRebuild" },
    { Buffer::CacheSlotStamp,  "cache_slot_stamp", "CACHE_SLOT_STAMP",  Lifetime::Cache,    PerSlot<4>,       "AdmitBlocks",                      "CacheAges, CacheEvict" },
    { Buffer::CacheFreeSlots,  "cache_free_slots", "CACHE_FREE_SLOTS",  Lifetime::Cache,    PerSlot<4>,       "CacheRebuild",                     "AdmitBlocks" },
    { Buffer::CacheVisible,    "cache_visible",    "CACHE_VISIBLE",     Lifetime::Cache,    VisibleBytes,     "MarkBlocks, MarkShading",          "AdmitBlocks" },
    { Buffer::CacheDecodeList, "cache_decode_list","CACHE_DECODE_LIST", Lifetime::Cache,    PerSlot<4>,       "AdmitBlocks",                      "DecodeBlocks" },
    { Buffer::CacheWorkItems,  "cache_work_items", "CACHE_WORK_ITEMS",  Lifetime::Cache,    WorkItemBytes,    "AdmitBlocks",                      "IntersectBlocks" },
  } };
  // clang-format on
  return buffers;
}
