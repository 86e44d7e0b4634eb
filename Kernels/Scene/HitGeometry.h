// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Where the hits of an image lie. Pixels count from the bottom left of the viewport.
#ifndef HitGeometry_h
#define HitGeometry_h

#include "Shaders/Glsl.h"

#include <cstdint>
#include <vector>

/// Finds the ray's parameter at the hit that a key of Rays.glsl stands for; infinity for no hit.
double HitParameter(const glsl::View& view, int x, int y, std::uint32_t key);

/// Finds the distance in world units from the camera (in parallel projection: from its plane) to
/// the place with parameter t on a ray.
double RayLength(const glsl::View& view, int x, int y, double t);

/// Finds the distances of all pixels' hits, infinity for none. The keys of a translucent image are
/// those of the last hits; `firstParameters` are then the parameters of the first, otherwise empty.
std::vector<float> HitDistances(const glsl::View& view, const std::vector<std::uint32_t>& keys,
  const std::vector<float>& firstParameters);

/// Finds the place with parameter t on a ray, in eye coordinates.
void EyePosition(const glsl::View& view, int x, int y, double t, double position[3]);

#endif
