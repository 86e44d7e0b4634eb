// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Views for unit tests.
#ifndef TestViews_h
#define TestViews_h

#include "Pipeline/ViewGeometry.h"

#include <initializer_list>

/// Parallel rays along -z from z = 10 on, a pixel for each voxel; nothing is drawn yet.
inline ViewGeometry MakeParallelView(int width, int height)
{
  ViewGeometry view = {};
  view.ViewportSize[0] = width;
  view.ViewportSize[1] = height;
  for (PixelVector* origin : { &view.RayOrigin, &view.EyeOrigin })
  {
    origin->Base[2] = 10.0;
    origin->PerX[0] = 1.0;
    origin->PerY[1] = 1.0;
  }
  view.RayDirection.Base[2] = view.EyeDirection.Base[2] = -1.0;
  view.Depth[2] = -1.0;
  view.Depth[3] = 10.0;
  view.NearDistance = 1.0;
  view.FarDistance = 100.0;
  return view;
}

#endif
