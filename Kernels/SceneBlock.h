// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The uniform block of Scene.glsl (std140), member for member.
#ifndef SceneBlock_h
#define SceneBlock_h

#include <cstdint>

struct SceneLight
{
  float Place[4];
  float Color[4];
};

struct SceneBlock
{
  static constexpr int MaximumLights = 16;

  // what a hit depends on: a change restarts the image
  double RayOrigin[3][4] = {};
  double RayDirection[3][4] = {};
  double EyeOrigin[3][4] = {};
  double EyeDirection[3][4] = {};
  double RayRange[4] = {};
  std::int32_t FirstDrawn[4] = {};
  std::int32_t LastDrawn[4] = {};
  std::int32_t Samples[4] = {};
  std::int32_t Blocks[4] = {};
  std::int32_t CoarseCells[4] = {};
  std::int32_t Image[4] = {};
  std::uint32_t Cache[4] = {};
  std::uint32_t Policy[4] = {};
  float Isovalue[4] = {};
  // what only its look depends on: a change needs no new rays
  float NormalMatrix[16] = {};
  float DepthTerms[4] = {};
  float Color[4] = {};
  float Material[4] = {};
  std::int32_t Lighting[4] = {};
  SceneLight Lights[MaximumLights] = {};
};
static_assert(
  sizeof(SceneBlock) == 13 * 32 + 9 * 16 + 64 + 4 * 16 + 16 * 32, "std140 layout of Scene.glsl");

#endif
