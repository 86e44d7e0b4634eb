// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// A view in fixed point, so that the GPU walks rays by whole numbers: see Rays.glsl.
#ifndef FixedView_h
#define FixedView_h

#include "Pipeline/ViewGeometry.h"

/// Depths along the view direction between which rays are drawn: those of the part of the volume
/// that is drawn, within the clipping range. Not First < Last if there are none.
struct DrawnDepths
{
  double First;
  double Last;
};

DrawnDepths FindDrawnDepths(const ViewGeometry& view);

/// Finds the depth of the hit that a key of Rays.glsl stands for; infinity for no hit.
double HitDepth(const DrawnDepths& depths, std::uint32_t key);

/// Whether rays cross 2^29 voxels or more between the first and the last depth: more than FixView
/// has numbers for. Spacings that differ a million times make them.
bool HasTooLongWays(const ViewGeometry& view);

/// Translates a view for the GPU. Its origins and ways are off by 2^-31 voxels at most. No ray is
/// drawn where the image is wider than 2^29 voxels: all of a volume would be less than a pixel.
glsl::View FixView(const ViewGeometry& view);

#endif
