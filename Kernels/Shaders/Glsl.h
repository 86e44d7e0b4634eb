// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What C++ shares with GLSL: constants, and structures of the same layout as uniform blocks and the
// contents of storage buffers.
#ifndef Glsl_h
#define Glsl_h

#include <cstdint>

namespace glsl
{
using uint = std::uint32_t;
using vec3 = float[3];
using vec4 = float[4];
using mat3 = float[3][4]; // columns
using ivec2 = std::int32_t[2];
using vec2 = float[2];
using ivec3 = std::int32_t[3];
using uvec3 = std::uint32_t[3];

#include "Shaders/Shared/Constants.glsl.h"

#define UNIFORM_BLOCK(name, number) struct name
#define INSTANCE(name)
#include "Shaders/Light/Palette.glsl.h"
#include "Shaders/Shared/SceneBlocks.glsl.h"
#include "Shaders/Store/Box.glsl.h"
#include "Shaders/Store/Segment.glsl.h"

#define STORAGE_BLOCK(name, declaration) struct name
#define BUFFER_CONTROL
#define HAS_CACHE_MAP
#include "Shaders/Shared/BufferStructs.glsl.h"
#undef HAS_CACHE_MAP
#undef BUFFER_CONTROL
#undef STORAGE_BLOCK
#undef UNIFORM_BLOCK
#undef INSTANCE
}

#endif
