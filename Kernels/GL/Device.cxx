// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/Device.h"

#include "Shaders/Glsl.h"

#include <algorithm>
#include <utility>

namespace
{
// Sets the uniform of BlockStore.glsl in the program in use.
void SetSegment(GLuint program, const glsl::Segment& segment)
{
  const std::pair<const char*, GLuint> members[] = { { "segment.FirstBlock", segment.FirstBlock },
    { "segment.Blocks", segment.Blocks }, { "segment.FirstBit", segment.FirstBit },
    { "segment.Words", segment.Words }, { "segment.BlockBits", segment.BlockBits } };
  for (const auto& member : members)
  {
    glUniform1ui(glGetUniformLocation(program, member.first), member.second);
  }
}

// Sets the uniform of BlockBox.glsl.
void SetBox(GLuint program, const glsl::BlockBox& box)
{
  glUniform3iv(glGetUniformLocation(program, "box.First"), 1, box.First);
  glUniform3iv(glGetUniformLocation(program, "box.Size"), 1, box.Size);
}

// See FoldedGroup in Scene.glsl.
void DispatchFolded(std::int64_t groups)
{
  const std::int64_t most = glsl::MAX_GROUPS;
  const GLuint x = static_cast<GLuint>(std::min(groups, most));
  const GLuint y = static_cast<GLuint>((groups + most - 1) / most);
  glDispatchCompute(x, y, 1);
}
}

Status Device::Initialize(std::uint64_t contextId)
{
  if (!this->Gl.Open())
  {
    return this->Gl.GetStatus();
  }
  this->Programs = ProgramCache::OfContext(contextId, this->Gl.GetDialect(), this->Gl.GetLimits());
  this->Programs->CountGLErrors();
  this->Timer.SetSoftware(this->Gl.GetLimits().Software);
  this->Uniforms.Initialize();
  this->Transfer.Initialize();
  glGenVertexArrays(1, &this->VertexArray);
  return Status();
}

void Device::Release()
{
  this->Buffers.FreeAll();
  this->Uniforms.Release();
  this->Transfer.Release();
  this->Snapshots.Release();
  this->Timer.Release();
  glDeleteVertexArrays(1, &this->VertexArray);
  this->VertexArray = 0;
  glUseProgram(0); // a stage that failed is still in use
  this->GLErrors = this->GetNumberOfGLErrors();
  if (this->Programs && this->Programs.use_count() == 1)
  {
    this->Programs->Release();
  }
  this->Programs = nullptr;
  this->Gl.Close();
}

int Device::GetNumberOfGLErrors() const
{
  return this->Programs ? this->Programs->GetNumberOfGLErrors() : this->GLErrors;
}

void Device::SetNeeds(const SceneNeeds& needs)
{
  this->Needs = needs;
  this->Timer.SetDetailed(needs.Detailed);
}

void Device::Request(Urgency urgency, const SceneNeeds& needs)
{
  this->Programs->Request(ProgramsOf(urgency, needs), needs);
}

bool Device::IsReady(Stage stage)
{
  return this->Programs->IsReady(stage, this->Needs);
}

bool Device::IsReady(Urgency urgency)
{
  const std::vector<Stage> stages = ProgramsOf(urgency, this->Needs);
  return std::all_of(
    stages.begin(), stages.end(), [this](Stage stage) { return this->IsReady(stage); });
}

const Status& Device::Compile(Stage stage)
{
  GLuint program = 0;
  const Status built = this->Programs->Get(stage, this->Needs, program);
  return built ? this->Gl.GetStatus() : this->Gl.Fail(built);
}

bool Device::CompileNext(Urgency urgency)
{
  for (const Stage stage : ProgramsOf(urgency, this->Needs))
  {
    if (!this->Programs->HasGiven(stage, this->Needs) && this->Gl.GetStatus())
    {
      return this->Compile(stage).IsOk();
    }
  }
  return false;
}

std::vector<ProgramTime> Device::GetProgramTimes() const
{
  return this->Programs ? this->Programs->GetTimes(this->Needs) : std::vector<ProgramTime>();
}

// Binds a stage's program and buffers; 0 after an error.
GLuint Device::Bind(Stage stage, const BoundSegment* segment)
{
  GLuint program = 0;
  if (const Status built = this->Programs->Get(stage, this->Needs, program); !built)
  {
    this->Gl.Fail(built);
    return 0;
  }
  glUseProgram(program);
  this->Uniforms.Bind();
  GLuint binding = 0;
  for (const Buffer buffer : InfoOf(stage).BuffersOf(this->Needs))
  {
    const bool isStream = buffer == Buffer::Stream || buffer == Buffer::ColorStream;
    const GLuint name = isStream && segment ? segment->Buffer : this->Buffers.GetName(buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, name);
  }
  if (segment)
  {
    SetSegment(program, segment->Place);
  }
  return program;
}

template <typename Launch>
void Device::Run(Stage stage, const std::vector<BoundSegment>& segments, const Launch& launch)
{
  if (!this->Gl.GetStatus())
  {
    return; // what an earlier stage should have made may be missing: this one could hang the GPU
  }
  this->Timer.BeginStage(stage);
  for (std::size_t i = 0; i < std::max<std::size_t>(segments.size(), 1); ++i)
  {
    if (const GLuint program = this->Bind(stage, segments.empty() ? nullptr : &segments[i]))
    {
      launch(program);
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    }
  }
  this->Timer.EndStage();
}

void Device::Dispatch(Stage stage, std::int64_t groups)
{
  this->Run(stage, {}, [=](GLuint) { DispatchFolded(groups); });
}

// The box goes after it: a pass that runs the same program has none.
void Device::DispatchSlice(Stage stage, std::int64_t groups, const VolumeSlice& slice,
  const glsl::BlockBox& box, const BoundSegment* segment)
{
  std::vector<BoundSegment> segments;
  if (segment)
  {
    segments.push_back(*segment);
  }
  this->Run(stage, segments,
    [=](GLuint program)
    {
      glUniform2ui(glGetUniformLocation(program, "slice"), static_cast<GLuint>(slice.First),
        static_cast<GLuint>(slice.End));
      SetBox(program, box);
      DispatchFolded(groups);
      SetBox(program, {});
    });
}

void Device::DispatchIndirect(
  Stage stage, std::size_t controlOffset, const std::vector<BoundSegment>& segments)
{
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, this->Buffers.GetName(Buffer::Control));
  this->Run(stage, segments,
    [=](GLuint) { glDispatchComputeIndirect(static_cast<GLintptr>(controlOffset)); });
}

void Device::Draw(Stage stage, const SelectedId* selected)
{
  this->Run(stage, {},
    [=](GLuint program)
    {
      if (selected)
      {
        const auto place = [program](const char* name)
        { return glGetUniformLocation(program, name); };
        glUniform3fv(place("color"), 1, selected->Color.data());
        glUniform1i(place("idPart"), selected->IdPart);
        glUniform1i(place("ofPoints"), selected->OfPoints ? 1 : 0);
        glUniform1i(place("isCentred"), selected->IsCentred ? 1 : 0);
        glUniform3iv(place("firstSample"), 1, selected->FirstSample.data());
        glUniform3iv(place("ids"), 1, selected->Ids.data());
      }
      glBindVertexArray(this->VertexArray);
      glDrawArrays(GL_TRIANGLES, 0, 3);
      glBindVertexArray(0);
    });
  for (GLuint binding = 0; binding < NumberOfBuffers; ++binding)
  {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, 0);
  }
  UniformBuffers::Unbind();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
  glUseProgram(0);
}
