// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The current OpenGL context: whether it can run the stages, what it allows, and the first error.
#ifndef Context_h
#define Context_h

#include "GL/DeviceLimits.h"
#include "Shaders/ShaderAssembler.h"

#include "Status.h"

#include <cstdint>
#include <string>

class Context
{
public:
  /// Checks the version and asks for the limits. An error where the context cannot run the stages.
  const Status& Open();
  /// Forgets the error.
  void Close();

  /// What the sources of its shaders may use.
  const ShaderDialect& GetDialect() const { return this->Dialect; }
  const DeviceLimits& GetLimits() const { return this->Limits; }
  /// Lowers the largest buffer to so many bytes; 0 restores what OpenGL allows.
  void LimitBuffers(std::int64_t bytes);

  ///@{ OpenGL tells errors late, and a stage that runs after one could hang the GPU: the first
  /// error is kept until Close(), and stops all later work. Each function returns it.
  const Status& GetStatus() const { return this->FirstError; }
  const Status& Fail(const Status& error);
  /// Asks whether OpenGL has run out of memory: some drivers make memory only where it is used.
  const Status& CheckMemory();
  ///@}

  /// The renderer's name and OpenGL's version.
  static std::string GetDescription();

private:
  Status CheckVersion();
  void AskLimits();

  DeviceLimits Limits;
  std::int64_t LargestAllowed = 0; ///< bytes of a buffer
  ShaderDialect Dialect;
  Status FirstError;
};

#endif
