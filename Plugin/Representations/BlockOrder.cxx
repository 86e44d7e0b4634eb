// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockOrder.h"

#include <algorithm>

namespace
{
using BlockOrder::Bounds;
using BlockOrder::Viewer;

// Is the viewer on the upper side of a plane across an axis?
bool IsAbove(const Viewer& viewer, int axis, double plane)
{
  return viewer.IsParallel ? viewer.Position[axis] > 0.0 : viewer.Position[axis] > plane;
}

// Can the front block hide a part of the other one? Not if a plane parts them and the viewer is on
// the other one's side of it.
bool CanHide(const Bounds& front, const Bounds& other, const Viewer& viewer)
{
  bool parted = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double slack = 1e-9 * (front[2 * axis + 1] - front[2 * axis]);
    const bool frontAbove = other[2 * axis + 1] <= front[2 * axis] + slack;
    const bool frontBelow = front[2 * axis + 1] <= other[2 * axis] + slack;
    if (!frontAbove && !frontBelow)
    {
      continue;
    }
    parted = true;
    const double plane = frontAbove ? front[2 * axis] : other[2 * axis];
    if (IsAbove(viewer, axis, plane) != frontAbove)
    {
      return false;
    }
  }
  return parted;
}

double Distance(const Bounds& block, const Viewer& viewer)
{
  double distance = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double middle = 0.5 * (block[2 * axis] + block[2 * axis + 1]);
    const double way = middle - viewer.Position[axis];
    distance += viewer.IsParallel ? -middle * viewer.Position[axis] : way * way;
  }
  return distance;
}
}

std::vector<std::size_t> BlockOrder::FromBackToFront(
  const std::vector<Bounds>& blocks, const Viewer& viewer)
{
  const std::size_t count = blocks.size();
  std::vector<std::size_t> hides(count, 0); // how many blocks that are not drawn yet
  std::vector<std::vector<std::size_t>> hiddenBy(count);
  for (std::size_t front = 0; front < count; ++front)
  {
    for (std::size_t other = 0; other < count; ++other)
    {
      if (front != other && CanHide(blocks[front], blocks[other], viewer))
      {
        ++hides[front];
        hiddenBy[other].push_back(front);
      }
    }
  }
  std::vector<std::size_t> order, left(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    left[i] = i;
  }
  while (!left.empty())
  {
    const auto next = std::max_element(left.begin(), left.end(),
      [&](std::size_t a, std::size_t b)
      {
        const bool firstIsFree = hides[a] == 0, secondIsFree = hides[b] == 0;
        return firstIsFree != secondIsFree
          ? secondIsFree
          : Distance(blocks[a], viewer) < Distance(blocks[b], viewer);
      });
    for (std::size_t front : hiddenBy[*next])
    {
      --hides[front];
    }
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}
