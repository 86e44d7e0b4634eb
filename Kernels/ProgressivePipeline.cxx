// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressivePipeline.h"

#include <algorithm>
#include <cstddef>

namespace
{
constexpr std::int64_t MinimumSlots = 128; // a quarter of it admits any block's neighbourhood
constexpr std::int64_t AutomaticCacheBytes = 1LL << 30; // upper bound where the user sets none
constexpr int FewestGroupedRays = 8; // below, a GPU's work group has too little to do
constexpr int PassesPerBatch = 4;    // submitted before the CPU asks how many rays are left
constexpr int PatienceWithNone = 16; // passes or shading rounds that get nowhere before we give up

std::int64_t DivideUp(std::int64_t a, std::int64_t b)
{
  return (a + b - 1) / b;
}
}

bool ProgressivePipeline::Initialize()
{
  this->Gpu.ClearError();
  if (this->Gpu.IsInitialized())
  {
    return true;
  }
  if (!this->Gpu.Initialize() || !this->Gpu.Allocate(Lifetime::Pipeline, this->Extent))
  {
    return false;
  }
  ControlBlock control = {};
  control.PassSerial = 1;
  for (DispatchArguments* groups :
    { &control.TraverseGroups, &control.PairGroups, &control.AdmitGroups, &control.DecodeGroups,
      &control.IntersectGroups, &control.EvictGroups })
  {
    *groups = { 0, 1, 1, 0 };
  }
  this->Gpu.Write(Buffer::Control, 0, &control, sizeof(control));
  return true;
}

void ProgressivePipeline::Release()
{
  glDeleteQueries(static_cast<GLsizei>(this->TimeQueries.size()), this->TimeQueries.data());
  this->TimeQueries.clear();
  this->Gpu.Release();
  this->Extent = PipelineExtent();
  this->Started = false;
}

ControlBlock ProgressivePipeline::ReadControl()
{
  ControlBlock control;
  this->Gpu.Read(Buffer::Control, &control, sizeof(control));
  return control;
}

void ProgressivePipeline::WriteControl(std::size_t offset, std::uint32_t value)
{
  this->Gpu.Write(Buffer::Control, offset, &value, sizeof(value));
}

//------------------------------------------------------------------------------
// The volume and its cache
//------------------------------------------------------------------------------
bool ProgressivePipeline::SetVolume(const PipelineVolume& volume)
{
  if (volume.StreamBytes > PipelineResources::LargestBuffer)
  {
    return this->Gpu.Fail("the compressed volume has " + std::to_string(volume.StreamBytes) +
      " bytes, more than one GPU buffer can bind (" +
      std::to_string(PipelineResources::LargestBuffer) + "): lower the rate");
  }
  this->Started = false;
  this->Gpu.ForgetStages();
  std::int64_t blocks = 1, coarseCells = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Scene.Samples[axis] = volume.Samples[axis];
    this->Scene.Blocks[axis] = static_cast<std::int32_t>(DivideUp(volume.Samples[axis], 4));
    this->Scene.CoarseCells[axis] = static_cast<std::int32_t>(DivideUp(volume.Samples[axis], 16));
    blocks *= this->Scene.Blocks[axis];
    coarseCells *= this->Scene.CoarseCells[axis];
  }
  this->Scene.Blocks[3] = static_cast<std::int32_t>(blocks);
  this->Scene.CoarseCells[3] = static_cast<std::int32_t>(coarseCells);
  this->Scene.Payload[0] = static_cast<std::uint32_t>(volume.BlockBits);
  this->Scene.Payload[1] = static_cast<std::uint32_t>(volume.StreamBytes / 4);
  this->Scene.Payload[2] = static_cast<std::uint32_t>(PipelineExtent::RaysPerWorkItem);
  this->Extent.PayloadBytes = volume.StreamBytes;
  this->Extent.CoarseCells = coarseCells;
  this->Extent.Slots = 0; // the next Start() makes a cache for this volume
  if (!this->Gpu.Allocate(Lifetime::Volume, this->Extent))
  {
    return false;
  }
  this->Gpu.Upload(Buffer::Payload, volume.Stream, volume.StreamBytes);
  this->Gpu.UploadScene(this->Scene);
  this->Gpu.Dispatch(Stage::BlockRanges, coarseCells);
  return this->GetError().empty();
}

void ProgressivePipeline::SetLimits(std::int64_t cacheBytes, int speculation, int grouping)
{
  if (cacheBytes != this->CacheLimit)
  {
    this->Extent.Slots = 0;
  }
  this->CacheLimit = cacheBytes;
  this->SpeculationLimit = speculation;
  // a software renderer has no lanes to keep busy
  this->GroupingThreshold = grouping >= 0 ? grouping
    : this->Gpu.IsSoftware()              ? 0
                                          : FewestGroupedRays;
}

// As many slots as the limit, one buffer's size and the volume's number of blocks let make sense.
std::int64_t ProgressivePipeline::MaximumSlots() const
{
  PipelineExtent one;
  one.Slots = 1;
  std::int64_t bytesPerSlot = 0;
  for (const BufferInfo& info : PipelineBuffers())
  {
    bytesPerSlot += info.Life == Lifetime::Cache ? info.Bytes(one) : 0;
  }
  const std::int64_t limit = this->CacheLimit > 0 ? this->CacheLimit : AutomaticCacheBytes;
  const std::int64_t most = std::min(limit / bytesPerSlot, PipelineResources::LargestBuffer / 256);
  return std::max(MinimumSlots, std::min<std::int64_t>(most, this->Scene.Blocks[3]));
}

// A cache of another size that keeps the blocks it holds; with none before, an empty one.
bool ProgressivePipeline::ResizeCache(std::int64_t slots)
{
  const ControlBlock control = this->ReadControl();
  const std::int64_t kept = this->Extent.Slots;
  const std::array<Buffer, 3> contents = { Buffer::CacheValues, Buffer::CacheSlotBlock,
    Buffer::CacheSlotStamp };
  std::array<GLuint, 3> old;
  std::transform(contents.begin(), contents.end(), old.begin(),
    [this](Buffer b) { return this->Gpu.Detach(b); });
  this->Extent.Slots = slots;
  const bool allocated = this->Gpu.Allocate(Lifetime::Cache, this->Extent);
  if (allocated)
  {
    this->Gpu.Fill(Buffer::CacheMap, 0xFFFFFFFFu);
    this->Gpu.Fill(Buffer::CacheSlotBlock, 0xFFFFFFFFu);
  }
  for (std::size_t i = 0; i < old.size(); ++i)
  {
    const std::int64_t bytes = allocated ? kept * (this->Gpu.GetBytes(contents[i]) / slots) : 0;
    this->Gpu.CopyAndDelete(old[i], contents[i], bytes);
  }
  if (!allocated)
  {
    this->Extent.Slots = 0;
    return false;
  }
  this->Scene.Cache[0] = static_cast<std::uint32_t>(slots);
  this->Scene.Cache[1] = static_cast<std::uint32_t>(this->Extent.Entries());
  this->Gpu.UploadScene(this->Scene);
  // BeginPass takes the slots of the last pass off the ring: here they are off it already
  const std::uint32_t taken = kept ? control.DecodedBlocks : 0;
  this->WriteControl(offsetof(ControlBlock, DecodedBlocks), taken);
  this->WriteControl(offsetof(ControlBlock, FreeHead), 0);
  this->WriteControl(offsetof(ControlBlock, FreeSlots), taken);
  this->WriteControl(offsetof(ControlBlock, MapUsed), 0);
  this->Gpu.Dispatch(Stage::CacheAges, DivideUp(this->Extent.Entries(), 256)); // empties the map
  this->Gpu.Dispatch(Stage::CacheRebuild, DivideUp(slots, 256));
  return true;
}

bool ProgressivePipeline::GrowCache()
{
  const std::int64_t slots = std::min(2 * this->Extent.Slots, this->MaximumSlots());
  return slots <= this->Extent.Slots || this->ResizeCache(slots);
}

//------------------------------------------------------------------------------
// The image
//------------------------------------------------------------------------------
bool ProgressivePipeline::SetScene(const SceneBlock& scene)
{
  const SceneBlock own = this->Scene;
  this->Scene = scene;
  std::copy(own.Samples, own.Samples + 4, this->Scene.Samples);
  std::copy(own.Blocks, own.Blocks + 4, this->Scene.Blocks);
  std::copy(own.CoarseCells, own.CoarseCells + 4, this->Scene.CoarseCells);
  std::copy(own.Payload, own.Payload + 4, this->Scene.Payload);
  std::copy(own.Cache, own.Cache + 4, this->Scene.Cache);
  this->Scene.Cache[2] = static_cast<std::uint32_t>(this->SpeculationLimit);
  this->Scene.Payload[3] = static_cast<std::uint32_t>(this->GroupingThreshold);
  this->Extent.Pixels = static_cast<std::int64_t>(scene.Image[0]) * scene.Image[1];
  if (!this->Gpu.Allocate(Lifetime::Image, this->Extent))
  {
    return false;
  }
  // its size follows from both the cache and the image
  const std::int64_t workItems =
    PipelineBuffers()[static_cast<int>(Buffer::CacheWorkItems)].Bytes(this->Extent);
  if (this->Extent.Slots > 0 && !this->Gpu.Allocate(Buffer::CacheWorkItems, workItems))
  {
    return false;
  }
  this->Gpu.UploadScene(this->Scene);
  if (this->Extent.Slots == 0)
  {
    // holds the working sets of small volumes; it grows on demand
    const std::int64_t wanted = std::max<std::int64_t>(16384, this->Extent.Pixels / 8);
    return this->ResizeCache(std::min(wanted, this->MaximumSlots()));
  }
  return true;
}

void ProgressivePipeline::Start()
{
  this->Passes.clear();
  this->PassEnds.clear();
  this->PassesSubmitted = 0;
  this->Remaining = this->Extent.Pixels;
  this->Started = true;
  this->Gpu.ForgetStages({ Stage::BlockRanges }); // which ran for the volume
  this->StartTime = Clock::now();
  if (!this->Gpu.IsSoftware())
  {
    this->MarkPassEnd(); // the first query is the image's start
  }
  this->WriteControl(offsetof(ControlBlock, LiveRays), 0);
  this->WriteControl(offsetof(ControlBlock, NextLiveRays), 0);
  this->WriteControl(offsetof(ControlBlock, PassIndex), 0);
  this->Gpu.Dispatch(
    Stage::InitialRays, DivideUp(this->Scene.Image[0], 8), DivideUp(this->Scene.Image[1], 8));
  this->Gpu.Swap(Buffer::LiveRays, Buffer::NextLiveRays);
}

// The algorithm. Every dispatch's size is decided on the GPU; see Buffers.glsl for what flows
// between the stages.
void ProgressivePipeline::RunPass()
{
  this->Gpu.Dispatch(Stage::BeginPass, 1);
  this->EvictBlocks();
  this->Gpu.DispatchIndirect(Stage::TraverseGrid, offsetof(ControlBlock, TraverseGroups));
  this->Gpu.DispatchIndirect(Stage::MarkBlocks, offsetof(ControlBlock, PairGroups));
  this->Gpu.DispatchIndirect(Stage::AdmitBlocks, offsetof(ControlBlock, AdmitGroups));
  this->Gpu.DispatchIndirect(Stage::DecodeBlocks, offsetof(ControlBlock, DecodeGroups));
  this->Gpu.DispatchIndirect(Stage::GroupRays, offsetof(ControlBlock, PairGroups));
  this->Gpu.DispatchIndirect(Stage::IntersectBlocks, offsetof(ControlBlock, IntersectGroups));
  if (this->Scene.Payload[3] > 0)
  {
    this->Gpu.DispatchIndirect(Stage::IntersectPairs, offsetof(ControlBlock, PairGroups));
  }
  this->Gpu.DispatchIndirect(Stage::NearestHit, offsetof(ControlBlock, TraverseGroups));
  this->Gpu.Swap(Buffer::LiveRays, Buffer::NextLiveRays);
  ++this->PassesSubmitted;
  this->MarkPassEnd();
}

// Zero work groups unless BeginPass or BeginShading found the cache too full; nothing at all where
// the cache holds the whole volume.
void ProgressivePipeline::EvictBlocks()
{
  if (this->Extent.Slots >= this->Scene.Blocks[3])
  {
    return;
  }
  for (Stage stage : { Stage::CacheAges, Stage::CacheEvict, Stage::CacheRebuild })
  {
    this->Gpu.DispatchIndirect(stage, offsetof(ControlBlock, EvictGroups));
  }
}

void ProgressivePipeline::RunPasses(int maximum, bool eager, const std::function<bool()>& stop)
{
  const int batch = eager || this->Gpu.IsSoftware() ? 1 : PassesPerBatch;
  int left = maximum > 0 ? maximum : -1;
  int stalled = 0;
  while (this->Remaining > 0 && left != 0)
  {
    const int passes = left > 0 ? std::min(batch, left) : batch;
    for (int i = 0; i < passes; ++i)
    {
      this->RunPass();
    }
    left = left > 0 ? left - passes : left;
    const ControlBlock control = this->ReadControl();
    const bool gotOn = control.Pairs > 0 || control.NextLiveRays != this->Remaining;
    this->Remaining = control.NextLiveRays;
    stalled = gotOn ? 0 : stalled + 1;
    if (stalled == PatienceWithNone)
    {
      this->Gpu.Fail("makes no progress: the GPU may have been lost; release the graphics "
                     "resources and render again");
    }
    if (control.PassIndex - this->Passes.size() > PassRecords / 2)
    {
      this->ReadPassRecords();
    }
    if ((control.DeferredBlocks > 0 && !this->GrowCache()) || !this->GetError().empty() || stop())
    {
      return;
    }
  }
}

void ProgressivePipeline::ShadeHits(bool again)
{
  if (again)
  {
    this->Gpu.Fill(Buffer::PixelColor, 0);
  }
  const std::int64_t groups = DivideUp(this->Extent.Pixels, 64);
  std::uint32_t unshaded = 0;
  int stalled = 0;
  do
  {
    this->Gpu.Dispatch(Stage::BeginShading, 1);
    this->EvictBlocks(); // also where nothing is looked up: BeginShading may have planned it
    if (this->Scene.Lighting[0] > 0)
    {
      this->Gpu.Dispatch(Stage::MarkShading, groups);
      this->Gpu.DispatchIndirect(Stage::AdmitBlocks, offsetof(ControlBlock, AdmitGroups));
      this->Gpu.DispatchIndirect(Stage::DecodeBlocks, offsetof(ControlBlock, DecodeGroups));
    }
    this->Gpu.Dispatch(Stage::ShadeHits, groups);
    const std::uint32_t before = unshaded;
    unshaded = this->ReadControl().UnshadedHits;
    stalled = unshaded == before ? stalled + 1 : 0;
    if (unshaded > 0 && stalled == PatienceWithNone)
    {
      this->Gpu.Fail("cannot shade: the GPU may have been lost; release the graphics resources and "
                     "render again");
    }
  } while (unshaded > 0 && this->GetError().empty() && this->GrowCache());
  this->ReadPassRecords();
}

//------------------------------------------------------------------------------
// What came out
//------------------------------------------------------------------------------
double ProgressivePipeline::Since(Clock::time_point start) const
{
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Software renderers have no credible timer queries, but a synchronous end.
void ProgressivePipeline::MarkPassEnd()
{
  if (this->Gpu.IsSoftware())
  {
    glFinish();
    this->PassEnds.push_back(this->Since(this->StartTime));
    return;
  }
  const std::size_t query = static_cast<std::size_t>(this->PassesSubmitted);
  if (query >= this->TimeQueries.size())
  {
    this->TimeQueries.push_back(0);
    glGenQueries(1, &this->TimeQueries.back());
  }
  glQueryCounter(this->TimeQueries[query], GL_TIMESTAMP);
}

// Records of the passes that had rays; those submitted after the last ray was done leave none.
void ProgressivePipeline::ReadPassRecords()
{
  const std::size_t total = this->ReadControl().PassIndex;
  if (total == this->Passes.size())
  {
    return;
  }
  std::array<PassRecord, PassRecords> ring;
  this->Gpu.Read(Buffer::PassStatistics, ring.data(), sizeof(ring));
  GLuint64 start = 0;
  if (!this->Gpu.IsSoftware())
  {
    glGetQueryObjectui64v(this->TimeQueries[0], GL_QUERY_RESULT, &start);
  }
  for (std::size_t pass = this->Passes.size(); pass < total; ++pass)
  {
    TimedPass timed;
    static_cast<PassRecord&>(timed) = ring[pass % PassRecords];
    if (this->Gpu.IsSoftware())
    {
      timed.ElapsedMilliseconds = this->PassEnds[pass];
    }
    else
    {
      GLuint64 end = 0;
      glGetQueryObjectui64v(this->TimeQueries[pass + 1], GL_QUERY_RESULT, &end);
      timed.ElapsedMilliseconds = (end - start) * 1e-6;
    }
    this->Passes.push_back(timed);
  }
}

double ProgressivePipeline::GetCompletedFraction() const
{
  return this->Started && this->Extent.Pixels > 0
    ? 1.0 - static_cast<double>(this->Remaining) / static_cast<double>(this->Extent.Pixels)
    : 0.0;
}

std::vector<std::uint32_t> ProgressivePipeline::ReadHitKeys()
{
  std::vector<std::uint32_t> keys(static_cast<std::size_t>(this->Extent.Pixels));
  this->Gpu.Read(Buffer::RayHit, keys.data(), 4 * keys.size());
  return keys;
}

bool ProgressivePipeline::DecodeBlocks(std::int64_t first, std::int64_t count, float* values)
{
  if (this->Extent.Slots < count && !this->ResizeCache(count))
  {
    return false;
  }
  std::vector<std::uint32_t> slots(count), blocks(count);
  for (std::int64_t i = 0; i < count; ++i)
  {
    slots[i] = static_cast<std::uint32_t>(i);
    blocks[i] = static_cast<std::uint32_t>(first + i);
  }
  const std::size_t bytes = static_cast<std::size_t>(4 * count);
  this->Gpu.Write(Buffer::CacheDecodeList, 0, slots.data(), bytes);
  this->Gpu.Write(Buffer::CacheSlotBlock, 0, blocks.data(), bytes);
  this->WriteControl(offsetof(ControlBlock, DecodedBlocks), static_cast<std::uint32_t>(count));
  this->Gpu.Dispatch(Stage::DecodeBlocks, DivideUp(count, 32));
  this->Gpu.Read(Buffer::CacheValues, values, 64 * bytes);
  // the cache's bookkeeping knows nothing of these blocks: start afresh
  this->WriteControl(offsetof(ControlBlock, DecodedBlocks), 0);
  this->Extent.Slots = 0;
  this->Started = false;
  return this->GetError().empty();
}
