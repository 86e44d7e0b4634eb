// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What decides which hits the rays of an image have, in double precision: a volume may lie at 1e6
// with a spacing of 1e-3. The GPU gets it in fixed point: see FixedView.h.
#ifndef ViewGeometry_h
#define ViewGeometry_h

#include "Shaders/Glsl.h"

/// A vector that is Base + x PerX + y PerY at the pixel's centre (x, y) of the viewport.
struct PixelVector
{
  double Base[3];
  double PerX[3];
  double PerY[3];
};

/// In index space; the surface is drawn at p where dot(Normal, p) + Offset >= 0.
struct ClippingPlane
{
  double Normal[3];
  double Offset;
};

/// Beyond all depths: sums of two are finite, too.
constexpr double EndlessDepth = 1e300;

/// Up to which depth a level of detail is drawn, and from which on it goes over to the next: the
/// weights of that at both depths, linear between them.
struct LevelSpan
{
  double BlendFrom;
  double Until;
  double FirstWeight;
  double LastWeight;
};

/// Has no gaps between its members, as views are compared byte by byte: value-initialize it.
struct ViewGeometry
{
  /// In index space; a ray's parameter t is the depth along the view direction.
  PixelVector RayOrigin;
  PixelVector RayDirection;
  PixelVector EyeOrigin; ///< the same in view coordinates
  PixelVector EyeDirection;
  double Depth[4];     ///< of a point p of index space: dot(the first three, p) + the fourth
  double NearDistance; ///< clipping range of the camera
  double FarDistance;
  ClippingPlane ClippingPlanes[glsl::MAX_CLIPPING_PLANES];
  double CroppingLow[3]; ///< index space: the planes that part the volume into 3^3 regions
  double CroppingHigh[3];
  /// Samples between which the surface is drawn; beyond, they only give normals.
  std::int32_t FirstDrawn[3];
  std::int32_t LastDrawn[3];
  /// In pixels, of which each is one of the window's, or a rectangle of them.
  std::int32_t ViewportSize[2];
  std::int32_t WindowSize[2];     ///< of the viewport in the window's own pixels
  std::int32_t ViewportOrigin[2]; ///< in the window
  /// The image is a rectangle of the viewport, outside of which no ray meets what is drawn.
  std::int32_t ImageSize[2];
  std::int32_t ImageOrigin[2]; ///< in the viewport
  std::int32_t NumberOfIsovalues;
  std::int32_t NumberOfClippingPlanes;
  std::int32_t DrawnRegions;                     ///< a bit for each cropping region
  std::int32_t NumberOfLevels;                   ///< of detail that are drawn; 1: the volume itself
  LevelSpan Levels[glsl::MAX_LEVELS];            ///< in the order of their depths
  glsl::FloatSum Isovalues[glsl::MAX_ISOVALUES]; ///< in the units of the stream
};

#endif
