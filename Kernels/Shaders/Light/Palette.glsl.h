// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The uniform block of colours for the values of another volume. GLSL (Shading.glsl) and C++
// (Glsl.h) read this file.

struct PaletteColor
{
  vec3 Rgb;
  float Padding0;
};

// Colours at equal distances over the range of values from Low to Low + 1 / PerUnit.
UNIFORM_BLOCK(Palette, PALETTE_BINDING)
{
  float Low;
  float PerUnit;
  float Padding0;
  float Padding1;
  PaletteColor Colors[PALETTE_SIZE];
}
INSTANCE(palette);
