// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Every stage of the pipeline: a GLSL file of this folder and the buffers it is given.
#ifndef StageTable_h
#define StageTable_h

#include "Shaders/BufferTable.h"

#include <map>
#include <string>
#include <vector>

enum class Stage
{
  BlockRanges,
  PlanPass,
  CacheReset,
  CacheAges,
  CacheEvict,
  CastRays,
  CastFewRays,
  FinishHits,
  RequestBlocks,
  DecodeBlocks,
  DecodeColors,
  Composite,
  Select,
  NumberOfStages
};
constexpr int NumberOfStages = static_cast<int>(Stage::NumberOfStages);

struct StageInfo
{
  Stage Id;
  const char* Name;
  const char* File; ///< its GLSL file, in the folder of this header
  std::vector<Buffer>
    Buffers; ///< in the order of their bindings; at most 8, OpenGL 4.3's guarantee
};

/// The table itself, in the order of the enumeration.
const std::vector<StageInfo>& PipelineStages();

/// Text of every GLSL file, by name (generated).
const std::map<std::string, const char*>& ShaderSources();

/// What an OpenGL context older than 4.3 must offer instead, by name.
const std::vector<std::string>& RequiredExtensions();

/// Complete source of a GLSL file: version (4.30, or 1.50 with the required extensions), the
/// bindings of those buffers of its stage that are `bound`, which buffers the scene has at all, and
/// the file with its includes.
std::string AssembleShader(const std::string& file, const std::vector<Buffer>& bound,
  const PipelineExtent& extent, bool byExtensions);

#endif
