// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Shaders/StageTable.h"

#include "Shaders/Glsl.h"

#include <algorithm>
#include <cstddef>

const std::vector<StageInfo>& PipelineStages()
{
  using namespace Conditions;
  using B = Buffer;
  constexpr Access R = Access::Read, W = Access::Write, RW = Access::ReadWrite;
  constexpr Moment Volume = Moment::Volume, Isovalues = Moment::Isovalues, Cache = Moment::Cache,
                   Growth = Moment::Growth, Pass = Moment::Pass, Drawing = Moment::Drawing;
  constexpr Urgency AtOnce = Urgency::AtOnce, Soon = Urgency::Soon, OnDemand = Urgency::OnDemand;
  // clang-format off
  static const std::vector<StageInfo> stages = {
    { Stage::BlockRanges, "BlockRanges", "Store/BlockRanges.comp",
      glsl::BLOCKS_PER_MACROCELL / 2,
      AtOnce, OneGroup,
      { { Volume, UnknownRanges } },
      { { B::Macrocells, W }, { B::HiddenCells, R }, { B::CacheValues, R } } },
    { Stage::MarkBlocks, "MarkBlocks", "Rays/MarkBlocks.comp", 64,
      AtOnce, OneGroup,
      { { Isovalues, Always } },
      { { B::Macrocells, R }, { B::BlockMarks, RW } } },
    { Stage::MarkCells, "MarkCells", "Rays/MarkCells.comp", glsl::BLOCKS_PER_MACROCELL,
      AtOnce, OneGroup,
      { { Isovalues, Decoded } },
      { { B::Macrocells, R }, { B::BlockMarks, RW }, { B::CellMarks, W },
        { B::CacheValues, R } } },
    { Stage::PlanPass, "PlanPass", "Rays/PlanPass.comp", 1,
      AtOnce, OneGroup,
      { { Pass, Always } },
      { { B::Control, RW }, { B::PassStatistics, W } } },
    { Stage::CacheReset, "CacheReset", "Cache/CacheReset.comp", 256,
      AtOnce, OneGroup,
      { { Cache, Cached } },
      { { B::Control, W }, { B::Macrocells, W }, { B::CacheMap, W }, { B::CacheFreeSlots, W } } },
    { Stage::CacheUnwind, "CacheUnwind", "Cache/CacheUnwind.comp", 256,
      Soon, OneGroup,
      { { Growth, Cached } },
      { { B::Control, RW }, { B::CacheFreeSlots, RW } } },
    { Stage::CacheGrow, "CacheGrow", "Cache/CacheGrow.comp", 256,
      Soon, OneGroup,
      { { Growth, Cached } },
      { { B::Control, RW }, { B::CacheMap, RW }, { B::CacheFreeSlots, W } } },
    { Stage::CacheAges, "CacheAges", "Cache/CacheAges.comp", glsl::PASS_AGES,
      Soon, offsetof(glsl::Control, EvictGroups),
      { { Pass, Evicting } },
      { { B::Control, RW }, { B::CacheMap, R } } },
    { Stage::CacheEvict, "CacheEvict", "Cache/CacheEvict.comp", 64,
      Soon, offsetof(glsl::Control, EvictGroups),
      { { Pass, Evicting } },
      { { B::Control, RW }, { B::Macrocells, W }, { B::CacheMap, RW }, { B::CacheFreeSlots, W } } },
    { Stage::CastRays, "CastRays", "Rays/CastRays.comp", 32,
      AtOnce, offsetof(glsl::Control, CastGroups),
      { { Pass, Always } },
      { { B::Control, RW }, { B::Macrocells, R, Cached }, { B::BlockMarks, R },
        { B::CellMarks, R }, { B::CacheMap, RW }, { B::CacheValues, R }, { B::Hits, RW },
        { B::Rays, RW }, { B::CacheSeen, RW } } },
    { Stage::CastStragglers, "CastStragglers", "Rays/CastStragglers.comp", 32,
      Soon, offsetof(glsl::Control, StragglerGroups),
      { { Pass, Straggling } },
      { { B::Control, RW }, { B::Macrocells, R, Cached }, { B::BlockMarks, R },
        { B::CellMarks, R }, { B::CacheMap, RW }, { B::CacheValues, R }, { B::Hits, RW },
        { B::Rays, RW }, { B::CacheSeen, RW } } },
    { Stage::FinishHits, "FinishHits", "Surface/FinishHits.comp", 64,
      AtOnce, offsetof(glsl::Control, FinishGroups),
      { { Pass, FinishedHits } },
      { { B::Control, RW }, { B::Macrocells, RW }, { B::CacheMap, RW }, { B::CacheValues, R },
        { B::CacheRequests, W }, { B::Hits, RW }, { B::Normals, W }, { B::Layers, RW },
        { B::Rays, RW } } },
    { Stage::RequestBlocks, "RequestBlocks", "Cache/RequestBlocks.comp", 64,
      AtOnce, offsetof(glsl::Control, RequestGroups),
      { { Pass, Cached } },
      { { B::Control, RW }, { B::Macrocells, RW }, { B::BlockMarks, R }, { B::CacheMap, RW },
        { B::CacheRequests, W }, { B::Hits, R }, { B::Rays, R } } },
    { Stage::DecodeBlocks, "DecodeBlocks", "Store/DecodeBlocks.comp", 32,
      AtOnce, offsetof(glsl::Control, DecodeGroups),
      { { Volume, DecodedAtFirst }, { Pass, Cached } },
      { { B::Control, RW }, { B::Stream, R }, { B::HiddenCells, R }, { B::Macrocells, RW },
        { B::CacheMap, RW }, { B::CacheFreeSlots, RW }, { B::CacheRequests, R },
        { B::CacheValues, W } } },
    { Stage::DecodeColors, "DecodeColors", "Store/DecodeColors.comp", 32,
      AtOnce, offsetof(glsl::Control, DecodeGroups),
      { { Volume, DecodedColors }, { Pass, CachedColors } },
      { { B::Control, R }, { B::ColorStream, R }, { B::HiddenColors, R }, { B::Macrocells, R },
        { B::CacheMap, R },
        { B::CacheRequests, R }, { B::CacheValues, W } } },
    { Stage::Composite, "Composite", "Output/Composite.frag", 0,
      AtOnce, OneGroup,
      { { Drawing, Always } },
      { { B::Hits, R }, { B::Normals, R }, { B::Layers, R } } },
    { Stage::Select, "Select", "Output/Select.frag", 0,
      OnDemand, OneGroup,
      { { Drawing, Always } },
      { { B::Hits, R } } },
  };
  // clang-format on
  return stages;
}

const StageInfo& InfoOf(Stage stage)
{
  return PipelineStages()[static_cast<std::size_t>(stage)];
}

bool StageInfo::IsNeeded(Moment moment, const SceneNeeds& needs) const
{
  return std::any_of(this->Runs.begin(), this->Runs.end(),
    [&](const StageRun& run) { return run.When == moment && run.Needed.Holds(needs); });
}

bool StageInfo::IsNeeded(const SceneNeeds& needs) const
{
  return std::any_of(this->Runs.begin(), this->Runs.end(),
    [&](const StageRun& run) { return run.Needed.Holds(needs); });
}

std::vector<Buffer> StageInfo::BuffersOf(const SceneNeeds& needs) const
{
  std::vector<Buffer> bound;
  for (const BufferUse& use : this->Buffers)
  {
    const BufferInfo& buffer = PipelineBuffers()[static_cast<std::size_t>(use.Id)];
    if (use.Needed.Holds(needs) && buffer.IsNeeded(needs))
    {
      bound.push_back(use.Id);
    }
  }
  return bound;
}

Access StageInfo::AccessTo(Buffer buffer) const
{
  for (const BufferUse& use : this->Buffers)
  {
    if (use.Id == buffer)
    {
      return use.How;
    }
  }
  return Access::None;
}

std::vector<Stage> ProgramsOf(Urgency urgency, const SceneNeeds& needs)
{
  std::vector<Stage> stages;
  for (const StageInfo& info : PipelineStages())
  {
    if (info.Compiled == urgency && info.IsNeeded(needs))
    {
      stages.push_back(info.Id);
    }
  }
  return stages;
}

std::int64_t GroupsFor(Stage stage, std::int64_t items)
{
  const int size = InfoOf(stage).GroupSize;
  return (items + size - 1) / size;
}
