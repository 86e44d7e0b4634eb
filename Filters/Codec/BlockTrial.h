// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   BlockTrial
 * @brief   encodes and decodes one block at a time, to see what zfp makes of it (internal)
 *
 * The last block whose samples all have one value is remembered: where there is nothing, or a
 * label, block after block is the same.
 */
#ifndef BlockTrial_h
#define BlockTrial_h

#include "Codec/BlockGeometry.h"

#include "vtkType.h"

#include <zfp.h>

class BlockTrial
{
public:
  BlockTrial();
  ~BlockTrial();
  BlockTrial(const BlockTrial&) = delete;
  void operator=(const BlockTrial&) = delete;

  /// Returns the calling thread's own.
  static BlockTrial& OfThread();

  /// Encodes a block to so many bits, and decodes it: to what GetDecoded() returns.
  void Run(const float samples[BlockSamples], const int size[3], int blockBits);

  const float* GetDecoded() const { return this->Decoded; }

  /// Writes the encoded block into a stream, at its position.
  void CopyTo(zfp_stream* stream);

private:
  static constexpr int MaximumWords = 2048 / 64;

  vtkTypeUInt64 Words[MaximumWords + 1] = {};
  bitstream* Bits;
  zfp_stream* Stream;
  float Decoded[BlockSamples] = {};
  int BlockBits = 0;      // of the block in Words
  bool IsUniform = false; // whether that is a whole block of one value
  float Value = 0.0f;
};

#endif
