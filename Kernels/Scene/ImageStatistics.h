// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What an image cost, as vtkProgressiveIsosurfaceStatistics shows it.
#ifndef ImageStatistics_h
#define ImageStatistics_h

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

class ProgressivePipeline;

/// A pass of the image: see vtkProgressiveIsosurfaceStatistics for the meaning of each member.
struct PassStatistics
{
  double Pass;
  double ActiveRays;
  double Speculation;
  double Pairs;
  double VisibleBlocks;
  double ActiveBlocks;
  double DecodedBlocks;
  double CachedBlocks;
  double Completed;
  double ElapsedMilliseconds;
};

/// A column of the table of passes, and the member that it shows.
struct PassColumn
{
  const char* Name;
  double PassStatistics::*Value;
};

constexpr PassColumn PassColumns[] = {
  { "pass", &PassStatistics::Pass },
  { "active_rays", &PassStatistics::ActiveRays },
  { "speculation", &PassStatistics::Speculation },
  { "pairs", &PassStatistics::Pairs },
  { "visible_blocks", &PassStatistics::VisibleBlocks },
  { "active_blocks", &PassStatistics::ActiveBlocks },
  { "decoded_blocks", &PassStatistics::DecodedBlocks },
  { "cached_blocks", &PassStatistics::CachedBlocks },
  { "completed", &PassStatistics::Completed },
  { "elapsed_ms", &PassStatistics::ElapsedMilliseconds },
};

/// A stage's program: until it was compiled, and for how long Render() could do nothing else.
struct ProgramStatistics
{
  std::string Stage;
  double Milliseconds;
  double WaitedMilliseconds;
};

struct ImageStatistics
{
  std::vector<PassStatistics> Passes;
  double TotalMilliseconds = 0.0; ///< spent in Render() on this image
  double InputMilliseconds = 0.0; ///< reading and compressing
  double UploadMilliseconds = 0.0;
  double PreparationMilliseconds = 0.0;
  double BlocksDecodedAtFirst = 0.0;
  std::vector<ProgramStatistics> Programs;
  std::vector<std::pair<std::string, std::int64_t>> Buffers; ///< names and bytes
  std::int64_t StreamBytes = 0;                              ///< of the compressed streams
  std::int64_t HostBytes = 0;                                ///< beside the inputs
  std::int64_t MemoryBudget = 0;
  std::int64_t LeastMemoryBudget = 0;
  std::vector<std::pair<std::string, double>> Stages; ///< that ran, and their milliseconds
  std::vector<std::string> StagesLeftOut;
  std::vector<std::int64_t> LevelPixels; ///< hits in each level of detail
  double UncertainFraction = 0.0;        ///< of the pixels: levels may hide something there
  bool Converged = false;
  std::string GLDescription;
};

/// Collects what the pipeline knows of its present image. Without `distinctBlocksCounted` the
/// numbers of visible and active blocks are NaN.
ImageStatistics CollectStatistics(
  ProgressivePipeline& pipeline, std::int64_t pixels, bool distinctBlocksCounted);

#endif
