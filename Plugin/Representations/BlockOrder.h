// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// In which order translucent blocks are drawn: those that others can hide come first.
#ifndef BlockOrder_h
#define BlockOrder_h

#include <array>
#include <cstddef>
#include <vector>

namespace BlockOrder
{
using Bounds = std::array<double, 6>;

/// Where blocks are seen from, in their own coordinates: from a point, or along a direction
/// (in which case Position points towards the viewer).
struct Viewer
{
  std::array<double, 3> Position;
  bool IsParallel = false;
};

/// Numbers the blocks from back to front. Exact for blocks that planes across the axes part, unless
/// they hide each other in a circle; of others the farthest comes first.
std::vector<std::size_t> FromBackToFront(const std::vector<Bounds>& blocks, const Viewer& viewer);
}

#endif
