// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/ProgramCache.h"

#include <iterator>
#include <mutex>

namespace
{
// Compiles one shader into a program; the compiler's log where that fails.
std::string AttachShader(GLuint program, GLenum type, const AssembledShader& source)
{
  GLuint shader = glCreateShader(type);
  const char* text = source.Text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::string log;
  if (!compiled)
  {
    log.resize(4096);
    GLsizei length = 0;
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, &log[0]);
    log.resize(length);
    log = log.empty() ? "no log" : NameFiles(log, source);
  }
  glAttachShader(program, shader);
  glDeleteShader(shader);
  return log;
}
}

std::shared_ptr<ProgramCache> ProgramCache::OfContext(std::uint64_t context, bool byExtensions)
{
  static std::map<std::uint64_t, std::weak_ptr<ProgramCache>> contexts;
  static std::mutex mutex; // windows may be rendered by threads of their own
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<ProgramCache> programs = contexts[context].lock();
  if (!programs)
  {
    for (auto entry = contexts.begin(); entry != contexts.end();) // of contexts that are gone
    {
      entry = entry->second.expired() ? contexts.erase(entry) : std::next(entry);
    }
    programs = std::make_shared<ProgramCache>(byExtensions);
    contexts[context] = programs;
  }
  return programs;
}

GLuint ProgramCache::Get(
  Stage stage, const std::vector<Buffer>& bound, const PipelineExtent& extent, std::string& error)
{
  const Variant variant(stage, bound, extent.GetFeatures());
  const auto found = this->Programs.find(variant);
  if (found != this->Programs.end())
  {
    return found->second;
  }
  const GLuint program = this->Build(stage, bound, extent, error);
  if (program) // else it is tried again, and told again, at the next render
  {
    this->Programs[variant] = program;
  }
  return program;
}

GLuint ProgramCache::Build(Stage stage, const std::vector<Buffer>& bound,
  const PipelineExtent& extent, std::string& error) const
{
  const StageInfo& info = InfoOf(stage);
  const GLuint program = glCreateProgram();
  const auto attach = [&](GLenum type, const std::string& file)
  {
    return AttachShader(
      program, type, AssembleShader(info, file, bound, extent, this->ByExtensions));
  };
  const std::string log = info.Draws()
    ? attach(GL_VERTEX_SHADER, ViewportShader) + attach(GL_FRAGMENT_SHADER, info.File)
    : attach(GL_COMPUTE_SHADER, info.File);
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked)
  {
    return program;
  }
  char text[2048] = {};
  glGetProgramInfoLog(program, sizeof(text), nullptr, text);
  error = std::string("shader ") + info.Name + " does not build on this driver: " + log + text;
  glDeleteProgram(program);
  return 0;
}

void ProgramCache::Release()
{
  for (const auto& entry : this->Programs)
  {
    glDeleteProgram(entry.second);
  }
  this->Programs.clear();
}
