// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The part of a stream that a dispatch sees. GLSL (BlockStore.glsl) and C++ (Glsl.h) read this
// file.

struct Segment
{
  uint FirstBlock; // of those that are decoded from it
  uint Blocks;
  uint FirstBit; // of the first block, in the first word
  uint Words;
  uint BlockBits;
};
