// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressivePipeline.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace
{
constexpr std::int64_t MinimumSlots = 128;              // a quarter of it admits any block's neighbourhood
constexpr std::int64_t LargestBuffer = 2147483647;      // bytes of one SSBO binding on NVIDIA
constexpr std::int64_t AutomaticCacheBytes = 1LL << 30; // upper bound where the user sets none
constexpr std::int64_t MaximumGroups = 65535;
constexpr int PassesPerBatch = 4;  // submitted before the CPU asks how many rays are left
constexpr int PatienceWithNone = 16; // passes or shading rounds that get nowhere before we give up

int Index(Buffer buffer)
{
  return static_cast<int>(buffer);
}

std::int64_t DivideUp(std::int64_t a, std::int64_t b)
{
  return (a + b - 1) / b;
}

void GLAPIENTRY CountError(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar*, const void* counter)
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
// GL objects
//------------------------------------------------------------------------------
bool ProgressivePipeline::Fail(const std::string& message)
{
  this->Error = this->Error.empty() ? message : this->Error; // what comes later follows from the first
  return false;
}

// OpenGL 4.3, or an older context with its extensions: VTK asks EGL for 3.2, and NVIDIA gives just that.
bool ProgressivePipeline::CheckContext()
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
    offered.insert(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
  }
  for (const std::string& extension : RequiredExtensions())
  {
    if (!offered.count(extension))
    {
      return this->Fail("needs OpenGL 4.3 (compute shaders), but this context offers " + std::to_string(major) + "." +
        std::to_string(minor) + " without " + extension + ": use a newer driver, or Mesa's llvmpipe");
    }
  }
  return true;
}

bool ProgressivePipeline::Initialize()
{
  if (this->SceneBuffer)
  {
    return true;
  }
  if (!this->CheckContext())
  {
    return false;
  }
  const char* debug = std::getenv("PROGISO_GL_DEBUG");
  if (debug && *debug && *debug != '0')
  {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(CountError, &this->GLErrors);
  }
  const char* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  this->SoftwareRenderer = renderer &&
    (std::strstr(renderer, "llvmpipe") || std::strstr(renderer, "softpipe") || std::strstr(renderer, "SWR"));
  glGenVertexArrays(1, &this->VertexArray);
  glGenBuffers(1, &this->Staging);
  glGenBuffers(1, &this->SceneBuffer);
  glBindBuffer(GL_UNIFORM_BUFFER, this->SceneBuffer);
  glBufferData(GL_UNIFORM_BUFFER, sizeof(SceneBlock), nullptr, GL_DYNAMIC_DRAW);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
  if (!this->AllocateAll(Lifetime::Pipeline))
  {
    return false;
  }
  ControlBlock control = {};
  control.PassSerial = 1;
  for (DispatchArguments* groups : { &control.TraverseGroups, &control.PairGroups, &control.AdmitGroups,
         &control.DecodeGroups, &control.IntersectGroups, &control.EvictGroups })
  {
    *groups = { 0, 1, 1, 0 };
  }
  this->Write(Buffer::Control, 0, &control, sizeof(control));
  return true;
}

void ProgressivePipeline::Release()
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
  glDeleteQueries(static_cast<GLsizei>(this->TimeQueries.size()), this->TimeQueries.data());
  if (this->SceneBuffer && std::getenv("PROGISO_GL_DEBUG"))
  {
    glDebugMessageCallback(nullptr, nullptr); // the counter goes away with this object
  }
  this->TimeQueries.clear();
  this->Error.clear();
  this->SceneBuffer = 0;
  this->Staging = 0;
  this->VertexArray = 0;
  this->Extent = PipelineExtent();
  this->Started = false;
}

GLuint ProgressivePipeline::Program(Stage stage)
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
    log = AttachShader(program, GL_VERTEX_SHADER, AssembleShader(name + ".vert", info, this->ByExtensions)) +
      AttachShader(program, GL_FRAGMENT_SHADER, AssembleShader(name + ".frag", info, this->ByExtensions));
  }
  else
  {
    log = AttachShader(program, GL_COMPUTE_SHADER, AssembleShader(name + ".comp", info, this->ByExtensions));
  }
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked)
  {
    char text[2048] = {};
    glGetProgramInfoLog(program, sizeof(text), nullptr, text);
    this->Fail("shader " + name + " does not build on this driver: " + log + text);
  }
  return program;
}

void ProgressivePipeline::Bind(Stage stage)
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

void ProgressivePipeline::Dispatch(Stage stage, std::int64_t groupsX, std::int64_t groupsY)
{
  this->Bind(stage);
  glDispatchCompute(static_cast<GLuint>(std::min(groupsX, MaximumGroups)), static_cast<GLuint>(groupsY), 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void ProgressivePipeline::DispatchIndirect(Stage stage, std::size_t controlOffset)
{
  this->Bind(stage);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, this->Names[Index(Buffer::Control)]);
  glDispatchComputeIndirect(static_cast<GLintptr>(controlOffset));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

bool ProgressivePipeline::Allocate(Buffer buffer, std::int64_t bytes)
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
  glBufferData(GL_SHADER_STORAGE_BUFFER, std::max<std::int64_t>(bytes, 4), nullptr, GL_DYNAMIC_COPY);
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

bool ProgressivePipeline::AllocateAll(Lifetime lifetime)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.Life == lifetime && !this->Allocate(info.Id, info.Bytes(this->Extent)))
    {
      return false;
    }
  }
  return true;
}

void ProgressivePipeline::Free(Buffer buffer)
{
  const int i = Index(buffer);
  glDeleteBuffers(1, &this->Names[i]);
  this->Names[i] = 0;
  this->Bytes[i] = 0;
}

void ProgressivePipeline::Fill(Buffer buffer, std::uint32_t value)
{
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(buffer)]);
  glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
}

// The CPU never touches a buffer of the stages itself but a copy: drivers move what it touches to the
// host's memory, where the stages' atomics are slow or, on some, go astray.
template <typename T>
T ProgressivePipeline::Read(Buffer buffer)
{
  T value;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, this->Names[Index(buffer)]);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Staging);
  glBufferData(GL_COPY_WRITE_BUFFER, sizeof(T), nullptr, GL_STREAM_READ);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, sizeof(T));
  glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, sizeof(T), &value);
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  return value;
}

void ProgressivePipeline::Write(Buffer buffer, std::size_t offset, const void* data, std::size_t bytes)
{
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, this->Staging);
  glBufferData(GL_COPY_READ_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Names[Index(buffer)]);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, static_cast<GLintptr>(offset),
    static_cast<GLsizeiptr>(bytes));
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void ProgressivePipeline::WriteControl(std::size_t offset, std::uint32_t value)
{
  this->Write(Buffer::Control, offset, &value, sizeof(value));
}

void ProgressivePipeline::UploadScene()
{
  glBindBuffer(GL_UNIFORM_BUFFER, this->SceneBuffer);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(SceneBlock), &this->Scene);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

std::string ProgressivePipeline::GetDescription() const
{
  std::ostringstream out;
  for (GLenum what : { GL_RENDERER, GL_VERSION })
  {
    const GLubyte* text = glGetString(what);
    out << (what == GL_VERSION ? ", OpenGL " : "") << (text ? reinterpret_cast<const char*>(text) : "unknown");
  }
  return out.str();
}

//------------------------------------------------------------------------------
// The volume and its cache
//------------------------------------------------------------------------------
bool ProgressivePipeline::SetVolume(const PipelineVolume& volume)
{
  if (volume.StreamBytes > LargestBuffer)
  {
    return this->Fail("the compressed volume has " + std::to_string(volume.StreamBytes) +
      " bytes, more than one GPU buffer can bind (" + std::to_string(LargestBuffer) + "): lower the rate");
  }
  this->Volume = volume;
  this->Started = false;
  this->StagesRun.clear();
  std::int64_t blocks = 1, coarseCells = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Scene.Samples[axis] = volume.Samples[axis];
    this->Scene.Blocks[axis] = static_cast<std::int32_t>(DivideUp(volume.Samples[axis], 4));
    this->Scene.CoarseCells[axis] = static_cast<std::int32_t>(DivideUp(volume.Samples[axis], 16));
    blocks *= this->Scene.Blocks[axis];
    coarseCells *= this->Scene.CoarseCells[axis];
  }
  this->Scene.Blocks[3] = static_cast<std::int32_t>(blocks);
  this->Scene.CoarseCells[3] = static_cast<std::int32_t>(coarseCells);
  this->Scene.Payload[0] = static_cast<std::uint32_t>(volume.BlockBits);
  this->Scene.Payload[1] = static_cast<std::uint32_t>(volume.StreamBytes / 4);
  this->Scene.Payload[2] = static_cast<std::uint32_t>(PipelineExtent::RaysPerWorkItem);
  this->Extent.PayloadBytes = volume.StreamBytes;
  this->Extent.CoarseCells = coarseCells;
  this->Extent.Slots = 0; // the next Start() makes a cache for this volume
  if (!this->AllocateAll(Lifetime::Volume))
  {
    return false;
  }
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(Buffer::Payload)]);
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, volume.StreamBytes, volume.Stream);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  this->UploadScene();
  this->Dispatch(Stage::BlockRanges, coarseCells);
  return this->Error.empty();
}

void ProgressivePipeline::SetLimits(std::int64_t cacheBytes, int speculation)
{
  if (cacheBytes != this->CacheLimit)
  {
    this->Extent.Slots = 0;
  }
  this->CacheLimit = cacheBytes;
  this->SpeculationLimit = speculation;
}

// As many slots as the limit, one buffer's size and the volume's number of blocks let make sense.
std::int64_t ProgressivePipeline::MaximumSlots() const
{
  PipelineExtent one;
  one.Slots = 1;
  std::int64_t bytesPerSlot = 0;
  for (const BufferInfo& info : PipelineBuffers())
  {
    bytesPerSlot += info.Life == Lifetime::Cache ? info.Bytes(one) : 0;
  }
  const std::int64_t limit = this->CacheLimit > 0 ? this->CacheLimit : AutomaticCacheBytes;
  const std::int64_t most = std::min(limit / bytesPerSlot, LargestBuffer / 256);
  return std::max(MinimumSlots, std::min<std::int64_t>(most, this->Scene.Blocks[3]));
}

// A cache of another size that keeps the blocks it holds; with none before, an empty one.
bool ProgressivePipeline::ResizeCache(std::int64_t slots)
{
  const ControlBlock control = this->Read<ControlBlock>(Buffer::Control);
  const std::int64_t kept = this->Extent.Slots;
  std::array<GLuint, NumberOfBuffers> old = {};
  for (Buffer buffer : { Buffer::CacheValues, Buffer::CacheSlotBlock, Buffer::CacheSlotStamp })
  {
    std::swap(old[Index(buffer)], this->Names[Index(buffer)]);
  }
  this->Extent.Slots = slots;
  this->Scene.Cache[0] = static_cast<std::uint32_t>(slots);
  this->Scene.Cache[1] = static_cast<std::uint32_t>(this->Extent.Entries());
  this->UploadScene();
  const bool allocated = this->AllocateAll(Lifetime::Cache);
  if (allocated)
  {
    this->Fill(Buffer::CacheMap, 0xFFFFFFFFu);
    this->Fill(Buffer::CacheSlotBlock, 0xFFFFFFFFu);
  }
  for (int i = 0; i < NumberOfBuffers; ++i)
  {
    if (old[i] && kept && allocated)
    {
      glBindBuffer(GL_COPY_READ_BUFFER, old[i]);
      glBindBuffer(GL_COPY_WRITE_BUFFER, this->Names[i]);
      glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, kept * (this->Bytes[i] / slots));
    }
    glDeleteBuffers(1, &old[i]);
  }
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  if (!allocated)
  {
    return false;
  }
  // BeginPass takes the slots of the last pass off the ring: here they are off it already
  const std::uint32_t taken = kept ? control.DecodedBlocks : 0;
  this->WriteControl(offsetof(ControlBlock, DecodedBlocks), taken);
  this->WriteControl(offsetof(ControlBlock, FreeHead), 0);
  this->WriteControl(offsetof(ControlBlock, FreeSlots), taken);
  this->WriteControl(offsetof(ControlBlock, MapUsed), 0);
  this->Dispatch(Stage::CacheAges, DivideUp(this->Extent.Entries(), 256)); // empties the map
  this->Dispatch(Stage::CacheRebuild, DivideUp(slots, 256));
  return true;
}

bool ProgressivePipeline::GrowCache()
{
  const std::int64_t slots = std::min(2 * this->Extent.Slots, this->MaximumSlots());
  return slots <= this->Extent.Slots || this->ResizeCache(slots);
}

//------------------------------------------------------------------------------
// The image
//------------------------------------------------------------------------------
bool ProgressivePipeline::SetScene(const SceneBlock& scene)
{
  const SceneBlock own = this->Scene;
  this->Scene = scene;
  std::copy(own.Samples, own.Samples + 4, this->Scene.Samples);
  std::copy(own.Blocks, own.Blocks + 4, this->Scene.Blocks);
  std::copy(own.CoarseCells, own.CoarseCells + 4, this->Scene.CoarseCells);
  std::copy(own.Payload, own.Payload + 4, this->Scene.Payload);
  std::copy(own.Cache, own.Cache + 4, this->Scene.Cache);
  this->Scene.Cache[2] = static_cast<std::uint32_t>(this->SpeculationLimit);
  this->Extent.Pixels = static_cast<std::int64_t>(scene.Image[0]) * scene.Image[1];
  if (!this->AllocateAll(Lifetime::Image))
  {
    return false;
  }
  const bool newImage = this->Extent.Slots > 0 &&
    this->Bytes[Index(Buffer::CacheWorkItems)] != PipelineBuffers()[Index(Buffer::CacheWorkItems)].Bytes(this->Extent);
  if (newImage && !this->Allocate(Buffer::CacheWorkItems, PipelineBuffers()[Index(Buffer::CacheWorkItems)].Bytes(this->Extent)))
  {
    return false;
  }
  this->UploadScene();
  if (this->Extent.Slots == 0)
  {
    // holds the working sets of small volumes; it grows on demand
    const std::int64_t wanted = std::max<std::int64_t>(16384, this->Extent.Pixels / 8);
    return this->ResizeCache(std::min(wanted, this->MaximumSlots()));
  }
  return true;
}

void ProgressivePipeline::Start()
{
  this->Passes.clear();
  this->PassEnds.clear();
  this->PassesSubmitted = 0;
  this->Remaining = this->Extent.Pixels;
  this->Started = true;
  const std::set<Stage> volumeStages = { Stage::BlockRanges };
  for (auto stage = this->StagesRun.begin(); stage != this->StagesRun.end();)
  {
    stage = volumeStages.count(*stage) ? std::next(stage) : this->StagesRun.erase(stage);
  }
  this->StartTime = Clock::now();
  if (!this->SoftwareRenderer)
  {
    this->MarkPassEnd(); // the first query is the image's start
  }
  this->WriteControl(offsetof(ControlBlock, LiveRays), 0);
  this->WriteControl(offsetof(ControlBlock, NextLiveRays), 0);
  this->WriteControl(offsetof(ControlBlock, PassIndex), 0);
  this->Dispatch(Stage::InitialRays, DivideUp(this->Scene.Image[0], 8), DivideUp(this->Scene.Image[1], 8));
  std::swap(this->Names[Index(Buffer::LiveRays)], this->Names[Index(Buffer::NextLiveRays)]);
}

// The algorithm. Every dispatch's size is decided on the GPU; see Buffers.glsl for what flows between
// the stages.
void ProgressivePipeline::RunPass()
{
  this->Dispatch(Stage::BeginPass, 1);
  this->EvictBlocks();
  this->DispatchIndirect(Stage::TraverseGrid, offsetof(ControlBlock, TraverseGroups));
  this->DispatchIndirect(Stage::MarkBlocks, offsetof(ControlBlock, PairGroups));
  this->DispatchIndirect(Stage::AdmitBlocks, offsetof(ControlBlock, AdmitGroups));
  this->DispatchIndirect(Stage::DecodeBlocks, offsetof(ControlBlock, DecodeGroups));
  this->DispatchIndirect(Stage::GroupRays, offsetof(ControlBlock, PairGroups));
  this->DispatchIndirect(Stage::IntersectBlocks, offsetof(ControlBlock, IntersectGroups));
  this->DispatchIndirect(Stage::NearestHit, offsetof(ControlBlock, TraverseGroups));
  std::swap(this->Names[Index(Buffer::LiveRays)], this->Names[Index(Buffer::NextLiveRays)]);
  ++this->PassesSubmitted;
  this->MarkPassEnd();
}

// Zero work groups unless BeginPass or BeginShading found the cache too full; nothing at all where the
// cache holds the whole volume.
void ProgressivePipeline::EvictBlocks()
{
  if (this->Extent.Slots >= this->Scene.Blocks[3])
  {
    return;
  }
  for (Stage stage : { Stage::CacheAges, Stage::CacheEvict, Stage::CacheRebuild })
  {
    this->DispatchIndirect(stage, offsetof(ControlBlock, EvictGroups));
  }
}

void ProgressivePipeline::RunPasses(int maximum, bool eager, const std::function<bool()>& stop)
{
  const int batch = eager || this->SoftwareRenderer ? 1 : PassesPerBatch;
  int left = maximum > 0 ? maximum : -1;
  int stalled = 0;
  while (this->Remaining > 0 && left != 0)
  {
    const int passes = left > 0 ? std::min(batch, left) : batch;
    for (int i = 0; i < passes; ++i)
    {
      this->RunPass();
    }
    left = left > 0 ? left - passes : left;
    const ControlBlock control = this->Read<ControlBlock>(Buffer::Control);
    const bool gotOn = control.Pairs > 0 || control.NextLiveRays != this->Remaining;
    this->Remaining = control.NextLiveRays;
    stalled = gotOn ? 0 : stalled + 1;
    if (stalled == PatienceWithNone)
    {
      this->Fail("makes no progress: the GPU may have been lost; release the graphics resources and render again");
    }
    if (control.PassIndex - this->Passes.size() > PassRecords / 2)
    {
      this->ReadPassRecords();
    }
    if ((control.DeferredBlocks > 0 && !this->GrowCache()) || !this->Error.empty() || stop())
    {
      return;
    }
  }
}

void ProgressivePipeline::ShadeHits(bool again)
{
  if (again)
  {
    this->Fill(Buffer::PixelColor, 0);
  }
  const std::int64_t groups = DivideUp(this->Extent.Pixels, 64);
  std::uint32_t unshaded = 0;
  int stalled = 0;
  do
  {
    this->Dispatch(Stage::BeginShading, 1);
    this->EvictBlocks(); // also where nothing is looked up: BeginShading may have planned it
    if (this->Scene.Lighting[0] > 0)
    {
      this->Dispatch(Stage::MarkShading, groups);
      this->DispatchIndirect(Stage::AdmitBlocks, offsetof(ControlBlock, AdmitGroups));
      this->DispatchIndirect(Stage::DecodeBlocks, offsetof(ControlBlock, DecodeGroups));
    }
    this->Dispatch(Stage::ShadeHits, groups);
    const std::uint32_t before = unshaded;
    unshaded = this->Read<ControlBlock>(Buffer::Control).UnshadedHits;
    stalled = unshaded == before ? stalled + 1 : 0;
    if (unshaded > 0 && stalled == PatienceWithNone)
    {
      this->Fail("cannot shade: the GPU may have been lost; release the graphics resources and render again");
    }
  } while (unshaded > 0 && this->Error.empty() && this->GrowCache());
  this->ReadPassRecords();
}

void ProgressivePipeline::Composite()
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

//------------------------------------------------------------------------------
// What came out
//------------------------------------------------------------------------------
double ProgressivePipeline::Since(Clock::time_point start) const
{
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Software renderers have no credible timer queries, but a synchronous end.
void ProgressivePipeline::MarkPassEnd()
{
  if (this->SoftwareRenderer)
  {
    glFinish();
    this->PassEnds.push_back(this->Since(this->StartTime));
    return;
  }
  const std::size_t query = static_cast<std::size_t>(this->PassesSubmitted);
  if (query >= this->TimeQueries.size())
  {
    this->TimeQueries.push_back(0);
    glGenQueries(1, &this->TimeQueries.back());
  }
  glQueryCounter(this->TimeQueries[query], GL_TIMESTAMP);
}

// Records of the passes that had rays; those submitted after the last ray was done leave none.
void ProgressivePipeline::ReadPassRecords()
{
  const std::size_t total = this->Read<ControlBlock>(Buffer::Control).PassIndex;
  if (total == this->Passes.size())
  {
    return;
  }
  const auto ring = this->Read<std::array<PassRecord, PassRecords>>(Buffer::PassStatistics);
  GLuint64 start = 0;
  if (!this->SoftwareRenderer)
  {
    glGetQueryObjectui64v(this->TimeQueries[0], GL_QUERY_RESULT, &start);
  }
  for (std::size_t pass = this->Passes.size(); pass < total; ++pass)
  {
    TimedPass timed;
    static_cast<PassRecord&>(timed) = ring[pass % PassRecords];
    if (this->SoftwareRenderer)
    {
      timed.ElapsedMilliseconds = this->PassEnds[pass];
    }
    else
    {
      GLuint64 end = 0;
      glGetQueryObjectui64v(this->TimeQueries[pass + 1], GL_QUERY_RESULT, &end);
      timed.ElapsedMilliseconds = (end - start) * 1e-6;
    }
    this->Passes.push_back(timed);
  }
}

double ProgressivePipeline::GetCompletedFraction() const
{
  return this->Started && this->Extent.Pixels > 0
    ? 1.0 - static_cast<double>(this->Remaining) / static_cast<double>(this->Extent.Pixels)
    : 0.0;
}

std::vector<std::uint32_t> ProgressivePipeline::ReadHitKeys()
{
  std::vector<std::uint32_t> keys(static_cast<std::size_t>(this->Extent.Pixels));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(Buffer::RayHit)]);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(keys.size() * 4), keys.data());
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  return keys;
}

bool ProgressivePipeline::DecodeBlocks(std::int64_t first, std::int64_t count, float* values)
{
  if (this->Extent.Slots < count && !this->ResizeCache(count))
  {
    return false;
  }
  std::vector<std::uint32_t> slots(count), blocks(count);
  for (std::int64_t i = 0; i < count; ++i)
  {
    slots[i] = static_cast<std::uint32_t>(i);
    blocks[i] = static_cast<std::uint32_t>(first + i);
  }
  const GLsizeiptr bytes = static_cast<GLsizeiptr>(4 * count);
  this->Write(Buffer::CacheDecodeList, 0, slots.data(), bytes);
  this->Write(Buffer::CacheSlotBlock, 0, blocks.data(), bytes);
  this->WriteControl(offsetof(ControlBlock, DecodedBlocks), static_cast<std::uint32_t>(count));
  this->Dispatch(Stage::DecodeBlocks, DivideUp(count, 32));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->Names[Index(Buffer::CacheValues)]);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, 64 * bytes, values);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  // the cache's bookkeeping knows nothing of these blocks: start afresh
  this->WriteControl(offsetof(ControlBlock, DecodedBlocks), 0);
  this->Extent.Slots = 0;
  this->Started = false;
  return this->Error.empty();
}
