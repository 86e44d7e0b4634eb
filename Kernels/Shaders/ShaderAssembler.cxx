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

void WriteVersion(std::ostream& out, bool compute, const ShaderDialect& dialect)
{
  if (!dialect.ByExtensions)
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

// NVIDIA's compiler takes its time over unrolled loops, and no stage is faster for them.
void ForbidUnrolling(std::ostream& out)
{
  out << "#pragma optionNV(unroll none)\n";
}

// A text that can use integers of 64 bits mentions the macro.
void UseIntegers64(std::ostream& out, const std::string& text, const ShaderDialect& dialect)
{
  const std::string macro = "NATIVE_INT64";
  if (dialect.Integers64 && text.find(macro) != std::string::npos)
  {
    out << "#extension GL_ARB_gpu_shader_int64 : require\n#define " << macro << "\n";
  }
}

// What a shader may use of the tables and the scene: names, and the lines that define them.
class Definitions
{
public:
  void Add(const std::string& name, const std::string& value = "")
  {
    this->Lines.emplace_back(name, "#define " + name + (value.empty() ? "" : " " + value) + "\n");
  }

  /// Writes those that a text mentions: scenes that differ in others only share a program.
  void Write(std::ostream& out, const std::string& text) const
  {
    std::set<std::string> words;
    std::string word;
    for (const char c : text + " ")
    {
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
      {
        word += c;
      }
      else if (!word.empty())
      {
        words.insert(word);
        word.clear();
      }
    }
    for (const auto& line : this->Lines)
    {
      out << (words.count(line.first) ? line.second : "");
    }
  }

private:
  std::vector<std::pair<std::string, std::string>> Lines;
};

void DefineGroupSizes(Definitions& definitions, const StageInfo& stage)
{
  for (const StageInfo& info : PipelineStages())
  {
    if (!info.Draws())
    {
      definitions.Add(MacroName(info.Name) + "_GROUP_SIZE", std::to_string(info.GroupSize) + "u");
    }
  }
  if (!stage.Draws())
  {
    definitions.Add("COMPUTE");
    definitions.Add("GROUP_SIZE", std::to_string(stage.GroupSize) + "u");
  }
}

// No two buffers of a stage overlap, so that all are `restrict`.
void DefineBuffers(Definitions& definitions, const StageInfo& stage, const SceneNeeds& needs)
{
  int binding = 0;
  for (const Buffer buffer : stage.BuffersOf(needs))
  {
    const std::string macro = PipelineBuffers()[static_cast<std::size_t>(buffer)].Macro;
    const Access access = stage.AccessTo(buffer);
    definitions.Add("BUFFER_" + macro,
      "layout(std430, binding = " + std::to_string(binding++) + ") restrict " +
        (Writes(access) ? "" : "readonly ") + (Reads(access) ? "" : "writeonly ") + "buffer");
    if (Writes(access))
    {
      definitions.Add("WRITES_" + macro);
    }
  }
}

void DefineFeatures(Definitions& definitions, const SceneNeeds& needs)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.IsNeeded(needs))
    {
      definitions.Add(std::string("HAS_") + info.Macro);
    }
  }
  const std::pair<bool, const char*> features[] = { { needs.Lit, "LIT" },
    { needs.SeveralIsovalues, "SEVERAL_ISOVALUES" }, { needs.Translucent, "TRANSLUCENT" },
    { needs.Obstructed, "OBSTRUCTED" }, { needs.Clipped, "CLIPPED" }, { needs.Cropped, "CROPPED" },
    { needs.Colored, "COLORED" }, { needs.Categories, "CATEGORIES" }, { needs.Levels, "LEVELS" },
    { needs.Levels && needs.Conservative, "CONSERVATIVE" },
    // not every crossing of a ray with a surface is its hit
    { needs.Translucent || needs.Cropped, "MANY_CROSSINGS" },
    // hits are queued to be lit, coloured or blended
    { !needs.IsSinglePass() && Conditions::FinishedHits.Holds(needs), "HAS_PENDING_HITS" } };
  for (const auto& feature : features)
  {
    if (feature.first)
    {
      definitions.Add(feature.second);
    }
  }
  definitions.Add("RAYS_CONTINUE", needs.Translucent ? "true" : "false"); // behind a hit
}

void DefineHitSections(Definitions& definitions, const SceneNeeds& needs)
{
  const HitSections sections(needs);
  const std::pair<const char*, int> numbers[] = { { "KEY_SECTION", sections.Key },
    { "DEPTH_SECTION", sections.Depth }, { "ISOVALUE_SECTION", sections.Isovalue },
    { "COLOR_SECTION", sections.Color }, { "OBSTACLE_SECTION", sections.Obstacle } };
  for (const auto& number : numbers)
  {
    definitions.Add(number.first, std::to_string(number.second) + "u");
  }
}

// Adds files to a shader's text, each once, and keeps where each line comes from.
class Paster
{
public:
  Paster(const ShaderFiles& files, std::string blockAccess)
    : Files(files)
    , BlockAccess(std::move(blockAccess))
  {
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

  const std::string& GetText() const { return this->Shader.Text; }

  /// The shader, after a generated header.
  AssembledShader WithHeader(const std::string& header) const
  {
    const int lines = static_cast<int>(std::count(header.begin(), header.end(), '\n'));
    AssembledShader shader = { header + this->Shader.Text, { { 1, "(generated)", 1 } } };
    for (const ShaderSection& section : this->Shader.Sections)
    {
      shader.Sections.push_back(
        { section.FirstLine + lines, section.File, section.FirstLineInFile });
    }
    return shader;
  }

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
  int NextLine = 1;
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
    "GL_ARB_gpu_shader5", "GL_ARB_shader_bit_encoding", "GL_ARB_shader_image_load_store",
    "GL_ARB_shader_storage_buffer_object", "GL_ARB_shading_language_420pack",
    "GL_ARB_shading_language_packing", "GL_ARB_timer_query" };
  return names;
}

AssembledShader AssembleShader(const StageInfo& stage, const std::string& file,
  const SceneNeeds& needs, const ShaderDialect& dialect, const ShaderFiles& files)
{
  Definitions definitions;
  DefineGroupSizes(definitions, stage);
  DefineBuffers(definitions, stage, needs);
  DefineFeatures(definitions, needs);
  DefineHitSections(definitions, needs);
  Paster paster(files, needs.Cached ? "Cache/CachedBlocks.glsl" : "Cache/DecodedVolume.glsl");
  paster.Paste(file);
  std::ostringstream header;
  WriteVersion(header, !stage.Draws(), dialect);
  UseIntegers64(header, paster.GetText(), dialect);
  ForbidUnrolling(header);
  definitions.Write(header, paster.GetText());
  if (!stage.Draws())
  {
    header << "layout(local_size_x = " << stage.GroupSize << ") in;\n";
  }
  return paster.WithHeader(header.str());
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
