// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/DrawingState.h"

#include "GL/ProgIsoGL.h"
#include "Pipeline/ViewGeometry.h"

#include <cstdint>

namespace
{
// Finds the window's pixels in which the image's lie, on one axis: the first, and how many.
struct Part
{
  int First;
  int Count;
};

Part FindPart(const ViewGeometry& view, int axis)
{
  const std::int64_t window = view.WindowSize[axis], viewport = view.ViewportSize[axis];
  const std::int64_t first = view.ImageOrigin[axis];
  const std::int64_t end = first + view.ImageSize[axis];
  const auto begin = static_cast<int>(first * window / viewport);
  return { view.ViewportOrigin[axis] + begin,
    static_cast<int>((end * window + viewport - 1) / viewport) - begin };
}
}

DrawingState::DrawingState(vtkOpenGLState* state, const ViewGeometry& view, bool blended)
  : Blend(state, GL_BLEND)
  , DepthTest(state, GL_DEPTH_TEST)
  , CullFace(state, GL_CULL_FACE)
  , DepthMask(state)
  , DepthFunction(state)
  , BlendFunction(state)
  , Viewport(state)
{
  const Part x = FindPart(view, 0), y = FindPart(view, 1);
  state->vtkglViewport(x.First, y.First, x.Count, y.Count);
  state->vtkglDisable(GL_CULL_FACE);
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDepthFunc(GL_LEQUAL);
  state->vtkglDepthMask(blended ? GL_FALSE : GL_TRUE);
  state->SetEnumState(GL_BLEND, blended);
  if (blended)
  {
    state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
}
