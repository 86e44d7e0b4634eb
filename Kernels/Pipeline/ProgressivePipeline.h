// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Drives the stages of progressive speculative iso-raycasting (Usher, Dyken and Kumar, LDAV 2023)
// on the current OpenGL context. It owns the GPU's objects and knows nothing of VTK: the mapper
// translates VTK's scene into a PipelineScene.
//
// For a frame the mapper calls SetScene, then Start where no image is under way, RunPasses until
// GetConverged or as long as there is time, and Composite.
#ifndef ProgressivePipeline_h
#define ProgressivePipeline_h

#include "GL/DepthCapture.h"
#include "GL/Device.h"
#include "GL/Stopwatch.h"
#include "Pipeline/CachePolicy.h"
#include "Pipeline/HitReadback.h"
#include "Pipeline/MemoryPlan.h"
#include "Pipeline/PassForecast.h"
#include "Pipeline/PassLog.h"
#include "Pipeline/PipelineScene.h"
#include "Pipeline/PipelineSettings.h"
#include "Pipeline/PipelineVolume.h"
#include "Pipeline/SliceSize.h"
#include "Store/StreamStore.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

class ProgressivePipeline
{
public:
  ProgressivePipeline() = default;
  ~ProgressivePipeline() = default; // Release() needs a current context
  ProgressivePipeline(const ProgressivePipeline&) = delete;
  ProgressivePipeline& operator=(const ProgressivePipeline&) = delete;
  ProgressivePipeline& operator=(ProgressivePipeline&&) = default;

  /// Opens the current context, which `contextId` identifies. An error where it cannot run the
  /// stages.
  Status Initialize(std::uint64_t contextId);
  /// Deletes every OpenGL object, and forgets the error: after one, nothing else works before.
  void Release();

  /// Replaces the volume; it is uploaded when a scene needs it.
  void SetVolume(const PipelineVolume& volume);
  /// Colours for the volume that gives them, see Shading.glsl; empty without such a volume.
  void SetPalette(const std::optional<glsl::Palette>& palette);
  /// Forgets all decoded blocks before the next scene.
  void EmptyCache() { this->CacheToEmpty = true; }
  /// Makes ready what the scene needs: the volume's macrocells, the cache, the image's buffers. An
  /// error where the GPU has no room; GetStatus() has it, too, unless it follows from the volume's
  /// size alone. `newImage`: the last image is not to go on.
  /// For an image without pixels nothing is made, and no stage runs.
  Status SetScene(const PipelineScene& scene, const PipelineSettings& settings, bool newImage);

  /// Waits until the programs that any picture needs are compiled, but not much longer than so many
  /// milliseconds: where the driver compiles nothing in the background, for one of them at least.
  /// Returns false if some are not. A software renderer compiles when a stage first runs: it does
  /// not wait.
  bool AwaitPrograms(double milliseconds);
  /// Has the volume been uploaded? It has for the scene after it, unless that wants it otherwise.
  bool IsVolumeLoaded() const { return this->VolumeLoaded; }
  /// Is the volume still to be uploaded or prepared, or does a program lack that every pass runs?
  bool IsLoading() const;
  /// Prepares the volume once it is loaded: decodes it if it is to be decoded whole, and finds the
  /// values' range in each block, unless it came with the volume. Waits for the programs. `goesOn`
  /// gets the fraction that is done, from time to time; false: everything has been released
  /// meanwhile.
  const Status& PrepareVolume(const std::function<bool(double)>& goesOn);
  /// Starts an image of the prepared volume.
  void Start();
  /// Is an image under way, or complete, that the scene lets go on?
  bool IsStarted() const { return this->Started; }
  /// Runs passes until the image is complete, `maximum` are done (0: no limit) or `stop`, which is
  /// asked after each pass, says so. `milliseconds`: there is time for those passes that are
  /// expected to take no longer.
  void RunPasses(int maximum, double milliseconds, const std::function<bool()>& stop);
  bool GetConverged() const { return this->Started && this->Log.GetRemainingRays() == 0; }
  double GetCompletedFraction() const;

  /// Has the driver compile what a click on the complete image may need next: stages on demand, and
  /// those of the scene with a second isovalue, translucent, or clipped.
  void RequestForClicks();
  /// Draws the image with its depth into the current framebuffer. The viewport is the image's part
  /// of the window.
  void Composite();
  /// Draws identifiers instead, for a vtkHardwareSelector; see Select.frag.
  void Select(const SelectedId& selected);
  /// What the rays have met so far.
  HitReadback GetHits();
  /// Decodes the whole volume with the pipeline's own decoder; `values`: 64 for each block.
  Status DecodeVolume(std::vector<float>& values);
  /// The words of the prepared volume's macrocells: see WordsOfMacrocell().
  std::vector<std::uint32_t> ReadRanges();

  /// The first error since Initialize().
  const Status& GetStatus() const { return this->Gpu->Gl.GetStatus(); }
  const Status& CheckMemory() { return this->Gpu->Gl.CheckMemory(); }
  int GetNumberOfGLErrors() const { return this->Gpu->GetNumberOfGLErrors(); }

  ///@{ Statistics of the image.
  /// Waits for the records and times of all passes.
  void CompleteStatistics();
  const std::vector<TimedPass>& GetPasses() const { return this->Log.GetPasses(); }
  /// The stages that ran, with their milliseconds if the settings are detailed.
  const std::map<Stage, double>& GetStages() { return this->Gpu->Timer.GetStages(); }
  /// Name and bytes of everything on the GPU.
  std::vector<std::pair<std::string, std::int64_t>> GetMemoryUse() const;
  /// Bytes of the compressed streams, which are part of it.
  std::int64_t GetStreamBytes() const
  {
    return this->Streams.GetBytes(Buffer::Stream) + this->Streams.GetBytes(Buffer::ColorStream);
  }
  const MemoryPlan& GetMemoryPlan() const { return this->Plan; }
  ///@}

  ///@{ What was done before the first image of a volume, in milliseconds.
  double GetUploadMilliseconds() const { return this->UploadMilliseconds; }
  /// Blocks that were decoded, of which some may count twice, or colours too.
  std::int64_t GetBlocksDecodedAtFirst() const { return this->DecodedAtFirst; }
  double GetPreparationMilliseconds() { return this->Gpu->Timer.GetPreparationMilliseconds(); }
  std::vector<ProgramTime> GetProgramTimes() const { return this->Gpu->GetProgramTimes(); }
  ///@}

private:
  void ApplySettings(const PipelineSettings& settings);
  void DropDecodedBlocks();
  void UpdateNeeds(const PipelineScene& scene);
  Status MakeRoom(bool newImage);
  Status MakeBuffers(bool reload, bool newImage);
  SceneNeeds NeedsOfImage() const { return WithPixels(this->Needs, this->ImagePixels); }
  void FreeForPlan(bool reload);
  Status LoadVolume();
  Status UploadVolume();
  Status UploadLevel(const PipelineLevel& level, const LevelGrid& grid);
  void UploadRanges(const RangeReader& ranges, const LevelGrid& grid);
  struct Preparation;
  bool RunSlices(const VolumeSlice& all, Preparation& preparation, SliceSize& size,
    const std::function<VolumeSlice(const VolumeSlice&)>& run);
  bool DecodeWholeVolume(Preparation& preparation);
  bool FindRangesOfDecoded(Preparation& preparation);
  bool FindRangesByBoxes(Preparation& preparation);
  void FindRangesOf(const VolumeSlice& macrocells, const BoundSegment& segment);
  Status MakeCache(bool newImage);
  void RemakeCache(std::int64_t slots);
  void GrowCache(std::int64_t slots, bool ahead);
  void GrowCacheAhead(std::int64_t slots);
  void EndImageOfCache(std::int64_t touchedSlots);
  void FillCacheBlock(std::int64_t firstNewSlot, std::int64_t firstNewPage);
  bool CheckCache(const Status& made);
  void UploadCacheBlock();
  std::uint32_t ChoosePixelsPerStraggler();
  void UseReadyPrograms();
  bool AwaitsPrograms();
  void MarkBlocks();
  void ClearImage();
  void RunPass();
  void RunStage(Stage stage);
  bool MayLeaveOut(Stage stage);
  std::int64_t PassesToSubmit(double millisecondsLeft) const;
  void AwaitPass();
  void EndImage();

  std::unique_ptr<Device> Gpu = std::make_unique<Device>(); ///< its parts know each other's places
  StreamStore Streams;
  PipelineVolume Volume;
  VolumeSize Size;               ///< of the volume itself
  std::vector<LevelGrid> Levels; ///< of detail, the volume itself first
  PipelineSettings Settings;
  SceneNeeds Needs; ///< of the scene, which the GPU's buffers are made for
  glsl::Cache Cache = {};
  ///@{ Of the scene, and those that blocks are marked for.
  std::vector<glsl::FloatSum> Isovalues, MarkedIsovalues;
  ///@}
  DepthPlace Place; ///< of the image
  std::int64_t ImagePixels = 0;
  std::int64_t ViewportPixels = 0;
  MemoryPlan Plan;
  CachePolicy Policy;
  PassLog Log;
  PassForecast Forecast;
  bool VolumeLoaded = false;
  bool VolumePrepared = false;
  bool Shown = false; ///< a picture has been, of a scene that needs the same programs
  std::int64_t DecodedAtFirst = 0;
  double UploadMilliseconds = 0.0;
  bool CacheToEmpty = false;
  bool Started = false;
  std::int64_t PassesBeforeCache = 0; ///< submitted before the cache got its size
  Stopwatch SinceImage;               ///< the last one
};

#endif
