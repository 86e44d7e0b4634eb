// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Shaders/StageTable.h"

#include <set>
#include <sstream>
#include <utility>

const std::vector<StageInfo>& PipelineStages()
{
  using B = Buffer;
  // clang-format off
  static const std::vector<StageInfo> stages = {
    { Stage::BlockRanges,   "BlockRanges",   "Store/BlockRanges.comp", { B::Macrocells, B::Stream, B::HiddenCells, B::CacheValues } },
    { Stage::PlanPass,      "PlanPass",      "Rays/PlanPass.comp", { B::Control, B::PassStatistics } },
    { Stage::CacheReset,    "CacheReset",    "Cache/CacheReset.comp", { B::Control, B::Macrocells, B::CacheMap, B::CacheFreeSlots } },
    { Stage::CacheAges,     "CacheAges",     "Cache/CacheAges.comp", { B::Control, B::CacheMap } },
    { Stage::CacheEvict,    "CacheEvict",    "Cache/CacheEvict.comp", { B::Control, B::Macrocells, B::CacheMap, B::CacheFreeSlots } },
    { Stage::CastRays,      "CastRays",      "Rays/CastRays.comp", { B::Control, B::Macrocells, B::CacheMap, B::CacheValues, B::Hits, B::Rays, B::CacheSeen } },
    { Stage::CastFewRays,   "CastFewRays",   "Rays/CastFewRays.comp", { B::Control, B::Macrocells, B::CacheMap, B::CacheValues, B::Hits, B::Rays, B::CacheSeen } },
    { Stage::FinishHits,   "FinishHits",   "Surface/FinishHits.comp", { B::Control, B::Macrocells, B::CacheMap, B::CacheValues, B::CacheRequests, B::Hits, B::Normals, B::Layers, B::Rays } },
    { Stage::RequestBlocks, "RequestBlocks", "Cache/RequestBlocks.comp", { B::Control, B::Macrocells, B::CacheMap, B::CacheRequests, B::Hits, B::Rays } },
    { Stage::DecodeBlocks,  "DecodeBlocks",  "Store/DecodeBlocks.comp", { B::Control, B::Stream, B::HiddenCells, B::Macrocells, B::CacheMap, B::CacheFreeSlots, B::CacheRequests, B::CacheValues } },
    { Stage::DecodeColors,  "DecodeColors",  "Store/DecodeColors.comp", { B::Control, B::ColorStream, B::Macrocells, B::CacheMap, B::CacheRequests, B::CacheValues } },
    { Stage::Composite,     "Composite",     "Output/Composite.frag", { B::Hits, B::Normals, B::Layers } },
    { Stage::Select,        "Select",        "Output/Select.frag", { B::Hits } },
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

std::string AssembleShader(const std::string& file, const std::vector<Buffer>& bound,
  const PipelineExtent& extent, bool byExtensions)
{
  const bool compute = file.find(".comp") != std::string::npos;
  // some bring functions only, and only a compute shader may name its own
  std::set<std::string> unnamed = { "GL_ARB_clear_buffer_object", "GL_ARB_timer_query" };
  if (!compute)
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
  out << (compute ? "#define COMPUTE\n" : "");
  int binding = 0;
  for (Buffer buffer : bound)
  {
    out << "#define BINDING_" << PipelineBuffers()[static_cast<int>(buffer)].Macro << " "
        << binding++ << "\n";
  }
  PipelineExtent one = extent; // what the scene needs, whatever its size
  one.Macrocells = one.Pixels = one.Slots = one.Pages = 1;
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.Bytes(one) > 0)
    {
      out << "#define HAS_" << info.Macro << "\n";
    }
  }
  const std::pair<bool, const char*> features[] = { { extent.Lit, "LIT" },
    { extent.SeveralIsovalues, "SEVERAL_ISOVALUES" }, { extent.Translucent, "TRANSLUCENT" },
    { extent.Obstructed, "OBSTRUCTED" }, { extent.Clipped, "CLIPPED" },
    { extent.Cropped, "CROPPED" }, { extent.Colored, "COLORED" } };
  for (const auto& feature : features)
  {
    out << (feature.first ? std::string("#define ") + feature.second + "\n" : "");
  }
  std::set<std::string> pasted;
  Paste(file, pasted, out);
  return out.str();
}
