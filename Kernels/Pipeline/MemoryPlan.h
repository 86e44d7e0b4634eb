// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Decides how the GPU's memory is used, from values alone: it needs no GPU.
#ifndef MemoryPlan_h
#define MemoryPlan_h

#include "GL/DeviceLimits.h"
#include "Pipeline/PipelineSettings.h"
#include "Shaders/BufferTable.h"

#include "Status.h"

#include <cstdint>
#include <string>

struct MemoryPlan
{
  std::int64_t Wanted = 0;      ///< bytes that are asked for, beside the compressed stream
  std::int64_t Budget = 0;      ///< bytes in force: the same, or the least that works
  std::int64_t LeastBudget = 0; ///< bytes that this scene needs at least
  bool Cached = true;           ///< false: the whole volume is decoded, once
  /// Blocks that a cache may hold; 0: one buffer has no room for the smallest one.
  std::int64_t MaximumSlots = 0;

  /// Says that more is taken than was asked for; empty if that is not so.
  std::string DescribeExcess() const;
};

/// Chooses the budget, at least what this scene needs, decides between a cache and the decoded
/// volume, and limits the cache. The scene's slots and map pages do not count. Its pixels are to be
/// all of the viewport, whatever part of it has rays: then nothing changes when a user comes
/// nearer.
MemoryPlan PlanMemory(
  const DeviceLimits& limits, const PipelineSettings& settings, const SceneNeeds& scene);

///@{ The scene with a cache of so many slots and the map pages that go with them, or with the whole
/// volume decoded.
SceneNeeds WithCache(const SceneNeeds& scene, std::int64_t slots);
SceneNeeds WithWholeVolume(const SceneNeeds& scene);
///@}

/// An error where the volume is larger than numbers of blocks or one buffer of the GPU can be, or
/// one buffer cannot hold the smallest cache: no budget helps.
Status CheckSizes(const DeviceLimits& limits, const SceneNeeds& scene);

/// The scene with addresses reserved for a cache of any size, where the GPU can do that and the
/// volume needs more than a small one.
SceneNeeds WithReservation(const DeviceLimits& limits, const SceneNeeds& scene);

/// The scene with room for so many pixels.
SceneNeeds WithPixels(const SceneNeeds& scene, std::int64_t pixels);

/// For how many pixels there is to be room in the next image's buffers, which have room for `held`.
/// The image has `needed`, and at most `most`. In a movement, where it differs from frame to frame,
/// it doubles at least, and does not shrink before a pause of so many milliseconds. An image that
/// covers more than a quarter of its viewport has room for all of it: new memory costs a GPU up to
/// a millisecond a MiB, which is much in a frame, and for a small image little.
std::int64_t RoomForImage(std::int64_t held, std::int64_t needed, std::int64_t most, double idle);

struct CacheGrowth
{
  std::int64_t Slots = 0;
  bool Keeps = true; ///< what the cache holds; false: it is made anew
};

/// How far the scene's cache can grow at once towards so many slots, at most the plan's, so that
/// the sum of all memory never exceeds the budget. A reserved cache just gets more memory. Any
/// other moves to larger buffers, one after the other: for a moment there is one of them twice. Up
/// to half of what the budget has room for, this fits. Beyond, such a cache is made anew, once, as
/// large as the plan allows.
CacheGrowth PlanGrowth(const MemoryPlan& plan, const SceneNeeds& scene, std::int64_t wanted);

/// Bytes of all GPU memory beside the compressed stream.
std::int64_t BytesBesideStream(const SceneNeeds& needs);

#endif
