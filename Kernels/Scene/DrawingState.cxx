// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/DrawingState.h"

#include "GL/ProgIsoGL.h"
#include "Pipeline/ViewGeometry.h"

DrawingState::DrawingState(vtkOpenGLState* state, const ViewGeometry& view, bool blended)
  : Blend(state, GL_BLEND)
  , DepthTest(state, GL_DEPTH_TEST)
  , CullFace(state, GL_CULL_FACE)
  , DepthMask(state)
  , DepthFunction(state)
  , BlendFunction(state)
  , Viewport(state)
{
  state->vtkglViewport(view.ViewportOrigin[0] + view.ImageOrigin[0],
    view.ViewportOrigin[1] + view.ImageOrigin[1], view.ImageSize[0], view.ImageSize[1]);
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
