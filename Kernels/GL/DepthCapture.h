// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DepthCapture_h
#define DepthCapture_h

#include "GL/ProgIsoGL.h"

#include <cstdint>

/// Whose depths are wanted. Rectangles are width, height and origin.
struct DepthPlace
{
  std::int32_t Window[4] = { 0, 0, 0, 0 }; ///< of the framebuffer, in its pixels
  std::int32_t Size[2] = { 0, 0 };         ///< of that rectangle in pixels, as many or fewer
  std::int32_t Part[4] = { 0, 0, 0, 0 };   ///< of those pixels
};

/// Copies depths of the framebuffer that is drawn into to a buffer, from `offset` bytes on, as
/// 32-bit floats. A pixel of several of the framebuffer's has the depth in its middle.
void CaptureDepths(const DepthPlace& place, GLuint buffer, std::int64_t offset);

#endif
