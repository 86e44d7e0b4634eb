// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/MemoryPlan.h"

#include "GL/HostTransfer.h"
#include "GL/SnapshotQueue.h"
#include "GL/UniformBuffers.h"

#include <algorithm>

namespace
{
constexpr std::int64_t AutomaticCacheBytes = 1LL << 30; // where no budget is set
constexpr std::int64_t AutomaticDeviceShare = 4;        // likewise: a quarter of the GPU's memory

// The rays of the least window find room for all the blocks and map pages that they need at once.
constexpr std::int64_t MinimumSlots = 32 * glsl::LEAST_WINDOW;
constexpr std::int64_t MinimumMapPages = 8 * glsl::LEAST_WINDOW;
constexpr std::int64_t SlotsPerMapPage = 8;

std::int64_t LeastSlots(const SceneNeeds& scene)
{
  return std::min(MinimumSlots, scene.Blocks);
}

std::int64_t ChooseBudget(
  const DeviceLimits& limits, const PipelineSettings& settings, const SceneNeeds& scene)
{
  if (settings.MemoryBudget > 0)
  {
    return settings.MemoryBudget;
  }
  const std::int64_t most = BytesBesideStream(WithCache(scene, 0)) + AutomaticCacheBytes;
  return limits.DeviceMemory > 0 ? std::min(most, limits.DeviceMemory / AutomaticDeviceShare)
                                 : most;
}

// As many slots as the volume has blocks, one buffer can hold and the budget has room for.
std::int64_t LimitSlots(const DeviceLimits& limits, std::int64_t budget, const SceneNeeds& scene)
{
  std::int64_t low = 0;
  std::int64_t high = std::min(scene.Blocks, limits.LargestBuffer / BytesPerSlot(scene));
  while (low < high)
  {
    const std::int64_t middle = (low + high + 1) / 2;
    if (BytesBesideStream(WithCache(scene, middle)) <= budget)
    {
      low = middle;
    }
    else
    {
      high = middle - 1;
    }
  }
  return low >= LeastSlots(scene) ? low : 0;
}
}

MemoryPlan PlanMemory(
  const DeviceLimits& limits, const PipelineSettings& settings, const SceneNeeds& scene)
{
  MemoryPlan plan;
  plan.Budget = ChooseBudget(limits, settings, scene);
  const SceneNeeds whole = WithWholeVolume(scene);
  const std::int64_t wholeBytes = BytesBesideStream(whole);
  const std::int64_t leastCached = BytesBesideStream(WithCache(scene, LeastSlots(scene)));
  const bool wholeFits =
    wholeBytes <= plan.Budget && BytesPerSlot(whole) * whole.Slots <= limits.LargestBuffer;
  plan.Cached = !(settings.DecodeWholeVolume && wholeFits);
  plan.LeastBudget = settings.DecodeWholeVolume ? std::min(leastCached, wholeBytes) : leastCached;
  plan.MaximumSlots = LimitSlots(limits, plan.Budget, scene);
  return plan;
}

SceneNeeds WithCache(const SceneNeeds& scene, std::int64_t slots)
{
  SceneNeeds needs = scene;
  needs.Cached = true;
  needs.Slots = slots;
  needs.MapPages = std::min(scene.Macrocells, std::max(MinimumMapPages, slots / SlotsPerMapPage));
  return needs;
}

SceneNeeds WithWholeVolume(const SceneNeeds& scene)
{
  SceneNeeds needs = scene;
  needs.Cached = false;
  needs.Slots = scene.Blocks;
  needs.MapPages = 0;
  return needs;
}

std::int64_t BytesBesideStream(const SceneNeeds& needs)
{
  std::int64_t bytes = UniformBuffers::GetBlockBytes() +
    (needs.Colored ? static_cast<std::int64_t>(sizeof(glsl::Palette)) : 0) +
    HostTransfer::MaximumStagingBytes + SnapshotQueue::MaximumBytes;
  for (Lifetime lifetime :
    { Lifetime::Pipeline, Lifetime::Volume, Lifetime::Image, Lifetime::Cache })
  {
    bytes += BytesOf(lifetime, needs);
  }
  return bytes;
}
