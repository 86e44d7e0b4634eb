// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/HostTransfer.h"

#include <algorithm>

namespace
{
constexpr std::int64_t KeptStagingBytes = 1 << 12; // between reads
}

void HostTransfer::Release()
{
  glDeleteBuffers(1, &this->Staging);
  this->Staging = 0;
  this->StagingBytes = 0;
}

void HostTransfer::Read(GLuint buffer, std::int64_t offset, void* data, std::int64_t bytes)
{
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, buffer);
  glBindBuffer(GL_COPY_WRITE_BUFFER, this->Staging);
  for (std::int64_t done = 0; done < bytes; done += MaximumStagingBytes)
  {
    const std::int64_t rest = bytes - done;
    const GLsizeiptr part = static_cast<GLsizeiptr>(std::min(+MaximumStagingBytes, rest));
    glBufferData(GL_COPY_WRITE_BUFFER, part, nullptr, GL_STREAM_READ);
    glCopyBufferSubData(
      GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset + done), 0, part);
    glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, part, static_cast<char*>(data) + done);
  }
  this->StagingBytes = std::min(bytes, KeptStagingBytes);
  glBufferData(
    GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(this->StagingBytes), nullptr, GL_STREAM_READ);
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void HostTransfer::Write(GLuint buffer, std::int64_t offset, const void* data, std::int64_t bytes)
{
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, this->Staging);
  glBufferData(GL_COPY_READ_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
  this->StagingBytes = bytes;
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, static_cast<GLintptr>(offset),
    static_cast<GLsizeiptr>(bytes));
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}
