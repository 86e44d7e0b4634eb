// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The compiled stages, and the count of OpenGL's errors. All mappers of a window share them: a
// program is compiled when the first scene needs it, once.
#ifndef PipelinePrograms_h
#define PipelinePrograms_h

#include "GL/ProgIsoGL.h"
#include "Shaders/ShaderAssembler.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

class ProgramCache
{
public:
  /// The programs of a context, which is told by a number of its own. The caller keeps them alive;
  /// whoever holds them last calls Release() with the context current.
  static std::shared_ptr<ProgramCache> OfContext(std::uint64_t context, bool byExtensions);

  explicit ProgramCache(bool byExtensions)
    : ByExtensions(byExtensions)
  {
  }
  ProgramCache(const ProgramCache&) = delete;
  void operator=(const ProgramCache&) = delete;

  /// A stage's program for what it is bound to and what the scene needs; 0 and a message in `error`
  /// where it does not build.
  GLuint Get(Stage stage, const std::vector<Buffer>& bound, const PipelineExtent& extent,
    std::string& error);
  void Release();

  int GLErrors = 0; ///< of the context, where they are counted

private:
  GLuint Build(Stage stage, const std::vector<Buffer>& bound, const PipelineExtent& extent,
    std::string& error) const;

  /// stage, buffers bound, and what the scene needs, see PipelineExtent
  using Variant = std::tuple<Stage, std::vector<Buffer>, std::uint32_t>;
  std::map<Variant, GLuint> Programs;
  bool ByExtensions; ///< the context is older than 4.3 but offers what we need
};

#endif
