// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PipelineResources.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <sstream>
#include <utility>

namespace
{
constexpr std::int64_t MaximumGroups = 65535; // on an axis, guaranteed by OpenGL 4.3
constexpr std::size_t LargestStaging = 1
  << 12; // bytes that stay allocated for traffic with the CPU

int Index(Buffer buffer)
{
  return static_cast<int>(buffer);
}

void GLAPIENTRY CountError(
  GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar*, const void* counter)
{
  if (type == GL_DEBUG_TYPE_ERROR)
  {
    ++*static_cast<int*>(const_cast<void*>(counter));
  }
}

// Compiles one shader into a program; the compiler's log where that fails.
std::string AttachShader(GLuint program, GLenum type, const std::string& source)
{
  GLuint shader = glCreateShader(type);
  const char* text = source.c_str();
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
    log = log.empty() ? "no log" : log;
  }
  glAttachShader(program, shader);
  glDeleteShader(shader);
  return log;
}
}

//------------------------------------------------------------------------------
// The context
//------------------------------------------------------------------------------
bool PipelineResources::Fail(const std::string& message)
{
  this->Error =
    this->Error.empty() ? message : this->Error; // what comes later follows from the first
  return false;
}

// OpenGL 4.3, or an older context with its extensions: VTK asks EGL for 3.2, and NVIDIA gives just
// that.
bool PipelineResources::CheckContext()
{
  GLint major = 0, minor = 0, count = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  this->ByExtensions = major * 10 + minor < 43;
  if (!this->ByExtensions)
  {
    return true;
  }
  std::set<std::string> offered;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i)
  {
    offered.insert(
      reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
  }
  for (const std::string& extension : RequiredExtensions())
  {
    if (!offered.count(extension))
    {
      return this->Fail("needs OpenGL 4.3 (compute shaders), but this context offers " +
        std::to_string(major) + "." + std::to_string(minor) + " without " + extension +
        ": use a newer driver, or Mesa's llvmpipe");
    }
  }
  return true;
}

bool PipelineResources::Initialize()
{
  if (!this->CheckContext())
  {
    return false;
  }
  const char* debug = std::getenv("PROGISO_GL_DEBUG");
  this->CountsErrors = debug && *debug && *debug != '0';
  if (this->CountsErrors)
  {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(CountError, &this->GLErrors);
  }
  const char* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  this->Software = renderer &&
    (std::strstr(renderer, "llvmpipe") || std::strstr(renderer, "softpipe") ||
      std::strstr(renderer, "SWR"));
  glGenVertexArrays(1, &this->VertexArray);
  glGenBuffers(1, &this->Staging);
  glGenBuffers(1, &this->SceneBuffer);
  glBindBuffer(GL_UNIFORM_BUFFER, this->SceneBuffer);
  glBufferData(GL_UNIFORM_BUFFER, sizeof(SceneBlock), nullptr, GL_DYNAMIC_DRAW);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
  return true;
}

void PipelineResources::Release()
{
  for (int i = 0; i < NumberOfBuffers; ++i)
  {
    this->Free(static_cast<Buffer>(i));
  }
  for (GLuint& program : this->Programs)
  {
    glDeleteProgram(program);
    program = 0;
  }
  glDeleteBuffers(1, &this->SceneBuffer);
  glDeleteBuffers(1, &this->Staging);
  glDeleteVertexArrays(1, &this->VertexArray);
  if (this->CountsErrors)
  {
    glDebugMessageCallback(nullptr, nullptr); // the counter goes away with this object
  }
  this->SceneBuffer = 0;
  this->Staging = 0;
  this->StagingBytes = 0;
  this->VertexArray = 0;
  this->CountsErrors = false;
  this->StagesRun.clear();
  this->Error.clear();
}

std::string PipelineResources::GetDescription()
{
  std::ostringstream out;
  for (GLenum what : { GL_RENDERER, GL_VERSION })
  {
    const GLubyte* text = glGetString(what);
    out << (what == GL_VERSION ? ", OpenGL " : "")
        << (text ? reinterpret_cast<const char*>(text) : "unknown");
  }
  return out.str();
}

//------------------------------------------------------------------------------
// Stages
//------------------------------------------------------------------------------
GLuint PipelineResources::Program(Stage stage)
{
  GLuint& program = this->Programs[static_cast<int>(stage)];
  if (program)
  {
    return program;
  }
  const StageInfo& info = PipelineStages()[static_cast<int>(stage)];
  const std::string name = info.Name;
  program = glCreateProgram();
  std::string log;
  if (stage == Stage::Composite)
  {
    log = AttachShader(
            program, GL_VERTEX_SHADER, AssembleShader(name + ".vert", info, this->ByExtensions)) +
      AttachShader(
        program, GL_FRAGMENT_SHADER, AssembleShader(name + ".frag", info, this->ByExtensions));
  }
  else
  {
    log = AttachShader(
      program, GL_COMPUTE_SHADER, AssembleShader(name + ".comp", info, this->ByExtensions));
  }
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked)
  {
    char text[2048] = {};
    glGetProgramInfoLog(program, sizeof(text), nullptr, text);
    this->Fail("shader " + name + " does not build on this driver: " + log + text);
    glDeleteProgram(program);
    program = 0; // tried again, and told again, at the next render
  }
  return program;
}

void PipelineResources::Bind(Stage stage)
{
  glUseProgram(this->Program(stage));
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, this->SceneBuffer);
  GLuint binding = 0;
  for (Buffer buffer : PipelineStages()[static_cast<int>(stage)].Buffers)
  {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, this->Names[Index(buffer)]);
  }
  this->StagesRun.insert(stage);
}

void PipelineResources::Dispatch(Stage stage, std::int64_t groupsX, std::int64_t groupsY)
{
  this->Bind(stage);
  glDispatchCompute(
    static_cast<GLuint>(std::min(groupsX, MaximumGroups)), static_cast<GLuint>(groupsY), 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void PipelineResources::DispatchIndirect(Stage stage, std::size_t controlOffset)
{
  this->Bind(stage);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, this->Names[Index(Buffer::Control)]);
  glDispatchComputeIndirect(static_cast<GLintptr>(controlOffset));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void PipelineResources::DrawComposite()
{
  this->Bind(Stage::Composite);
  glBindVertexArray(this->VertexArray);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  for (GLuint binding = 0; binding < 8; ++binding)
  {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, 0);
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
  glUseProgram(0);
}

void PipelineResources::ForgetStages(const std::set<Stage>& except)
{
  std::set<Stage> kept;
  std::set_intersection(this->StagesRun.begin(), this->StagesRun.end(), except.begin(),
    except.end(), std::inserter(kept, kept.end()));
  this->StagesRun = std::move(kept);
}

//------------------------------------------------------------------------------
// Buffers
//------------------------------------------------------------------------------
std::int64_t PipelineResources::GetBytes(Buffer buffer) const
{
  return this->Bytes[Index(buffer)];
}

bool PipelineResources::Allocate(Buffer buffer, std::int64_t bytes)
{
  const int i = Index(buffer);
  if (this->Names[i] && this->Bytes[i] == bytes)
  {
    return true;
  }
  this->Free(buffer);
  while (glGetError() != GL_NO_ERROR)
  {
  }
  glGenBuffers(1, &this->Names[i]);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[i]);
  glBufferData(
    GL_SHADER_STORAGE_BUFFER, std::max<std::int64_t>(bytes, 4), nullptr, GL_DYNAMIC_COPY);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  if (glGetError() != GL_NO_ERROR)
  {
    this->Free(buffer);
    return this->Fail("the GPU has no room for " + std::to_string(bytes) + " bytes of " +
      PipelineBuffers()[i].Name + ": lower the rate, the image size or the cache limit");
  }
  this->Bytes[i] = std::max<std::int64_t>(bytes, 4);
  return true;
}

bool PipelineResources::Allocate(Lifetime lifetime, const PipelineExtent& extent)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.Life == lifetime && !this->Allocate(info.Id, info.Bytes(extent)))
    {
      return false;
    }
  }
  return true;
}

void PipelineResources::Free(Buffer buffer)
{
  const int i = Index(buffer);
  glDeleteBuffers(1, &this->Names[i]);
  this->Names[i] = 0;
  this->Bytes[i] = 0;
}

void PipelineResources::Fill(Buffer buffer, std::uint32_t value)
{
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(buffer)]);
  glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
}

void PipelineResources::Swap(Buffer a, Buffer b)
{
  std::swap(this->Names[Index(a)], this->Names[Index(b)]);
  std::swap(this->Bytes[Index(a)], this->Bytes[Index(b)]);
}

GLuint PipelineResources::Detach(Buffer buffer)
{
  this->Bytes[Index(buffer)] = 0;
  return std::exchange(this->Names[Index(buffer)], 0);
}

void PipelineResources::CopyAndDelete(GLuint old, Buffer buffer, std::int64_t bytes)
{
  if (old && bytes > 0)
  {
    glBindBuffer(GL_COPY_READ_BUFFER, old);
    glBindBuffer(GL_COPY_WRITE_BUFFER, this->Names[Index(buffer)]);
    glCopyBufferSubData(
      GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, static_cast<GLsizeiptr>(bytes));
    glBindBuffer(GL_COPY_READ_BUFFER, 0);
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  }
  glDeleteBuffers(1, &old);
}

// The CPU never touches a buffer of the stages itself but a copy: drivers move what it touches to
// the host's memory, where the stages' atomics are slow or, on some, go astray.
void PipelineResources::Read(Buffer buffer, void* data, std::size_t bytes)
{
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, this->Names[Index(buffer)]);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Staging);
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
  this->StagingBytes = static_cast<std::int64_t>(bytes);
  glCopyBufferSubData(
    GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, static_cast<GLsizeiptr>(bytes));
  glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
  if (bytes > LargestStaging) // a whole image: nothing to keep room for
  {
    glBufferData(GL_COPY_WRITE_BUFFER, 4, nullptr, GL_STREAM_READ);
    this->StagingBytes = 4;
  }
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void PipelineResources::Write(
  Buffer buffer, std::size_t offset, const void* data, std::size_t bytes)
{
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, this->Staging);
  glBufferData(GL_COPY_READ_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
  this->StagingBytes = static_cast<std::int64_t>(bytes);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Names[Index(buffer)]);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, static_cast<GLintptr>(offset),
    static_cast<GLsizeiptr>(bytes));
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

// For what the stages only read, and what may be too large for a second copy.
void PipelineResources::Upload(Buffer buffer, const void* data, std::int64_t bytes)
{
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(buffer)]);
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
}

void PipelineResources::UploadScene(const SceneBlock& scene)
{
  glBindBuffer(GL_UNIFORM_BUFFER, this->SceneBuffer);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(SceneBlock), &scene);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}
