// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the GPU tells the CPU after each pass. Snapshots arrive in the order in which they were
// requested, and the GPU continues meanwhile.
#ifndef SnapshotQueue_h
#define SnapshotQueue_h

#include "GL/ProgIsoGL.h"
#include "Shaders/Glsl.h"

#include <cstdint>
#include <deque>
#include <vector>

class Context;

struct Snapshot
{
  glsl::Control Control;
  glsl::PassRecord Records[glsl::PASS_RECORDS];
};

class SnapshotQueue
{
public:
  /// At once, with room to spare.
  static constexpr std::int64_t MaximumBytes = 8 * static_cast<std::int64_t>(sizeof(Snapshot));

  explicit SnapshotQueue(Context& context)
    : Gl(context)
  {
  }

  /// Copies the two buffers as they are after all commands so far.
  void Request(GLuint control, GLuint passStatistics);
  /// Waits for the oldest requested snapshot.
  Snapshot Await();
  /// Drops all requested snapshots.
  void Clear();
  void Release();

  std::int64_t GetBytes() const;

private:
  struct Copy
  {
    GLuint Buffer = 0;
    GLsync Fence = nullptr;
  };

  Context& Gl;
  std::deque<Copy> Requested; ///< oldest first
  std::vector<GLuint> SpareBuffers;
};

#endif
