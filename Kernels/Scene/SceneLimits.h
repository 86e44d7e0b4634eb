// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the stages have room for.
#ifndef SceneLimits_h
#define SceneLimits_h

#include "Status.h"

class vtkPlaneCollection;
class vtkRenderer;
class vtkVolumeProperty;

/// Checks that isovalues are numbers, and that there are not too many of them, of clipping planes
/// (null: none) and of lights.
Status CheckLimits(
  vtkRenderer* renderer, vtkVolumeProperty* property, vtkPlaneCollection* clippingPlanes);

#endif
