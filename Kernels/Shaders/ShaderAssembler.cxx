// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Shaders/ShaderAssembler.h"

#include "Shaders/HitSections.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

namespace
{
// "CAST_RAYS" from "CastRays".
std::string MacroName(const char* name)
{
  std::string macro;
  for (const char* c = name; *c; ++c)
  {
    const bool begins = std::isupper(static_cast<unsigned char>(*c)) != 0 && c != name;
    macro += begins ? "_" : "";
    macro += static_cast<char>(std::toupper(static_cast<unsigned char>(*c)));
  }
  return macro;
}

void WriteVersion(std::ostream& out, bool compute, bool byExtensions)
{
  if (!byExtensions)
  {
    out << "#version 430\n";
    return;
  }
  out << "#version 150\n";
  for (const std::string& extension : RequiredExtensions())
  {
    // some bring functions only, and only a compute shader may name its own
    const bool named = extension != "GL_ARB_clear_buffer_object" &&
      extension != "GL_ARB_timer_query" && (compute || extension != "GL_ARB_compute_shader");
    out << (named ? "#extension " + extension + " : require\n" : "");
  }
}

void WriteGroupSizes(std::ostream& out, const StageInfo& stage)
{
  for (const StageInfo& info : PipelineStages())
  {
    if (!info.Draws())
    {
      out << "#define " << MacroName(info.Name) << "_GROUP_SIZE " << info.GroupSize << "u\n";
    }
  }
  if (!stage.Draws())
  {
    out << "#define COMPUTE\n"
        << "#define GROUP_SIZE " << stage.GroupSize << "u\n"
        << "layout(local_size_x = " << stage.GroupSize << ") in;\n";
  }
}

// No two buffers of a stage overlap, so that all are `restrict`.
void WriteBuffers(std::ostream& out, const StageInfo& stage, const std::vector<Buffer>& bound)
{
  int binding = 0;
  for (const Buffer buffer : bound)
  {
    const std::string macro = PipelineBuffers()[static_cast<std::size_t>(buffer)].Macro;
    const Access access = stage.AccessTo(buffer);
    out << "#define BUFFER_" << macro << " layout(std430, binding = " << binding++ << ") restrict "
        << (Writes(access) ? "" : "readonly ") << (Reads(access) ? "" : "writeonly ") << "buffer\n"
        << (Writes(access) ? "#define WRITES_" + macro + "\n" : "");
  }
}

void WriteFeatures(std::ostream& out, const SceneNeeds& needs)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    out << (info.IsNeeded(needs) ? std::string("#define HAS_") + info.Macro + "\n" : "");
  }
  const std::pair<bool, const char*> features[] = { { needs.Lit, "LIT" },
    { needs.SeveralIsovalues, "SEVERAL_ISOVALUES" }, { needs.Translucent, "TRANSLUCENT" },
    { needs.Obstructed, "OBSTRUCTED" }, { needs.Clipped, "CLIPPED" }, { needs.Cropped, "CROPPED" },
    { needs.Colored, "COLORED" } };
  for (const auto& feature : features)
  {
    out << (feature.first ? std::string("#define ") + feature.second + "\n" : "");
  }
}

void WriteHitSections(std::ostream& out, const SceneNeeds& needs)
{
  const HitSections sections(needs);
  out << "#define KEY_SECTION " << sections.Key << "u\n"
      << "#define DEPTH_SECTION " << sections.Depth << "u\n"
      << "#define ISOVALUE_SECTION " << sections.Isovalue << "u\n"
      << "#define COLOR_SECTION " << sections.Color << "u\n"
      << "#define OBSTACLE_SECTION " << sections.Obstacle << "u\n";
}

// Adds files to a shader's text, each once, and keeps where each line comes from.
class Paster
{
public:
  Paster(const std::string& header, const ShaderFiles& files, std::string blockAccess)
    : Files(files)
    , BlockAccess(std::move(blockAccess))
    , NextLine(1 + static_cast<int>(std::count(header.begin(), header.end(), '\n')))
  {
    this->Shader = { header, { { 1, "(generated)", 1 } } };
  }

  void Paste(const std::string& file)
  {
    if (!this->Pasted.insert(file).second)
    {
      return;
    }
    this->Shader.Sections.push_back({ this->NextLine, file, 1 });
    std::istringstream text(this->Files.at(file));
    std::string line;
    for (int number = 1; std::getline(text, line); ++number)
    {
      const std::string included = this->FileIncludedBy(line);
      if (included.empty())
      {
        this->Shader.Text += line + "\n";
        ++this->NextLine;
      }
      else
      {
        this->Paste(included);
        this->Shader.Sections.push_back({ this->NextLine, file, number + 1 });
      }
    }
  }

  const AssembledShader& GetShader() const { return this->Shader; }

private:
  // Empty if the line includes no GLSL file.
  std::string FileIncludedBy(const std::string& line) const
  {
    if (line == "#include BLOCK_ACCESS")
    {
      return this->BlockAccess;
    }
    const std::string directive = "#include \"";
    return line.compare(0, directive.size(), directive) == 0
      ? line.substr(directive.size(), line.size() - directive.size() - 1)
      : "";
  }

  const ShaderFiles& Files;
  std::string BlockAccess;
  std::set<std::string> Pasted;
  AssembledShader Shader;
  int NextLine;
};

// "File:line" of a line of the shader's text.
std::string PlaceOf(int line, const AssembledShader& shader)
{
  const auto next = std::find_if(shader.Sections.begin(), shader.Sections.end(),
    [line](const ShaderSection& section) { return section.FirstLine > line; });
  const ShaderSection& section = *std::prev(next);
  return section.File + ":" + std::to_string(section.FirstLineInFile + line - section.FirstLine);
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

AssembledShader AssembleShader(const StageInfo& stage, const std::string& file,
  const std::vector<Buffer>& bound, const SceneNeeds& needs, bool byExtensions,
  const ShaderFiles& files)
{
  std::ostringstream out;
  WriteVersion(out, !stage.Draws(), byExtensions);
  WriteGroupSizes(out, stage);
  WriteBuffers(out, stage, bound);
  WriteFeatures(out, needs);
  WriteHitSections(out, needs);
  Paster paster(
    out.str(), files, needs.Cached ? "Cache/CachedBlocks.glsl" : "Cache/DecodedVolume.glsl");
  paster.Paste(file);
  return paster.GetShader();
}

std::string NameFiles(const std::string& log, const AssembledShader& shader)
{
  std::ostringstream out;
  std::istringstream text(log);
  std::string line;
  while (std::getline(text, line))
  {
    int number = 0, length = 0;
    std::sscanf(line.c_str(), "%*d:%d(%*d)%n", &number, &length);
    if (length == 0)
    {
      std::sscanf(line.c_str(), "%*d(%d)%n", &number, &length);
    }
    out << (length > 0 && number > 0
               ? PlaceOf(number, shader) + line.substr(static_cast<std::size_t>(length))
               : line)
        << "\n";
  }
  return out.str();
}
