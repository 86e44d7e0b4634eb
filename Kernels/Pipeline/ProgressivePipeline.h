// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Drives the stages of progressive speculative iso-raycasting (Usher, Dyken and Kumar, LDAV 2023)
// on the current OpenGL context. It owns the GPU's objects and knows nothing of VTK's scene: the
// mapper (vtkProgressiveIsosurfaceMapper) translates that into a PipelineScene and calls, in this
// order, SetVolume, SetSettings, SetScene, Start, RunPasses, Composite.
#ifndef ProgressivePipeline_h
#define ProgressivePipeline_h

#include "GL/Device.h"
#include "Pipeline/PipelineScene.h"
#include "Store/CompressedStream.h"

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

/// Samples on a grid, and optionally others on the same grid that give the colours.
struct PipelineVolume
{
  int Samples[3] = { 0, 0, 0 };
  CompressedStream Values;
  CompressedStream Colors;
  std::vector<std::uint32_t> Hidden; ///< cells: see HiddenCells in Buffers.glsl; empty: none
};

struct PipelineSettings
{
  std::int64_t MemoryBudget = 0;  ///< bytes beside the compressed stream; 0: automatic
  std::int64_t LargestBuffer = 0; ///< bytes of one storage buffer; 0: what OpenGL allows
  int SpeculationLimit = glsl::MAX_SPECULATION; ///< 1: off
  bool DecodeWholeVolume = true;                ///< where the budget has room for it
  bool Detailed = false;                        ///< stages are timed, distinct blocks counted
};

struct TimedPass : PassRecord
{
  double ElapsedMilliseconds = 0.0; ///< from the start of the image to the end of the pass
};

/// What a pixel's ray has met. Of a translucent image the key is that of the last hit.
struct PixelHit
{
  std::uint32_t Key = glsl::NO_HIT;
  float Depth = 0.0f;        ///< parameter t of the first hit
  std::uint32_t Surface = 0; ///< first hit's isovalue, among those that show
};

class ProgressivePipeline
{
public:
  ProgressivePipeline() = default;
  ~ProgressivePipeline() = default; // Release() needs a current context
  ProgressivePipeline(const ProgressivePipeline&) = delete;
  ProgressivePipeline& operator=(const ProgressivePipeline&) = delete;
  ProgressivePipeline& operator=(ProgressivePipeline&&) = default;

  /// Check the context, told by a number of its own; false and GetError() where it cannot run the
  /// stages (OpenGL < 4.3).
  bool Initialize(std::uint64_t context);
  /// Delete every GL object. Also needed after an error, before anything else is asked for.
  void Release();

  /// Take another volume.
  void SetVolume(const PipelineVolume& volume);
  void SetSettings(const PipelineSettings& settings);
  /// Colours for the volume that gives them, see Shading.glsl; none where there is no such volume.
  void SetPalette(const std::vector<float>& palette) { this->Gpu.UploadPalette(palette); }
  /// Forget all decoded blocks.
  void EmptyCache();
  /// The image's size, camera, isovalues and look. Makes ready what the scene needs: the volume's
  /// macrocells, the cache, the image's buffers. False and GetError() where the budget or the GPU
  /// has no room. `newImage`: Start() follows.
  bool SetScene(const PipelineScene& scene, bool newImage);

  /// Begin a new image: no ray has begun. Needed first, and where IsStarted() tells so.
  void Start();
  bool IsStarted() const { return this->Started; }
  /// Do passes until the image is complete, `maximum` are done (0: no limit) or `stop` says so
  /// after a pass. With `eager` no pass is submitted before the last one is known to be needed.
  void RunPasses(int maximum, bool eager, const std::function<bool()>& stop);
  /// Draw the image with its depth into the current framebuffer and viewport.
  void Composite() { this->Gpu.Draw(Stage::Composite); }
  /// Draw identifiers instead, for a vtkHardwareSelector; see Select.frag.
  void Select(const std::array<float, 4>& selected) { this->Gpu.Draw(Stage::Select, &selected); }
  /// Wait for what the passes tell of themselves.
  void CompleteStatistics();

  bool GetConverged() const { return this->Started && this->Remaining == 0; }
  double GetCompletedFraction() const;
  ///@{ Bytes: the budget in force, and the least that this scene can work with.
  std::int64_t GetMemoryBudget() const { return this->Budget; }
  std::int64_t GetLeastMemoryBudget() const;
  ///@}
  const std::vector<TimedPass>& GetPasses() const { return this->Passes; }
  Device& GetResources() { return this->Gpu; }
  const std::string& GetError() const { return this->Gpu.GetError(); }
  bool CheckMemory() { return this->Gpu.CheckMemory(); }

  ///@{ Of all pixels, rows from the bottom, or of one: what Hits.glsl holds.
  std::vector<std::uint32_t> ReadHitKeys();
  std::vector<float> ReadHitDepths();
  PixelHit ReadHit(std::int64_t pixel);
  ///@}
  /// Decode the whole volume with the pipeline's own decoder; `values`: 64 for every block.
  bool DecodeVolume(std::vector<float>& values);

private:
  using Clock = std::chrono::steady_clock;

  void UploadCache();
  bool MakeRoom(bool newImage);
  bool MakeCache(std::int64_t most, bool newImage);
  std::int64_t BytesWith(const PipelineExtent& extent) const;
  PipelineExtent WithSlots(std::int64_t slots) const;
  PipelineExtent WholeVolume() const;
  std::int64_t ChooseBudget() const;
  std::int64_t MinimumSlots() const;
  std::int64_t MaximumSlots() const;

  bool UploadStream(Buffer buffer, const CompressedStream& stream);
  bool UploadStreams();
  bool MakeVolumeBuffers();
  bool LoadVolume();
  bool LoadWholeVolume();
  bool ResizeCache(std::int64_t slots);
  void GrowCache(const PassRecord& pass);
  std::int64_t SlotsForRecentImages() const;

  std::vector<std::uint32_t> ReadHits(std::int64_t section);
  void RunStage(Stage stage);
  void RunPass();
  void MarkPassEnd();
  void TakeSnapshot();
  void EndImage();
  double Since(Clock::time_point start) const;

  Device Gpu;
  PipelineVolume Volume;
  PipelineSettings Settings;
  PipelineExtent Extent; ///< what the GPU's buffers are made for
  glsl::Volume Grid = {};
  glsl::Cache Cache = {};
  std::int32_t Viewport[4] = { 0, 0, 0, 0 }; ///< width, height and origin in the window
  std::int64_t Budget = 0;
  bool VolumeLoaded = false;

  bool Started = false;
  std::int64_t Remaining = 0; ///< live rays after the last known pass
  std::int64_t PassesSubmitted = 0;
  std::int64_t PassesKnown = 0;
  std::int64_t CacheAge = 0; ///< the pass before which the cache was made
  int Refusals = 0;          ///< passes in a row, of this cache, that were refused blocks
  int PassesWithoutProgress = 0;
  std::vector<std::int64_t> TouchedSlots; ///< of the last complete images, newest last

  Clock::time_point StartTime;
  std::vector<GLuint> TimeQueries; ///< image start, then one a pass; unused on software renderers
  std::vector<double> PassEnds;    ///< software renderers: milliseconds since the start
  std::vector<TimedPass> Passes;
};

#endif
