// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/Device.h"

#include "Shaders/Glsl.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <numeric>
#include <sstream>
#include <utility>

namespace
{
constexpr std::int64_t LargestRead = 1 << 18;      // bytes read at once
constexpr std::int64_t LargestStaging = 1 << 12;   // bytes that stay allocated between reads
constexpr std::int64_t MostSnapshots = 8;          // under way at once, with room to spare
constexpr int MostErrors = 16;                     // of others; a lost context never has none
constexpr std::int64_t SoftwareBuffer = 1LL << 30; // llvmpipe has no limit, whatever it reports

// Bytes of the uniform blocks, by their bindings.
constexpr std::int64_t UniformBytes[] = { sizeof(glsl::View), sizeof(glsl::Look),
  sizeof(glsl::Volume), sizeof(glsl::Cache) };

// Bytes beyond which a buffer is made sparse: NVIDIA then backs it with large pages. Random reads
// of a plain buffer are as fast up to 128 MiB and then 10 to 400 times slower, but it is made 10
// times faster, which counts for the decoded blocks: their buffer comes and goes with the scene,
// and neighbouring rays read neighbouring values.
constexpr std::int64_t LargestPlain = 1LL << 27;
constexpr std::int64_t LargestPlainValues = 1LL << 29;

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

double Milliseconds()
{
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}
}

//------------------------------------------------------------------------------
// The context
//------------------------------------------------------------------------------
bool Device::Fail(const std::string& message)
{
  this->Error =
    this->Error.empty() ? message : this->Error; // what comes later follows from the first
  return false;
}

// OpenGL 4.3, or an older context with its extensions: VTK asks EGL for 3.2, and NVIDIA gives just
// that.
bool Device::CheckContext()
{
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  this->ByExtensions = major * 10 + minor < 43;
  const std::set<std::string> offered = OfferedExtensions();
  for (const std::string& extension : RequiredExtensions())
  {
    if (this->ByExtensions && !offered.count(extension))
    {
      return this->Fail("needs OpenGL 4.3 (compute shaders), but this context offers " +
        std::to_string(major) + "." + std::to_string(minor) + " without " + extension +
        ": use a newer driver, or Mesa's llvmpipe");
    }
  }
  return true;
}

void Device::AskLimits()
{
  const char* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  this->Software = renderer &&
    (std::strstr(renderer, "llvmpipe") || std::strstr(renderer, "softpipe") ||
      std::strstr(renderer, "SWR"));
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  this->LargestAllowed = this->Software ? SoftwareBuffer : static_cast<std::int64_t>(largest);
  this->LimitBuffers(0);
  const std::set<std::string> offered = OfferedExtensions();
  this->OffersSparse =
    offered.count("GL_ARB_sparse_buffer") > 0 && glBufferStorage && glBufferPageCommitmentARB;
  GLint kibibytes[4] = { 0, 0, 0, 0 };
  if (offered.count("GL_NVX_gpu_memory_info"))
  {
    glGetIntegerv(0x9047, kibibytes); // GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX
  }
  else if (offered.count("GL_ATI_meminfo"))
  {
    glGetIntegerv(0x87FB, kibibytes); // VBO_FREE_MEMORY_ATI, the total first
  }
  this->DeviceMemory = static_cast<std::int64_t>(kibibytes[0]) << 10;
}

void Device::LimitBuffers(std::int64_t bytes)
{
  this->LargestBuffer = bytes > 0 ? std::min(bytes, this->LargestAllowed) : this->LargestAllowed;
}

bool Device::Initialize(std::uint64_t context)
{
  if (!this->CheckContext())
  {
    return false;
  }
  const char* debug = std::getenv("PROGISO_GL_DEBUG");
  this->CountsErrors = debug && *debug && *debug != '0';
  this->Programs = ProgramCache::OfContext(context, this->ByExtensions);
  if (this->CountsErrors)
  {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(CountError, &this->Programs->GLErrors);
  }
  this->AskLimits();
  glGenVertexArrays(1, &this->VertexArray);
  glGenBuffers(1, &this->Staging);
  glGenBuffers(static_cast<GLsizei>(this->UniformBuffers.size()), this->UniformBuffers.data());
  for (std::size_t binding = 0; binding < this->UniformBuffers.size(); ++binding)
  {
    glBindBuffer(GL_UNIFORM_BUFFER, this->UniformBuffers[binding]);
    glBufferData(GL_UNIFORM_BUFFER, UniformBytes[binding], nullptr, GL_DYNAMIC_DRAW);
  }
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
  return true;
}

void Device::Release()
{
  for (int i = 0; i < NumberOfBuffers; ++i)
  {
    this->Free(static_cast<Buffer>(i));
  }
  this->FreeStreams();
  this->UploadPalette({});
  this->ForgetSnapshots();
  glDeleteBuffers(static_cast<GLsizei>(this->SpareSnapshots.size()), this->SpareSnapshots.data());
  this->SpareSnapshots.clear();
  this->ForgetStages();
  glUseProgram(0); // where a stage has failed it is still in use
  this->GLErrors = this->GetNumberOfGLErrors();
  if (this->Programs && this->Programs.use_count() == 1)
  {
    if (this->CountsErrors)
    {
      glDebugMessageCallback(nullptr, nullptr); // the counter goes away with the programs
    }
    this->Programs->Release();
  }
  this->Programs = nullptr;
  glDeleteBuffers(static_cast<GLsizei>(this->UniformBuffers.size()), this->UniformBuffers.data());
  glDeleteBuffers(1, &this->Staging);
  glDeleteVertexArrays(1, &this->VertexArray);
  this->UniformBuffers.fill(0);
  this->Staging = 0;
  this->StagingBytes = 0;
  this->VertexArray = 0;
  this->CountsErrors = false;
  this->Error.clear();
}

std::string Device::GetDescription()
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
// What the stage reads of a compressed stream; null where it reads none, or there is none.
const Device::StreamBuffers* Device::StreamOf(Stage stage) const
{
  for (const BufferUse& use : InfoOf(stage).Buffers)
  {
    const auto found = this->Streams.find(use.Id);
    if (found != this->Streams.end())
    {
      return &found->second;
    }
  }
  return nullptr;
}

bool Device::Bind(Stage stage, GLuint stream, const StreamSegment* segment)
{
  std::vector<Buffer> bound;
  std::vector<GLuint> names;
  for (const BufferUse& use : InfoOf(stage).Buffers)
  {
    const bool ofStream = use.Id == Buffer::Stream || use.Id == Buffer::ColorStream;
    const GLuint name = ofStream ? stream : this->Names[Index(use.Id)];
    if (name)
    {
      bound.push_back(use.Id);
      names.push_back(name);
    }
  }
  const GLuint program = this->Programs->Get(stage, bound, this->Extent, this->Error);
  if (!program)
  {
    return false;
  }
  glUseProgram(program);
  for (std::size_t i = 0; i < this->UniformBuffers.size(); ++i)
  {
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(i), this->UniformBuffers[i]);
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, PALETTE_BINDING, this->PaletteBuffer);
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(i), names[i]);
  }
  if (segment)
  {
    const GLuint values[] = { segment->FirstBlock, segment->Blocks, segment->FirstBit,
      static_cast<GLuint>(segment->Bytes / 4), segment->FirstMacrocell, segment->Macrocells };
    glUniform1uiv(glGetUniformLocation(program, "segment"), 6, values);
  }
  this->StagesRun.insert(stage);
  return true;
}

template <typename Launch>
void Device::Run(Stage stage, const Launch& launch)
{
  if (!this->Error.empty())
  {
    return; // what an earlier stage should have made may be missing: this one could hang the GPU
  }
  const StreamBuffers* stream = this->StreamOf(stage);
  const std::size_t times = stream ? stream->Segments.size() : 1;
  this->BeginTiming(stage);
  for (std::size_t i = 0; i < times; ++i)
  {
    if (this->Bind(stage, stream ? stream->Names[i] : 0, stream ? &stream->Segments[i] : nullptr))
    {
      launch();
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    }
  }
  this->EndTiming(stage);
}

void Device::Dispatch(Stage stage, std::int64_t groups)
{
  const std::int64_t most = glsl::MAX_GROUPS;
  const GLuint x = static_cast<GLuint>(std::min(groups, most));
  const GLuint y = static_cast<GLuint>((groups + most - 1) / most);
  this->Run(stage, [=]() { glDispatchCompute(x, y, 1); });
}

void Device::DispatchIndirect(Stage stage, std::size_t controlOffset)
{
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, this->Names[Index(Buffer::Control)]);
  this->Run(stage, [=]() { glDispatchComputeIndirect(static_cast<GLintptr>(controlOffset)); });
}

void Device::Draw(Stage stage, const std::array<float, 4>* selected)
{
  this->Run(stage,
    [=]()
    {
      if (selected)
      {
        GLint program = 0;
        glGetIntegerv(GL_CURRENT_PROGRAM, &program);
        glUniform4fv(glGetUniformLocation(program, "selected"), 1, selected->data());
      }
      glBindVertexArray(this->VertexArray);
      glDrawArrays(GL_TRIANGLES, 0, 3);
      glBindVertexArray(0);
    });
  for (GLuint binding = 0; binding < NumberOfBuffers; ++binding)
  {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, 0);
  }
  for (GLuint binding = 0; binding <= PALETTE_BINDING; ++binding)
  {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, 0);
  }
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
  glUseProgram(0);
}

// Software renderers have no credible timer queries, but a synchronous end.
void Device::BeginTiming(Stage stage)
{
  if (!this->Extent.Detailed)
  {
    return;
  }
  if (this->Software)
  {
    glFinish();
    this->TimingStart = Milliseconds();
    return;
  }
  Timing timing = { stage, 0, 0 };
  glGenQueries(1, &timing.Begin);
  glGenQueries(1, &timing.End);
  glQueryCounter(timing.Begin, GL_TIMESTAMP);
  this->Timings.push_back(timing);
}

void Device::EndTiming(Stage stage)
{
  if (this->Extent.Detailed && this->Software)
  {
    glFinish();
    this->StageMilliseconds[stage] += Milliseconds() - this->TimingStart;
  }
  else if (this->Extent.Detailed)
  {
    glQueryCounter(this->Timings.back().End, GL_TIMESTAMP);
  }
}

std::map<Stage, double> Device::GetStageMilliseconds()
{
  for (const Timing& timing : this->Timings)
  {
    GLuint64 begin = 0, end = 0;
    glGetQueryObjectui64v(timing.Begin, GL_QUERY_RESULT, &begin);
    glGetQueryObjectui64v(timing.End, GL_QUERY_RESULT, &end);
    this->StageMilliseconds[timing.Id] += (end - begin) * 1e-6;
    glDeleteQueries(1, &timing.Begin);
    glDeleteQueries(1, &timing.End);
  }
  this->Timings.clear();
  return this->StageMilliseconds;
}

void Device::ForgetStages(const std::set<Stage>& except)
{
  std::set<Stage> kept;
  std::set_intersection(this->StagesRun.begin(), this->StagesRun.end(), except.begin(),
    except.end(), std::inserter(kept, kept.end()));
  this->StagesRun = std::move(kept);
  for (const Timing& timing : this->Timings)
  {
    glDeleteQueries(1, &timing.Begin);
    glDeleteQueries(1, &timing.End);
  }
  this->Timings.clear();
  this->StageMilliseconds.clear();
}

//------------------------------------------------------------------------------
// Buffers
//------------------------------------------------------------------------------
std::int64_t Device::GetBytes(Buffer buffer) const
{
  std::int64_t bytes = this->Bytes[Index(buffer)];
  const auto stream = this->Streams.find(buffer);
  if (stream != this->Streams.end())
  {
    for (const StreamSegment& segment : stream->second.Segments)
    {
      bytes += segment.Bytes;
    }
  }
  return bytes;
}

bool Device::MakeBuffer(
  GLuint& name, std::int64_t bytes, std::int64_t largestPlain, const char* what)
{
  if (bytes > this->LargestBuffer)
  {
    return this->Fail(std::to_string(bytes) + " bytes of " + what +
      " are more than one GPU buffer can hold here (" + std::to_string(this->LargestBuffer) +
      "): lower the image size or the volume's");
  }
  if (!this->CheckMemory())
  {
    return false;
  }
  glGenBuffers(1, &name);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
  const GLsizeiptr size = static_cast<GLsizeiptr>(bytes);
  if (this->OffersSparse && bytes > largestPlain)
  {
    glBufferStorage(
      GL_SHADER_STORAGE_BUFFER, size, nullptr, GL_SPARSE_STORAGE_BIT_ARB | GL_DYNAMIC_STORAGE_BIT);
    glBufferPageCommitmentARB(GL_SHADER_STORAGE_BUFFER, 0, size, GL_TRUE);
  }
  else
  {
    glBufferData(GL_SHADER_STORAGE_BUFFER, size, nullptr, GL_DYNAMIC_COPY);
  }
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  if (glGetError() == GL_NO_ERROR)
  {
    return true;
  }
  glDeleteBuffers(1, &name);
  name = 0;
  return this->Fail("the GPU has no room for " + std::to_string(bytes) + " bytes of " + what +
    ": lower the memory budget, the rate or the image size");
}

bool Device::CheckMemory()
{
  GLenum error = GL_NO_ERROR;
  for (int i = 0; i < MostErrors && (error = glGetError()) != GL_NO_ERROR; ++i)
  {
    if (error == GL_OUT_OF_MEMORY)
    {
      this->Fail(
        "the GPU has run out of memory: lower the memory budget, the rate or the image size");
    }
  }
  return this->Error.empty();
}

bool Device::Allocate(Buffer buffer, std::int64_t bytes)
{
  const int i = Index(buffer);
  if (this->Bytes[i] == bytes)
  {
    return true;
  }
  this->Free(buffer);
  const std::int64_t plain = buffer == Buffer::CacheValues ? LargestPlainValues : LargestPlain;
  if (bytes > 0 && !this->MakeBuffer(this->Names[i], bytes, plain, PipelineBuffers()[i].Name))
  {
    return false;
  }
  this->Bytes[i] = bytes;
  return true;
}

void Device::Trim(const PipelineExtent& extent)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.Bytes(extent) != this->Bytes[Index(info.Id)])
    {
      this->Free(info.Id);
    }
  }
}

bool Device::Allocate(Lifetime lifetime, const PipelineExtent& extent)
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

bool Device::Has(Lifetime lifetime, const PipelineExtent& extent) const
{
  const auto& buffers = PipelineBuffers();
  return std::all_of(buffers.begin(), buffers.end(),
    [&](const BufferInfo& info)
    { return info.Life != lifetime || info.Bytes(extent) == this->Bytes[Index(info.Id)]; });
}

void Device::Free(Lifetime lifetime)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.Life == lifetime)
    {
      this->Free(info.Id);
    }
  }
}

void Device::Free(Buffer buffer)
{
  const int i = Index(buffer);
  glDeleteBuffers(1, &this->Names[i]);
  this->Names[i] = 0;
  this->Bytes[i] = 0;
}

void Device::Fill(Buffer buffer, std::uint32_t value)
{
  if (!this->Names[Index(buffer)])
  {
    return;
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(buffer)]);
  glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
}

void Device::Upload(Buffer buffer, const std::vector<std::uint32_t>& words)
{
  if (!words.empty())
  {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(buffer)]);
    glBufferSubData(
      GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(4 * words.size()), words.data());
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  }
}

// The stages only read it, and it may be too large for a second copy.
bool Device::UploadStream(
  Buffer which, const unsigned char* bytes, const std::vector<StreamSegment>& segments)
{
  StreamBuffers& stream = this->Streams[which];
  for (const StreamSegment& segment : segments)
  {
    GLuint name = 0;
    if (!this->MakeBuffer(name, segment.Bytes, LargestPlain, "the compressed volume"))
    {
      return false;
    }
    stream.Names.push_back(name);
    stream.Segments.push_back(segment);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(segment.Bytes),
      bytes + segment.FirstByte);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  }
  return true;
}

void Device::FreeStreams()
{
  for (const auto& entry : this->Streams)
  {
    const std::vector<GLuint>& names = entry.second.Names;
    glDeleteBuffers(static_cast<GLsizei>(names.size()), names.data());
  }
  this->Streams.clear();
}

//------------------------------------------------------------------------------
// Traffic with the CPU. It never touches a buffer of the stages itself but a copy: drivers move
// what it touches to the host's memory, where the stages' atomics are slow or, on some, go astray.
//------------------------------------------------------------------------------
std::int64_t Device::GetStagingLimit()
{
  return LargestRead + MostSnapshots * static_cast<std::int64_t>(sizeof(Snapshot));
}

std::int64_t Device::GetStagingBytes() const
{
  const std::size_t snapshots = this->Ordered.size() + this->SpareSnapshots.size();
  return this->StagingBytes + static_cast<std::int64_t>(snapshots * sizeof(Snapshot));
}

void Device::Read(Buffer buffer, std::int64_t offset, void* data, std::int64_t bytes)
{
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, this->Names[Index(buffer)]);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Staging);
  for (std::int64_t done = 0; done < bytes; done += LargestRead)
  {
    const GLsizeiptr part = static_cast<GLsizeiptr>(std::min(LargestRead, bytes - done));
    glBufferData(GL_COPY_WRITE_BUFFER, part, nullptr, GL_STREAM_READ);
    glCopyBufferSubData(
      GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset + done), 0, part);
    glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, part, static_cast<char*>(data) + done);
  }
  this->StagingBytes = std::min(bytes, LargestStaging);
  glBufferData(
    GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(this->StagingBytes), nullptr, GL_STREAM_READ);
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void Device::Write(Buffer buffer, std::size_t offset, const void* data, std::size_t bytes)
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

void Device::UploadUniforms(int binding, const void* block, std::size_t bytes)
{
  glBindBuffer(GL_UNIFORM_BUFFER, this->UniformBuffers[binding]);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, static_cast<GLsizeiptr>(bytes), block);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

std::int64_t Device::GetUniformBytes()
{
  return std::accumulate(std::begin(UniformBytes), std::end(UniformBytes), std::int64_t(0));
}

void Device::UploadPalette(const std::vector<float>& palette)
{
  this->PaletteBytes = static_cast<std::int64_t>(palette.size() * sizeof(float));
  if (palette.empty())
  {
    glDeleteBuffers(1, &this->PaletteBuffer);
    this->PaletteBuffer = 0;
    return;
  }
  if (!this->PaletteBuffer)
  {
    glGenBuffers(1, &this->PaletteBuffer);
  }
  glBindBuffer(GL_UNIFORM_BUFFER, this->PaletteBuffer);
  glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(this->PaletteBytes), palette.data(),
    GL_DYNAMIC_DRAW);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

namespace
{
// Internal format of the depths that the framebuffer to be read from has.
GLenum DepthFormat(bool& stencil)
{
  GLint bits = 0, type = 0, stencilBits = 0, bound = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &bound);
  const GLenum depth = bound ? GL_DEPTH_ATTACHMENT : GL_DEPTH; // the window's own names it so
  const auto ask = [depth](GLenum what, GLint& answer)
  { glGetFramebufferAttachmentParameteriv(GL_READ_FRAMEBUFFER, depth, what, &answer); };
  ask(GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE, bits);
  ask(GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE, stencilBits);
  ask(GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE, type);
  stencil = stencilBits > 0;
  if (type == GL_FLOAT)
  {
    return stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F;
  }
  return stencil ? GL_DEPTH24_STENCIL8
    : bits == 16 ? GL_DEPTH_COMPONENT16
    : bits == 24 ? GL_DEPTH_COMPONENT24
                 : GL_DEPTH_COMPONENT32;
}

// A framebuffer of one sample a pixel, with the depths of the one that is read from; it is bound to
// be read from instead, until it is destroyed.
class ResolvedDepths
{
public:
  explicit ResolvedDepths(const std::int32_t image[4])
  {
    bool stencil = false;
    const GLenum format = DepthFormat(stencil);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &this->Drawn);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &this->Read);
    glGenRenderbuffers(1, &this->Depths);
    glBindRenderbuffer(GL_RENDERBUFFER, this->Depths);
    glRenderbufferStorage(GL_RENDERBUFFER, format, image[2] + image[0], image[3] + image[1]);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glGenFramebuffers(1, &this->Framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, this->Framebuffer);
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER,
      stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, this->Depths);
    glBlitFramebuffer(image[2], image[3], image[2] + image[0], image[3] + image[1], image[2],
      image[3], image[2] + image[0], image[3] + image[1], GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, this->Framebuffer);
  }
  ~ResolvedDepths()
  {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(this->Drawn));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(this->Read));
    glDeleteFramebuffers(1, &this->Framebuffer);
    glDeleteRenderbuffers(1, &this->Depths);
  }
  ResolvedDepths(const ResolvedDepths&) = delete;
  void operator=(const ResolvedDepths&) = delete;

private:
  GLint Drawn = 0, Read = 0;
  GLuint Framebuffer = 0, Depths = 0;
};
}

// What is drawn into now is read, whatever was to be read from before.
void Device::CaptureDepths(const std::int32_t image[4], Buffer buffer, std::int64_t offset)
{
  GLint drawn = 0, read = 0, samples = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn);
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(drawn));
  glGetIntegerv(GL_SAMPLES, &samples);
  {
    const std::unique_ptr<ResolvedDepths> resolved(
      samples > 0 ? new ResolvedDepths(image) : nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, this->Names[Index(buffer)]);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(image[2], image[3], image[0], image[1], GL_DEPTH_COMPONENT, GL_FLOAT,
      reinterpret_cast<void*>(static_cast<std::intptr_t>(offset)));
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read));
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void Device::OrderSnapshot()
{
  Order order = { 0, nullptr };
  if (this->SpareSnapshots.empty())
  {
    glGenBuffers(1, &order.Buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, order.Buffer);
    glBufferData(GL_COPY_WRITE_BUFFER, sizeof(Snapshot), nullptr, GL_STREAM_READ);
    this->CheckMemory();
  }
  else
  {
    order.Buffer = this->SpareSnapshots.back();
    this->SpareSnapshots.pop_back();
    glBindBuffer(GL_COPY_WRITE_BUFFER, order.Buffer);
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, this->Names[Index(Buffer::Control)]);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, sizeof(Snapshot::Control));
  glBindBuffer(GL_COPY_READ_BUFFER, this->Names[Index(Buffer::PassStatistics)]);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, offsetof(Snapshot, Records),
    sizeof(Snapshot::Records));
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  order.Fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  this->Ordered.push_back(order);
}

Snapshot Device::AwaitSnapshot()
{
  const Order order = this->Ordered.front();
  this->Ordered.pop_front();
  const GLuint64 second = 1000000000;
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED)
  {
    state = glClientWaitSync(order.Fence, GL_SYNC_FLUSH_COMMANDS_BIT, second);
  }
  glDeleteSync(order.Fence);
  Snapshot snapshot = {};
  if (state == GL_WAIT_FAILED)
  {
    this->Fail("the GPU was lost: release the graphics resources and render again");
  }
  glBindBuffer(GL_COPY_READ_BUFFER, order.Buffer);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof(snapshot), &snapshot);
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  this->SpareSnapshots.push_back(order.Buffer);
  return snapshot;
}

void Device::ForgetSnapshots()
{
  for (const Order& order : this->Ordered)
  {
    glDeleteSync(order.Fence);
    this->SpareSnapshots.push_back(order.Buffer);
  }
  this->Ordered.clear();
}
