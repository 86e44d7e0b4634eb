// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sizes of a volume's levels of detail, and the bits that they get (internal).
#ifndef LevelShape_h
#define LevelShape_h

#include <vector>

struct LevelShape
{
  int Dimensions[3]; ///< samples per axis
  bool Halves[3];    ///< the axes of which the level has every second sample of the one before
  int Steps[3];      ///< samples of level 0 from one sample to the next

  /// Returns the shape of level 0.
  static LevelShape OfVolume(const int dims[3]);

  /// Returns the next level's shape, with every second sample along some axes.
  LevelShape Halve(const bool halves[3]) const;
};

/// Samples of a volume that is one page: levels end with one that is not larger.
constexpr int PageSide = 64;

/// Returns the samples along a halved axis: coarse sample j lies on fine sample 2j, and the last
/// one on the last fine sample, or where there is no such sample, one beyond.
constexpr int HalvedCount(int samples)
{
  return samples / 2 + 1;
}

/**
 * Finds the shapes of at most `levels` levels beyond level 0. Each halves the axes along which
 * samples are nearest to each other, all that are within a factor of the root of 2, so that cells
 * become cubes; axes of 2 samples stay. The last level is the first that fits one page. Spacings
 * that are 0 or not finite count as the smallest of the others.
 */
std::vector<LevelShape> PlanLevels(const int dims[3], const double spacing[3], int levels);

/// Returns the bits per block of level 1, 2, ... of a volume: what keeps a level's largest error
/// below that of level 0 (Testing/Benchmarks/results/levels.md).
int BlockBitsOfLevel(int level, int blockBits);

#endif
