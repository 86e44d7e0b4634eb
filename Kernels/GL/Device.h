// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL objects of a pipeline in the current context: buffers by their names in
// BufferTable.h, programs by their names in StageTable.h, and how they come together in a
// dispatch. Knows nothing of the algorithm.
#ifndef PipelineResources_h
#define PipelineResources_h

#include "GL/ProgIsoGL.h"
#include "GL/ProgramCache.h"
#include "Shaders/BufferTable.h"
#include "Shaders/ShaderAssembler.h"
#include "Store/StreamSegments.h"

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

/// What the GPU tells the CPU after a pass.
struct Snapshot
{
  ControlBlock Control;
  PassRecord Records[PassRecords];
};

class Device
{
public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  Device& operator=(Device&&) = default;

  /// Check the context, told by a number of its own, and make what is always there; false where it
  /// cannot run the stages.
  bool Initialize(std::uint64_t context);
  bool IsInitialized() const { return this->UniformBuffers[0] != 0; }
  void Release();

  ///@{ The first thing that went wrong since Release().
  bool Fail(const std::string& message);
  const std::string& GetError() const { return this->Error; }
  ///@}

  ///@{ Buffers. Allocate() makes those of a lifetime as an extent wants them, and frees those it
  /// does not want. One that has the size already is kept, else its contents are undefined.
  bool Allocate(Lifetime lifetime, const PipelineExtent& extent);
  bool Has(Lifetime lifetime, const PipelineExtent& extent) const;
  /// Free all that an extent wants in another size: the sum never exceeds what it will be.
  void Trim(const PipelineExtent& extent);
  void Free(Lifetime lifetime);
  void Fill(Buffer buffer, std::uint32_t value);
  std::int64_t GetBytes(Buffer buffer) const;
  /// Did OpenGL run out of memory since it was asked last? Some drivers make it where it is used.
  bool CheckMemory();
  /// Bytes that traffic with the CPU takes now.
  std::int64_t GetStagingBytes() const;
  ///@}

  /// Fill a buffer that the stages only read.
  void Upload(Buffer buffer, const std::vector<std::uint32_t>& words);

  ///@{ A compressed stream, in as many buffers as it takes: of Stream or of ColorStream.
  bool UploadStream(
    Buffer which, const unsigned char* bytes, const std::vector<StreamSegment>& segments);
  void FreeStreams();
  ///@}

  ///@{ Traffic with the CPU. It waits for the GPU only where it reads.
  void Read(Buffer buffer, std::int64_t offset, void* data, std::int64_t bytes);
  void Write(Buffer buffer, std::size_t offset, const void* data, std::size_t bytes);
  /// A uniform block of SceneBlocks.glsl.h.
  void UploadUniforms(int binding, const void* block, std::size_t bytes);
  static std::int64_t GetUniformBytes();
  /// Colours over a range, see Shading.glsl; none: nothing is left of it.
  void UploadPalette(const std::vector<float>& palette);
  std::int64_t GetPaletteBytes() const { return this->PaletteBytes; }
  /// Copy the depths of a part of the current framebuffer (width, height, origin) into a buffer.
  void CaptureDepths(const std::int32_t image[4], Buffer buffer, std::int64_t offset);
  ///@}

  ///@{ Snapshots are ordered now and arrive in that order, without anyone waiting in between.
  void OrderSnapshot();
  int GetOrderedSnapshots() const { return static_cast<int>(this->Ordered.size()); }
  Snapshot AwaitSnapshot();
  void ForgetSnapshots();
  ///@}

  ///@{ Where nothing has gone wrong, run a stage on so many work groups, or on as many as the
  /// control block says at an offset; a
  /// stage that reads the stream once for each of its segments.
  void Dispatch(Stage stage, std::int64_t groups);
  void DispatchIndirect(Stage stage, std::size_t controlOffset);
  ///@}
  /// Draw the viewport with a stage that does, and leave no binding behind.
  void Draw(Stage stage, const std::array<float, 4>* selected = nullptr);

  /// What the scene needs; it chooses the variants of the stages.
  void SetExtent(const PipelineExtent& extent) { this->Extent = extent; }

  ///@{ Stages that have run since they were forgotten, and with detailed statistics their
  /// milliseconds.
  const std::set<Stage>& GetStagesRun() const { return this->StagesRun; }
  void ForgetStages(const std::set<Stage>& except = {});
  std::map<Stage, double> GetStageMilliseconds();
  ///@}

  bool IsSoftware() const { return this->Software; }
  ///@{ Bytes that one storage buffer may have: what OpenGL allows here, or less (0: no less).
  void LimitBuffers(std::int64_t bytes);
  std::int64_t GetLargestBuffer() const { return this->LargestBuffer; }
  ///@}
  /// Bytes of graphics memory that this GPU reports; 0 where it does not tell.
  std::int64_t GetDeviceMemory() const { return this->DeviceMemory; }
  /// Of the context, as long as this is initialized.
  int GetNumberOfGLErrors() const
  {
    return this->Programs ? this->Programs->GLErrors : this->GLErrors;
  }
  static std::string GetDescription();

  /// Bytes that Read(), Write() and snapshots take at most.
  static std::int64_t GetStagingLimit();

private:
  struct Order
  {
    GLuint Buffer;
    GLsync Fence;
  };
  struct Timing
  {
    Stage Id;
    GLuint Begin, End;
  };

  struct StreamBuffers
  {
    std::vector<GLuint> Names;
    std::vector<StreamSegment> Segments;
  };

  bool CheckContext();
  void AskLimits();
  bool Allocate(Buffer buffer, std::int64_t bytes);
  bool MakeBuffer(GLuint& name, std::int64_t bytes, std::int64_t largestPlain, const char* what);
  void Free(Buffer buffer);
  const StreamBuffers* StreamOf(Stage stage) const;
  bool Bind(Stage stage, GLuint stream, const StreamSegment* segment);
  template <typename Launch>
  void Run(Stage stage, const Launch& launch);
  void BeginTiming(Stage stage);
  void EndTiming(Stage stage);

  std::array<GLuint, NumberOfBuffers> Names = {};
  std::array<std::int64_t, NumberOfBuffers> Bytes = {};
  std::map<Buffer, StreamBuffers> Streams;
  std::shared_ptr<ProgramCache> Programs;
  PipelineExtent Extent;

  std::array<GLuint, 4> UniformBuffers = {}; ///< by their bindings, without the palette
  GLuint PaletteBuffer = 0;
  std::int64_t PaletteBytes = 0;
  GLuint Staging = 0; ///< what the CPU reads and writes passes through it
  std::int64_t StagingBytes = 0;
  std::deque<Order> Ordered; ///< snapshots under way, oldest first
  std::vector<GLuint> SpareSnapshots;
  GLuint VertexArray = 0;

  bool Software = false;     ///< no GPU: Mesa's llvmpipe
  bool ByExtensions = false; ///< the context is older than 4.3 but offers what we need
  std::int64_t LargestAllowed = 0;
  std::int64_t LargestBuffer = 0;
  std::int64_t DeviceMemory = 0;
  bool OffersSparse = false; ///< buffers that are committed page by page
  bool CountsErrors = false;
  int GLErrors = 0; ///< until the last Release()
  std::set<Stage> StagesRun;
  std::vector<Timing> Timings; ///< not yet added up
  std::map<Stage, double> StageMilliseconds;
  double TimingStart = 0.0; ///< software renderers: wall clock
  std::string Error;
};

#endif
