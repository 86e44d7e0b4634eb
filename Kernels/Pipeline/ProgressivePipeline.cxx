// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ProgressivePipeline.h"

#include "Pipeline/FixedView.h"
#include "Pipeline/MacrocellBox.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <set>
#include <thread>

namespace
{
constexpr std::int64_t FirstSlice = 256;          // macrocells
constexpr std::int64_t MaximumResetGroups = 4096; // each resets many slots where there are more
// Where fewer than one pixel of so many has a live ray, each ray gets a work group.
constexpr std::uint32_t PixelsPerStraggler = 32;
constexpr std::chrono::milliseconds PollingInterval(1); // of programs that are being compiled

// The levels' streams and shapes, the volume itself first.
std::vector<const PipelineLevel*> LevelsOf(const PipelineVolume& volume)
{
  std::vector<const PipelineLevel*> levels = { &volume };
  for (const PipelineLevel& level : volume.Coarser)
  {
    levels.push_back(&level);
  }
  return levels;
}

std::vector<LevelGrid> GridsOf(const PipelineVolume& volume)
{
  std::vector<LevelGrid> grids = { { VolumeSize(volume.Samples), 0, 0 } };
  for (const PipelineLevel& level : volume.Coarser)
  {
    grids.push_back(grids.back().Next(level.Samples));
  }
  return grids;
}

void CopyCounts(const std::array<std::int64_t, 3>& counts, glsl::ivec3& copy)
{
  std::copy(counts.begin(), counts.end(), copy);
}

glsl::Volume DescribeVolume(const std::vector<LevelGrid>& grids, const PipelineVolume& volume)
{
  glsl::Volume block = {};
  const std::vector<const PipelineLevel*> levels = LevelsOf(volume);
  for (std::size_t i = 0; i < grids.size(); ++i)
  {
    const LevelGrid& grid = grids[i];
    glsl::VolumeLevel& level = block.Levels[i];
    CopyCounts(grid.Size.Samples, level.Samples);
    CopyCounts(grid.Size.Blocks, level.Blocks);
    CopyCounts(grid.Size.Macrocells, level.Macrocells);
    level.FirstBlock = static_cast<std::uint32_t>(grid.FirstBlock);
    level.FirstMacrocell = static_cast<std::uint32_t>(grid.FirstMacrocell);
    std::copy(levels[i]->Halvings, levels[i]->Halvings + 3, level.Halvings);
    block.NumberOfBlocks += static_cast<std::uint32_t>(grid.Size.GetNumberOfBlocks());
    ++block.NumberOfLevels;
    block.NumberOfMacrocells += static_cast<std::uint32_t>(grid.Size.GetNumberOfMacrocells());
  }
  CopyCounts(grids[0].Size.Samples, block.Samples);
  CopyCounts(grids[0].Size.Blocks, block.Blocks);
  CopyCounts(grids[0].Size.Macrocells, block.Macrocells);
  return block;
}

std::set<Stage> StagesOf(Moment moment, const SceneNeeds& needs)
{
  std::set<Stage> stages;
  for (const StageInfo& info : PipelineStages())
  {
    if (info.IsNeeded(moment, needs))
    {
      stages.insert(info.Id);
    }
  }
  return stages;
}
}

Status ProgressivePipeline::Initialize(std::uint64_t contextId)
{
  if (this->Gpu->IsInitialized())
  {
    return Status();
  }
  if (Status opened = this->Gpu->Initialize(contextId); !opened)
  {
    return opened;
  }
  if (Status made = this->Gpu->Buffers.Allocate(Lifetime::Pipeline, this->Needs); !made)
  {
    return made;
  }
  glsl::Control control = {};
  for (glsl::Dispatch* groups :
    { &control.CastGroups, &control.StragglerGroups, &control.FinishGroups, &control.RequestGroups,
      &control.DecodeGroups, &control.EvictGroups })
  {
    *groups = { 0, 1, 1, 0 };
  }
  this->Gpu->Transfer.Write(
    this->Gpu->Buffers.GetName(Buffer::Control), 0, &control, sizeof(control));
  return this->CheckMemory();
}

void ProgressivePipeline::Release()
{
  this->Streams.Free();
  this->Gpu->Release();
  this->Needs = SceneNeeds();
  this->Volume = PipelineVolume();
  this->VolumeLoaded = false;
  this->Started = false;
}

//------------------------------------------------------------------------------
// The volume
//------------------------------------------------------------------------------
void ProgressivePipeline::SetVolume(const PipelineVolume& volume)
{
  this->Volume = volume;
  this->Size = VolumeSize(volume.Samples);
  this->Levels = GridsOf(volume);
  this->VolumeLoaded = false;
  this->Started = false;
  const LevelGrid& last = this->Levels.back();
  this->Needs.Blocks = last.FirstBlock + last.Size.GetNumberOfBlocks();
  this->Needs.Macrocells = last.FirstMacrocell + last.Size.GetNumberOfMacrocells();
  this->Needs.Levels = !volume.Coarser.empty();
  this->Needs.StoredRanges = static_cast<bool>(volume.Ranges);
  this->Needs.Colored = volume.Colors.Data != nullptr;
  this->Needs.HiddenCells = !volume.Hidden.empty();
  this->Needs.HiddenWords = static_cast<std::int64_t>(volume.Hidden.size());
  this->Needs.HiddenColors = this->Needs.Colored && !volume.HiddenColors.empty();
  this->Needs.HiddenColorWords = static_cast<std::int64_t>(volume.HiddenColors.size());
  this->Policy.Reset(this->Needs.SlotCapacity > 0);
}

void ProgressivePipeline::SetPalette(const std::optional<glsl::Palette>& palette)
{
  this->Gpu->Uniforms.UploadPalette(palette);
}

Status ProgressivePipeline::LoadVolume()
{
  this->Gpu->Timer.Forget();
  this->VolumeLoaded = false;
  this->VolumePrepared = false;
  this->DecodedAtFirst = 0;
  this->MarkedIsovalues.clear();
  Status status = this->Gpu->Buffers.Allocate(Lifetime::Volume, this->Needs);
  if (status && !this->Needs.Cached)
  {
    status = this->Gpu->Buffers.Allocate(Lifetime::Cache, this->Needs);
  }
  if (status)
  {
    status = this->UploadVolume();
  }
  this->VolumeLoaded = status.IsOk();
  return status;
}

Status ProgressivePipeline::UploadVolume()
{
  const Stopwatch stopwatch;
  this->Gpu->Uniforms.Upload(DescribeVolume(this->Levels, this->Volume));
  this->Gpu->Buffers.Upload(Buffer::HiddenCells, this->Volume.Hidden);
  this->Gpu->Buffers.Upload(Buffer::HiddenColors, this->Volume.HiddenColors);
  this->Streams.Free();
  Status status;
  const std::vector<const PipelineLevel*> levels = LevelsOf(this->Volume);
  for (std::size_t i = 0; i < levels.size() && status; ++i)
  {
    status = this->UploadLevel(*levels[i], this->Levels[i]);
  }
  this->UploadMilliseconds = stopwatch.GetMilliseconds();
  return status;
}

Status ProgressivePipeline::UploadLevel(const PipelineLevel& level, const LevelGrid& grid)
{
  Context& gl = this->Gpu->Gl;
  Status status = this->Streams.Upload(gl, Buffer::Stream, level.Values, grid);
  if (status && this->Needs.Colored)
  {
    status = this->Streams.Upload(gl, Buffer::ColorStream, level.Colors, grid);
  }
  if (status && this->Needs.StoredRanges)
  {
    this->UploadRanges(level.Ranges, grid);
  }
  return status;
}

// A part at a time: the host keeps them in another form, and not twice.
void ProgressivePipeline::UploadRanges(const RangeReader& ranges, const LevelGrid& grid)
{
  const std::int64_t bytes = std::int64_t(sizeof(std::uint32_t)) * WordsOfMacrocell(this->Needs);
  const std::int64_t most = HostTransfer::MaximumStagingBytes / bytes;
  const std::int64_t all = grid.Size.GetNumberOfMacrocells();
  const GLuint buffer = this->Gpu->Buffers.GetName(Buffer::Macrocells);
  for (std::int64_t first = 0; first < all; first += most)
  {
    const std::int64_t count = std::min(most, all - first);
    const std::vector<std::uint32_t> words = DescribeMacrocells(ranges, first, count, this->Needs);
    this->Gpu->Transfer.Write(
      buffer, bytes * (grid.FirstMacrocell + first), words.data(), bytes * count);
  }
}

// How far a volume's preparation is: it goes through all blocks once or more often.
struct ProgressivePipeline::Preparation
{
  const std::function<bool(double)>& GoesOn;
  double Rounds = 1.0;
  double Whole = 1.0; ///< items of the present round
  double Done = 0.0;  ///< rounds

  bool Add(std::int64_t items)
  {
    this->Done += static_cast<double>(items) / this->Whole;
    return this->GoesOn(std::min(this->Done / this->Rounds, 1.0));
  }
};

bool ProgressivePipeline::IsLoading() const
{
  const std::set<Stage> stages = StagesOf(Moment::Pass, this->Needs);
  return !this->VolumeLoaded || !this->VolumePrepared ||
    std::any_of(stages.begin(), stages.end(),
      [this](Stage stage)
      { return InfoOf(stage).Compiled == Urgency::AtOnce && !this->Gpu->HasCompiled(stage); });
}

// Where the whole volume is decoded the streams go again.
const Status& ProgressivePipeline::PrepareVolume(const std::function<bool(double)>& goesOn)
{
  if (this->VolumePrepared)
  {
    return this->GetStatus();
  }
  for (const StageInfo& info : PipelineStages()) // their compilation is not to be timed with them
  {
    if (info.IsNeeded(Moment::Volume, this->Needs) && !this->Gpu->Compile(info.Id))
    {
      return this->GetStatus();
    }
  }
  Preparation preparation = { goesOn };
  this->Gpu->Timer.BeginPreparation();
  bool wentOn = this->Needs.Cached || this->DecodeWholeVolume(preparation);
  if (wentOn && !this->Needs.StoredRanges)
  {
    wentOn = this->Needs.Cached ? this->FindRangesByBoxes(preparation)
                                : this->FindRangesOfDecoded(preparation);
  }
  if (wentOn)
  {
    this->Gpu->Timer.EndPreparation();
    this->VolumePrepared = this->GetStatus().IsOk();
  }
  return this->GetStatus();
}

// Does work on a volume's macrocells or blocks by slices, of which none takes the GPU long. Returns
// false if everything has been released meanwhile.
bool ProgressivePipeline::RunSlices(const VolumeSlice& all, Preparation& preparation,
  SliceSize& size, const std::function<VolumeSlice(const VolumeSlice&)>& run)
{
  for (VolumeSlice rest = all; rest.First < rest.End && this->GetStatus();)
  {
    const Stopwatch stopwatch;
    const VolumeSlice done = run(rest);
    Device::Finish();
    size.Record(done.GetItems(), stopwatch.GetMilliseconds());
    rest.First = done.End;
    if (!preparation.Add(done.GetItems()))
    {
      return false;
    }
  }
  return true;
}

// Decodes all blocks, an invocation each, then frees the streams.
bool ProgressivePipeline::DecodeWholeVolume(Preparation& preparation)
{
  preparation.Rounds = (this->Needs.Colored ? 2.0 : 1.0) + (this->Needs.StoredRanges ? 0.0 : 1.0);
  preparation.Whole = static_cast<double>(this->Needs.Blocks);
  for (const Stage stage : { Stage::DecodeBlocks, Stage::DecodeColors })
  {
    if (!InfoOf(stage).IsNeeded(Moment::Volume, this->Needs))
    {
      continue;
    }
    SliceSize size(FirstSlice * glsl::BLOCKS_PER_MACROCELL);
    for (const BoundSegment& segment : this->Streams.GetSegments(stage))
    {
      const std::int64_t first = segment.Place.FirstBlock;
      const auto decode = [&](const VolumeSlice& rest)
      {
        const VolumeSlice slice = { rest.First, std::min(rest.First + size.Get(), rest.End) };
        this->Gpu->DispatchSlice(stage, GroupsFor(stage, slice.GetItems()), slice, {}, &segment);
        this->DecodedAtFirst += slice.GetItems();
        return slice;
      };
      if (!this->RunSlices({ first, first + segment.Place.Blocks }, preparation, size, decode))
      {
        return false;
      }
    }
  }
  this->Streams.Free();
  return true;
}

bool ProgressivePipeline::FindRangesOfDecoded(Preparation& preparation)
{
  preparation.Whole = static_cast<double>(this->Needs.Macrocells);
  SliceSize size(FirstSlice);
  const glsl::BlockBox whole = WholeBox(this->Size).Blocks;
  return this->RunSlices({ 0, this->Needs.Macrocells }, preparation, size,
    [&](const VolumeSlice& rest)
    {
      const VolumeSlice slice = { rest.First, std::min(rest.First + size.Get(), rest.End) };
      this->Gpu->DispatchSlice(Stage::BlockRanges, slice.GetItems(), slice, whole, nullptr);
      return slice;
    });
}

// Decodes boxes of blocks, one after the other, into the cache, which is empty yet: its first slots
// have them until their macrocells' ranges are found. So one program decodes for ranges and rays.
bool ProgressivePipeline::FindRangesByBoxes(Preparation& preparation)
{
  preparation.Whole = static_cast<double>(this->Needs.Macrocells);
  SliceSize size(FirstSlice);
  for (const BoundSegment& segment : this->Streams.GetSegments(Stage::DecodeBlocks))
  {
    const auto find = [&](const VolumeSlice& rest)
    {
      const std::int64_t items = MacrocellsAtATime(this->Size, rest, size.Get());
      const VolumeSlice slice = { rest.First, rest.First + items };
      this->FindRangesOf(slice, segment);
      return slice;
    };
    if (!this->RunSlices(segment.Macrocells, preparation, size, find))
    {
      return false;
    }
  }
  return true;
}

void ProgressivePipeline::FindRangesOf(const VolumeSlice& macrocells, const BoundSegment& segment)
{
  for (VolumeSlice rest = macrocells; rest.First < rest.End;)
  {
    const MacrocellBox box = FirstBox(this->Size, rest, this->Needs.Slots);
    this->Gpu->DispatchSlice(Stage::DecodeBlocks,
      GroupsFor(Stage::DecodeBlocks, box.GetNumberOfBlocks()), {}, box.Blocks, &segment);
    this->DecodedAtFirst += box.GetNumberOfBlocks();
    this->Gpu->DispatchSlice(
      Stage::BlockRanges, box.Macrocells.GetItems(), box.Macrocells, box.Blocks, nullptr);
    rest.First = box.Macrocells.End;
  }
}

Status ProgressivePipeline::DecodeVolume(std::vector<float>& values)
{
  this->Needs = WithWholeVolume(this->Needs);
  this->Gpu->SetNeeds(this->Needs);
  if (Status loaded = this->LoadVolume(); !loaded)
  {
    return loaded;
  }
  if (!this->PrepareVolume([](double) { return true; }))
  {
    return this->GetStatus();
  }
  values.resize(static_cast<std::size_t>(glsl::SAMPLES_PER_BLOCK * this->Needs.Slots));
  this->Gpu->Transfer.Read(this->Gpu->Buffers.GetName(Buffer::CacheValues), 0, values.data(),
    static_cast<std::int64_t>(values.size() * sizeof(float)));
  return this->GetStatus();
}

std::vector<std::uint32_t> ProgressivePipeline::ReadRanges()
{
  const int words = WordsOfMacrocell(this->Needs);
  std::vector<std::uint32_t> all(static_cast<std::size_t>(words * this->Needs.Macrocells));
  this->Gpu->Transfer.Read(this->Gpu->Buffers.GetName(Buffer::Macrocells), 0, all.data(),
    static_cast<std::int64_t>(all.size() * sizeof(std::uint32_t)));
  return all;
}

//------------------------------------------------------------------------------
// The cache
//------------------------------------------------------------------------------
// A cache is left alone while an image is under way, unless the image needs a larger one.
Status ProgressivePipeline::MakeCache(bool newImage)
{
  const std::int64_t most = this->Plan.MaximumSlots;
  const std::int64_t before = this->Needs.Slots;
  std::int64_t slots = before;
  if (before == 0)
  {
    slots = CachePolicy::SlotsAtFirst(this->ViewportPixels, most);
  }
  else if (newImage)
  {
    slots = this->Policy.SlotsForNewImage(before, most, this->SinceImage.GetMilliseconds());
  }
  if (before == 0 || slots < before || !this->Gpu->Buffers.Has(Lifetime::Cache, this->Needs))
  {
    this->RemakeCache(slots);
  }
  else if (slots > before)
  {
    this->GrowCacheAhead(slots);
  }
  return this->GetStatus();
}

// A cache that is made anew is empty: rays ask again for what they still need.
void ProgressivePipeline::RemakeCache(std::int64_t slots)
{
  this->Needs = WithCache(this->Needs, slots);
  if (!this->CheckCache(this->Gpu->Buffers.Allocate(Lifetime::Cache, this->Needs)))
  {
    return;
  }
  this->FillCacheBlock(0, 0);
  const std::int64_t items = std::max(slots, this->Needs.Macrocells);
  this->Gpu->Dispatch(
    Stage::CacheReset, std::min(GroupsFor(Stage::CacheReset, items), MaximumResetGroups));
  this->Policy.Reset(this->Needs.SlotCapacity > 0);
}

// Gives the cache more slots while it keeps what it holds. `ahead`: they are not needed yet.
void ProgressivePipeline::GrowCache(std::int64_t slots, bool ahead)
{
  const SceneNeeds before = this->Needs;
  const CacheGrowth growth = PlanGrowth(this->Plan, before, slots);
  if (!growth.Keeps)
  {
    if (!ahead)
    {
      this->RemakeCache(growth.Slots);
    }
    return;
  }
  this->Needs = WithCache(before, growth.Slots);
  if (!this->CheckCache(this->Gpu->Buffers.Grow(Lifetime::Cache, before, this->Needs)))
  {
    return;
  }
  this->FillCacheBlock(before.Slots, before.MapPages);
  for (const Stage stage : { Stage::CacheUnwind, Stage::CacheGrow })
  {
    this->Gpu->Dispatch(stage, std::min(GroupsFor(stage, this->Needs.Slots), MaximumResetGroups));
  }
  this->Policy.RecordGrowth();
}

// Nobody waits for its programs while there is no need.
void ProgressivePipeline::GrowCacheAhead(std::int64_t slots)
{
  if (this->Gpu->IsReady(Stage::CacheUnwind) && this->Gpu->IsReady(Stage::CacheGrow))
  {
    this->GrowCache(slots, true);
  }
}

void ProgressivePipeline::EndImageOfCache(std::int64_t touchedSlots)
{
  const std::int64_t slots =
    this->Policy.SlotsAfterImage(touchedSlots, this->Needs.Slots, this->Plan.MaximumSlots);
  if (this->Needs.Cached && slots > this->Needs.Slots)
  {
    this->GrowCacheAhead(slots);
  }
}

// Where the GPU has no room for the cache, there is none; the context keeps the error.
bool ProgressivePipeline::CheckCache(const Status& made)
{
  if (!made)
  {
    this->Gpu->Buffers.Free(Lifetime::Cache);
    this->Needs.Slots = 0;
  }
  this->Gpu->SetNeeds(this->Needs);
  return made.IsOk();
}

void ProgressivePipeline::FillCacheBlock(std::int64_t firstNewSlot, std::int64_t firstNewPage)
{
  const SceneNeeds& needs = this->Needs;
  this->Cache.Slots = static_cast<std::uint32_t>(needs.Slots);
  this->Cache.MapPages = static_cast<std::uint32_t>(needs.MapPages);
  this->Cache.SlotCapacity = static_cast<std::uint32_t>(std::max(needs.Slots, needs.SlotCapacity));
  this->Cache.FirstNewSlot = static_cast<std::uint32_t>(firstNewSlot);
  this->Cache.FirstNewPage = static_cast<std::uint32_t>(firstNewPage);
  this->UploadCacheBlock();
  this->PassesBeforeCache = this->Log.GetSubmitted();
}

void ProgressivePipeline::UploadCacheBlock()
{
  this->Cache.CannotGrow = this->Needs.Slots >= this->Plan.MaximumSlots ? 1 : 0;
  this->Cache.SpeculationLimit = static_cast<std::uint32_t>(this->Settings.SpeculationLimit);
  this->Cache.PixelsPerStraggler = this->ChoosePixelsPerStraggler();
  this->Gpu->Uniforms.Upload(this->Cache);
}

std::uint32_t ProgressivePipeline::ChoosePixelsPerStraggler()
{
  if (!InfoOf(Stage::CastStragglers).IsNeeded(Moment::Pass, this->Needs))
  {
    return 0;
  }
  if (this->Settings.PixelsPerStraggler >= 0)
  {
    return static_cast<std::uint32_t>(this->Settings.PixelsPerStraggler);
  }
  // a software renderer has no lanes to keep busy, and its work groups cost much
  const bool wanted = !this->Gpu->Gl.GetLimits().Software;
  // a large program, whose compilation would delay the first picture
  return wanted && this->Shown && this->Gpu->IsReady(Stage::CastStragglers) ? PixelsPerStraggler
                                                                            : 0;
}

// Has the next pass planned with the stages that are compiled by now.
void ProgressivePipeline::UseReadyPrograms()
{
  if (this->Cache.PixelsPerStraggler != this->ChoosePixelsPerStraggler())
  {
    this->UploadCacheBlock();
  }
}

//------------------------------------------------------------------------------
// The scene
//------------------------------------------------------------------------------
Status ProgressivePipeline::SetScene(
  const PipelineScene& scene, const PipelineSettings& settings, bool newImage)
{
  this->ApplySettings(settings);
  if (this->CacheToEmpty)
  {
    this->DropDecodedBlocks();
  }
  this->Gpu->Uniforms.Upload(FixView(scene.View));
  this->Gpu->Uniforms.Upload(scene.Look);
  const SceneNeeds before = this->NeedsOfImage();
  this->UpdateNeeds(scene);
  this->Started = this->Started && !newImage && before.Pixels == this->ImagePixels &&
    before.GetBits() == this->Needs.GetBits();
  this->Shown = this->Shown && before.GetBits() == this->Needs.GetBits();
  return this->MakeRoom(newImage);
}

void ProgressivePipeline::ApplySettings(const PipelineSettings& settings)
{
  if (settings.LargestBuffer != this->Settings.LargestBuffer)
  {
    this->VolumeLoaded = false;
  }
  this->Settings = settings;
  this->Gpu->Gl.LimitBuffers(settings.LargestBuffer);
}

void ProgressivePipeline::DropDecodedBlocks()
{
  this->CacheToEmpty = false;
  this->Started = false;
  if (!this->Needs.Cached)
  {
    this->VolumeLoaded = false;
  }
  else if (this->Needs.Slots > 0)
  {
    this->RemakeCache(this->Needs.Slots);
  }
}

void ProgressivePipeline::UpdateNeeds(const PipelineScene& scene)
{
  const ViewGeometry& view = scene.View;
  for (int axis = 0; axis < 2; ++axis)
  {
    this->Place.Window[axis] = view.WindowSize[axis];
    this->Place.Window[2 + axis] = view.ViewportOrigin[axis];
    this->Place.Size[axis] = view.ViewportSize[axis];
    this->Place.Part[axis] = view.ImageSize[axis];
    this->Place.Part[2 + axis] = view.ImageOrigin[axis];
  }
  this->ImagePixels = static_cast<std::int64_t>(view.ImageSize[0]) * view.ImageSize[1];
  this->ViewportPixels = static_cast<std::int64_t>(view.ViewportSize[0]) * view.ViewportSize[1];
  this->Isovalues.assign(view.Isovalues, view.Isovalues + view.NumberOfIsovalues);
  this->Needs.Detailed = this->Settings.Detailed;
  this->Needs.Lit = scene.Look.NumberOfLights > 0;
  this->Needs.Conservative = this->Needs.Levels && scene.Conservative;
  this->Needs.Translucent = scene.Translucent;
  this->Needs.Obstructed = scene.Obstructed;
  this->Needs.Categories = this->Needs.Colored && scene.Categories;
  this->Needs.SeveralIsovalues = view.NumberOfIsovalues > 1;
  this->Needs.Clipped = view.NumberOfClippingPlanes > 0;
  this->Needs.Cropped = view.DrawnRegions != glsl::ALL_REGIONS;
}

// Makes each buffer as large as the scene needs and the budget allows.
Status ProgressivePipeline::MakeRoom(bool newImage)
{
  const DeviceLimits& limits = this->Gpu->Gl.GetLimits();
  this->Needs = WithReservation(limits, this->Needs);
  const SceneNeeds most = WithPixels(this->Needs, this->ViewportPixels);
  this->Plan = PlanMemory(limits, this->Settings, most);
  if (Status sizes = CheckSizes(limits, WithCache(most, 0)); !sizes)
  {
    this->Started = false;
    return sizes;
  }
  this->Needs.Pixels = RoomForImage(this->Needs.Pixels, this->ImagePixels, this->ViewportPixels,
    newImage ? this->SinceImage.GetMilliseconds() : 0.0);
  const bool reload = !this->VolumeLoaded || this->Plan.Cached != this->Needs.Cached;
  this->FreeForPlan(reload);
  return this->ImagePixels > 0 ? this->MakeBuffers(reload, newImage) : Status();
}

Status ProgressivePipeline::MakeBuffers(bool reload, bool newImage)
{
  Status status = reload ? this->LoadVolume() : Status();
  if (status)
  {
    status = this->Gpu->Buffers.Allocate(Lifetime::Image, this->Needs);
  }
  if (status)
  {
    status = this->Plan.Cached ? this->MakeCache(newImage)
                               : this->Gpu->Buffers.Allocate(Lifetime::Cache, this->Needs);
  }
  return status;
}

// Frees first what the plan wants in another size, so that the sum never exceeds the budget.
void ProgressivePipeline::FreeForPlan(bool reload)
{
  const std::int64_t before = this->Needs.Slots;
  const std::int64_t kept = reload ? 0 : std::min(before, this->Plan.MaximumSlots);
  this->Needs = this->Plan.Cached ? WithCache(this->Needs, kept) : WithWholeVolume(this->Needs);
  this->Started = this->Started && this->Needs.Slots == before && !reload;
  if (reload)
  {
    this->Streams.Free();
    this->VolumeLoaded = false;
  }
  this->Gpu->Buffers.Trim(this->Needs);
  this->Gpu->SetNeeds(this->Needs);
  this->Gpu->Request(Urgency::AtOnce, this->Needs); // they compile while the volume is uploaded
  if (this->Shown)                                  // else they would delay the first picture
  {
    this->Gpu->Request(Urgency::Soon, this->Needs);
  }
  this->UploadCacheBlock();
}

//------------------------------------------------------------------------------
// The image
//------------------------------------------------------------------------------
bool ProgressivePipeline::AwaitPrograms(double milliseconds)
{
  const Stopwatch stopwatch;
  while (this->AwaitsPrograms())
  {
    if (stopwatch.GetMilliseconds() >= milliseconds)
    {
      return false;
    }
  }
  return true;
}

// Goes on compiling for a moment. Returns whether some programs may still be lacking.
bool ProgressivePipeline::AwaitsPrograms()
{
  if (this->Gpu->Gl.GetLimits().Software)
  {
    return false;
  }
  if (this->Gpu->CompilesInBackground() && !this->Gpu->IsReady(Urgency::AtOnce))
  {
    std::this_thread::sleep_for(PollingInterval);
    return true;
  }
  // NVIDIA's driver, too, does a part of the work only now
  return this->Gpu->CompileNext(Urgency::AtOnce);
}

void ProgressivePipeline::Start()
{
  this->Gpu->Snapshots.Clear();
  this->Log.StartImage(this->ImagePixels);
  this->PassesBeforeCache = 0;
  this->Started = true;
  this->Gpu->Timer.StartImage(StagesOf(Moment::Volume, this->Needs));
  if (this->ImagePixels == 0)
  {
    this->SinceImage = Stopwatch();
    return;
  }
  this->MarkBlocks();
  this->ClearImage();
  const std::uint32_t yes = 1;
  this->Gpu->Transfer.Write(this->Gpu->Buffers.GetName(Buffer::Control),
    offsetof(glsl::Control, NewImage), &yes, sizeof(yes));
  if (this->CheckMemory()) // else the stages may never come to an end
  {
    this->Gpu->Dispatch(Stage::PlanPass, 1);
  }
}

// Most images have the isovalues of the last.
void ProgressivePipeline::MarkBlocks()
{
  const auto same = [](const glsl::FloatSum& a, const glsl::FloatSum& b)
  { return a.High == b.High && a.Low == b.Low; };
  if (!std::equal(this->Isovalues.begin(), this->Isovalues.end(), this->MarkedIsovalues.begin(),
        this->MarkedIsovalues.end(), same))
  {
    for (const LevelGrid& grid : this->Levels) // each looks at the marks of the one before
    {
      const std::int64_t count = grid.Size.GetNumberOfMacrocells();
      this->Gpu->DispatchSlice(Stage::MarkBlocks,
        std::min(GroupsFor(Stage::MarkBlocks, count), MaximumResetGroups),
        { grid.FirstMacrocell, grid.FirstMacrocell + count }, {}, nullptr);
    }
    if (InfoOf(Stage::MarkCells).IsNeeded(Moment::Isovalues, this->Needs))
    {
      this->Gpu->Dispatch(Stage::MarkCells, std::min(this->Needs.Macrocells, MaximumResetGroups));
    }
    this->MarkedIsovalues = this->Isovalues;
  }
}

void ProgressivePipeline::ClearImage()
{
  const SceneNeeds needs = this->NeedsOfImage();
  this->Gpu->Buffers.Fill(Buffer::Hits, glsl::NO_HIT, needs);
  this->Gpu->Buffers.Fill(Buffer::Normals, glsl::NO_NORMAL, needs);
  this->Gpu->Buffers.Fill(Buffer::Layers, 0, needs);
  if (needs.Obstructed)
  {
    CaptureDepths(
      this->Place, this->Gpu->Buffers.GetName(Buffer::Hits), HitReadback::GetObstacleOffset(needs));
  }
}

// The algorithm; docs/reference/buffers.md has what flows between the stages. Where the whole
// volume is decoded, one pass casts all rays to their ends.
void ProgressivePipeline::RunPass()
{
  this->UseReadyPrograms();
  this->RunStage(Stage::CacheAges);
  this->RunStage(Stage::CacheEvict);
  this->RunStage(Stage::CastRays);
  this->RunStage(Stage::CastStragglers);
  this->RunStage(Stage::FinishHits);
  this->RunStage(Stage::RequestBlocks);
  this->RunStage(Stage::DecodeBlocks);
  this->RunStage(Stage::DecodeColors);
  this->RunStage(Stage::PlanPass);
  this->Log.AddSubmitted();
  this->Gpu->Timer.EndPass();
  this->Gpu->Snapshots.Request(this->Gpu->Buffers.GetName(Buffer::Control),
    this->Gpu->Buffers.GetName(Buffer::PassStatistics));
}

// Runs a stage if the passes of this scene need it. The GPU decides how many work groups it has.
void ProgressivePipeline::RunStage(Stage stage)
{
  const StageInfo& info = InfoOf(stage);
  if (!info.IsNeeded(Moment::Pass, this->Needs) || this->MayLeaveOut(stage))
  {
    return;
  }
  if (info.GroupsInPass == OneGroup)
  {
    this->Gpu->Dispatch(stage, 1);
  }
  else
  {
    this->Gpu->DispatchIndirect(
      stage, static_cast<std::size_t>(info.GroupsInPass), this->Streams.GetSegments(stage));
  }
}

// Is a stage still being compiled that the passes can do without? The last rays are cast as all
// others are. Nothing has to be evicted until a pass was refused blocks.
bool ProgressivePipeline::MayLeaveOut(Stage stage)
{
  switch (stage)
  {
    case Stage::CastStragglers:
      return this->Cache.PixelsPerStraggler == 0;
    case Stage::CacheAges:
    case Stage::CacheEvict:
      return !this->Log.WasRefusedBlocks() &&
        !(this->Gpu->IsReady(Stage::CacheAges) && this->Gpu->IsReady(Stage::CacheEvict));
    default:
      return false;
  }
}

// The GPU has more work than the CPU knows of; passes that turn out not to be needed have no work
// groups.
void ProgressivePipeline::RunPasses(
  int maximum, double milliseconds, const std::function<bool()>& stop)
{
  const Stopwatch stopwatch;
  const std::int64_t known = this->Log.GetKnown();
  const std::int64_t last =
    maximum > 0 ? this->Log.GetSubmitted() + maximum : std::numeric_limits<std::int64_t>::max();
  bool more = this->Log.GetRemainingRays() > 0 && this->GetStatus();
  while (more || this->Log.AwaitsPasses())
  {
    const std::int64_t submit = this->PassesToSubmit(milliseconds - stopwatch.GetMilliseconds());
    while (more && this->Log.GetSubmitted() < std::min(submit, last))
    {
      this->RunPass();
    }
    if (this->Needs.IsSinglePass())
    {
      this->Log.AssumeComplete();
      this->SinceImage = Stopwatch();
      return;
    }
    this->AwaitPass();
    if (this->Log.GetRemainingRays() == 0 || !this->GetStatus())
    {
      return;
    }
    this->Forecast.RecordTime(this->Log.GetKnown() - known, stopwatch.GetMilliseconds());
    more = more && !stop() && this->Log.GetSubmitted() < last;
    if (!this->Started) // `stop` has released everything
    {
      return;
    }
  }
}

// A software renderer runs its passes at once: none that may not be needed is submitted.
std::int64_t ProgressivePipeline::PassesToSubmit(double millisecondsLeft) const
{
  const bool single = this->Gpu->Gl.GetLimits().Software || this->Needs.IsSinglePass();
  const std::int64_t known = this->Log.GetKnown();
  return single ? known + 1 : this->Forecast.PassesToSubmit(known, millisecondsLeft);
}

// Learns what the next of the submitted passes did.
void ProgressivePipeline::AwaitPass()
{
  const glsl::PassRecord* pass = this->Log.AddKnown(this->Gpu->Snapshots.Await());
  if (pass && this->Log.GetKnown() > this->PassesBeforeCache)
  {
    const std::int64_t slots =
      this->Policy.SlotsAfterPass(*pass, this->Needs.Slots, this->Plan.MaximumSlots);
    if (slots > this->Needs.Slots)
    {
      this->GrowCache(slots, false);
    }
  }
  if (this->Log.GetRemainingRays() == 0)
  {
    this->EndImage();
  }
  if (this->Log.IsStuck())
  {
    this->Gpu->Gl.Fail(Status::Error("makes no progress: the GPU may have been lost; release the "
                                     "graphics resources and render again"));
  }
}

void ProgressivePipeline::EndImage()
{
  this->Gpu->Snapshots.Clear(); // those of passes that were not needed
  this->Log.EndImage();
  this->SinceImage = Stopwatch();
  if (!this->Log.GetPasses().empty())
  {
    this->EndImageOfCache(this->Log.GetPasses().back().TouchedSlots);
    this->Forecast.RecordImage(static_cast<std::int64_t>(this->Log.GetPasses().size()));
  }
}

// A driver without threads of its own compiles nothing here.
void ProgressivePipeline::RequestForClicks()
{
  this->Gpu->Request(Urgency::OnDemand, this->Needs);
  for (const auto feature :
    { &SceneNeeds::SeveralIsovalues, &SceneNeeds::Translucent, &SceneNeeds::Clipped })
  {
    SceneNeeds next = this->Needs;
    next.*feature = true;
    this->Gpu->Request(Urgency::AtOnce, next);
  }
}

void ProgressivePipeline::Composite()
{
  if (this->ImagePixels > 0)
  {
    this->Gpu->Draw(Stage::Composite);
    this->Shown = true;
  }
}

void ProgressivePipeline::Select(const SelectedId& selected)
{
  if (this->ImagePixels > 0)
  {
    this->Gpu->Draw(Stage::Select, &selected);
  }
}

double ProgressivePipeline::GetCompletedFraction() const
{
  if (!this->Started)
  {
    return 0.0;
  }
  const double pixels = static_cast<double>(std::max<std::int64_t>(this->ImagePixels, 1));
  return 1.0 - static_cast<double>(this->Log.GetRemainingRays()) / pixels;
}

HitReadback ProgressivePipeline::GetHits()
{
  return HitReadback(
    this->Gpu->Transfer, this->Gpu->Buffers.GetName(Buffer::Hits), this->NeedsOfImage());
}

//------------------------------------------------------------------------------
// Statistics
//------------------------------------------------------------------------------
void ProgressivePipeline::CompleteStatistics()
{
  while (this->Log.AwaitsPasses())
  {
    this->AwaitPass();
  }
  this->Log.SetTimes(this->Gpu->Timer.GetPassEnds(this->Log.GetPasses().size()));
}

std::vector<std::pair<std::string, std::int64_t>> ProgressivePipeline::GetMemoryUse() const
{
  std::vector<std::pair<std::string, std::int64_t>> use;
  const auto add = [&use](const char* name, std::int64_t bytes)
  {
    if (bytes > 0)
    {
      use.emplace_back(name, bytes);
    }
  };
  for (const BufferInfo& info : PipelineBuffers())
  {
    add(info.Name, this->Gpu->Buffers.GetBytes(info.Id) + this->Streams.GetBytes(info.Id));
  }
  add("scene", UniformBuffers::GetBlockBytes());
  add("palette", this->Gpu->Uniforms.GetPaletteBytes());
  use.emplace_back(
    "staging", this->Gpu->Transfer.GetStagingBytes() + this->Gpu->Snapshots.GetBytes());
  return use;
}
