// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Runs the stages of StageTable.h on the buffers of BufferTable.h, in the current OpenGL context.
// Knows nothing of the algorithm.
#ifndef Device_h
#define Device_h

#include "GL/Context.h"
#include "GL/HostTransfer.h"
#include "GL/ProgramCache.h"
#include "GL/SnapshotQueue.h"
#include "GL/StageTimer.h"
#include "GL/StorageBuffers.h"
#include "GL/UniformBuffers.h"
#include "GL/VolumeSlice.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

/// A part of a compressed stream as a stage sees it, and the macrocells whose blocks it holds.
struct BoundSegment
{
  GLuint Buffer;
  glsl::Segment Place;
  VolumeSlice Macrocells;
};

/// What Select.frag draws: a colour, or 24 bits of the id of the image's cell or point that was
/// hit.
struct SelectedId
{
  std::array<float, 3> Color = {};
  int IdPart = 0;         ///< 0: the colour, 1: the low bits, 2: the high bits
  bool OfPoints = false;  ///< the id is a point's
  bool IsCentred = false; ///< samples lie in the centres of cells
  /// The volume's first sample, among the points or cells that have ids, and their numbers.
  std::array<int, 3> FirstSample = {}, Ids = {};
};

class Device
{
public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Opens the current context, which `contextId` identifies. An error where it cannot run the
  /// stages.
  Status Initialize(std::uint64_t contextId);
  bool IsInitialized() const { return this->Programs != nullptr; }
  /// Deletes every OpenGL object, and forgets the error.
  void Release();

  ///@{ The device's parts.
  Context Gl;
  StorageBuffers Buffers{ this->Gl };
  UniformBuffers Uniforms;
  HostTransfer Transfer;
  SnapshotQueue Snapshots{ this->Gl };
  StageTimer Timer;
  ///@}

  /// Chooses the variants of the stages by what the scene needs.
  void SetNeeds(const SceneNeeds& needs);

  /// Has the programs of a scene compiled in the background: see ProgramCache.
  void Request(Urgency urgency, const SceneNeeds& needs);
  ///@{ The programs of the chosen variants.
  bool IsReady(Stage stage);
  bool IsReady(Urgency urgency);
  /// Has somebody waited for a stage's?
  bool HasCompiled(Stage stage) const { return this->Programs->HasGiven(stage, this->Needs); }
  /// Compiles a stage's, and waits for it.
  const Status& Compile(Stage stage);
  /// Compiles the next one, and waits for it. Returns whether there was one left.
  bool CompileNext(Urgency urgency);
  bool CompilesInBackground() const { return this->Programs->CompilesInBackground(); }
  std::vector<ProgramTime> GetProgramTimes() const;
  ///@}

  ///@{ Runs a stage with so many work groups, or as many as the control block says at an offset. A
  /// stage that reads a stream runs once for each of its segments. Nothing runs after an error.
  void Dispatch(Stage stage, std::int64_t groups);
  void DispatchIndirect(
    Stage stage, std::size_t controlOffset, const std::vector<BoundSegment>& segments = {});
  ///@}
  /// Runs a stage with so many work groups on a part of a whole volume: macrocells, blocks or a
  /// box of decoded blocks, as the stage takes them. A segment of the stream holds the blocks
  /// (null: the stage reads no stream).
  void DispatchSlice(Stage stage, std::int64_t groups, const VolumeSlice& slice,
    const glsl::BlockBox& box, const BoundSegment* segment);
  /// Waits until the GPU has done all that it was given.
  static void Finish() { glFinish(); }
  /// Draws the viewport with a stage, and leaves no binding behind.
  void Draw(Stage stage, const SelectedId* selected = nullptr);

  /// OpenGL errors in the context, where they are counted; after Release() those until then.
  int GetNumberOfGLErrors() const;

private:
  GLuint Bind(Stage stage, const BoundSegment* segment);
  template <typename Launch>
  void Run(Stage stage, const std::vector<BoundSegment>& segments, const Launch& launch);

  std::shared_ptr<ProgramCache> Programs;
  SceneNeeds Needs;
  GLuint VertexArray = 0;
  int GLErrors = 0; ///< until the last Release()
};

#endif
