// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The sections of the buffer of hits, a word a pixel each: see Hits.glsl, which gets their numbers
// as <NAME>_SECTION.
#ifndef HitSections_h
#define HitSections_h

#include "Shaders/SceneNeeds.h"

struct HitSections
{
  explicit HitSections(const SceneNeeds& needs)
    : Color(Isovalue + (needs.SeveralIsovalues ? 1 : 0))
    , Obstacle(Color + (needs.Colored ? 1 : 0))
    , Count(Obstacle + (needs.Obstructed ? 1 : 0))
  {
  }

  int Key = 0;
  int Depth = 1;
  int Isovalue = 2; ///< if there are several
  int Color;        ///< if another volume gives the colours
  int Obstacle;     ///< if opaque geometry may hide the surface
  int Count;
};

#endif
