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
  float Axis[4];
  float Fading[4];
  float Highlight[4];
};

struct SceneBlock
{
  static constexpr int MaximumLights = 16;
  static constexpr int MaximumIsovalues = 16;
  static constexpr int MaximumClippingPlanes = 16;
  static constexpr std::int32_t LitLikeMeshes = 2; ///< LIT_LIKE_MESHES of Scene.glsl
  static constexpr std::int32_t AllRegions = (1 << 27) - 1;

  // what a hit depends on: a change restarts the image
  double RayOrigin[3][4] = {};
  double RayDirection[3][4] = {};
  double EyeOrigin[3][4] = {};
  double EyeDirection[3][4] = {};
  double RayRange[4] = {};
  double ClippingPlanes[MaximumClippingPlanes][4] = {};
  double CroppingLow[4] = {};
  double CroppingHigh[4] = {};
  std::int32_t FirstDrawn[4] = {};
  std::int32_t LastDrawn[4] = {};
  std::int32_t Samples[4] = {};
  std::int32_t Blocks[4] = {};
  std::int32_t Macrocells[4] = {};
  std::int32_t Image[4] = {};
  std::uint32_t Cache[4] = {};
  std::uint32_t Policy[4] = {};
  std::int32_t Surface[4] = { 0, 0, AllRegions, 0 };
  float Isovalues[MaximumIsovalues][4] = {};
  // what only its look depends on: a change needs no new rays
  float NormalMatrix[16] = {};
  float DepthTerms[4] = {};
  float Colors[MaximumIsovalues][4] = {};
  float Material[4] = {};
  std::int32_t Lighting[4] = {};
  SceneLight Lights[MaximumLights] = {};
};
static_assert(
  sizeof(SceneBlock) == (13 + 16 + 2) * 32 + (9 + 16) * 16 + 64 + (3 + 16) * 16 + 16 * 80,
  "std140 layout of Scene.glsl");

#endif
