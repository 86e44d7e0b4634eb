// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/StorageBuffers.h"

#include "GL/Context.h"

#include <algorithm>

namespace
{
// The decoded blocks come and go with the scene, and a plain buffer is made 10 times faster than a
// sparse one; neighbouring rays read neighbouring values.
constexpr std::int64_t LargestPlainValues = 1LL << 29;

int Index(Buffer buffer)
{
  return static_cast<int>(buffer);
}

// Gives the buffer that is bound its memory.
void CommitMemory(std::int64_t bytes, bool sparse)
{
  const GLsizeiptr size = static_cast<GLsizeiptr>(bytes);
  if (sparse)
  {
    glBufferStorage(
      GL_SHADER_STORAGE_BUFFER, size, nullptr, GL_SPARSE_STORAGE_BIT_ARB | GL_DYNAMIC_STORAGE_BIT);
    glBufferPageCommitmentARB(GL_SHADER_STORAGE_BUFFER, 0, size, GL_TRUE);
  }
  else
  {
    glBufferData(GL_SHADER_STORAGE_BUFFER, size, nullptr, GL_DYNAMIC_COPY);
  }
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
  if (!context.CheckMemory())
  {
    return context.GetStatus();
  }
  glGenBuffers(1, &name);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
  CommitMemory(bytes, limits.SparseBuffers && bytes > largestPlain);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  if (glGetError() == GL_NO_ERROR)
  {
    return Status();
  }
  glDeleteBuffers(1, &name);
  name = 0;
  return context.Fail(Status::Error("the GPU has no room for ", bytes, " bytes of ", what,
    ": lower the memory budget, the rate or the image size"));
}

Status StorageBuffers::Allocate(const BufferInfo& info, std::int64_t bytes)
{
  const int i = Index(info.Id);
  if (this->Bytes[i] == bytes)
  {
    return Status();
  }
  this->Free(info.Id);
  if (bytes > 0)
  {
    const std::int64_t plain =
      info.Id == Buffer::CacheValues ? LargestPlainValues : LargestPlainBuffer;
    Status made = MakeStorageBuffer(this->Gl, this->Names[i], bytes, info.Name, plain);
    if (!made)
    {
      return made;
    }
  }
  this->Bytes[i] = bytes;
  return Status();
}

Status StorageBuffers::Allocate(Lifetime lifetime, const SceneNeeds& needs)
{
  Status status;
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (status && info.Life == lifetime)
    {
      status = this->Allocate(info, info.Bytes(needs));
    }
  }
  return status;
}

bool StorageBuffers::Has(Lifetime lifetime, const SceneNeeds& needs) const
{
  const auto& buffers = PipelineBuffers();
  return std::all_of(buffers.begin(), buffers.end(),
    [&](const BufferInfo& info)
    { return info.Life != lifetime || info.Bytes(needs) == this->GetBytes(info.Id); });
}

void StorageBuffers::Trim(const SceneNeeds& needs)
{
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (info.Bytes(needs) != this->GetBytes(info.Id))
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
  glDeleteBuffers(static_cast<GLsizei>(this->Names.size()), this->Names.data());
  this->Names.fill(0);
  this->Bytes.fill(0);
}

void StorageBuffers::Free(Buffer buffer)
{
  const int i = Index(buffer);
  glDeleteBuffers(1, &this->Names[i]);
  this->Names[i] = 0;
  this->Bytes[i] = 0;
}

void StorageBuffers::Fill(Buffer buffer, std::uint32_t value)
{
  if (!this->GetName(buffer))
  {
    return;
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, this->GetName(buffer));
  glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
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
