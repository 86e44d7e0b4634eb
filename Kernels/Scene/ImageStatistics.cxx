// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ImageStatistics.h"

#include "Pipeline/ProgressivePipeline.h"

#include <limits>
#include <map>

namespace
{
void CollectPasses(const ProgressivePipeline& pipeline, std::int64_t pixels,
  bool distinctBlocksCounted, ImageStatistics& statistics)
{
  const double uncounted = distinctBlocksCounted ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  for (const TimedPass& pass : pipeline.GetPasses())
  {
    PassStatistics row;
    row.Pass = static_cast<double>(statistics.Passes.size());
    row.ActiveRays = pass.ActiveRays;
    row.Speculation = pass.Speculation;
    row.Pairs = pass.Pairs;
    row.VisibleBlocks = pass.VisibleBlocks + uncounted;
    row.ActiveBlocks = pass.ActiveBlocks + uncounted;
    row.DecodedBlocks = pass.DecodedBlocks;
    row.CachedBlocks = pass.CachedBlocks;
    row.Completed = 1.0 - pass.RemainingRays / static_cast<double>(pixels);
    row.ElapsedMilliseconds = pass.ElapsedMilliseconds;
    statistics.Passes.push_back(row);
  }
}

void CollectStages(const std::map<Stage, double>& milliseconds, ImageStatistics& statistics)
{
  for (const StageInfo& info : PipelineStages())
  {
    const auto stage = milliseconds.find(info.Id);
    if (stage != milliseconds.end())
    {
      statistics.Stages.emplace_back(info.Name, stage->second);
    }
    else
    {
      statistics.StagesLeftOut.emplace_back(info.Name);
    }
  }
}

void CollectLoading(ProgressivePipeline& pipeline, ImageStatistics& statistics)
{
  statistics.UploadMilliseconds = pipeline.GetUploadMilliseconds();
  statistics.PreparationMilliseconds = pipeline.GetPreparationMilliseconds();
  statistics.BlocksDecodedAtFirst = static_cast<double>(pipeline.GetBlocksDecodedAtFirst());
  for (const ProgramTime& time : pipeline.GetProgramTimes())
  {
    statistics.Programs.push_back(
      { InfoOf(time.Id).Name, time.Milliseconds, time.WaitedMilliseconds });
  }
}
}

ImageStatistics CollectStatistics(
  ProgressivePipeline& pipeline, std::int64_t pixels, bool distinctBlocksCounted)
{
  ImageStatistics statistics;
  CollectPasses(pipeline, pixels, distinctBlocksCounted, statistics);
  CollectStages(pipeline.GetStages(), statistics);
  CollectLoading(pipeline, statistics);
  statistics.Buffers = pipeline.GetMemoryUse();
  statistics.StreamBytes = pipeline.GetStreamBytes();
  statistics.MemoryBudget = pipeline.GetMemoryPlan().Budget;
  statistics.LeastMemoryBudget = pipeline.GetMemoryPlan().LeastBudget;
  statistics.Converged = pipeline.GetConverged();
  statistics.GLDescription = Context::GetDescription();
  return statistics;
}
