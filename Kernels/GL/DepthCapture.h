// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DepthCapture_h
#define DepthCapture_h

#include "GL/ProgIsoGL.h"

#include <cstdint>

/// Copies the depths of a part (width, height, origin) of the framebuffer that is drawn into to a
/// buffer, from `offset` bytes on, as 32-bit floats.
void CaptureDepths(const std::int32_t part[4], GLuint buffer, std::int64_t offset);

#endif
