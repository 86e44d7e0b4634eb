// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/SnapshotQueue.h"

#include "GL/Context.h"

#include <cstddef>

void SnapshotQueue::Request(GLuint control, GLuint passStatistics)
{
  Copy copy;
  if (this->SpareBuffers.empty())
  {
    glGenBuffers(1, &copy.Buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, copy.Buffer);
    glBufferData(GL_COPY_WRITE_BUFFER, sizeof(Snapshot), nullptr, GL_STREAM_READ);
    this->Gl.CheckMemory();
  }
  else
  {
    copy.Buffer = this->SpareBuffers.back();
    this->SpareBuffers.pop_back();
    glBindBuffer(GL_COPY_WRITE_BUFFER, copy.Buffer);
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, control);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, sizeof(Snapshot::Control));
  glBindBuffer(GL_COPY_READ_BUFFER, passStatistics);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, offsetof(Snapshot, Records),
    sizeof(Snapshot::Records));
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  copy.Fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  this->Requested.push_back(copy);
}

Snapshot SnapshotQueue::Await()
{
  const Copy copy = this->Requested.front();
  this->Requested.pop_front();
  const GLuint64 second = 1000000000; // in nanoseconds
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED)
  {
    state = glClientWaitSync(copy.Fence, GL_SYNC_FLUSH_COMMANDS_BIT, second);
  }
  glDeleteSync(copy.Fence);
  if (state == GL_WAIT_FAILED)
  {
    this->Gl.Fail(
      Status::Error("the GPU was lost: release the graphics resources and render again"));
  }
  Snapshot snapshot = {};
  glBindBuffer(GL_COPY_READ_BUFFER, copy.Buffer);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof(snapshot), &snapshot);
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  this->SpareBuffers.push_back(copy.Buffer);
  return snapshot;
}

void SnapshotQueue::Clear()
{
  for (const Copy& copy : this->Requested)
  {
    glDeleteSync(copy.Fence);
    this->SpareBuffers.push_back(copy.Buffer);
  }
  this->Requested.clear();
}

void SnapshotQueue::Release()
{
  this->Clear();
  glDeleteBuffers(static_cast<GLsizei>(this->SpareBuffers.size()), this->SpareBuffers.data());
  this->SpareBuffers.clear();
}

std::int64_t SnapshotQueue::GetBytes() const
{
  const std::size_t buffers = this->Requested.size() + this->SpareBuffers.size();
  return static_cast<std::int64_t>(buffers * sizeof(Snapshot));
}
