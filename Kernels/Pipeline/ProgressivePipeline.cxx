// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ProgressivePipeline.h"

#include "Status.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>

namespace
{
constexpr std::int64_t AutomaticValues = 1LL
  << 30; // bytes of decoded blocks where no budget is set
constexpr std::int64_t PaletteBytes = 16 * (1 + glsl::PALETTE_SIZE);
constexpr std::int64_t LeastSlots = 2048; // any 64 rays find room for all that they need at once
constexpr std::int64_t LeastPages = 512;  // of the block map, likewise
constexpr std::int64_t SlotsPerPage = 8;  // else
constexpr std::int64_t FirstSlots = 16384;
constexpr std::int64_t Growth = 4;   // of the cache, at least
constexpr int MostRefusals = 3;      // in a row, of a cache that has a slot for every pixel
constexpr int PassesAhead = 3;       // submitted before the CPU knows whether they are needed
constexpr int PatienceWithNone = 64; // passes that get nowhere before we give up
constexpr std::size_t RecentImages = 8;
constexpr std::uint32_t FewRays = 32; // as many pixels a ray, or more: each gets a work group

std::int64_t DivideUp(std::int64_t a, std::int64_t b)
{
  return (a + b - 1) / b;
}

std::string Bytes(std::int64_t bytes)
{
  return std::to_string(bytes) + " bytes";
}
}

bool ProgressivePipeline::Initialize(std::uint64_t context)
{
  if (this->Gpu.IsInitialized())
  {
    return true;
  }
  if (!this->Gpu.Initialize(context) || !this->Gpu.Allocate(Lifetime::Pipeline, this->Extent))
  {
    return false;
  }
  ControlBlock control = {};
  for (DispatchArguments* groups : { &control.CastGroups, &control.FewGroups, &control.NormalGroups,
         &control.RequestGroups, &control.DecodeGroups, &control.EvictGroups })
  {
    *groups = { 0, 1, 1, 0 };
  }
  this->Gpu.Write(Buffer::Control, 0, &control, sizeof(control));
  return this->Gpu.CheckMemory();
}

void ProgressivePipeline::Release()
{
  glDeleteQueries(static_cast<GLsizei>(this->TimeQueries.size()), this->TimeQueries.data());
  this->TimeQueries.clear();
  this->Gpu.Release();
  this->Extent = PipelineExtent();
  this->VolumeLoaded = false;
  this->Started = false;
}

//------------------------------------------------------------------------------
// What there is room for
//------------------------------------------------------------------------------
// All GPU memory beside the compressed stream.
std::int64_t ProgressivePipeline::BytesWith(const PipelineExtent& extent) const
{
  std::int64_t bytes =
    Device::GetUniformBytes() + Device::GetStagingLimit() + (extent.Colored ? PaletteBytes : 0);
  for (Lifetime lifetime :
    { Lifetime::Pipeline, Lifetime::Volume, Lifetime::Image, Lifetime::Cache })
  {
    bytes += BytesOf(lifetime, extent);
  }
  return bytes;
}

PipelineExtent ProgressivePipeline::WithSlots(std::int64_t slots) const
{
  PipelineExtent extent = this->Extent;
  extent.Cached = true;
  extent.Slots = slots;
  extent.Pages = std::min(extent.Macrocells, std::max(LeastPages, slots / SlotsPerPage));
  return extent;
}

PipelineExtent ProgressivePipeline::WholeVolume() const
{
  PipelineExtent extent = this->Extent;
  extent.Cached = false;
  extent.Slots = this->Extent.Blocks;
  extent.Pages = 0;
  return extent;
}

// Automatic: a quarter of what the GPU has, but not more than the decoded blocks are given by
// default.
std::int64_t ProgressivePipeline::ChooseBudget() const
{
  if (this->Settings.MemoryBudget > 0)
  {
    return this->Settings.MemoryBudget;
  }
  const std::int64_t most = this->BytesWith(this->WithSlots(0)) + AutomaticValues;
  const std::int64_t device = this->Gpu.GetDeviceMemory();
  return device > 0 ? std::min(most, device / 4) : most;
}

std::int64_t ProgressivePipeline::MinimumSlots() const
{
  return std::min<std::int64_t>(LeastSlots, this->Grid.NumberOfBlocks);
}

// As many as the budget has room for, one buffer can hold and the volume has blocks; 0 where the
// budget has no room for the fewest that can work.
std::int64_t ProgressivePipeline::MaximumSlots() const
{
  std::int64_t least = 0;
  std::int64_t most = std::min<std::int64_t>(
    this->Grid.NumberOfBlocks, this->Gpu.GetLargestBuffer() / BytesPerSlot(this->Extent));
  while (least < most)
  {
    const std::int64_t middle = DivideUp(least + most, 2);
    if (this->BytesWith(this->WithSlots(middle)) <= this->Budget)
    {
      least = middle;
    }
    else
    {
      most = middle - 1;
    }
  }
  return least >= this->MinimumSlots() ? least : 0;
}

std::int64_t ProgressivePipeline::GetLeastMemoryBudget() const
{
  const std::int64_t cached = this->BytesWith(this->WithSlots(this->MinimumSlots()));
  return this->Settings.DecodeWholeVolume ? std::min(cached, this->BytesWith(this->WholeVolume()))
                                          : cached;
}

//------------------------------------------------------------------------------
// The volume
//------------------------------------------------------------------------------
void ProgressivePipeline::SetVolume(const PipelineVolume& volume)
{
  this->Volume = volume;
  this->VolumeLoaded = false;
  this->Started = false;
  std::int64_t blocks = 1, macrocells = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Grid.Samples[axis] = volume.Samples[axis];
    this->Grid.Blocks[axis] =
      static_cast<std::int32_t>(DivideUp(volume.Samples[axis], glsl::BLOCK_SIDE));
    this->Grid.Macrocells[axis] =
      static_cast<std::int32_t>(DivideUp(this->Grid.Blocks[axis], glsl::MACROCELL_SIDE));
    blocks *= this->Grid.Blocks[axis];
    macrocells *= this->Grid.Macrocells[axis];
  }
  this->Grid.BlockBits = volume.Values.BlockBits;
  this->Grid.ColorBlockBits = volume.Colors.BlockBits;
  this->Grid.NumberOfBlocks = static_cast<std::uint32_t>(blocks);
  this->Grid.NumberOfMacrocells = static_cast<std::uint32_t>(macrocells);
  this->Extent.Blocks = blocks;
  this->Extent.Macrocells = macrocells;
  this->Extent.Colored = volume.Colors.Data != nullptr;
  this->Extent.HiddenWords = static_cast<std::int64_t>(volume.Hidden.size());
  this->TouchedSlots.clear();
}

void ProgressivePipeline::EmptyCache()
{
  if (!this->Extent.Cached)
  {
    this->VolumeLoaded = false;
  }
  else if (this->Extent.Slots > 0)
  {
    this->ResizeCache(this->Extent.Slots);
  }
  this->Started = false;
}

void ProgressivePipeline::SetSettings(const PipelineSettings& settings)
{
  if (settings.LargestBuffer != this->Settings.LargestBuffer)
  {
    this->VolumeLoaded = false;
  }
  this->Settings = settings;
  this->Gpu.LimitBuffers(settings.LargestBuffer);
}

bool ProgressivePipeline::UploadStream(Buffer buffer, const CompressedStream& stream)
{
  std::vector<StreamSegment> segments;
  const Status status =
    SplitStream(stream, VolumeSize(this->Volume.Samples), this->Gpu.GetLargestBuffer(), segments);
  return status ? this->Gpu.UploadStream(buffer, stream.Data.get(), segments)
                : this->Gpu.Fail(status.GetMessage());
}

bool ProgressivePipeline::UploadStreams()
{
  this->Gpu.FreeStreams();
  return this->UploadStream(Buffer::Stream, this->Volume.Values) &&
    (!this->Extent.Colored || this->UploadStream(Buffer::ColorStream, this->Volume.Colors));
}

bool ProgressivePipeline::MakeVolumeBuffers()
{
  if (!this->Gpu.Allocate(Lifetime::Volume, this->Extent))
  {
    return false;
  }
  this->Gpu.UploadUniforms(VOLUME_BINDING, &this->Grid, sizeof(this->Grid));
  this->Gpu.Upload(Buffer::HiddenCells, this->Volume.Hidden);
  return true;
}

// The stream goes to the GPU and stays there; its macrocells are made (section 3.1).
bool ProgressivePipeline::LoadVolume()
{
  if (!this->MakeVolumeBuffers() || !this->UploadStreams())
  {
    return false;
  }
  this->Gpu.Dispatch(Stage::BlockRanges, this->Extent.Macrocells);
  return true;
}

// The stream goes to the GPU, is decoded, and goes again.
bool ProgressivePipeline::LoadWholeVolume()
{
  if (!this->MakeVolumeBuffers() || !this->Gpu.Allocate(Lifetime::Cache, this->Extent) ||
    !this->UploadStreams())
  {
    return false;
  }
  for (const Stage stage : { Stage::DecodeBlocks, Stage::DecodeColors })
  {
    if (InfoOf(stage).IsNeeded(Moment::Volume, this->Extent))
    {
      this->Gpu.Dispatch(stage, GroupsFor(stage, this->Extent.Slots));
    }
  }
  this->Gpu.FreeStreams();
  this->Gpu.Dispatch(Stage::BlockRanges, this->Extent.Macrocells);
  return true;
}

//------------------------------------------------------------------------------
// The cache
//------------------------------------------------------------------------------
// A new cache, which holds nothing yet.
bool ProgressivePipeline::ResizeCache(std::int64_t slots)
{
  this->Extent = this->WithSlots(slots);
  this->Gpu.SetExtent(this->Extent);
  if (!this->Gpu.Allocate(Lifetime::Cache, this->Extent))
  {
    this->Gpu.Free(Lifetime::Cache);
    this->Extent.Slots = 0;
    return false;
  }
  this->Cache.Slots = static_cast<std::uint32_t>(slots);
  this->Cache.MapPages = static_cast<std::uint32_t>(this->Extent.Pages);
  this->Cache.CannotGrow = slots == this->MaximumSlots() ? 1 : 0;
  this->UploadCache();
  this->Gpu.Dispatch(Stage::CacheReset,
    std::min<std::int64_t>(
      4096, GroupsFor(Stage::CacheReset, std::max(slots, this->Extent.Macrocells))));
  this->CacheAge = this->PassesSubmitted;
  this->Refusals = 0;
  this->TouchedSlots.clear();
  return true;
}

// Where an image needs more than fits, and there is room, the cache grows: seldom and by much, as
// GPUs take long to make memory. Beyond a slot a pixel it does so, then twofold, only where pass
// after pass is refused blocks: up to then eviction helps, and another pass costs less than memory.
// It loses what it holds; rays ask again for what they still need.
void ProgressivePipeline::GrowCache(const PassRecord& pass)
{
  const std::int64_t most = this->MaximumSlots();
  const std::int64_t needed = std::int64_t(pass.TouchedSlots) + pass.RefusedBlocks;
  const bool small = this->Extent.Slots < this->Extent.Pixels && needed > this->Extent.Slots;
  this->Refusals = pass.RefusedBlocks > 0 ? this->Refusals + 1 : 0;
  if (this->Refusals > (small ? 0 : MostRefusals) && this->Extent.Slots < most)
  {
    const std::int64_t enough =
      small ? std::max(Growth * this->Extent.Slots, 2 * needed) : 2 * this->Extent.Slots;
    this->ResizeCache(std::min(enough, most));
  }
}

// A cache that the last images left mostly unused shrinks: to less than it has ever grown at once.
std::int64_t ProgressivePipeline::SlotsForRecentImages() const
{
  if (this->TouchedSlots.size() < RecentImages)
  {
    return this->Extent.Slots;
  }
  const std::int64_t most = *std::max_element(this->TouchedSlots.begin(), this->TouchedSlots.end());
  const std::int64_t enough = std::max({ 2 * most, FirstSlots, this->MinimumSlots() });
  return Growth * most < this->Extent.Slots ? std::min(enough, this->Extent.Slots)
                                            : this->Extent.Slots;
}

//------------------------------------------------------------------------------
// The scene
//------------------------------------------------------------------------------
void ProgressivePipeline::UploadCache()
{
  this->Cache.SpeculationLimit = static_cast<std::uint32_t>(this->Settings.SpeculationLimit);
  // a software renderer has no lanes to keep busy, and its work groups cost much
  this->Cache.PixelsPerStraggler = this->Gpu.IsSoftware() ? 0 : FewRays;
  this->Gpu.UploadUniforms(CACHE_BINDING, &this->Cache, sizeof(this->Cache));
}

bool ProgressivePipeline::SetScene(const PipelineScene& scene, bool newImage)
{
  const glsl::View& view = scene.View;
  this->Gpu.UploadUniforms(VIEW_BINDING, &scene.View, sizeof(scene.View));
  this->Gpu.UploadUniforms(LOOK_BINDING, &scene.Look, sizeof(scene.Look));
  std::copy(view.ImageSize, view.ImageSize + 2, this->Viewport);
  std::copy(view.ImageOrigin, view.ImageOrigin + 2, this->Viewport + 2);
  const PipelineExtent before = this->Extent;
  this->Extent.Pixels = static_cast<std::int64_t>(view.ImageSize[0]) * view.ImageSize[1];
  this->Extent.Detailed = this->Settings.Detailed;
  this->Extent.Lit = scene.Look.NumberOfLights > 0;
  this->Extent.Translucent = scene.Translucent;
  this->Extent.Obstructed = scene.Obstructed;
  this->Extent.SeveralIsovalues = view.NumberOfIsovalues > 1;
  this->Extent.Clipped = view.NumberOfClippingPlanes > 0;
  this->Extent.Cropped = view.DrawnRegions != glsl::ALL_REGIONS;
  const bool sameImage =
    before.Pixels == this->Extent.Pixels && before.GetFeatures() == this->Extent.GetFeatures();
  this->Started = this->Started && sameImage;
  return this->MakeRoom(newImage);
}

// Decides between the whole volume, decoded, and a cache; has each buffer made as large as the
// budget allows and the scene needs.
bool ProgressivePipeline::MakeRoom(bool newImage)
{
  this->Budget = this->ChooseBudget();
  const PipelineExtent whole = this->WholeVolume();
  const bool fits = this->BytesWith(whole) <= this->Budget &&
    BytesPerSlot(whole) * whole.Slots <= this->Gpu.GetLargestBuffer();
  const bool cached = !(fits && this->Settings.DecodeWholeVolume);
  const std::int64_t most = this->MaximumSlots();
  if (cached && most == 0)
  {
    return this->Gpu.Fail("the memory budget of " + Bytes(this->Budget) +
      " is too small: this volume at this image size needs at least " +
      Bytes(this->GetLeastMemoryBudget()) + " beside the compressed stream");
  }
  const bool reload = !this->VolumeLoaded || cached != this->Extent.Cached;
  std::int64_t slots = cached ? std::min(this->Extent.Slots, most) : whole.Slots;
  if (reload)
  {
    this->Gpu.FreeStreams();
    slots = cached ? 0 : whole.Slots;
  }
  this->Started = this->Started && slots == this->Extent.Slots && !reload;
  this->Extent = cached ? this->WithSlots(slots) : whole;
  this->Gpu.Trim(this->Extent);
  this->Gpu.SetExtent(this->Extent);
  this->UploadCache();
  if (reload)
  {
    this->Gpu.ForgetStages();
    this->VolumeLoaded = cached ? this->LoadVolume() : this->LoadWholeVolume();
  }
  return this->GetError().empty() && this->Gpu.Allocate(Lifetime::Image, this->Extent) &&
    (cached ? this->MakeCache(most, newImage) : this->Gpu.Allocate(Lifetime::Cache, this->Extent));
}

// The cache begins small, and is left alone while an image is under way.
bool ProgressivePipeline::MakeCache(std::int64_t most, bool newImage)
{
  std::int64_t slots = this->Extent.Slots;
  if (slots == 0)
  {
    slots = std::min(std::max(FirstSlots, this->Extent.Pixels / 4), most);
  }
  else if (newImage)
  {
    slots = this->SlotsForRecentImages();
  }
  const bool same = this->Gpu.Has(Lifetime::Cache, this->WithSlots(slots)) &&
    this->Cache.CannotGrow == (slots == most ? 1u : 0u);
  return same || this->ResizeCache(slots);
}

//------------------------------------------------------------------------------
// The image
//------------------------------------------------------------------------------
void ProgressivePipeline::Start()
{
  this->Gpu.ForgetSnapshots();
  this->Passes.clear();
  this->PassEnds.clear();
  this->PassesSubmitted = 0;
  this->PassesKnown = 0;
  this->CacheAge = 0;
  this->PassesWithoutProgress = 0;
  this->Remaining = this->Extent.Pixels;
  this->Started = true;
  std::set<Stage> forVolume;
  for (const StageInfo& info : PipelineStages())
  {
    if (info.IsNeeded(Moment::Volume, this->Extent))
    {
      forVolume.insert(info.Id);
    }
  }
  this->Gpu.ForgetStages(forVolume);
  this->StartTime = Clock::now();
  if (!this->Gpu.IsSoftware())
  {
    this->MarkPassEnd(); // the first query is the image's start
  }
  this->Gpu.Fill(Buffer::Hits, glsl::NO_HIT);
  this->Gpu.Fill(Buffer::Normals, glsl::NO_NORMAL);
  this->Gpu.Fill(Buffer::Layers, 0);
  if (this->Extent.Obstructed)
  {
    const std::int64_t section = 2 + this->Extent.SeveralIsovalues + this->Extent.Colored;
    this->Gpu.CaptureDepths(this->Viewport, Buffer::Hits, 4 * section * this->Extent.Pixels);
  }
  const std::uint32_t yes = 1;
  this->Gpu.Write(Buffer::Control, offsetof(ControlBlock, NewImage), &yes, sizeof(yes));
  if (this->Gpu.CheckMemory()) // else the stages may never come to an end
  {
    this->Gpu.Dispatch(Stage::PlanPass, 1);
  }
}

// Runs a stage if this scene's passes need it. The GPU decides how many work groups it has.
void ProgressivePipeline::RunStage(Stage stage)
{
  const StageInfo& info = InfoOf(stage);
  if (!info.IsNeeded(Moment::Pass, this->Extent))
  {
    return;
  }
  if (info.GroupsInPass == OneGroup)
  {
    this->Gpu.Dispatch(stage, 1);
  }
  else
  {
    this->Gpu.DispatchIndirect(stage, static_cast<std::size_t>(info.GroupsInPass));
  }
}

// The algorithm. See docs/reference/buffers.md for what flows between the stages. Where the whole
// volume is decoded one pass casts all rays to their ends.
void ProgressivePipeline::RunPass()
{
  this->RunStage(Stage::CacheAges);
  this->RunStage(Stage::CacheEvict);
  this->RunStage(Stage::CastRays);
  this->RunStage(Stage::CastFewRays);
  this->RunStage(Stage::FinishHits);
  this->RunStage(Stage::RequestBlocks);
  this->RunStage(Stage::DecodeBlocks);
  this->RunStage(Stage::DecodeColors);
  this->RunStage(Stage::PlanPass);
  ++this->PassesSubmitted;
  this->MarkPassEnd();
  this->Gpu.OrderSnapshot();
}

// The GPU is always given work ahead of what the CPU knows; passes that turn out not to be needed
// have no work groups.
void ProgressivePipeline::RunPasses(int maximum, bool eager, const std::function<bool()>& stop)
{
  const std::int64_t ahead =
    eager || this->Gpu.IsSoftware() || this->Extent.IsSinglePass() ? 1 : PassesAhead;
  const std::int64_t last =
    maximum > 0 ? this->PassesSubmitted + maximum : std::numeric_limits<std::int64_t>::max();
  bool more = this->Remaining > 0 && this->GetError().empty();
  while (more || this->PassesKnown < this->PassesSubmitted)
  {
    while (
      more && this->PassesSubmitted < this->PassesKnown + ahead && this->PassesSubmitted < last)
    {
      this->RunPass();
    }
    if (this->Extent.IsSinglePass())
    {
      this->Remaining = 0; // there is nothing to wait for
      return;
    }
    this->TakeSnapshot();
    if (this->Remaining == 0 || !this->GetError().empty())
    {
      return;
    }
    more = more && !stop() && this->PassesSubmitted < last;
    if (!this->Started) // whoever was asked has released everything
    {
      return;
    }
  }
}

// What the next pass of those submitted has done.
void ProgressivePipeline::TakeSnapshot()
{
  const Snapshot snapshot = this->Gpu.AwaitSnapshot();
  const std::size_t total = snapshot.Control.PassIndex;
  ++this->PassesKnown;
  if (this->Passes.size() < total)
  {
    TimedPass pass;
    static_cast<PassRecord&>(pass) = snapshot.Records[(total - 1) % PassRecords];
    const bool gotOn =
      pass.Pairs > 0 || pass.DecodedBlocks > 0 || pass.RemainingRays != this->Remaining;
    this->PassesWithoutProgress = gotOn ? 0 : this->PassesWithoutProgress + 1;
    this->Remaining = pass.RemainingRays;
    this->Passes.push_back(pass);
    if (this->PassesKnown > this->CacheAge)
    {
      this->GrowCache(pass);
    }
  }
  if (this->Remaining == 0)
  {
    this->EndImage();
  }
  if (this->PassesWithoutProgress == PatienceWithNone)
  {
    this->Gpu.Fail("makes no progress: the GPU may have been lost; release the graphics "
                   "resources and render again");
  }
}

void ProgressivePipeline::EndImage()
{
  this->Gpu.ForgetSnapshots(); // of passes that were not needed
  this->PassesKnown = this->PassesSubmitted;
  if (!this->Passes.empty())
  {
    this->TouchedSlots.push_back(this->Passes.back().TouchedSlots);
  }
  if (this->TouchedSlots.size() > RecentImages)
  {
    this->TouchedSlots.erase(this->TouchedSlots.begin());
  }
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

void ProgressivePipeline::CompleteStatistics()
{
  while (this->PassesKnown < this->PassesSubmitted)
  {
    this->TakeSnapshot();
  }
  GLuint64 start = 0;
  if (!this->Gpu.IsSoftware() && !this->Passes.empty())
  {
    glGetQueryObjectui64v(this->TimeQueries[0], GL_QUERY_RESULT, &start);
  }
  for (std::size_t i = 0; i < this->Passes.size(); ++i)
  {
    if (this->Gpu.IsSoftware())
    {
      this->Passes[i].ElapsedMilliseconds = this->PassEnds[i];
      continue;
    }
    GLuint64 end = 0;
    glGetQueryObjectui64v(this->TimeQueries[i + 1], GL_QUERY_RESULT, &end);
    this->Passes[i].ElapsedMilliseconds = (end - start) * 1e-6;
  }
}

double ProgressivePipeline::GetCompletedFraction() const
{
  return this->Started && this->Extent.Pixels > 0
    ? 1.0 - static_cast<double>(this->Remaining) / static_cast<double>(this->Extent.Pixels)
    : 0.0;
}

// One section of Hits.glsl.
std::vector<std::uint32_t> ProgressivePipeline::ReadHits(std::int64_t section)
{
  std::vector<std::uint32_t> words(static_cast<std::size_t>(this->Extent.Pixels));
  this->Gpu.Read(
    Buffer::Hits, 4 * section * this->Extent.Pixels, words.data(), 4 * this->Extent.Pixels);
  return words;
}

std::vector<std::uint32_t> ProgressivePipeline::ReadHitKeys()
{
  return this->ReadHits(0);
}

std::vector<float> ProgressivePipeline::ReadHitDepths()
{
  const std::vector<std::uint32_t> words = this->ReadHits(1);
  std::vector<float> depths(words.size());
  std::memcpy(depths.data(), words.data(), 4 * words.size());
  return depths;
}

PixelHit ProgressivePipeline::ReadHit(std::int64_t pixel)
{
  PixelHit hit;
  const auto read = [this, pixel](std::int64_t section, void* word)
  { this->Gpu.Read(Buffer::Hits, 4 * (section * this->Extent.Pixels + pixel), word, 4); };
  read(0, &hit.Key);
  read(1, &hit.Depth);
  if (this->Extent.SeveralIsovalues)
  {
    read(2, &hit.Surface);
    hit.Surface >>= 16;
  }
  return hit;
}

bool ProgressivePipeline::DecodeVolume(std::vector<float>& values)
{
  this->Extent = this->WholeVolume();
  this->Gpu.SetExtent(this->Extent);
  if (!this->LoadWholeVolume())
  {
    return false;
  }
  values.resize(static_cast<std::size_t>(glsl::SAMPLES_PER_BLOCK * this->Extent.Slots));
  this->Gpu.Read(Buffer::CacheValues, 0, values.data(),
    static_cast<std::int64_t>(values.size() * sizeof(float)));
  return this->GetError().empty();
}
