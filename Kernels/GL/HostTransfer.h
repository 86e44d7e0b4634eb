// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Copies between the CPU and storage buffers, through a staging buffer: drivers move a buffer that
// the CPU touches to the CPU's memory, where the stages' atomics are slow or, on some, go astray.
#ifndef HostTransfer_h
#define HostTransfer_h

#include "GL/ProgIsoGL.h"

#include <cstdint>

class HostTransfer
{
public:
  static constexpr std::int64_t MaximumStagingBytes = 1 << 18;

  void Initialize() { glGenBuffers(1, &this->Staging); }
  void Release();

  /// Copies from a buffer, and waits for the GPU.
  void Read(GLuint buffer, std::int64_t offset, void* data, std::int64_t bytes);
  /// Copies into a buffer, without waiting.
  void Write(GLuint buffer, std::int64_t offset, const void* data, std::int64_t bytes);

  std::int64_t GetStagingBytes() const { return this->StagingBytes; }

private:
  GLuint Staging = 0;
  std::int64_t StagingBytes = 0;
};

#endif
