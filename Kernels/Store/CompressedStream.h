// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// A fixed-rate ZFP stream in the memory of the CPU, and the size of the volume that it holds.
#ifndef CompressedStream_h
#define CompressedStream_h

#include "Shaders/Glsl.h"

#include <array>
#include <cstdint>
#include <memory>

/// A stream of 4^3 blocks. It shares the ownership of its bytes.
struct CompressedStream
{
  std::shared_ptr<const unsigned char> Data;
  std::int64_t Size = 0; ///< bytes, a multiple of 8
  int BlockBits = 0;
};

/// How many samples, blocks of 4^3 samples and macrocells of 4^3 blocks a volume has on each axis.
struct VolumeSize
{
  std::array<std::int64_t, 3> Samples = { 0, 0, 0 };
  std::array<std::int64_t, 3> Blocks = { 0, 0, 0 };
  std::array<std::int64_t, 3> Macrocells = { 0, 0, 0 };

  VolumeSize() = default;
  explicit VolumeSize(const int samples[3])
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Samples[axis] = samples[axis];
      this->Blocks[axis] = Parts(samples[axis], glsl::BLOCK_SIDE);
      this->Macrocells[axis] = Parts(this->Blocks[axis], glsl::MACROCELL_SIDE);
    }
  }
  std::int64_t GetNumberOfBlocks() const { return Product(this->Blocks); }
  std::int64_t GetNumberOfMacrocells() const { return Product(this->Macrocells); }

private:
  static std::int64_t Parts(std::int64_t length, std::int64_t side)
  {
    return (length + side - 1) / side;
  }
  static std::int64_t Product(const std::array<std::int64_t, 3>& n) { return n[0] * n[1] * n[2]; }
};

/// The grid of a level of detail: blocks and macrocells are numbered through all levels.
struct LevelGrid
{
  VolumeSize Size;
  std::int64_t FirstBlock = 0;
  std::int64_t FirstMacrocell = 0;

  /// The grid of the next level.
  LevelGrid Next(const int samples[3]) const
  {
    return { VolumeSize(samples), this->FirstBlock + this->Size.GetNumberOfBlocks(),
      this->FirstMacrocell + this->Size.GetNumberOfMacrocells() };
  }
};

#endif
