// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The uniform block of colours for the values of another volume, in its stream's units. GLSL
// (ValueColors.glsl) and C++ (Glsl.h) read this file.

struct PaletteNode
{
  vec3 Rgb;
  float Value;
};

// Nodes in the order of their values, between which colours change linearly: where there are two
// nodes for a value they jump. Of categories each has a node.
UNIFORM_BLOCK(Palette, PALETTE_BINDING)
{
  int NumberOfNodes;
  float Tolerance; // how far compression may have moved a value
  float Padding0;
  float Padding1;
  vec4 Below; // colour and opacity of values below all nodes,
  vec4 Above; // above them,
  vec4 None;  // and where there is no value, or no node for it
  PaletteNode Nodes[PALETTE_SIZE];
  vec4 Opacities[PALETTE_SIZE / 4]; // of nodes, four in each
}
INSTANCE(palette);
