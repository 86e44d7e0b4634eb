// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/StorageBuffers.h"

#include "GL/Context.h"

#include <algorithm>
#include <cstddef>

namespace
{
// Of the decoded blocks of a whole volume neighbouring rays read neighbouring values.
constexpr std::int64_t LargestPlainValues = 1LL << 29;

int Index(Buffer buffer)
{
  return static_cast<int>(buffer);
}

Status NoRoom(std::int64_t bytes, const char* what)
{
  return Status::Error("the GPU has no room for ", bytes, " bytes of ", what,
    ": lower the memory budget, the rate or the image size");
}

// Gives addresses to the buffer that is bound, and no memory yet.
void ReserveAddresses(std::int64_t bytes)
{
  glBufferStorage(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr,
    GL_SPARSE_STORAGE_BIT_ARB | GL_DYNAMIC_STORAGE_BIT);
}

// Gives memory to a part of the buffer that is bound, which was reserved.
void CommitMemory(const ByteRange& part)
{
  if (part.Bytes > 0)
  {
    glBufferPageCommitmentARB(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(part.Begin),
      static_cast<GLsizeiptr>(part.Bytes), GL_TRUE);
  }
}

// What parts of a buffer have gained at their ends.
std::vector<ByteRange> Gained(
  const std::vector<ByteRange>& before, const std::vector<ByteRange>& after)
{
  std::vector<ByteRange> gained;
  for (std::size_t i = 0; i < after.size(); ++i)
  {
    gained.push_back({ after[i].Begin + before[i].Bytes, after[i].Bytes - before[i].Bytes });
  }
  return gained;
}

// Makes a buffer, bound while `fill` gives it its memory.
template <typename Fill>
Status MakeBuffer(
  Context& context, GLuint& name, std::int64_t bytes, const char* what, const Fill& fill)
{
  if (!context.CheckMemory())
  {
    return context.GetStatus();
  }
  glGenBuffers(1, &name);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
  fill();
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  if (glGetError() == GL_NO_ERROR)
  {
    return Status();
  }
  glDeleteBuffers(1, &name);
  name = 0;
  return context.Fail(NoRoom(bytes, what));
}
}

Status MakeStorageBuffer(
  Context& context, GLuint& name, std::int64_t bytes, const char* what, std::int64_t largestPlain)
{
  const DeviceLimits& limits = context.GetLimits();
  if (bytes > limits.LargestBuffer)
  {
    return context.Fail(
      Status::Error(bytes, " bytes of ", what, " are more than one GPU buffer can hold here (",
        limits.LargestBuffer, "): lower the image size or the volume's"));
  }
  const bool sparse = limits.SparseBuffers && bytes > largestPlain;
  return MakeBuffer(context, name, bytes, what,
    [=]()
    {
      if (sparse)
      {
        ReserveAddresses(bytes);
        CommitMemory({ 0, bytes });
      }
      else
      {
        glBufferData(
          GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_COPY);
      }
    });
}

Status StorageBuffers::Allocate(const BufferInfo& info, const SceneNeeds& needs)
{
  if (this->Has(info, needs))
  {
    return Status();
  }
  this->Free(info.Id);
  return info.Bytes(needs) > 0 ? this->Make(info, needs) : Status();
}

Status StorageBuffers::Make(const BufferInfo& info, const SceneNeeds& needs)
{
  HeldBuffer& held = this->Held[Index(info.Id)];
  const std::int64_t bytes = info.Bytes(needs);
  Status made;
  if (info.IsReserved(needs))
  {
    made = MakeBuffer(this->Gl, held.Name, bytes, info.Name,
      [&]()
      {
        ReserveAddresses(info.ReservedBytes(needs));
        for (const ByteRange& part : info.Parts(needs))
        {
          CommitMemory(part);
        }
      });
  }
  else
  {
    const bool values = info.Id == Buffer::CacheValues;
    made = MakeStorageBuffer(
      this->Gl, held.Name, bytes, info.Name, values ? LargestPlainValues : LargestPlainBuffer);
  }
  if (made)
  {
    held.Bytes = bytes;
    held.Reserved = info.IsReserved(needs) ? info.ReservedBytes(needs) : 0;
  }
  return made;
}

Status StorageBuffers::Allocate(Lifetime lifetime, const SceneNeeds& needs)
{
  Status status;
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (status && info.Life == lifetime)
    {
      status = this->Allocate(info, needs);
    }
  }
  return status;
}

Status StorageBuffers::Grow(Lifetime lifetime, const SceneNeeds& before, const SceneNeeds& needs)
{
  Status status;
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (status && info.Life == lifetime && info.IsNeeded(needs))
    {
      status = info.IsReserved(needs) ? this->CommitMore(info, before, needs)
                                      : this->MakeLarger(info, before, needs);
    }
  }
  return status;
}

Status StorageBuffers::CommitMore(
  const BufferInfo& info, const SceneNeeds& before, const SceneNeeds& needs)
{
  HeldBuffer& held = this->Held[Index(info.Id)];
  if (!this->Gl.CheckMemory())
  {
    return this->Gl.GetStatus();
  }
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, held.Name);
  for (const ByteRange& part : Gained(info.Parts(before), info.Parts(needs)))
  {
    CommitMemory(part);
  }
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  const std::int64_t bytes = info.Bytes(needs);
  if (glGetError() != GL_NO_ERROR)
  {
    return this->Gl.Fail(NoRoom(bytes, info.Name));
  }
  held.Bytes = bytes;
  return Status();
}

// The old buffer is there until the GPU has copied it: see PlanGrowth in MemoryPlan.h.
Status StorageBuffers::MakeLarger(
  const BufferInfo& info, const SceneNeeds& before, const SceneNeeds& needs)
{
  HeldBuffer old = this->Held[Index(info.Id)];
  this->Held[Index(info.Id)] = HeldBuffer();
  Status made = this->Make(info, needs);
  if (made)
  {
    const std::vector<ByteRange> from = info.Parts(before), to = info.Parts(needs);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, old.Name);
    glBindBuffer(GL_COPY_WRITE_BUFFER, this->GetName(info.Id));
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER,
        static_cast<GLintptr>(from[i].Begin), static_cast<GLintptr>(to[i].Begin),
        static_cast<GLsizeiptr>(from[i].Bytes));
    }
    glBindBuffer(GL_COPY_READ_BUFFER, 0);
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  }
  glDeleteBuffers(1, &old.Name);
  return made;
}

bool StorageBuffers::Has(const BufferInfo& info, const SceneNeeds& needs) const
{
  const HeldBuffer& held = this->Held[Index(info.Id)];
  const bool reserved = info.IsNeeded(needs) && info.IsReserved(needs);
  return info.Bytes(needs) == held.Bytes &&
    (reserved ? info.ReservedBytes(needs) : 0) == held.Reserved;
}

bool StorageBuffers::Has(Lifetime lifetime, const SceneNeeds& needs) const
{
  const auto& buffers = PipelineBuffers();
  return std::all_of(buffers.begin(), buffers.end(),
    [&](const BufferInfo& info) { return info.Life != lifetime || this->Has(info, needs); });
}

void StorageBuffers::Trim(const SceneNeeds& needs)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (!this->Has(info, needs))
    {
      this->Free(info.Id);
    }
  }
}

void StorageBuffers::Free(Lifetime lifetime)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.Life == lifetime)
    {
      this->Free(info.Id);
    }
  }
}

void StorageBuffers::FreeAll()
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    this->Free(info.Id);
  }
}

void StorageBuffers::Free(Buffer buffer)
{
  HeldBuffer& held = this->Held[Index(buffer)];
  glDeleteBuffers(1, &held.Name);
  held = HeldBuffer();
}

void StorageBuffers::Fill(Buffer buffer, std::uint32_t value, const SceneNeeds& needs)
{
  const std::int64_t bytes = PipelineBuffers()[Index(buffer)].Bytes(needs);
  if (!this->GetName(buffer) || bytes == 0)
  {
    return;
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->GetName(buffer));
  glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, static_cast<GLsizeiptr>(bytes),
    GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
}

void StorageBuffers::Upload(Buffer buffer, const std::vector<std::uint32_t>& words)
{
  if (!words.empty())
  {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->GetName(buffer));
    glBufferSubData(
      GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(4 * words.size()), words.data());
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  }
}
