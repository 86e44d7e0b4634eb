// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SliceSize.h"

#include <algorithm>

namespace
{
constexpr double MaximumGrowth = 4.0; // other parts of a volume may take longer
constexpr double MaximumShrinkage = 4.0;
constexpr double MaximumItems = 1LL << 30;
}

void SliceSize::Record(std::int64_t items, double milliseconds)
{
  if (2 * items <= this->Items)
  {
    return;
  }
  const double factor =
    std::clamp(Milliseconds / std::max(milliseconds, 1e-3), 1.0 / MaximumShrinkage, MaximumGrowth);
  this->Items =
    static_cast<std::int64_t>(std::clamp(static_cast<double>(items) * factor, 1.0, MaximumItems));
}
