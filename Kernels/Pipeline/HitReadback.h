// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Reads what the pixels' rays have met; see Hits.glsl.
#ifndef HitReadback_h
#define HitReadback_h

#include "GL/HostTransfer.h"
#include "Shaders/BufferTable.h"
#include "Shaders/Glsl.h"

#include <cstdint>
#include <vector>

/// The hit of a pixel. In a translucent image, the key is that of the last hit.
struct PixelHit
{
  std::uint32_t Key = glsl::NO_HIT;
  float Depth = 0.0f;         ///< parameter t of the first hit, without the flag of levels
  std::uint32_t Isovalue = 0; ///< index of the first hit's, among those that show
};

class HitReadback
{
public:
  /// The needs have the image's own number of pixels.
  HitReadback(HostTransfer& transfer, GLuint hits, const SceneNeeds& needs)
    : Transfer(transfer)
    , Hits(hits)
    , Needs(needs)
  {
  }

  ///@{ Of all pixels of the image, rows from the bottom. Depths have the flags of levels: see
  /// Hits.glsl.
  std::vector<std::uint32_t> ReadKeys();
  std::vector<float> ReadDepths();
  ///@}
  PixelHit Read(std::int64_t pixel);

  /// Where in the buffer the depths of opaque geometry begin, in bytes.
  static std::int64_t GetObstacleOffset(const SceneNeeds& needs);

private:
  HostTransfer& Transfer;
  GLuint Hits;
  SceneNeeds Needs;
};

#endif
