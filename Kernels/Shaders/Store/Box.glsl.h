// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// A box of blocks. GLSL (BlockBox.glsl) and C++ (Glsl.h) read this file.

struct BlockBox
{
  ivec3 First;
  ivec3 Size; // in blocks; 0: there is no box
};
