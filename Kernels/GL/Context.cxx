// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/Context.h"

#include "GL/ProgIsoGL.h"
#include "Shaders/ShaderAssembler.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <set>
#include <sstream>

namespace
{
constexpr int MaximumErrors = 16; // read in a row: a lost context never runs out of them
constexpr std::int64_t SoftwareBuffer = 1LL << 30;   // llvmpipe has no limit, whatever it reports
constexpr std::int64_t AddressableBytes = 1LL << 34; // by the 32 bits of a word's number
constexpr GLenum DedicatedKibibytesNVX = 0x9047;     // GL_GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX
constexpr GLenum FreeKibibytesATI = 0x87FB; // GL_VBO_FREE_MEMORY_ATI: the total comes first

std::set<std::string> OfferedExtensions()
{
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  std::set<std::string> offered;
  for (GLint i = 0; i < count; ++i)
  {
    offered.insert(
      reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
  }
  return offered;
}

// Does OpenGL's string contain one of these words?
bool Names(GLenum what, std::initializer_list<const char*> words)
{
  const char* text = reinterpret_cast<const char*>(glGetString(what));
  return text &&
    std::any_of(
      words.begin(), words.end(), [=](const char* word) { return std::strstr(text, word); });
}

bool IsSoftwareRenderer()
{
  return Names(GL_RENDERER, { "llvmpipe", "softpipe", "SWR" });
}

// Only NVIDIA's driver is known to read large sparse buffers faster than plain ones; others may
// back them by small pages.
bool OffersFastSparseBuffers(const std::set<std::string>& offered)
{
  return offered.count("GL_ARB_sparse_buffer") > 0 && glBufferStorage &&
    glBufferPageCommitmentARB && Names(GL_VENDOR, { "NVIDIA" });
}

// NVIDIA's GPUs add and compare them in two instructions. Mesa breaks them up for Intel's, into
// more than pairs of words take, and llvmpipe takes longer over them, too.
bool OffersFastIntegers64(const std::set<std::string>& offered)
{
  return offered.count("GL_ARB_gpu_shader_int64") > 0 && Names(GL_VENDOR, { "NVIDIA" });
}

std::int64_t AskSparsePage()
{
  GLint bytes = 0;
  glGetIntegerv(GL_SPARSE_BUFFER_PAGE_SIZE_ARB, &bytes);
  return bytes;
}

std::int64_t AskDeviceMemory(const std::set<std::string>& offered)
{
  GLint kibibytes[4] = { 0, 0, 0, 0 };
  if (offered.count("GL_NVX_gpu_memory_info"))
  {
    glGetIntegerv(DedicatedKibibytesNVX, kibibytes);
  }
  else if (offered.count("GL_ATI_meminfo"))
  {
    glGetIntegerv(FreeKibibytesATI, kibibytes);
  }
  return static_cast<std::int64_t>(kibibytes[0]) << 10;
}
}

const Status& Context::Open()
{
  const Status status = this->CheckVersion();
  if (!status)
  {
    return this->Fail(status);
  }
  this->AskLimits();
  return this->FirstError;
}

void Context::Close()
{
  this->FirstError = Status();
}

// VTK asks EGL for OpenGL 3.2, and NVIDIA gives just that: then the extensions count.
Status Context::CheckVersion()
{
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  this->Dialect.ByExtensions = major * 10 + minor < 43;
  const std::set<std::string> offered = OfferedExtensions();
  for (const std::string& extension : RequiredExtensions())
  {
    if (this->Dialect.ByExtensions && !offered.count(extension))
    {
      return Status::Error("needs OpenGL 4.3 (compute shaders), but this context offers ", major,
        ".", minor, " without ", extension, ": use a newer driver, or Mesa's llvmpipe");
    }
  }
  this->Dialect.Integers64 = OffersFastIntegers64(offered);
  return Status();
}

void Context::AskLimits()
{
  const std::set<std::string> offered = OfferedExtensions();
  this->Limits.Software = IsSoftwareRenderer();
  this->Limits.SparseBuffers = OffersFastSparseBuffers(offered);
  this->Limits.SparsePage = this->Limits.SparseBuffers ? AskSparsePage() : 0;
  this->Limits.PersistentMapping = offered.count("GL_ARB_buffer_storage") > 0 && glBufferStorage;
  // llvmpipe offers it, too, but compiles a stage where it first runs
  this->Limits.BackgroundCompiler =
    !this->Limits.Software && offered.count("GL_KHR_parallel_shader_compile") > 0;
  this->Limits.DeviceMemory = AskDeviceMemory(offered);
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  this->LargestAllowed = this->Limits.Software
    ? SoftwareBuffer
    : std::min(static_cast<std::int64_t>(largest), AddressableBytes);
  this->LimitBuffers(0);
}

void Context::LimitBuffers(std::int64_t bytes)
{
  this->Limits.LargestBuffer =
    bytes > 0 ? std::min(bytes, this->LargestAllowed) : this->LargestAllowed;
}

const Status& Context::Fail(const Status& error)
{
  if (this->FirstError.IsOk())
  {
    this->FirstError = error;
  }
  return this->FirstError;
}

const Status& Context::CheckMemory()
{
  GLenum error = GL_NO_ERROR;
  for (int i = 0; i < MaximumErrors && (error = glGetError()) != GL_NO_ERROR; ++i)
  {
    if (error == GL_OUT_OF_MEMORY)
    {
      this->Fail(Status::Error(
        "the GPU has run out of memory: lower the memory budget, the rate or the image size"));
    }
  }
  return this->FirstError;
}

std::string Context::GetDescription()
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
