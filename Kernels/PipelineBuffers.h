// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Every GPU buffer of the pipeline: what it is for, how large it is, who writes it and who reads
// it. Buffers.glsl declares the same buffers for the stages.
#ifndef PipelineBuffers_h
#define PipelineBuffers_h

#include <array>
#include <cstdint>

enum class Buffer
{
  Control,
  PassStatistics,
  Payload,
  CoarseRanges,
  BlockRanges,
  RayBlock,
  RayHit,
  LiveRays,
  NextLiveRays,
  PixelColor,
  PairBlock,
  PairEntry,
  GroupedRays,
  CacheValues,
  CacheMap,
  CacheSlotBlock,
  CacheSlotStamp,
  CacheFreeSlots,
  CacheVisible,
  CacheDecodeList,
  CacheWorkItems,
  NumberOfBuffers
};
constexpr int NumberOfBuffers = static_cast<int>(Buffer::NumberOfBuffers);

/// What the buffers' sizes follow from.
struct PipelineExtent
{
  std::int64_t PayloadBytes = 0;
  std::int64_t CoarseCells = 0;
  std::int64_t Pixels = 0;
  std::int64_t Slots = 0; ///< blocks that the cache holds

  static constexpr std::int64_t RaysPerWorkItem = 256;
  static constexpr std::int64_t EntriesPerSlot = 2; ///< of the block map
  std::int64_t Entries() const { return EntriesPerSlot * this->Slots; }
};

/// When a buffer's size changes, and with it its contents are void.
enum class Lifetime
{
  Pipeline,
  Volume,
  Image,
  Cache
};

struct BufferInfo
{
  Buffer Id;
  const char* Name;  ///< in the statistics
  const char* Macro; ///< BINDING_<Macro> in Buffers.glsl
  Lifetime Life;
  std::int64_t (*Bytes)(const PipelineExtent&);
  const char* Producers;
  const char* Consumers;
};

/// The table itself, in the order of the enumeration.
const std::array<BufferInfo, NumberOfBuffers>& PipelineBuffers();

/// The host's view of `Control` and `PassRecord` in Buffers.glsl.
struct DispatchArguments
{
  std::uint32_t X, Y, Z, Pad;
};

struct ControlBlock
{
  std::uint32_t LiveRays, NextLiveRays, Speculation, PassSerial;
  std::uint32_t PassIndex, Pairs, VisibleBlocks, ActiveBlocks;
  std::uint32_t DecodedBlocks, WorkItems, ReservedSlots, DeferredBlocks;
  std::uint32_t FreeHead, FreeSlots, MapUsed, EvictSlots;
  std::uint32_t UnshadedHits, AdmittedBlocks, Evicted, Pad;
  DispatchArguments TraverseGroups, PairGroups, AdmitGroups, DecodeGroups, IntersectGroups,
    EvictGroups;
  std::uint32_t Ages[256];
};

struct PassRecord
{
  std::uint32_t ActiveRays, Speculation, Pairs, VisibleBlocks;
  std::uint32_t ActiveBlocks, DecodedBlocks, CachedBlocks, RemainingRays;
  std::uint32_t DeferredBlocks, Pad[3];
};
constexpr std::int64_t PassRecords = 64; ///< ring of the last passes' records

#endif
