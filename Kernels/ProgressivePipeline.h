// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Drives the stages of progressive speculative iso-raycasting (Usher, Dyken and Kumar, LDAV 2023)
// on the current OpenGL context. It owns the GPU's objects and knows nothing of VTK's scene: the
// mapper (vtkProgressiveIsosurfaceMapper) translates that into a SceneBlock and calls, in this
// order, SetVolume, SetScene, Start, RunPasses, ShadeHits, Composite.
#ifndef ProgressivePipeline_h
#define ProgressivePipeline_h

#include "PipelineResources.h"

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

/// A fixed-rate ZFP stream of 4^3 blocks and the grid it stands for.
struct PipelineVolume
{
  const unsigned char* Stream = nullptr;
  std::int64_t StreamBytes = 0;
  int Samples[3] = { 0, 0, 0 };
  int BlockBits = 0;
};

struct TimedPass : PassRecord
{
  double ElapsedMilliseconds = 0.0; ///< from the start of the image to the end of the pass
};

class ProgressivePipeline
{
public:
  ProgressivePipeline() = default;
  ~ProgressivePipeline() = default; // Release() needs a current context
  ProgressivePipeline(const ProgressivePipeline&) = delete;
  void operator=(const ProgressivePipeline&) = delete;

  /// Check the context; false and GetError() where it cannot run the stages (OpenGL < 4.3).
  bool Initialize();
  /// Delete every GL object.
  void Release();

  /// Upload a volume and compute its macrocell grid. What the cache held is void.
  bool SetVolume(const PipelineVolume& volume);
  /// Bounds of the block cache in bytes (0: automatic), the greatest speculation count (1: off),
  /// and the number of rays from which on a block's rays are grouped (negative: automatic).
  void SetLimits(std::int64_t cacheBytes, int speculation, int grouping);
  /// The image's size, camera, isovalue and look; the pipeline fills in what it knows itself.
  bool SetScene(const SceneBlock& scene);

  /// Begin a new image: all rays at the volume's border.
  void Start();
  /// Do passes until the image is complete, `maximum` are done (0: no limit) or `stop` says so
  /// after a pass. With `eager` no pass is submitted before the last one is known to be needed.
  void RunPasses(int maximum, bool eager, const std::function<bool()>& stop);
  /// Shade the hits that have come in. `again`: all of them, for a new look.
  void ShadeHits(bool again);
  /// Draw the image with its depth into the current framebuffer and viewport.
  void Composite() { this->Gpu.DrawComposite(); }

  bool GetConverged() const { return this->Started && this->Remaining == 0; }
  double GetCompletedFraction() const;
  const std::vector<TimedPass>& GetPasses() const { return this->Passes; }
  const PipelineResources& GetResources() const { return this->Gpu; }
  const SceneBlock& GetScene() const { return this->Scene; }
  const std::string& GetError() const { return this->Gpu.GetError(); }

  /// Hit keys of all pixels, rows from the bottom (see Rays.glsl), and the parameter one stands
  /// for.
  std::vector<std::uint32_t> ReadHitKeys();
  /// Decode blocks first … first + count - 1 with the pipeline's own decoder: 64 values each.
  bool DecodeBlocks(std::int64_t first, std::int64_t count, float* values);

private:
  using Clock = std::chrono::steady_clock;

  ControlBlock ReadControl();
  void WriteControl(std::size_t offset, std::uint32_t value);

  void RunPass();
  void EvictBlocks();
  void ReadPassRecords();
  void MarkPassEnd();
  std::int64_t MaximumSlots() const;
  bool ResizeCache(std::int64_t slots);
  bool GrowCache();
  double Since(Clock::time_point start) const;

  PipelineResources Gpu;
  std::vector<GLuint> TimeQueries; ///< image start, then one a pass; unused on software renderers

  PipelineExtent Extent;
  SceneBlock Scene;
  std::int64_t CacheLimit = 0;
  int SpeculationLimit = 64;
  int GroupingThreshold = 0;

  bool Started = false;
  std::int64_t Remaining = 0; ///< live rays after the last known pass
  std::int64_t PassesSubmitted = 0;
  Clock::time_point StartTime;
  std::vector<double> PassEnds; ///< software renderers: milliseconds since the start
  std::vector<TimedPass> Passes;
};

#endif
