// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the GPU tells the CPU after each pass. Snapshots arrive in the order in which they were
// requested, and the GPU continues meanwhile. They lie in a ring in one buffer, which the CPU sees
// all the time where OpenGL can map it persistently.
#ifndef SnapshotQueue_h
#define SnapshotQueue_h

#include "GL/ProgIsoGL.h"
#include "Shaders/Glsl.h"

#include <cstdint>
#include <deque>

class Context;

struct Snapshot
{
  glsl::Control Control;
  glsl::PassRecord Records[glsl::PASS_RECORDS];
};

class SnapshotQueue
{
public:
  /// At once.
  static constexpr int MaximumSnapshots = 8;
  static constexpr std::int64_t MaximumBytes =
    MaximumSnapshots * static_cast<std::int64_t>(sizeof(Snapshot));

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

  std::int64_t GetBytes() const { return this->Ring ? MaximumBytes : 0; }

private:
  struct Copy
  {
    GLintptr Place = 0; ///< byte of the ring
    GLsync Fence = nullptr;
  };

  void MakeRing();
  GLintptr TakePlace();
  Snapshot ReadPlace(GLintptr place);

  Context& Gl;
  GLuint Ring = 0;
  const char* Mapped = nullptr; ///< the ring, where it is mapped
  int Next = 0;                 ///< place in the ring
  std::deque<Copy> Requested;   ///< oldest first
};

#endif
