// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Every GPU buffer of the pipeline: what it is for, how large it is, who writes it and who reads
// it. Buffers.glsl declares the same buffers for the stages.
#ifndef BufferTable_h
#define BufferTable_h

#include <array>
#include <cstdint>

enum class Buffer
{
  Control,
  PassStatistics,
  Stream,
  ColorStream,
  Macrocells,
  HiddenCells,
  Hits,
  Normals,
  Layers,
  Rays,
  CacheValues,
  CacheMap,
  CacheFreeSlots,
  CacheRequests,
  CacheSeen,
  NumberOfBuffers
};
constexpr int NumberOfBuffers = static_cast<int>(Buffer::NumberOfBuffers);

/// What the buffers' sizes follow from, and what of it the scene at hand needs.
struct PipelineExtent
{
  std::int64_t Macrocells = 0;
  std::int64_t Pixels = 0;
  std::int64_t Slots = 0;       ///< blocks that the cache holds, or all blocks of the volume
  std::int64_t Pages = 0;       ///< of the block map
  std::int64_t HiddenWords = 0; ///< that tell which cells are hidden; 0: none is

  bool Cached = true;    ///< false: the whole volume is decoded, once
  bool Lit = false;      ///< hits need normals
  bool Detailed = false; ///< distinct blocks are counted
  bool SeveralIsovalues = false;
  bool Translucent = false; ///< rays go on behind a hit
  bool Obstructed = false;  ///< by opaque geometry, where translucent rays end
  bool Clipped = false;     ///< by planes
  bool Cropped = false;     ///< to regions
  bool Colored = false;     ///< another volume gives the colours

  /// The features above, a bit each.
  std::uint32_t GetFeatures() const
  {
    return this->Cached | this->Lit << 1 | this->Detailed << 2 | this->SeveralIsovalues << 3 |
      this->Translucent << 4 | this->Obstructed << 5 | this->Clipped << 6 | this->Cropped << 7 |
      this->Colored << 8 | (this->HiddenWords > 0) << 9;
  }
  /// Do rays begin and end in one pass?
  bool IsSinglePass() const { return !this->Cached && !this->Translucent; }
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
  const char* Macro; ///< BINDING_<Macro> and HAS_<Macro> in Buffers.glsl
  Lifetime Life;
  std::int64_t (*Bytes)(const PipelineExtent&); ///< 0 where the scene does not need it
  const char* Producers;
  const char* Consumers;
};

/// The table itself, in the order of the enumeration. The stream's size is the stream's.
const std::array<BufferInfo, NumberOfBuffers>& PipelineBuffers();

/// Bytes of a cache slot: of its decoded samples, and what is hidden.
std::int64_t BytesPerSlot(const PipelineExtent& extent);

/// Bytes of all buffers of a lifetime.
std::int64_t BytesOf(Lifetime lifetime, const PipelineExtent& extent);

/// The host's view of `Control` and `PassRecord` in Buffers.glsl.
struct DispatchArguments
{
  std::uint32_t X, Y, Z, Pad;
};

struct ControlBlock
{
  std::uint32_t Rays, Carried, NextCarried, List;
  std::uint32_t Fresh, Frontier, Window, FirstLive;
  std::uint32_t Unlit, NextUnlit, PassSerial, ImageSerial;
  std::uint32_t PassIndex, NewImage, ActiveRays, Pairs;
  std::uint32_t Requests, Refused, VisibleBlocks, ActiveBlocks;
  std::uint32_t TouchedSlots, FreeSlotsBegin, FreeSlots, ReturnedSlots;
  std::uint32_t FreePagesBegin, FreePages, TakenPages, EvictWanted;
  std::uint32_t EvictByPages, Evicted, RefusedBefore, Again;
  std::uint32_t GoingOn, Pad[3];
  DispatchArguments CastGroups, FewGroups, NormalGroups, RequestGroups, DecodeGroups, EvictGroups;
  std::uint32_t Ages[256];
};

struct PassRecord
{
  std::uint32_t ActiveRays, Speculation, Pairs, VisibleBlocks;
  std::uint32_t ActiveBlocks, DecodedBlocks, CachedBlocks, RemainingRays;
  std::uint32_t RefusedBlocks, TouchedSlots, Pad[2];
};
constexpr std::int64_t PassRecords = 64; ///< ring of the last passes' records

#endif
