// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PipelineSettings_h
#define PipelineSettings_h

#include "Shaders/Glsl.h"

#include <cstdint>

struct PipelineSettings
{
  std::int64_t MemoryBudget = 0;  ///< bytes beside the compressed stream; 0: automatic
  double MemoryShare = 1.0;       ///< of the budget, which others share; at least what suffices
  std::int64_t LargestBuffer = 0; ///< bytes of one storage buffer; 0: what OpenGL allows
  int SpeculationLimit = glsl::MAX_SPECULATION; ///< 1: off
  int PixelsPerStraggler = -1;                  ///< 0: never; less: what suits the GPU
  bool DecodeWholeVolume = true;                ///< where the budget has room for it
  bool Detailed = false;                        ///< stages are timed, distinct blocks counted
};

#endif
