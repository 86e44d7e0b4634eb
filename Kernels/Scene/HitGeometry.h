// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Where the hits of an image lie. Pixels count from the bottom left of the viewport.
#ifndef HitGeometry_h
#define HitGeometry_h

#include "Pipeline/ViewGeometry.h"

#include <cstdint>
#include <optional>
#include <vector>

/// The number that a pixel has in the image; none where it lies outside.
std::optional<std::int64_t> ImagePixel(const ViewGeometry& view, int x, int y);

/// Finds the distance in world units from the camera (in parallel projection: from its plane) to
/// the place with parameter t on a ray.
double RayLength(const ViewGeometry& view, int x, int y, double t);

/// Finds the depths along the view direction of the hits of the image's pixels, infinity for none.
/// The keys are those of the last hits in a translucent image; `firstParameters` are then the
/// parameters of the first, otherwise empty.
std::vector<double> HitDepths(const ViewGeometry& view, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& firstParameters);

/// Finds the distances of the hits of all of the viewport's pixels, likewise.
std::vector<float> HitDistances(const ViewGeometry& view, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& firstParameters);

/// Finds the place with parameter t on a ray, in eye coordinates.
void EyePosition(const ViewGeometry& view, int x, int y, double t, double position[3]);

#endif
