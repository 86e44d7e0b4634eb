// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the pipeline draws of a volume, from where and how.
#ifndef PipelineScene_h
#define PipelineScene_h

#include "Pipeline/ViewGeometry.h"

struct PipelineScene
{
  ViewGeometry View = {}; ///< all bytes zero: views are compared byte by byte
  glsl::Look Look = {};
  bool Translucent = false;  ///< an isosurface is
  bool Obstructed = false;   ///< opaque geometry may hide translucent isosurfaces
  bool Conservative = false; ///< levels of detail lose nothing that the volume itself has
  bool Categories = false;   ///< the colours' volume has categories, not values in between
};

#endif
