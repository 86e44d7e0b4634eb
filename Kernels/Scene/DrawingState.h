// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL state that an image is drawn with.
#ifndef DrawingState_h
#define DrawingState_h

#include "vtkOpenGLState.h"

struct ViewGeometry;

/// Sets the state, and restores what was there before when it goes out of scope.
class DrawingState
{
public:
  /// The viewport is the image's part of the window. With `blended` the fragments' colours are
  /// premultiplied by their opacities, and depths stay as they are.
  DrawingState(vtkOpenGLState* state, const ViewGeometry& view, bool blended);
  DrawingState(const DrawingState&) = delete;
  void operator=(const DrawingState&) = delete;

private:
  vtkOpenGLState::ScopedglEnableDisable Blend, DepthTest, CullFace;
  vtkOpenGLState::ScopedglDepthMask DepthMask;
  vtkOpenGLState::ScopedglDepthFunc DepthFunction;
  vtkOpenGLState::ScopedglBlendFuncSeparate BlendFunction;
  vtkOpenGLState::ScopedglViewport Viewport;
};

#endif
