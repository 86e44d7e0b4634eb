// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The storage buffers of BufferTable.h on the GPU.
#ifndef StorageBuffers_h
#define StorageBuffers_h

#include "GL/ProgIsoGL.h"
#include "Shaders/BufferTable.h"

#include <array>
#include <cstdint>
#include <vector>

class Context;
class Status;

class StorageBuffers
{
public:
  explicit StorageBuffers(Context& context)
    : Gl(context)
  {
  }

  /// Makes the buffers of a lifetime as large as the scene needs them, and frees those that it
  /// does not need. A buffer that has its size already is kept; the contents of others are
  /// undefined.
  Status Allocate(Lifetime lifetime, const SceneNeeds& needs);
  /// Makes the buffers of a lifetime, which are as large as another scene needed them, larger. They
  /// keep their contents. A reserved buffer gets memory where it has none yet; another moves.
  Status Grow(Lifetime lifetime, const SceneNeeds& before, const SceneNeeds& needs);
  /// Have all buffers of a lifetime the size that the scene needs?
  bool Has(Lifetime lifetime, const SceneNeeds& needs) const;
  /// Frees every buffer that the scene needs in another size, so that the sum of all never exceeds
  /// what it is going to be.
  void Trim(const SceneNeeds& needs);
  void Free(Lifetime lifetime);
  void FreeAll();

  /// Sets the words of a buffer that a scene uses, which may need less than there is room for.
  void Fill(Buffer buffer, std::uint32_t value, const SceneNeeds& needs);
  /// Fills a buffer that the stages only read.
  void Upload(Buffer buffer, const std::vector<std::uint32_t>& words);

  GLuint GetName(Buffer buffer) const { return this->Held[static_cast<int>(buffer)].Name; }
  /// Of its memory: what is only reserved does not count.
  std::int64_t GetBytes(Buffer buffer) const { return this->Held[static_cast<int>(buffer)].Bytes; }

private:
  struct HeldBuffer
  {
    GLuint Name = 0;
    std::int64_t Bytes = 0;    ///< of its memory
    std::int64_t Reserved = 0; ///< of its addresses, where memory is committed bit by bit
  };

  Status Allocate(const BufferInfo& info, const SceneNeeds& needs);
  Status Make(const BufferInfo& info, const SceneNeeds& needs);
  Status CommitMore(const BufferInfo& info, const SceneNeeds& before, const SceneNeeds& needs);
  Status MakeLarger(const BufferInfo& info, const SceneNeeds& before, const SceneNeeds& needs);
  bool Has(const BufferInfo& info, const SceneNeeds& needs) const;
  void Free(Buffer buffer);

  Context& Gl;
  std::array<HeldBuffer, NumberOfBuffers> Held = {};
};

/// Makes a storage buffer; an error where it is too large, or the GPU has no room for it. `what` is
/// its content, for the message. A buffer beyond `largestPlain` bytes is made sparse.
Status MakeStorageBuffer(
  Context& context, GLuint& name, std::int64_t bytes, const char* what, std::int64_t largestPlain);

/// NVIDIA backs a sparse buffer with large pages. Random reads of a plain buffer are as fast up to
/// this size, and then 10 to 400 times slower.
constexpr std::int64_t LargestPlainBuffer = 1LL << 27;

#endif
