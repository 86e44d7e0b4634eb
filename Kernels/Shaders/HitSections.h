// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The sections of the buffer of hits, a word a pixel each: see Hits.glsl, which gets their numbers
// as <NAME>_SECTION.
#ifndef HitSections_h
#define HitSections_h

#include "Shaders/PipelineExtent.h"

struct HitSections
{
  explicit HitSections(const PipelineExtent& extent)
    : Color(Isovalue + (extent.SeveralIsovalues ? 1 : 0))
    , Obstacle(Color + (extent.Colored ? 1 : 0))
    , Count(Obstacle + (extent.Obstructed ? 1 : 0))
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
