// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Drives the stages of progressive speculative iso-raycasting (Usher, Dyken and Kumar, LDAV 2023) on the
// current OpenGL context. It owns the GPU's objects and knows nothing of VTK's scene: the mapper
// (vtkProgressiveIsosurfaceMapper) translates that into a SceneBlock and calls, in this order,
// SetVolume, SetScene, Start, RunPasses, ShadeHits, Composite.
#ifndef ProgressivePipeline_h
#define ProgressivePipeline_h

#include "PipelineBuffers.h"
#include "PipelineStages.h"
#include "ProgIsoGL.h"
#include "SceneBlock.h"

#include <array>
#include <chrono>
#include <functional>
#include <set>
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
  /// Bounds of the block cache in bytes (0: automatic) and the greatest speculation count (1: off).
  void SetLimits(std::int64_t cacheBytes, int speculation);
  /// The image's size, camera, isovalue and look; the pipeline fills in what it knows itself.
  bool SetScene(const SceneBlock& scene);

  /// Begin a new image: all rays at the volume's border.
  void Start();
  /// Do passes until the image is complete, `maximum` are done (0: no limit) or `stop` says so after a
  /// pass. With `eager` no pass is submitted before the last one is known to be needed.
  void RunPasses(int maximum, bool eager, const std::function<bool()>& stop);
  /// Shade the hits that have come in. `again`: all of them, for a new look.
  void ShadeHits(bool again);
  /// Draw the image with its depth into the current framebuffer and viewport.
  void Composite();

  bool GetConverged() const { return this->Started && this->Remaining == 0; }
  double GetCompletedFraction() const;
  const std::vector<TimedPass>& GetPasses() const { return this->Passes; }
  const std::set<Stage>& GetStagesRun() const { return this->StagesRun; }
  std::int64_t GetBufferBytes(Buffer buffer) const { return this->Bytes[static_cast<int>(buffer)]; }
  std::int64_t GetSceneBytes() const { return this->SceneBuffer ? sizeof(SceneBlock) : 0; }
  const SceneBlock& GetScene() const { return this->Scene; }
  const std::string& GetError() const { return this->Error; }
  std::string GetDescription() const;
  int GetNumberOfGLErrors() const { return this->GLErrors; }

  /// Hit keys of all pixels, rows from the bottom (see Rays.glsl), and the parameter one stands for.
  std::vector<std::uint32_t> ReadHitKeys();
  /// Decode blocks first … first + count - 1 with the pipeline's own decoder: 64 values each.
  bool DecodeBlocks(std::int64_t first, std::int64_t count, float* values);

private:
  using Clock = std::chrono::steady_clock;

  bool CheckContext();
  GLuint Program(Stage stage);
  void Bind(Stage stage);
  void Dispatch(Stage stage, std::int64_t groupsX, std::int64_t groupsY = 1);
  void DispatchIndirect(Stage stage, std::size_t controlOffset);
  bool Allocate(Buffer buffer, std::int64_t bytes);
  bool AllocateAll(Lifetime lifetime);
  void Free(Buffer buffer);
  void Fill(Buffer buffer, std::uint32_t value);
  template <typename T>
  T Read(Buffer buffer);
  void Write(Buffer buffer, std::size_t offset, const void* data, std::size_t bytes);
  void WriteControl(std::size_t offset, std::uint32_t value);
  void UploadScene();

  void RunPass();
  void EvictBlocks();
  void ReadPassRecords();
  void MarkPassEnd();
  std::int64_t MaximumSlots() const;
  bool ResizeCache(std::int64_t slots);
  bool GrowCache();
  double Since(Clock::time_point start) const;
  bool Fail(const std::string& message);

  std::array<GLuint, NumberOfBuffers> Names = {};
  std::array<std::int64_t, NumberOfBuffers> Bytes = {};
  std::array<GLuint, NumberOfStages> Programs = {};
  GLuint SceneBuffer = 0;
  GLuint Staging = 0; ///< what the CPU reads and writes passes through it
  GLuint VertexArray = 0;
  std::vector<GLuint> TimeQueries; ///< image start, then one a pass; unused on software renderers

  PipelineExtent Extent;
  PipelineVolume Volume;
  SceneBlock Scene;
  std::int64_t CacheLimit = 0;
  int SpeculationLimit = 64;
  bool SoftwareRenderer = false;
  bool ByExtensions = false; ///< the context is older than 4.3 but offers what we need

  bool Started = false;
  std::int64_t Remaining = 0; ///< live rays after the last known pass
  std::int64_t PassesSubmitted = 0;
  Clock::time_point StartTime;
  std::vector<double> PassEnds; ///< software renderers: milliseconds since the start
  std::vector<TimedPass> Passes;
  std::set<Stage> StagesRun;
  std::string Error;
  int GLErrors = 0;
};

#endif
