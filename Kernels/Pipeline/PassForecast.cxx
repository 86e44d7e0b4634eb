// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/PassForecast.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr std::int64_t MostAhead = 3; // enough to hide that the CPU learns of a pass
// Beyond the foretold number any pass may be the last: one that is not needed delays the picture.
constexpr std::int64_t MostAheadBeyond = 2;
}

std::int64_t PassForecast::PassesToSubmit(std::int64_t known, double millisecondsLeft) const
{
  std::int64_t ahead = MostAhead;
  if (this->Passes > 0)
  {
    ahead = known < this->Passes ? std::min(ahead, this->Passes - known) : MostAheadBeyond;
  }
  if (std::isfinite(millisecondsLeft))
  {
    // a first pass may take all the time there is
    const double fit = this->Milliseconds > 0.0 ? millisecondsLeft / this->Milliseconds : 1.0;
    ahead = static_cast<std::int64_t>(std::clamp(fit, 1.0, static_cast<double>(ahead)));
  }
  return known + ahead;
}

void PassForecast::RecordTime(std::int64_t passes, double milliseconds)
{
  this->Milliseconds = milliseconds / static_cast<double>(passes);
}
