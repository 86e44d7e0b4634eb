// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Every GPU buffer of the pipeline: what it is for, how large it is and when it is needed. Which
// stages read and write it says StageTable.h; Buffers.glsl declares the same buffers for GLSL.
#ifndef BufferTable_h
#define BufferTable_h

#include "Shaders/Conditions.h"
#include "Shaders/SceneNeeds.h"

#include <array>
#include <cstdint>
#include <vector>

enum class Buffer
{
  Control,
  PassStatistics,
  Stream,
  ColorStream,
  Macrocells,
  BlockMarks,
  HiddenCells,
  HiddenColors,
  Hits,
  Normals,
  Layers,
  Rays,
  CacheValues,
  CellMarks,
  CacheMap,
  CacheFreeSlots,
  CacheRequests,
  CacheSeen,
  NumberOfBuffers
};
constexpr int NumberOfBuffers = static_cast<int>(Buffer::NumberOfBuffers);

/// When a buffer's size changes, and with it its contents are void. Those of the cache keep them
/// when they grow.
enum class Lifetime
{
  Pipeline,
  Volume,
  Image,
  Cache
};

/// A part of a buffer.
struct ByteRange
{
  std::int64_t Begin = 0;
  std::int64_t Bytes = 0;
};

/// How a stage, or the host, uses a buffer.
enum class Access
{
  None = 0,
  Read = 1,
  Write = 2,
  ReadWrite = 3
};
constexpr bool Reads(Access access)
{
  return (static_cast<int>(access) & static_cast<int>(Access::Read)) != 0;
}
constexpr bool Writes(Access access)
{
  return (static_cast<int>(access) & static_cast<int>(Access::Write)) != 0;
}

struct BufferInfo
{
  Buffer Id;
  const char* Name;  ///< in the statistics and the documentation
  const char* Macro; ///< BUFFER_<Macro>, WRITES_<Macro> and HAS_<Macro> in GLSL
  Lifetime Life;
  Condition Needed;
  const char* Size; ///< in words, what SizeInBytes computes: P pixels, B blocks, S cache slots
  std::int64_t (*SizeInBytes)(const SceneNeeds&);
  Access Host;
  const char* Purpose;

  bool IsNeeded(const SceneNeeds& needs) const { return this->Needed.Holds(needs); }
  /// What the GPU holds; 0 if the scene does not need the buffer.
  std::int64_t Bytes(const SceneNeeds& needs) const;
  /// Are addresses reserved for all that the buffer may ever hold, of which a part is committed?
  bool IsReserved(const SceneNeeds& needs) const
  {
    return this->Life == Lifetime::Cache && needs.SlotCapacity > 0;
  }
  /// Bytes that have an address.
  std::int64_t ReservedBytes(const SceneNeeds& needs) const;
  /// The parts that hold something: each grows at its end. In a reserved buffer they are whole
  /// multiples of what is committed at a time.
  std::vector<ByteRange> Parts(const SceneNeeds& needs) const;
};

/// The table itself, in the order of the enumeration. The stream's size is the stream's.
const std::array<BufferInfo, NumberOfBuffers>& PipelineBuffers();

/// Bytes of a cache slot: of its decoded samples, and what is hidden.
std::int64_t BytesPerSlot(const SceneNeeds& needs);
/// The least of these that a part of CacheValues has for a slot: see SlotLayout.glsl.
std::int64_t LeastBytesInPart(const SceneNeeds& needs);

/// Bytes of all buffers of a lifetime.
std::int64_t BytesOf(Lifetime lifetime, const SceneNeeds& needs);

#endif
