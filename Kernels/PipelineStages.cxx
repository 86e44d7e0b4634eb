// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PipelineStages.h"

#include <set>
#include <sstream>

const std::vector<StageInfo>& PipelineStages()
{
  using B = Buffer;
  // clang-format off
  static const std::vector<StageInfo> stages = {
    { Stage::BlockRanges,     "BlockRanges",     { B::Payload, B::CoarseRanges, B::BlockRanges } },
    { Stage::InitialRays,     "InitialRays",     { B::Control, B::RayBlock, B::RayHit, B::PixelColor, B::NextLiveRays } },
    { Stage::BeginPass,       "BeginPass",       { B::Control, B::PassStatistics } },
    { Stage::CacheAges,       "CacheAges",       { B::Control, B::CacheMap, B::CacheSlotBlock, B::CacheSlotStamp } },
    { Stage::CacheEvict,      "CacheEvict",      { B::Control, B::CacheSlotBlock, B::CacheSlotStamp } },
    { Stage::CacheRebuild,    "CacheRebuild",    { B::Control, B::CacheMap, B::CacheSlotBlock, B::CacheFreeSlots } },
    { Stage::TraverseGrid,    "TraverseGrid",    { B::Control, B::LiveRays, B::RayBlock, B::RayHit, B::CoarseRanges, B::BlockRanges, B::PairBlock } },
    { Stage::MarkBlocks,      "MarkBlocks",      { B::Control, B::PairBlock, B::PairEntry, B::CacheMap, B::CacheVisible } },
    { Stage::AdmitBlocks,     "AdmitBlocks",     { B::Control, B::CacheMap, B::CacheVisible, B::CacheSlotBlock, B::CacheSlotStamp, B::CacheFreeSlots, B::CacheDecodeList, B::CacheWorkItems } },
    { Stage::DecodeBlocks,    "DecodeBlocks",    { B::Control, B::Payload, B::CacheDecodeList, B::CacheSlotBlock, B::CacheValues } },
    { Stage::GroupRays,       "GroupRays",       { B::Control, B::LiveRays, B::PairEntry, B::CacheMap, B::GroupedRays } },
    { Stage::IntersectBlocks, "IntersectBlocks", { B::Control, B::CacheWorkItems, B::GroupedRays, B::CacheMap, B::CacheValues, B::RayHit } },
    { Stage::IntersectPairs,  "IntersectPairs",  { B::Control, B::LiveRays, B::PairBlock, B::PairEntry, B::CacheMap, B::CacheValues, B::RayHit } },
    { Stage::NearestHit,      "NearestHit",      { B::Control, B::LiveRays, B::RayHit, B::PairBlock, B::PairEntry, B::RayBlock, B::NextLiveRays } },
    { Stage::BeginShading,    "BeginShading",    { B::Control, B::PassStatistics } },
    { Stage::MarkShading,     "MarkShading",     { B::Control, B::RayHit, B::RayBlock, B::PixelColor, B::PairEntry, B::CacheMap, B::CacheVisible } },
    { Stage::ShadeHits,       "ShadeHits",       { B::Control, B::RayHit, B::RayBlock, B::PairEntry, B::CacheMap, B::CacheValues, B::PixelColor } },
    { Stage::Composite,       "Composite",       { B::RayHit, B::PixelColor } },
  };
  // clang-format on
  return stages;
}

namespace
{
// Pastes a file into `out`; a line `#include "X"` pastes X, once in a shader.
void Paste(const std::string& file, std::set<std::string>& pasted, std::ostringstream& out)
{
  if (!pasted.insert(file).second)
  {
    return;
  }
  std::istringstream text(ShaderSources().at(file));
  const std::string directive = "#include \"";
  std::string line;
  while (std::getline(text, line))
  {
    if (line.compare(0, directive.size(), directive) == 0)
    {
      Paste(line.substr(directive.size(), line.size() - directive.size() - 1), pasted, out);
    }
    else
    {
      out << line << "\n";
    }
  }
}
}

const std::vector<std::string>& RequiredExtensions()
{
  static const std::vector<std::string> names = { "GL_ARB_arrays_of_arrays",
    "GL_ARB_clear_buffer_object", "GL_ARB_compute_shader", "GL_ARB_explicit_attrib_location",
    "GL_ARB_gpu_shader5", "GL_ARB_gpu_shader_fp64", "GL_ARB_shader_bit_encoding",
    "GL_ARB_shader_image_load_store", "GL_ARB_shader_storage_buffer_object",
    "GL_ARB_shading_language_420pack", "GL_ARB_shading_language_packing", "GL_ARB_timer_query" };
  return names;
}

std::string AssembleShader(const std::string& file, const StageInfo& stage, bool byExtensions)
{
  // some bring functions only, and only a compute shader may name its own
  std::set<std::string> unnamed = { "GL_ARB_clear_buffer_object", "GL_ARB_timer_query" };
  if (stage.Id == Stage::Composite)
  {
    unnamed.insert("GL_ARB_compute_shader");
  }
  std::ostringstream out;
  out << (byExtensions ? "#version 150\n" : "#version 430\n");
  for (const std::string& extension : RequiredExtensions())
  {
    if (byExtensions && !unnamed.count(extension))
    {
      out << "#extension " << extension << " : require\n";
    }
  }
  int binding = 0;
  for (Buffer buffer : stage.Buffers)
  {
    out << "#define BINDING_" << PipelineBuffers()[static_cast<int>(buffer)].Macro << " "
        << binding++ << "\n";
  }
  std::set<std::string> pasted;
  Paste(file, pasted, out);
  return out.str();
}
