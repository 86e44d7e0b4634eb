// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The compiled stages of an OpenGL context, and the count of its errors. All mappers of a window
// share them: a program is compiled once, when the first scene needs it.
#ifndef ProgramCache_h
#define ProgramCache_h

#include "GL/ProgIsoGL.h"
#include "Shaders/ShaderAssembler.h"

#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

class Status;

class ProgramCache
{
public:
  /// The programs of the current context, which `contextId` identifies. The caller keeps them
  /// alive; the last owner must call Release() with the context current.
  static std::shared_ptr<ProgramCache> OfContext(std::uint64_t contextId, bool byExtensions);

  explicit ProgramCache(bool byExtensions)
    : ByExtensions(byExtensions)
  {
  }
  ProgramCache(const ProgramCache&) = delete;
  void operator=(const ProgramCache&) = delete;

  /// Finds, or builds, a stage's program for the buffers that are bound and what the scene needs.
  Status Get(
    Stage stage, const std::vector<Buffer>& bound, const SceneNeeds& needs, GLuint& program);
  void Release();

  ///@{ OpenGL errors of the context, counted if the environment variable PROGISO_GL_DEBUG is set.
  void CountGLErrors();
  int GetNumberOfGLErrors() const { return this->GLErrors; }
  ///@}

private:
  Status Build(
    Stage stage, const std::vector<Buffer>& bound, const SceneNeeds& needs, GLuint& program) const;

  /// Stage, buffers bound, and the features of the scene.
  using Variant = std::tuple<Stage, std::vector<Buffer>, std::uint32_t>;
  std::map<Variant, GLuint> Programs;
  bool ByExtensions; ///< the context is older than 4.3 but offers what we need
  bool CountsErrors = false;
  int GLErrors = 0;
};

#endif
