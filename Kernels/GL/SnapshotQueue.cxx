// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/SnapshotQueue.h"

#include "GL/Context.h"

#include <cstddef>
#include <cstring>

void SnapshotQueue::MakeRing()
{
  const GLsizeiptr bytes = static_cast<GLsizeiptr>(MaximumBytes);
  glGenBuffers(1, &this->Ring);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Ring);
  if (this->Gl.GetLimits().PersistentMapping)
  {
    const GLbitfield access = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glBufferStorage(GL_COPY_WRITE_BUFFER, bytes, nullptr, access | GL_CLIENT_STORAGE_BIT);
    this->Mapped =
      static_cast<const char*>(glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, bytes, access));
  }
  else
  {
    glBufferData(GL_COPY_WRITE_BUFFER, bytes, nullptr, GL_STREAM_READ);
  }
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  this->Gl.CheckMemory();
}

// The GPU copies in order: a place whose snapshot was dropped can be taken again at once.
GLintptr SnapshotQueue::TakePlace()
{
  if (!this->Ring)
  {
    this->MakeRing();
  }
  const int place = this->Next;
  this->Next = (this->Next + 1) % MaximumSnapshots;
  return static_cast<GLintptr>(place * sizeof(Snapshot));
}

void SnapshotQueue::Request(GLuint control, GLuint passStatistics)
{
  Copy copy;
  copy.Place = this->TakePlace();
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Ring);
  glBindBuffer(GL_COPY_READ_BUFFER, control);
  glCopyBufferSubData(
    GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, copy.Place, sizeof(Snapshot::Control));
  glBindBuffer(GL_COPY_READ_BUFFER, passStatistics);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0,
    copy.Place + static_cast<GLintptr>(offsetof(Snapshot, Records)), sizeof(Snapshot::Records));
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
  return this->ReadPlace(copy.Place);
}

// All bytes are zero after an error.
Snapshot SnapshotQueue::ReadPlace(GLintptr place)
{
  Snapshot snapshot = {};
  if (this->Mapped)
  {
    std::memcpy(&snapshot, this->Mapped + place, sizeof(snapshot));
  }
  else
  {
    glBindBuffer(GL_COPY_READ_BUFFER, this->Ring);
    glGetBufferSubData(GL_COPY_READ_BUFFER, place, sizeof(snapshot), &snapshot);
    glBindBuffer(GL_COPY_READ_BUFFER, 0);
  }
  return snapshot;
}

void SnapshotQueue::Clear()
{
  for (const Copy& copy : this->Requested)
  {
    glDeleteSync(copy.Fence);
  }
  this->Requested.clear();
}

void SnapshotQueue::Release()
{
  this->Clear();
  glDeleteBuffers(1, &this->Ring); // ends its mapping, too
  this->Ring = 0;
  this->Mapped = nullptr;
}
