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

void SliceSize::Record(double milliseconds)
{
  const double factor =
    std::clamp(Milliseconds / std::max(milliseconds, 1e-3), 1.0 / MaximumShrinkage, MaximumGrowth);
  const double items = static_cast<double>(this->Items) * factor;
  this->Items = static_cast<std::int64_t>(std::clamp(items, 1.0, MaximumItems));
}
