// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/ProgramCache.h"

#include "Status.h"

#include <cstdlib>
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

void GLAPIENTRY CountError(
  GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar*, const void* counter)
{
  if (type == GL_DEBUG_TYPE_ERROR)
  {
    ++*static_cast<int*>(const_cast<void*>(counter));
  }
}
}

std::shared_ptr<ProgramCache> ProgramCache::OfContext(std::uint64_t contextId, bool byExtensions)
{
  static std::map<std::uint64_t, std::weak_ptr<ProgramCache>> contexts;
  static std::mutex mutex; // windows may be rendered by threads of their own
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<ProgramCache> programs = contexts[contextId].lock();
  if (!programs)
  {
    for (auto entry = contexts.begin(); entry != contexts.end();) // of contexts that are gone
    {
      entry = entry->second.expired() ? contexts.erase(entry) : std::next(entry);
    }
    programs = std::make_shared<ProgramCache>(byExtensions);
    contexts[contextId] = programs;
  }
  return programs;
}

Status ProgramCache::Get(
  Stage stage, const std::vector<Buffer>& bound, const SceneNeeds& needs, GLuint& program)
{
  const Variant variant(stage, bound, needs.GetBits());
  const auto found = this->Programs.find(variant);
  if (found != this->Programs.end())
  {
    program = found->second;
    return Status();
  }
  Status built = this->Build(stage, bound, needs, program);
  if (built) // else the next render tries, and fails, again
  {
    this->Programs[variant] = program;
  }
  return built;
}

Status ProgramCache::Build(
  Stage stage, const std::vector<Buffer>& bound, const SceneNeeds& needs, GLuint& program) const
{
  const StageInfo& info = InfoOf(stage);
  program = glCreateProgram();
  const auto attach = [&](GLenum type, const std::string& file)
  {
    return AttachShader(
      program, type, AssembleShader(info, file, bound, needs, this->ByExtensions));
  };
  const std::string log = info.Draws()
    ? attach(GL_VERTEX_SHADER, ViewportShader) + attach(GL_FRAGMENT_SHADER, info.File)
    : attach(GL_COMPUTE_SHADER, info.File);
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked)
  {
    return Status();
  }
  char text[2048] = {};
  glGetProgramInfoLog(program, sizeof(text), nullptr, text);
  glDeleteProgram(program);
  program = 0;
  return Status::Error("shader ", info.Name, " does not build on this driver: ", log, text);
}

void ProgramCache::CountGLErrors()
{
  const char* debug = std::getenv("PROGISO_GL_DEBUG");
  this->CountsErrors = this->CountsErrors || (debug && *debug && *debug != '0');
  if (this->CountsErrors)
  {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(CountError, &this->GLErrors);
  }
}

void ProgramCache::Release()
{
  for (const auto& entry : this->Programs)
  {
    glDeleteProgram(entry.second);
  }
  this->Programs.clear();
  if (this->CountsErrors)
  {
    glDebugMessageCallback(nullptr, nullptr); // this object holds the counter
  }
}
