// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/ProgramCache.h"

#include "Status.h"

#include <cstdlib>
#include <iterator>
#include <mutex>

namespace
{
constexpr GLenum CompletionStatus = 0x91B1; // GL_COMPLETION_STATUS_KHR
constexpr GLuint AllThreads = 0xFFFFFFFF;   // as many as the driver allows
constexpr double LongestRequest = 50.0;     // milliseconds, where others do the work
constexpr int MostSlowRequests = 1;         // a busy machine may hold one up

// Lets the driver compile in threads: some do so only if they are asked.
void AllowCompilerThreads()
{
#ifdef GL_KHR_parallel_shader_compile
  if (glMaxShaderCompilerThreadsKHR)
  {
    glMaxShaderCompilerThreadsKHR(AllThreads);
  }
#endif
}

// Names a program for debuggers and for those who list what a context has compiled.
void Label(GLuint program, const char* name)
{
  if (glObjectLabel)
  {
    glObjectLabel(GL_PROGRAM, program, -1, name);
  }
}

// Compiles a shader into a program. Asks nothing: a question would wait for the answer.
GLuint AttachShader(GLuint program, GLenum type, const AssembledShader& source)
{
  const GLuint shader = glCreateShader(type);
  const char* text = source.Text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glDeleteShader(shader); // as soon as the program goes
  return shader;
}

// The compiler's log; empty where the shader has compiled.
std::string CompileLog(GLuint shader, const AssembledShader& source)
{
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled)
  {
    return "";
  }
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, &log[0]);
  log.resize(length);
  return log.empty() ? "no log" : NameFiles(log, source);
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

std::shared_ptr<ProgramCache> ProgramCache::OfContext(
  std::uint64_t contextId, const ShaderDialect& dialect, const DeviceLimits& limits)
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
    programs = std::make_shared<ProgramCache>(dialect, limits.BackgroundCompiler);
    contexts[contextId] = programs;
  }
  return programs;
}

ProgramCache::ProgramCache(const ShaderDialect& dialect, bool inBackground)
  : Dialect(dialect)
  , InBackground(inBackground)
{
  if (inBackground)
  {
    AllowCompilerThreads();
  }
}

void ProgramCache::Request(const std::vector<Stage>& stages, const SceneNeeds& needs)
{
  for (const Stage stage : stages)
  {
    this->IsReady(stage, needs);
  }
}

bool ProgramCache::IsReady(Stage stage, const SceneNeeds& needs)
{
  if (!this->InBackground)
  {
    return true;
  }
  const Stopwatch stopwatch;
  Program& program = this->Find(stage, needs);
  if (!program.Complete)
  {
    GLint complete = 0;
    glGetProgramiv(program.Name, CompletionStatus, &complete);
    if (complete)
    {
      SetComplete(program);
      // Mesa has the extension in common, but not every driver of it has the threads
      const double waited = stopwatch.GetMilliseconds();
      if (waited >= LongestRequest)
      {
        program.Time.WaitedMilliseconds += waited;
        this->SlowRequests += 1;
        this->InBackground = this->SlowRequests <= MostSlowRequests;
      }
    }
  }
  return program.Complete || !this->InBackground;
}

bool ProgramCache::HasGiven(Stage stage, const SceneNeeds& needs) const
{
  const auto found = this->Programs.find({ stage, needs.GetBits() });
  return found != this->Programs.end() && found->second->Shaders.empty();
}

Status ProgramCache::Get(Stage stage, const SceneNeeds& needs, GLuint& name)
{
  const Stopwatch waiting;
  Program& program = this->Find(stage, needs);
  Status built;
  if (!program.Shaders.empty())
  {
    built = this->Check(program);
    program.Time.WaitedMilliseconds += waiting.GetMilliseconds();
  }
  name = program.Name;
  if (!built)
  {
    this->Forget(program); // the next render tries, and fails, again
    name = 0;
  }
  return built;
}

// Finds a program, or has the driver begin with it.
ProgramCache::Program& ProgramCache::Find(Stage stage, const SceneNeeds& needs)
{
  std::shared_ptr<Program>& program = this->Programs[{ stage, needs.GetBits() }];
  if (program)
  {
    return *program;
  }
  std::vector<Shader> shaders = this->Assemble(stage, needs);
  std::string source = InfoOf(stage).Name;
  for (const Shader& shader : shaders)
  {
    source += "\n" + shader.Source.Text;
  }
  std::shared_ptr<Program>& same = this->BySource[source];
  if (!same)
  {
    same = std::make_shared<Program>();
    same->Time.Id = stage;
    same->Shaders = std::move(shaders);
    Start(*same);
  }
  program = same;
  return *program;
}

std::vector<ProgramCache::Shader> ProgramCache::Assemble(Stage stage, const SceneNeeds& needs) const
{
  const StageInfo& info = InfoOf(stage);
  const auto assemble = [&](GLenum type, const char* file) -> Shader {
    return { type, AssembleShader(info, file, needs, this->Dialect) };
  };
  std::vector<Shader> shaders;
  if (info.Draws())
  {
    shaders.push_back(assemble(GL_VERTEX_SHADER, ViewportShader));
  }
  shaders.push_back(assemble(info.Draws() ? GL_FRAGMENT_SHADER : GL_COMPUTE_SHADER, info.File));
  return shaders;
}

void ProgramCache::Start(Program& program)
{
  program.Name = glCreateProgram();
  Label(program.Name, InfoOf(program.Time.Id).Name);
  for (Shader& shader : program.Shaders)
  {
    shader.Name = AttachShader(program.Name, shader.Type, shader.Source);
  }
  glLinkProgram(program.Name);
}

void ProgramCache::SetComplete(Program& program)
{
  if (!program.Complete)
  {
    program.Complete = true;
    program.Time.Milliseconds = program.SinceRequest.GetMilliseconds();
  }
}

// Asks whether a program has been built, which waits for it.
Status ProgramCache::Check(Program& program)
{
  GLint linked = 0;
  glGetProgramiv(program.Name, GL_LINK_STATUS, &linked);
  SetComplete(program);
  std::string log;
  for (const Shader& shader : program.Shaders)
  {
    log += linked ? "" : CompileLog(shader.Name, shader.Source);
  }
  program.Shaders.clear();
  if (linked)
  {
    return Status();
  }
  char text[2048] = {};
  glGetProgramInfoLog(program.Name, sizeof(text), nullptr, text);
  return Status::Error(
    "shader ", InfoOf(program.Time.Id).Name, " does not build on this driver: ", log, text);
}

void ProgramCache::Forget(const Program& program)
{
  // the first erasure leaves an owner: the other map
  const auto erase = [&program](auto& entries)
  {
    for (auto entry = entries.begin(); entry != entries.end();)
    {
      entry = entry->second.get() == &program ? entries.erase(entry) : std::next(entry);
    }
  };
  glDeleteProgram(program.Name);
  erase(this->Programs);
  erase(this->BySource);
}

std::vector<ProgramTime> ProgramCache::GetTimes(const SceneNeeds& needs) const
{
  std::vector<ProgramTime> times;
  for (const StageInfo& info : PipelineStages())
  {
    const auto found = this->Programs.find({ info.Id, needs.GetBits() });
    if (found != this->Programs.end() && found->second->Complete)
    {
      times.push_back(found->second->Time);
    }
  }
  return times;
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
  for (const auto& entry : this->BySource)
  {
    glDeleteProgram(entry.second->Name);
  }
  this->Programs.clear();
  this->BySource.clear();
  if (this->CountsErrors)
  {
    glDebugMessageCallback(nullptr, nullptr); // this object holds the counter
  }
}
