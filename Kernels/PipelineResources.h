// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL objects of a pipeline in the current context: buffers by their names in
// PipelineBuffers.h, programs by their names in PipelineStages.h, and how they come together in a
// dispatch. Knows nothing of the algorithm.
#ifndef PipelineResources_h
#define PipelineResources_h

#include "PipelineBuffers.h"
#include "PipelineStages.h"
#include "ProgIsoGL.h"
#include "SceneBlock.h"

#include <array>
#include <cstdint>
#include <set>
#include <string>

class PipelineResources
{
public:
  PipelineResources() = default;
  PipelineResources(const PipelineResources&) = delete;
  void operator=(const PipelineResources&) = delete;

  static constexpr std::int64_t LargestBuffer = 2147483647; ///< bytes of one SSBO binding on NVIDIA

  /// Check the context and make what is always there; false where it cannot run the stages.
  bool Initialize();
  bool IsInitialized() const { return this->SceneBuffer != 0; }
  void Release();

  ///@{ The first thing that went wrong since ClearError().
  bool Fail(const std::string& message);
  void ClearError() { this->Error.clear(); }
  const std::string& GetError() const { return this->Error; }
  ///@}

  ///@{ Buffers. Allocate() keeps one that has the size already, else its contents are undefined.
  bool Allocate(Buffer buffer, std::int64_t bytes);
  bool Allocate(Lifetime lifetime, const PipelineExtent& extent);
  void Free(Buffer buffer);
  void Fill(Buffer buffer, std::uint32_t value);
  void Swap(Buffer a, Buffer b);
  std::int64_t GetBytes(Buffer buffer) const;
  std::int64_t GetStagingBytes() const { return this->StagingBytes; }
  ///@}

  ///@{ Take a buffer's GL object away; put its first bytes into the one made since, and delete it.
  GLuint Detach(Buffer buffer);
  void CopyAndDelete(GLuint old, Buffer buffer, std::int64_t bytes);
  ///@}

  ///@{ Traffic with the CPU. It waits for the GPU only where it reads.
  void Read(Buffer buffer, void* data, std::size_t bytes);
  void Write(Buffer buffer, std::size_t offset, const void* data, std::size_t bytes);
  void Upload(Buffer buffer, const void* data, std::int64_t bytes);
  void UploadScene(const SceneBlock& scene);
  ///@}

  ///@{ Run a stage on so many work groups, or on as many as the control block says at an offset.
  void Dispatch(Stage stage, std::int64_t groupsX, std::int64_t groupsY = 1);
  void DispatchIndirect(Stage stage, std::size_t controlOffset);
  ///@}
  /// Draw the viewport with the composite stage, and leave no binding behind.
  void DrawComposite();

  ///@{ Stages that have run since they were forgotten.
  const std::set<Stage>& GetStagesRun() const { return this->StagesRun; }
  void ForgetStages(const std::set<Stage>& except = {});
  ///@}

  bool IsSoftware() const { return this->Software; }
  int GetNumberOfGLErrors() const { return this->GLErrors; }
  static std::string GetDescription();

private:
  bool CheckContext();
  GLuint Program(Stage stage);
  void Bind(Stage stage);

  std::array<GLuint, NumberOfBuffers> Names = {};
  std::array<std::int64_t, NumberOfBuffers> Bytes = {};
  std::array<GLuint, NumberOfStages> Programs = {};
  GLuint SceneBuffer = 0;
  GLuint Staging = 0; ///< what the CPU reads and writes passes through it
  std::int64_t StagingBytes = 0;
  GLuint VertexArray = 0;
  bool Software = false;     ///< no GPU: Mesa's llvmpipe
  bool ByExtensions = false; ///< the context is older than 4.3 but offers what we need
  bool CountsErrors = false;
  int GLErrors = 0;
  std::set<Stage> StagesRun;
  std::string Error;
};

#endif
