// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/MemoryPlan.h"

#include "GL/HostTransfer.h"
#include "GL/SnapshotQueue.h"
#include "GL/UniformBuffers.h"

#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <sstream>

namespace
{
constexpr std::int64_t AutomaticCacheBytes = 1LL << 30; // where no budget is set
constexpr std::int64_t AutomaticDeviceShare = 4;        // likewise: a quarter of the GPU's memory

// The rays of the least window find room for all the blocks and map pages that they need at once.
constexpr std::int64_t MinimumSlots = 32 * glsl::LEAST_WINDOW;
constexpr std::int64_t MinimumMapPages = 8 * glsl::LEAST_WINDOW;
constexpr std::int64_t SlotsPerMapPage = 8;

constexpr std::int64_t LargestCopiedCache = 1 << 16; // slots: less costs little to copy

constexpr std::int64_t MostRoom = 2;         // for pixels, beside what the image needs
constexpr std::int64_t LargeShare = 4;       // an image that covers such a part of its viewport
constexpr double PauseMilliseconds = 2000.0; // no movement has one

std::string Mebibytes(std::int64_t bytes, int digits)
{
  std::ostringstream words;
  words << std::fixed << std::setprecision(digits) << static_cast<double>(bytes) / (1 << 20);
  return words.str();
}

// Where a level of detail goes over to the next, a ray needs blocks of both.
std::int64_t LevelsAtOnce(const SceneNeeds& scene)
{
  return scene.Levels ? 2 : 1;
}

std::int64_t LeastSlots(const SceneNeeds& scene)
{
  return std::min(LevelsAtOnce(scene) * MinimumSlots, scene.Blocks);
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

// Of a budget that others share. A part of an automatic one is what suffices, at least.
std::int64_t TakeShare(std::int64_t budget, const PipelineSettings& settings, std::int64_t least)
{
  if (settings.MemoryShare >= 1.0)
  {
    return budget;
  }
  const auto part = static_cast<std::int64_t>(settings.MemoryShare * static_cast<double>(budget));
  return settings.MemoryBudget == 0 ? std::max(part, least) : part;
}

// As many slots, up to `most`, as so many bytes have room for.
std::int64_t SlotsWithin(std::int64_t bytes, const SceneNeeds& scene, std::int64_t most)
{
  std::int64_t low = 0;
  std::int64_t high = most;
  while (low < high)
  {
    const std::int64_t middle = (low + high + 1) / 2;
    if (BytesBesideStream(WithCache(scene, middle)) <= bytes)
    {
      low = middle;
    }
    else
    {
      high = middle - 1;
    }
  }
  return low;
}

// As many slots as the volume has blocks and one buffer can hold.
std::int64_t SlotsOfOneBuffer(const DeviceLimits& limits, const SceneNeeds& scene)
{
  const std::int64_t most = std::min(scene.Blocks, limits.LargestBuffer / BytesPerSlot(scene));
  return scene.SlotCapacity > 0 ? std::min(most, scene.SlotCapacity) : most;
}

std::int64_t LimitSlots(const DeviceLimits& limits, std::int64_t budget, const SceneNeeds& scene)
{
  const std::int64_t slots = SlotsWithin(budget, scene, SlotsOfOneBuffer(limits, scene));
  return slots >= LeastSlots(scene) ? slots : 0;
}

// Bytes of the largest of the cache's buffers.
std::int64_t LargestCacheBuffer(const SceneNeeds& needs)
{
  std::int64_t largest = 0;
  for (const BufferInfo& info : PipelineBuffers())
  {
    largest = std::max(largest, info.Life == Lifetime::Cache ? info.Bytes(needs) : 0);
  }
  return largest;
}
}

MemoryPlan PlanMemory(
  const DeviceLimits& limits, const PipelineSettings& settings, const SceneNeeds& scene)
{
  MemoryPlan plan;
  const SceneNeeds whole = WithWholeVolume(scene);
  const std::int64_t wholeBytes = BytesBesideStream(whole);
  const std::int64_t leastCached = BytesBesideStream(WithCache(scene, LeastSlots(scene)));
  const bool mayBeWhole =
    settings.DecodeWholeVolume && BytesPerSlot(whole) * whole.Slots <= limits.LargestBuffer;
  plan.LeastBudget = mayBeWhole ? std::min(leastCached, wholeBytes) : leastCached;
  plan.Wanted = TakeShare(ChooseBudget(limits, settings, scene), settings, plan.LeastBudget);
  plan.Budget = std::max(plan.Wanted, plan.LeastBudget);
  plan.Cached = !(mayBeWhole && wholeBytes <= plan.Budget);
  plan.MaximumSlots = LimitSlots(limits, plan.Budget, scene);
  return plan;
}

Status CheckSizes(const DeviceLimits& limits, const SceneNeeds& scene)
{
  constexpr std::int64_t mostBlocks = glsl::CLAIMED; // this number and the next mean no block
  if (scene.Blocks > mostBlocks)
  {
    return Status::Error("the volume has ", scene.Blocks, " blocks of 4x4x4 samples, but only ",
      mostBlocks, " can be told apart: show a part of it, or fewer samples");
  }
  const BufferInfo& macrocells = PipelineBuffers()[static_cast<std::size_t>(Buffer::Macrocells)];
  const std::int64_t bytes = macrocells.Bytes(scene);
  if (bytes > limits.LargestBuffer)
  {
    const std::int64_t most = limits.LargestBuffer / (bytes / scene.Macrocells);
    return Status::Error("the volume has ", scene.Macrocells,
      " cells of 16x16x16 samples, but one GPU buffer can hold no more than ", most, " here (",
      limits.LargestBuffer, " bytes): show a part of it, or fewer samples");
  }
  const std::int64_t least = LeastSlots(scene) * BytesPerSlot(scene);
  if (least > limits.LargestBuffer)
  {
    return Status::Error("the smallest cache has ", least,
      " bytes, but one GPU buffer can hold no more than ", limits.LargestBuffer,
      " here: raise LargestBuffer, or use another GPU");
  }
  return Status();
}

std::string MemoryPlan::DescribeExcess() const
{
  if (this->Budget == this->Wanted)
  {
    return "";
  }
  int digits = 1; // so many that the two differ
  while (digits < 7 && Mebibytes(this->Wanted, digits) == Mebibytes(this->Budget, digits))
  {
    ++digits;
  }
  return "the memory budget of " + Mebibytes(this->Wanted, digits) +
    " MiB is too small: this volume at this image size takes " + Mebibytes(this->Budget, digits) +
    " MiB (" + std::to_string(this->Budget) +
    " bytes) beside the compressed stream, the least that works";
}

SceneNeeds WithCache(const SceneNeeds& scene, std::int64_t slots)
{
  SceneNeeds needs = scene;
  needs.Cached = true;
  needs.Slots = slots;
  needs.MapPages = std::min(
    scene.Macrocells, std::max(LevelsAtOnce(scene) * MinimumMapPages, slots / SlotsPerMapPage));
  return needs;
}

SceneNeeds WithWholeVolume(const SceneNeeds& scene)
{
  SceneNeeds needs = scene;
  needs.Cached = false;
  needs.Slots = scene.Blocks;
  needs.MapPages = 0;
  needs.SlotCapacity = 0;
  return needs;
}

// The parts of the buffer of samples begin where memory can be committed: the capacity is rounded.
SceneNeeds WithReservation(const DeviceLimits& limits, const SceneNeeds& scene)
{
  SceneNeeds needs = scene;
  needs.SlotCapacity = 0;
  const std::int64_t most = SlotsOfOneBuffer(limits, needs);
  if (!limits.SparseBuffers || most <= LargestCopiedCache)
  {
    return needs;
  }
  const std::int64_t multiple =
    std::max<std::int64_t>(limits.SparsePage / LeastBytesInPart(needs), 1);
  const std::int64_t up = (most + multiple - 1) / multiple * multiple;
  const bool fits = BytesPerSlot(needs) * up <= limits.LargestBuffer;
  needs.SlotCapacity = fits ? up : most / multiple * multiple;
  needs.MapPageCapacity = WithCache(needs, needs.SlotCapacity).MapPages;
  needs.CommitBytes = limits.SparsePage;
  return needs;
}

SceneNeeds WithPixels(const SceneNeeds& scene, std::int64_t pixels)
{
  SceneNeeds needs = scene;
  needs.Pixels = pixels;
  return needs;
}

std::int64_t RoomForImage(std::int64_t held, std::int64_t needed, std::int64_t most, double idle)
{
  std::int64_t room = held;
  if (needed > held)
  {
    room = LargeShare * needed > most ? most : std::max(needed, MostRoom * held);
  }
  else if (LargeShare * needed <= most && held > MostRoom * needed && idle >= PauseMilliseconds)
  {
    room = needed;
  }
  return std::min(room, most);
}

CacheGrowth PlanGrowth(const MemoryPlan& plan, const SceneNeeds& scene, std::int64_t wanted)
{
  const std::int64_t most = std::min(wanted, plan.MaximumSlots);
  if (scene.SlotCapacity > 0)
  {
    return { most, true };
  }
  const std::int64_t slots = SlotsWithin(plan.Budget - LargestCacheBuffer(scene), scene, most);
  const bool enough = slots == most || 2 * slots >= 3 * scene.Slots;
  return enough ? CacheGrowth{ slots, true } : CacheGrowth{ plan.MaximumSlots, false };
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
