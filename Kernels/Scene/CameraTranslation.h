// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// From VTK's camera to the pipeline's rays. All in double precision: a volume may lie at 1e6 with a
// spacing of 1e-3.
#ifndef CameraTranslation_h
#define CameraTranslation_h

#include "Pipeline/ViewGeometry.h"

class vtkMatrix4x4;

/// Finds the ray of every pixel of `view.ViewportSize`. `projection` maps eye to clip coordinates,
/// with depths from -1 to 1.
void TranslateRays(vtkMatrix4x4* projection, vtkMatrix4x4* eyeToIndex, ViewGeometry& view);

/// Finds how a ray's parameter maps to depths in the window.
void TranslateDepths(vtkMatrix4x4* projection, glsl::Look& look);

/// Finds how gradients in index space map to normals in eye coordinates.
void TranslateNormals(vtkMatrix4x4* eyeToIndex, glsl::Look& look);

/// Whether the rays are finite. They are not if the image's geometry, the prop's matrix or the
/// camera is not finite or has no inverse; a walk along them would never end.
bool HasRays(const ViewGeometry& view);

#endif
